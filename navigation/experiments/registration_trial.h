// Made-up registrations on a given bone with known truth: what a probe draws around a place, with the errors
// that a tip has in practice, seen from a world marker on a screw head nearby.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string_view>

#include "navigation/strokes/curves.h"
#include "planning/bones/bone.h"
#include "planning/geometry/rigid_transform.h"
#include "planning/geometry/surface.h"

namespace arthronaut::experiments {

enum class TrialNoise { Dry, ExVivo, Hard };
[[nodiscard]] std::string_view to_text(TrialNoise noise);               // "dry", "ex-vivo", "hard"
[[nodiscard]] TrialNoise trial_noise_from_text(std::string_view text);  // throws InvalidInput

struct TrialSetting {
  int stroke_count = 6;
  double length_of_each_mm = 90;
  double area_radius_mm = 16;  // strokes stay so near the middle of the area
  double white_mm = 0.1;       // error of each sample, each coordinate
  double slow_mm = 0.1;        // error that varies over 12 to 40 mm of path
  double lifted_share = 0;     // of the samples, in bursts 1 to 6 mm off the bone
  double soft_share = 0;       // of the samples, in bursts on 0.3 to 1.5 mm of soft tissue
  double step_mm = 0.4;        // between samples
};
[[nodiscard]] TrialSetting setting_of(TrialNoise noise);

struct Trial {
  strokes::Curves curves;
  geometry::RigidTransform marker_from_bone;  // the truth
};

// The marker's centre is 1 to 3 mm above a place of the bone 8 to 25 mm from the nearest touched point,
// tilted by up to 25 degrees and turned anyhow. Deterministic by seed. Throws InvalidInput when the bone has
// no such place.
[[nodiscard]] Trial make_trial(const geometry::TriangleMesh& mesh, const geometry::Surface& surface,
                               const Eigen::Vector3d& area_center_mm, const TrialSetting& setting,
                               std::uint64_t seed);

// The middle of the lateral wall of a femur's notch; mesh in LPS. nullopt when the shape has no notch.
[[nodiscard]] std::optional<Eigen::Vector3d> find_lateral_notch_wall(const geometry::TriangleMesh& mesh,
                                                                     const geometry::Surface& surface,
                                                                     bones::Side side);

}  // namespace arthronaut::experiments
