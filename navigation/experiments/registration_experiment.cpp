#include "navigation/experiments/registration_experiment.h"

#include <algorithm>
#include <cmath>
#include <ctime>

#include "planning/files/atomic_file.h"
#include "planning/files/format.h"
#include "planning/geometry/error.h"
#include "planning/geometry/quantile.h"

namespace arthronaut::experiments {

namespace {

double processor_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// Vertices of the bone 25 to 50 mm from the area, as far from one another as can be.
std::vector<ControlPoint> choose_control_points(const geometry::TriangleMesh& mesh,
                                                const Eigen::Vector3d& center_mm) {
  constexpr std::size_t kCount = 8;
  constexpr double kNearest_mm = 25, kFarthest_mm = 50;
  std::vector<ControlPoint> chosen;
  std::vector<double> apart_mm(mesh.vertices_mm.size(), 1e9);
  while (chosen.size() < kCount) {
    std::size_t best = mesh.vertices_mm.size();
    for (std::size_t i = 0; i < mesh.vertices_mm.size(); ++i) {
      const Eigen::Vector3d& p = mesh.vertices_mm[i];
      if (!chosen.empty()) apart_mm[i] = std::min(apart_mm[i], (p - chosen.back().point_mm).norm());
      const double distance_mm = (p - center_mm).norm();
      if (distance_mm < kNearest_mm || distance_mm > kFarthest_mm) continue;
      if (best == mesh.vertices_mm.size() || apart_mm[i] > apart_mm[best]) best = i;
    }
    if (best == mesh.vertices_mm.size()) break;  // a bone so small that nothing is far away
    ControlPoint point;
    point.point_mm = mesh.vertices_mm[best];
    point.distance_mm = (point.point_mm - center_mm).norm();
    chosen.push_back(point);
  }
  std::sort(chosen.begin(), chosen.end(),
            [](const ControlPoint& l, const ControlPoint& r) { return l.distance_mm < r.distance_mm; });
  return chosen;
}

// bone_from_bone: where each reliable trial's registration puts the bone's own points.
void measure_control_point(ControlPoint& control,
                           const std::vector<geometry::RigidTransform>& found_from_true) {
  if (found_from_true.empty()) return;
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  for (const auto& t : found_from_true)
    centroid += t * control.point_mm / static_cast<double>(found_from_true.size());
  double spread = 0, error = 0;
  for (const auto& t : found_from_true) {
    spread += (t * control.point_mm - centroid).squaredNorm();
    error += (t * control.point_mm - control.point_mm).squaredNorm();
  }
  const double count = static_cast<double>(found_from_true.size());
  control.spread_rms_mm = std::sqrt(spread / count);
  control.error_rms_mm = std::sqrt(error / count);
}

void count_outcomes(RegistrationExperimentResult& result) {
  std::vector<double> errors, ratios, seconds;
  for (const TrialOutcome& trial : result.trials) {
    seconds.push_back(trial.seconds);
    if (trial.has_pose) errors.push_back(trial.target_error_mm);
    const bool is_right = result.is_on_own_bone && trial.has_pose &&
                          trial.target_error_mm < RegistrationExperimentResult::success_mm;
    if (is_right && trial.predicted_error_mm > 0)
      ratios.push_back(trial.target_error_mm / trial.predicted_error_mm);
    result.success_count += is_right;
    result.reliable_count += trial.reliable;
    result.reliable_but_wrong_count += trial.reliable && !is_right;
    result.doubted_though_right_count += !trial.reliable && is_right;
  }
  result.median_target_error_mm = geometry::median(std::move(errors), 0);
  result.median_error_ratio = geometry::median(std::move(ratios), 0);
  result.median_seconds = geometry::median(std::move(seconds), 0);
}

}  // namespace

RegistrationExperimentResult run_registration_experiment(const geometry::TriangleMesh& mesh,
                                                         const RegistrationExperimentOptions& options,
                                                         const std::function<void(int)>& progress) {
  if (options.trial_count < 1) throw InvalidInput("an experiment needs at least one trial");
  const registration::SurfaceIndex bone(options.registered_to != nullptr ? *options.registered_to : mesh);
  const TrialSeries series(mesh, options.series);
  const Eigen::Vector3d& target = series.target_mm();

  RegistrationExperimentResult result;
  result.is_on_own_bone = options.registered_to == nullptr;
  result.control_points = choose_control_points(mesh, target);
  std::vector<geometry::RigidTransform> found_from_true;
  for (int i = 0; i < options.trial_count; ++i) {
    const Trial trial = series.make(i);
    const double start = processor_seconds();
    const auto found = registration::register_curves(bone, trial.curves,
                                                     {series.seed_of(i), options.use_marker_prior, target});
    TrialOutcome outcome;
    outcome.seconds = processor_seconds() - start;
    outcome.has_pose = found.has_pose;
    outcome.reliable = found.reliable;
    outcome.reasons = found.reasons;
    outcome.predicted_error_mm = found.predicted_tre_mm;
    outcome.evidence = found.evidence;
    const geometry::RigidTransform moved = found.marker_from_bone.inverse() * trial.marker_from_bone;
    outcome.target_error_mm = (moved * target - target).norm();
    if (found.reliable) found_from_true.push_back(moved);
    result.trials.push_back(std::move(outcome));
    if (progress) progress(i + 1);
  }
  double spread = 0, error = 0;
  for (ControlPoint& control : result.control_points) {
    measure_control_point(control, found_from_true);
    spread += control.spread_rms_mm * control.spread_rms_mm;
    error += control.error_rms_mm * control.error_rms_mm;
  }
  const double count = std::max<double>(1, static_cast<double>(result.control_points.size()));
  result.spread_rms_mm = std::sqrt(spread / count);
  result.error_rms_mm = std::sqrt(error / count);
  count_outcomes(result);
  return result;
}

void write_verdict_evidence(const std::filesystem::path& file, const RegistrationExperimentResult& result) {
  std::string text =
      "trial,reliable,has_pose,target_error_mm,predicted_error_mm,length_in_use_mm,white_noise_mm,"
      "excess_misfit_mm,bearable_excess_mm,lead,side_lead,log_odds,needed_log_odds\n";
  for (std::size_t i = 0; i < result.trials.size(); ++i) {
    const TrialOutcome& trial = result.trials[i];
    const registration::VerdictEvidence& e = trial.evidence;
    const std::string error = result.is_on_own_bone ? files::format("%.4f", trial.target_error_mm) : "";
    const std::string side_lead = e.side_lead ? files::format("%.3f", *e.side_lead) : "";
    text += files::format("%zu,%d,%d,%s,%.4f,%.1f,%.4f,%.4f,%.4f,%.3f,%s,%.3f,%.3f\n", i,
                          trial.reliable ? 1 : 0, trial.has_pose ? 1 : 0, error.c_str(),
                          trial.predicted_error_mm, e.length_in_use_mm, e.white_noise_mm, e.excess_misfit_mm,
                          e.bearable_excess_mm, e.lead, side_lead.c_str(), e.log_odds, e.needed_log_odds);
  }
  files::write_atomically(file, text);
}

}  // namespace arthronaut::experiments
