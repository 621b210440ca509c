#include "app/navigate/finish_words.h"

#include <algorithm>

#include "planning/files/format.h"

namespace arthronaut::navigate {

namespace {

using widgets::Severity;

std::string tunnel_in_words(const FinishedBone& bone) {
  if (!bone.is_drilled) return "not drilled yet";
  if (!bone.measured) return "drilled, by the surgeon's word";
  return bone.measured->depth_mm ? files::format("drilled, %.1f mm deep", *bone.measured->depth_mm)
                                 : "drilled and recorded; depth not read";
}

const FinishedBone* find(const std::vector<FinishedBone>& bones, bones::BoneKind bone, bool is_same) {
  const auto found = std::find_if(bones.begin(), bones.end(),
                                  [&](const FinishedBone& b) { return (b.bone == bone) == is_same; });
  return found == bones.end() ? nullptr : &*found;
}

}  // namespace

FinishList finish_list(const std::vector<FinishedBone>& bones) {
  FinishList list;
  list.is_done = !bones.empty();
  for (const FinishedBone& bone : bones) {
    std::string name(bones::to_text(bone.bone));
    name[0] = bone.bone == bones::BoneKind::Femur ? 'F' : 'T';
    // By word alone is not as good as seen.
    const bool is_seen = bone.is_drilled && bone.measured;
    list.lines.push_back(
        {is_seen ? Severity::Good : Severity::Caution, name + " tunnel", tunnel_in_words(bone)});
    list.lines.push_back({bone.marker_is_out ? Severity::Good : Severity::Caution, name + " marker",
                          bone.marker_is_out ? "out" : "is still in the bone"});
    list.is_done = list.is_done && bone.is_drilled && bone.marker_is_out;
  }
  return list;
}

FinishAction finish_action(const std::vector<FinishedBone>& bones, bones::BoneKind bone, bool is_under_way) {
  const FinishedBone* const own = find(bones, bone, true);
  if (own != nullptr && own->is_drilled && !own->marker_is_out) return FinishAction::TakeMarkerOut;
  const FinishedBone* const other = find(bones, bone, false);
  if (other != nullptr && !(other->is_drilled && other->marker_is_out)) return FinishAction::OtherBone;
  return is_under_way ? FinishAction::EndSource : FinishAction::Nothing;
}

std::string words_of(FinishAction action, bones::BoneKind bone) {
  const std::string own(bones::to_text(bone));
  const std::string other(
      bones::to_text(bone == bones::BoneKind::Femur ? bones::BoneKind::Tibia : bones::BoneKind::Femur));
  switch (action) {
    case FinishAction::TakeMarkerOut:
      return "take the " + own + "'s marker out, then say so";
    case FinishAction::OtherBone:
      return "go on to the " + other;
    case FinishAction::EndSource:
      return "all is drilled, the markers are out: end the pictures";
    case FinishAction::Nothing:
      return "done: the report is in Review (F3)";
  }
  return "";
}

}  // namespace arthronaut::navigate
