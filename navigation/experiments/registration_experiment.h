// The paper's registration experiment on any bone: many made-up trials, how far the results scatter about
// their mean at control points far from what was touched (the paper's figure), and how far they are from the
// truth.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "navigation/experiments/trial_series.h"
#include "navigation/registration/registration.h"

namespace arthronaut::experiments {

struct RegistrationExperimentOptions {
  TrialSeriesOptions series;
  int trial_count = 10;
  bool use_marker_prior = true;
  // The strokes of the trials' bone are registered to this one instead: another person's, so that no result
  // is right and every reliable one is wrong. Null: to their own. Must outlive the run.
  const geometry::TriangleMesh* registered_to = nullptr;
};

struct TrialOutcome {
  bool has_pose = false, reliable = false;
  double target_error_mm = 0;  // against the truth; on another bone it means nothing
  double predicted_error_mm = 0;
  registration::VerdictEvidence evidence;
  double seconds = 0;  // of the processor, for one registration
  std::vector<std::string> reasons;
};

struct ControlPoint {
  Eigen::Vector3d point_mm = Eigen::Vector3d::Zero();
  double distance_mm = 0;    // from the middle of the digitised area
  double spread_rms_mm = 0;  // about the centroid of the reliable trials: precision, the paper's figure
  double error_rms_mm = 0;   // of the reliable trials, against the truth: accuracy
};

struct RegistrationExperimentResult {
  std::vector<TrialOutcome> trials;
  std::vector<ControlPoint> control_points;
  double spread_rms_mm = 0, error_rms_mm = 0;  // over all control points
  double median_target_error_mm = 0;           // of the trials with a pose
  double median_error_ratio = 0;               // error / predicted error, of the trials within success_mm
  double median_seconds = 0;
  bool is_on_own_bone = true;
  int success_count = 0;  // target error below success_mm, on the own bone
  int reliable_count = 0, reliable_but_wrong_count = 0, doubted_though_right_count = 0;
  static constexpr double success_mm = 2.0;
};

// progress gets the number of trials done. Deterministic by seed but for the times. Throws InvalidInput when
// the options break their contract or no notch is found and no area given.
[[nodiscard]] RegistrationExperimentResult run_registration_experiment(
    const geometry::TriangleMesh& mesh, const RegistrationExperimentOptions& options,
    const std::function<void(int)>& progress = {});

// One row a trial: what its verdict rested on. CSV: trial, reliable, has_pose, target_error_mm (empty on
// another bone), predicted_error_mm, length_in_use_mm, white_noise_mm, excess_misfit_mm, bearable_excess_mm,
// lead, side_lead (empty where the mirror image was not asked), log_odds, needed_log_odds. "-" is standard
// output. Throws IoError.
void write_verdict_evidence(const std::filesystem::path& file, const RegistrationExperimentResult& result);

// The paper's plot: spread and error at each control point. PNG. Throws IoError.
void write_registration_plot(const std::filesystem::path& file, const RegistrationExperimentResult& result,
                             TrialNoise noise);

}  // namespace arthronaut::experiments
