// The phantom's femur, made ready once for all tests of a program, and trials on it.
#pragma once

#include <cstdio>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "navigation/experiments/registration_trial.h"
#include "navigation/registration/registration.h"
#include "planning/phantom/phantom_knee.h"

namespace arthronaut::registration {

struct PhantomBone {
  geometry::TriangleMesh mesh;
  Eigen::Vector3d target_mm;  // the tunnel's entry, on the lateral wall of the notch
  std::shared_ptr<const SurfaceIndex> prepared;
  std::unique_ptr<geometry::Surface> surface;

  [[nodiscard]] experiments::Trial trial(experiments::TrialNoise noise, std::uint64_t seed) const {
    return trial(experiments::setting_of(noise), seed);
  }
  [[nodiscard]] experiments::Trial trial(const experiments::TrialSetting& setting, std::uint64_t seed) const {
    return experiments::make_trial(mesh, *surface, target_mm, setting, seed);
  }
};

inline PhantomBone make_phantom_bone(std::uint64_t seed) {
  const phantom::PhantomKnee knee = phantom::make_phantom_knee({.seed = seed});
  PhantomBone bone;
  bone.mesh = knee.femur.mesh;
  bone.prepared = std::make_shared<const SurfaceIndex>(bone.mesh);
  bone.surface = std::make_unique<geometry::Surface>(bone.mesh);
  bone.target_mm = bone.surface->closest_point(knee.femoral_tunnel.entry_mm).point_mm;
  return bone;
}

inline const PhantomBone& phantom_bone() {
  static const PhantomBone bone = make_phantom_bone(1);
  return bone;
}

// Strokes on a bone that beyond `bare_mm` of the target is covered, by cartilage that the mesh lacks
// (thickness above 0) or has too much (below 0).
struct CartilageTrial {
  experiments::Trial trial;
  CartilageRegion region;
  std::vector<bool> is_on_cartilage;  // by point of the curves
};

inline CartilageTrial cartilage_trial(const PhantomBone& bone, experiments::Trial trial, double thickness_mm,
                                      double bare_mm = 9) {
  constexpr double kEnd_mm = 30;  // no stroke goes so far
  CartilageTrial laid{std::move(trial), {}, {}};
  for (strokes::CurvePoint& point : laid.trial.curves) {
    const Eigen::Vector3d p = laid.trial.marker_from_bone.inverse() * point.position_mm;
    const geometry::SurfacePoint nearest = bone.surface->closest_point(p);
    laid.is_on_cartilage.push_back((nearest.point_mm - bone.target_mm).norm() > bare_mm);
    if (!laid.is_on_cartilage.back()) continue;
    point.position_mm = laid.trial.marker_from_bone * (p + thickness_mm * nearest.normal);
  }
  for (const Eigen::Vector3d& vertex : bone.mesh.vertices_mm) {
    const double away_mm = (vertex - bone.target_mm).norm();
    if (away_mm > bare_mm + laid.region.reach_mm && away_mm < kEnd_mm)
      laid.region.points_mm.push_back(vertex);
  }
  return laid;
}

// Not a number where the text tells none.
inline double thickness_in(const std::string& assumption) {
  double thickness_mm = 0;
  const int count = std::sscanf(assumption.c_str(), "the cartilage lies %lf", &thickness_mm);
  return count == 1 ? thickness_mm : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace arthronaut::registration
