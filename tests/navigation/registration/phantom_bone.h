// The phantom's femur, made ready once for all tests of a program, and trials on it.
#pragma once

#include <memory>

#include "navigation/experiments/registration_trial.h"
#include "navigation/registration/registration.h"
#include "planning/phantom/phantom_knee.h"

namespace arthronaut::registration {

struct PhantomBone {
  geometry::TriangleMesh mesh;
  Eigen::Vector3d target_mm;  // the tunnel's entry, on the lateral wall of the notch
  std::shared_ptr<const PreparedBone> prepared;
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
  bone.prepared = std::make_shared<const PreparedBone>(bone.mesh);
  bone.surface = std::make_unique<geometry::Surface>(bone.mesh);
  bone.target_mm = bone.surface->closest_point(knee.femoral_tunnel.entry_mm).point_mm;
  return bone;
}

inline const PhantomBone& phantom_bone() {
  static const PhantomBone bone = make_phantom_bone(1);
  return bone;
}

}  // namespace arthronaut::registration
