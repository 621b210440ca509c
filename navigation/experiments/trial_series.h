// The trials of one registration experiment, each made when it is asked for; and the same trials as files, so
// that other programs can be run on the very same ones.
#pragma once

#include <filesystem>

#include "navigation/experiments/registration_trial.h"

namespace arthronaut::experiments {

struct TrialSeriesOptions {
  TrialNoise noise = TrialNoise::Dry;
  std::uint64_t seed = 1;
  bones::Side side = bones::Side::Right;
  // Middle of the digitised area and the target; else the lateral wall of the femur's notch.
  std::optional<Eigen::Vector3d> area_center_mm;
};

// Keeps a reference to the mesh.
class TrialSeries {
 public:
  // Throws InvalidInput when no area is given and the bone shows no notch.
  TrialSeries(const geometry::TriangleMesh& mesh, const TrialSeriesOptions& options);

  [[nodiscard]] const geometry::TriangleMesh& mesh() const { return mesh_; }
  [[nodiscard]] const Eigen::Vector3d& target_mm() const { return target_mm_; }  // bone frame, on the surface
  [[nodiscard]] TrialNoise noise() const { return options_.noise; }
  [[nodiscard]] std::uint64_t seed_of(int trial) const {
    return options_.seed * 100'003 + static_cast<std::uint64_t>(trial);
  }
  [[nodiscard]] Trial make(int trial) const;

 private:
  const geometry::TriangleMesh& mesh_;
  geometry::Surface surface_;
  TrialSeriesOptions options_;
  Eigen::Vector3d target_mm_;
};

// Into the folder, which is made when it isn't there: bone.ply (mm, LPS), trial_K.csv (curves.csv) and
// trial_K.json
// ("arthronaut.trial": the true marker_from_bone, target_mm in the bone frame, the noise and the seed), K
// from 0. Throws IoError.
void write_trials(const std::filesystem::path& folder, const TrialSeries& series, int trial_count);

}  // namespace arthronaut::experiments
