#include "app/navigate/finish_words.h"

#include <algorithm>
#include <cctype>

#include "planning/files/format.h"

namespace arthronaut::navigate {

namespace {

using widgets::Severity;

std::string tunnel_in_words(const FinishedTunnel& tunnel) {
  if (!tunnel.is_drilled) return "not drilled yet";
  if (!tunnel.measured) return "drilled, by the surgeon's word";
  return tunnel.measured->depth_mm ? files::format("drilled, %.1f mm deep", *tunnel.measured->depth_mm)
                                   : "drilled and recorded; depth not read";
}

// "Femur tunnel", "Femur AM tunnel".
std::string name_in_list(std::string name, const char* of_it) {
  name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  return name + of_it;
}

const FinishedBone* find(const std::vector<FinishedBone>& bones, bones::BoneKind bone, bool is_same) {
  const auto found = std::find_if(bones.begin(), bones.end(),
                                  [&](const FinishedBone& b) { return (b.bone == bone) == is_same; });
  return found == bones.end() ? nullptr : &*found;
}

}  // namespace

bool FinishedBone::is_drilled() const {
  return !tunnels.empty() && std::ranges::all_of(tunnels, &FinishedTunnel::is_drilled);
}

std::optional<bool> FinishedBone::was_verified() const {
  std::optional<bool> all;
  for (const FinishedTunnel& tunnel : tunnels)
    if (tunnel.is_drilled) all = all.value_or(true) && tunnel.was_verified;
  return all;
}

FinishList finish_list(const std::vector<FinishedBone>& bones) {
  FinishList list;
  list.is_done = !bones.empty();
  for (const FinishedBone& bone : bones) {
    for (const FinishedTunnel& tunnel : bone.tunnels) {
      // By word alone is not as good as seen.
      const bool is_seen = tunnel.is_drilled && tunnel.measured;
      list.lines.push_back({is_seen ? Severity::Good : Severity::Caution,
                            name_in_list(tunnels::name_of(tunnel.key), " tunnel"), tunnel_in_words(tunnel)});
    }
    if (const auto was_verified = bone.was_verified())
      list.lines.push_back({*was_verified ? Severity::Good : Severity::Caution,
                            name_in_list(std::string(bones::to_text(bone.bone)), " registration"),
                            *was_verified ? "verified by touches" : "NOT verified by touches"});
    list.lines.push_back({bone.marker_is_out ? Severity::Good : Severity::Caution,
                          name_in_list(std::string(bones::to_text(bone.bone)), " marker"),
                          bone.marker_is_out ? "out"
                          : bone.has_begun   ? "is still in the bone"
                                             : "not said to be out"});
    list.is_done = list.is_done && bone.is_drilled() && bone.marker_is_out;
  }
  return list;
}

FinishAction finish_action(const std::vector<FinishedBone>& bones, bones::BoneKind bone, bool is_under_way) {
  const FinishedBone* const own = find(bones, bone, true);
  if (own != nullptr && own->is_drilled() && !own->marker_is_out) return FinishAction::TakeMarkerOut;
  const FinishedBone* const other = find(bones, bone, false);
  if (other != nullptr && !(other->is_drilled() && other->marker_is_out)) return FinishAction::OtherBone;
  return is_under_way ? FinishAction::EndSource : FinishAction::Nothing;
}

std::string words_of(FinishAction action, const std::vector<FinishedBone>& bones, bones::BoneKind bone) {
  const bool is_unverified =
      std::ranges::any_of(bones, [](const FinishedBone& one) { return !one.was_verified().value_or(true); });
  const std::string own(bones::to_text(bone));
  const std::string other(
      bones::to_text(bone == bones::BoneKind::Femur ? bones::BoneKind::Tibia : bones::BoneKind::Femur));
  switch (action) {
    case FinishAction::TakeMarkerOut:
      return "take the " + own + "'s marker out, then press";
    case FinishAction::OtherBone:
      return "go on to the " + other;
    case FinishAction::EndSource:
      return "all is drilled, the markers are out: end the pictures";
    case FinishAction::Nothing:
      return is_unverified ? "done, not verified: the report is in Review (F3)"
                           : "done: the report is in Review (F3)";
  }
  return "";
}

}  // namespace arthronaut::navigate
