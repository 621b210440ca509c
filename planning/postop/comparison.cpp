#include "planning/postop/comparison.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "planning/files/format.h"
#include "planning/geometry/error.h"
#include "planning/postop/bone_pose.h"
#include "planning/postop/drilled_tunnel.h"

namespace arthronaut::postop {

namespace {

// A stretch says how wide the bore is where so much of its wall is seen, free of metal.
constexpr double kSeenOfStretch = 0.5, kMetalOfStretch = 0.3, kMostWidthSigma_mm = 0.5;
// Thin cortex about empty marrow is no brighter than this in the mean, and soft tissue is darker.
constexpr double kFaintBone_hu = 110;
// Where all that is brighter than that encloses no more than so much beyond what is as bright as bone, it is
// the same bones: whatever was not found among those is not found among these. A joint's end of a bone has 60
// cm^3 and more.
constexpr double kMoreOfFaint_mm3 = 15000;

AchievedBone told(const FoundBone& found) {
  AchievedBone bone;
  bone.is_found = found.is_found;
  bone.reliable = found.reliable;
  bone.reasons = found.reasons;
  if (!found.is_found) return bone;
  bone.plan_from_postop = found.pose.postop_from_plan.inverse();
  bone.rms_mm = found.pose.rms_mm;
  bone.on_edge_share = found.pose.on_edge_share;
  bone.in_view_share = found.pose.in_view_share;
  return bone;
}

double offset_across_mm(const tunnels::Tunnel& achieved, const tunnels::Tunnel& plan) {
  const double along_mm =
      (plan.entry_mm - achieved.entry_mm).dot(plan.direction) / achieved.direction.dot(plan.direction);
  return (achieved.entry_mm + along_mm * achieved.direction - plan.entry_mm).norm();
}

void take_trust(AchievedTunnel& achieved, const std::string& reason) {
  achieved.reliable = false;
  achieved.known.clear();
  achieved.reasons.insert(achieved.reasons.begin(), reason);
}

AchievedTunnel told(const DrilledTunnel& drilled, const FoundBone& bone, const tunnels::Tunnel& plan) {
  AchievedTunnel achieved;
  achieved.is_found = drilled.is_found;
  achieved.reasons.clear();
  achieved.known = tunnels::all_quantities();
  for (const Doubt& one : drilled.doubts) {
    achieved.reasons.push_back(one.reason);
    for (const tunnels::Quantity quantity : one.about) achieved.known.erase(quantity);
  }
  achieved.reliable = drilled.is_found && drilled.doubts.empty();
  if (drilled.is_found) {
    achieved.tunnel = drilled.tunnel;
    achieved.length_mm = drilled.length_mm;
    achieved.comes_out = drilled.comes_out;
    achieved.end_is_seen = drilled.end_is_seen;
    achieved.beyond_mm = drilled.beyond_mm;
    achieved.offset_mm = (drilled.tunnel.entry_mm - plan.entry_mm).norm();
    achieved.offset_across_mm = offset_across_mm(drilled.tunnel, plan);
    achieved.angle_rad = geometry::angle_between_rad(drilled.tunnel.direction, plan.direction);
    achieved.entry_sigma_mm = std::hypot(
        drilled.entry_sigma_mm, drilled.entry_per_across * bone.pose.sigma_at_mm(drilled.tunnel.entry_mm));
    achieved.direction_sigma_rad =
        std::hypot(drilled.direction_sigma_rad, bone.pose.sigma_of_direction_rad(drilled.tunnel.direction));
    achieved.diameter_sigma_mm = drilled.diameter_sigma_mm;
    achieved.length_sigma_mm = drilled.length_sigma_mm;
    achieved.metal_share = drilled.metal_share;
    for (const Stretch& stretch : drilled.stretches) {
      if (stretch.seen_share >= kSeenOfStretch && stretch.metal_share <= kMetalOfStretch &&
          stretch.noise_sigma_mm <= kMostWidthSigma_mm)
        achieved.widths.push_back({stretch.from_entry_mm, stretch.diameter_mm, stretch.diameter_sigma_mm});
    }
  }
  if (!bone.reliable)
    take_trust(achieved, "where the " + std::string(bones::to_text(plan.bone)) + " lies is not reliable");
  if (achieved.reliable) achieved.known.clear();
  return achieved;
}

// What is seen above a threshold.
struct SeenBones {
  double threshold_hu;
  BoneField field;
};

SeenBones seen_bones(const images::Volume& volume, double threshold_hu) {
  for (const double threshold : {threshold_hu, kFaintBone_hu}) {
    if (auto field = bone_field(volume, threshold)) return {threshold, std::move(*field)};
  }
  const auto [low, high] = std::ranges::minmax_element(volume.values);
  throw InvalidInput(
      files::format("shows no bone: nothing of any size is above %.0f HU; its values run from %.0f to %.0f",
                    std::min(threshold_hu, kFaintBone_hu), *low, *high));
}

}  // namespace

bool is_relied_on(const Comparison& comparison) {
  return comparison.bone.is_found && comparison.bone.reliable && comparison.tunnel.is_found &&
         comparison.tunnel.reliable;
}

tunnels::Quantities relied_on(const Comparison& comparison) {
  if (is_relied_on(comparison)) return tunnels::all_quantities();
  const bool is_found = comparison.bone.is_found && comparison.bone.reliable && comparison.tunnel.is_found;
  return is_found ? comparison.tunnel.known : tunnels::Quantities{};
}

bool is_relied_on(const Comparison& comparison, const tunnels::Quantities& quantities) {
  return std::ranges::includes(relied_on(comparison), quantities);
}

void doubt(Comparison& comparison, const std::string& reason) {
  comparison.bone.reliable = false;
  comparison.bone.reasons.insert(comparison.bone.reasons.begin(), reason);
  take_trust(comparison.tunnel, reason);
}

ComparisonVerdict verdict_of(const Comparison& comparison, bool is_of_the_plan) {
  if (!comparison.bone.is_found) return ComparisonVerdict::BoneNotFound;
  if (!comparison.tunnel.is_found) return ComparisonVerdict::TunnelNotFound;
  if (!is_of_the_plan) return ComparisonVerdict::OfAnEarlierPlan;
  if (is_relied_on(comparison)) return ComparisonVerdict::Reliable;
  return relied_on(comparison).empty() ? ComparisonVerdict::NotReliable : ComparisonVerdict::ReliableInPart;
}

std::string_view to_text(ComparisonVerdict verdict) {
  switch (verdict) {
    case ComparisonVerdict::BoneNotFound:
      return "bone not found in the images";
    case ComparisonVerdict::TunnelNotFound:
      return "no tunnel found";
    case ComparisonVerdict::OfAnEarlierPlan:
      return "of an earlier plan";
    case ComparisonVerdict::NotReliable:
      return "not reliable";
    case ComparisonVerdict::ReliableInPart:
      return "reliable in part";
    case ComparisonVerdict::Reliable:
      return "reliable";
  }
  return "";
}

bool is_against(const AchievedTunnel& achieved, const tunnels::Tunnel& plan) {
  constexpr double kRounded_mm = 0.01, kRounded_rad = 1e-3;
  return std::abs((achieved.tunnel.entry_mm - plan.entry_mm).norm() - achieved.offset_mm) < kRounded_mm &&
         std::abs(geometry::angle_between_rad(achieved.tunnel.direction, plan.direction) -
                  achieved.angle_rad) < kRounded_rad;
}

bool is_against(const AchievedTunnel& achieved, const tunnels::TunnelKey& key,
                const std::map<tunnels::TunnelKey, tunnels::Tunnel>& planned) {
  const auto plan = planned.find(key);
  return plan != planned.end() && is_against(achieved, plan->second);
}

struct PostopImages::Prepared {
  const images::Volume& volume;
  images::VolumeSampler sampler;
  SeenBones bones;
};

PostopImages::PostopImages(const images::Volume& postop, const ComparisonOptions& options)
    : prepared_(std::make_unique<Prepared>(
          Prepared{postop, images::VolumeSampler(postop), seen_bones(postop, options.threshold_hu)})) {}
PostopImages::~PostopImages() = default;
PostopImages::PostopImages(PostopImages&&) noexcept = default;
PostopImages& PostopImages::operator=(PostopImages&&) noexcept = default;

Comparison PostopImages::compare(const geometry::TriangleMesh& bone, const tunnels::Tunnel& plan,
                                 std::span<const tunnels::Tunnel> others, const GoesOn& goes_on) const {
  Comparison comparison;
  const SeenBones& seen = prepared_->bones;
  bool is_ended = false;
  const auto half = [&](double first) {
    return [&, first](double share) {
      is_ended = goes_on && !goes_on(first + 0.5 * share);
      return !is_ended;
    };
  };
  FoundBone found = find_bone(prepared_->sampler, seen.field, bone, plan.entry_mm, half(0));
  if (!found.is_found && !is_ended && seen.threshold_hu > kFaintBone_hu) {
    const auto faint = bone_field(prepared_->volume, kFaintBone_hu);
    if (faint && faint->bone_mm3 > kMoreOfFaint_mm3 + seen.field.bone_mm3)
      found = find_bone(prepared_->sampler, *faint, bone, plan.entry_mm, half(0.5));
  }
  if (is_ended) return comparison;
  comparison.bone = told(found);
  if (!found.is_found) {
    comparison.tunnel.reasons = {"the " + std::string(bones::to_text(plan.bone)) +
                                 " was not found in the images"};
    return comparison;
  }
  const DrilledTunnel drilled = find_drilled(prepared_->volume, found.pose.postop_from_plan,
                                             geometry::Surface(bone), plan, others, half(0.5));
  if (is_ended) return {};
  comparison.tunnel = told(drilled, found, plan);
  return comparison;
}

}  // namespace arthronaut::postop
