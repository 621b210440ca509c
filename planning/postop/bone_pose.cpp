#include "planning/postop/bone_pose.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <span>

#include "planning/files/format.h"

namespace arthronaut::postop {

namespace {

constexpr double kRadius_mm = 90;
constexpr std::size_t kSamples = 3000;
// Images that cut the bones off may hold no more of it than this about the planned entry.
constexpr std::array kNear_mm{38.0, 30.0};
// And it lies where they end then: so much farther from there, anchors stand for no such part.
constexpr double kBesideEnd_mm = 20;
// Less of the surface on an edge, edges more uneven, or a bone that would have to be longer or shorter to fit
// is another bone. That all edges lie outside, or inside, by as much is another scanner or another threshold.
constexpr double kLeastOnEdge = 0.85, kMostSpread_mm = 0.25, kMostBias_mm = 0.6, kMostStretch = 0.005;
// Less of the surface about the joint in view does not tell one bone from another.
constexpr double kLeastInView = 0.5;
constexpr double kMostSigma_mm = 0.3;
// So little on an edge: the bone is not in these images at all.
constexpr double kNothingOnEdge = 0.4;

constexpr const char* kNotInThem =
    ": they are another patient's, or of the other side, or do not show this bone";
constexpr const char* kTooLittle =
    ": they are another patient's, or of the other side, or show too little of it; 60 mm from the joint on "
    "are enough";

bool lies_on_edges(const EdgePose& pose) {
  return pose.on_edge_share >= kLeastOnEdge && pose.spread_mm <= kMostSpread_mm;
}
bool is_settled(const EdgePose& pose) {
  return lies_on_edges(pose) && pose.stretch <= kMostStretch && pose.in_view_share >= kLeastInView;
}

// What is out of view counts half: else a corner of the bone that happens to fit would win.
double merit(const EdgePose& pose) {
  return pose.on_edge_share * pose.in_view_share + 0.3 * (1 - pose.in_view_share);
}

}  // namespace

FoundBone find_bone(const images::VolumeSampler& postop, const BoneField& field,
                    const geometry::TriangleMesh& bone, const Eigen::Vector3d& near_mm,
                    const GoesOn& goes_on) {
  FoundBone found;
  const auto samples = surface_samples(bone, near_mm, kRadius_mm, kSamples);
  if (samples.empty()) {
    found.reasons = {"the plan's bone has no surface near the planned entry"};
    return found;
  }
  double best = -1;
  bool is_ended = false;
  // Of the searches that there may be: small and large turns, of all of it and of what is near.
  const double searches = 2 * (1 + (field.is_cut ? static_cast<double>(kNear_mm.size()) : 0));
  double searched = 0;
  const auto goes_on_here = [&](double share) {
    is_ended = goes_on && !goes_on((searched + share) / searches);
    return !is_ended;
  };
  const auto seek = [&](std::span<const SurfaceSample> sought, std::span<const Eigen::Vector3d> anchors_mm) {
    for (const Turns turns : {Turns::Small, Turns::Large}) {
      for (const CoarsePose& coarse : coarse_poses(field, anchors_mm, sought, turns, goes_on_here)) {
        if (!goes_on_here(1)) return;
        const EdgePose pose = edge_pose(postop, samples, coarse.postop_from_plan);
        if (!(pose.in_view_share > 0) || merit(pose) <= best) continue;
        best = merit(pose);
        found.pose = pose;
      }
      if (is_ended) return;
      searched += 1;
      const bool is_whole = sought.size() == samples.size();
      if (best >= 0 && (is_whole ? is_settled(found.pose) : lies_on_edges(found.pose))) return;
    }
  };
  seek(samples, field.anchors_mm);
  for (const double radius_mm : kNear_mm) {
    if (is_ended || !field.is_cut || (best >= 0 && lies_on_edges(found.pose))) break;
    std::vector<SurfaceSample> near;
    std::ranges::copy_if(samples, std::back_inserter(near), [&](const SurfaceSample& sample) {
      return (sample.point_mm - near_mm).norm() < radius_mm;
    });
    if (!near.empty()) seek(near, field.anchors_near_an_end(radius_mm + kBesideEnd_mm));
  }
  if (is_ended) return {};
  found.reasons.clear();
  const EdgePose& pose = found.pose;
  if (best < 0 || pose.on_edge_share < kNothingOnEdge) {
    found.reasons.push_back(std::string("nothing in the images looks like it") +
                            (field.is_cut ? kTooLittle : kNotInThem));
    return found;
  }
  found.is_found = true;
  if (pose.in_view_share < kLeastInView)
    found.reasons.push_back(
        files::format("only %.0f %% of it about the joint are in the images, %.0f %% are needed; 60 mm of it "
                      "from the joint on are enough",
                      100 * pose.in_view_share, 100 * kLeastInView));
  if (pose.on_edge_share < kLeastOnEdge)
    found.reasons.push_back(files::format(
        "only %.0f %% of its surface lie on an edge of the images, %.0f %% are needed: it may be another "
        "patient's bone, or the other side's",
        100 * pose.on_edge_share, 100 * kLeastOnEdge));
  if (pose.spread_mm > kMostSpread_mm)
    found.reasons.push_back(files::format(
        "its surface is unevenly off the edges of the images, by %.2f mm (rms), %.2f mm are borne: it may be "
        "another patient's bone",
        pose.spread_mm, kMostSpread_mm));
  if (std::abs(pose.bias_mm) > kMostBias_mm)
    found.reasons.push_back(
        files::format("its surface lies %.2f mm off the edges of the images all over, %.2f mm are borne",
                      pose.bias_mm, kMostBias_mm));
  if (pose.stretch > kMostStretch)
    found.reasons.push_back(files::format(
        "it would have to be %.1f %% longer or shorter to fit the images, %.1f %% are borne: it "
        "may be another patient's bone, or slices too thick",
        100 * pose.stretch, 100 * kMostStretch));
  if (const double sigma = pose.sigma_at_mm(near_mm); sigma > kMostSigma_mm)
    found.reasons.push_back(files::format(
        "where it lies is known to %.2f mm at the planned entry, %.2f mm are needed", sigma, kMostSigma_mm));
  found.reliable = found.reasons.empty();
  return found;
}

}  // namespace arthronaut::postop
