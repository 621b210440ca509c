#include "navigation/registration/verdict/confidence.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "navigation/registration/search/shaft_collision.h"
#include "navigation/registration/verdict/held_by_strokes.h"
#include "planning/files/format.h"
#include "planning/geometry/quantile.h"

namespace arthronaut::registration {

using geometry::cross_matrix;
using geometry::Matrix6d;

namespace {

// The covariance of marker_from_bone's body twist from that of the bone frame's twist about the pivot.
Matrix6d about_origin(const Matrix6d& about_pivot, const Eigen::Vector3d& pivot_mm) {
  Matrix6d shift = Matrix6d::Identity();
  shift.topRightCorner<3, 3>() = cross_matrix(pivot_mm);
  const Matrix6d covariance = shift * about_pivot * shift.transpose();
  return 0.5 * (covariance + covariance.transpose());
}

void measure_inliers(const RefinedPose& best, const WeightedPoints& points, RegistrationSummary& summary) {
  constexpr double kInlier_mm = 1.0;
  double inlier_weight = 0, square_sum = 0;
  for (std::size_t i = 0; i < points.positions_mm.size(); ++i) {
    if (std::abs(best.residuals_mm[i]) > kInlier_mm) continue;
    inlier_weight += points.weights[i];
    square_sum += points.weights[i] * best.residuals_mm[i] * best.residuals_mm[i];
  }
  summary.rms_mm = inlier_weight > 0 ? std::sqrt(square_sum / inlier_weight) : 0.0;
  summary.inlier_fraction = inlier_weight / std::max(points.weight_sum, 1e-9);
}

double misfit_of(const std::vector<double>& residuals_mm, const TouchedCurves& touched) {
  constexpr double kDeepest_mm = 1.5;  // deeper is no touch of this bone at all
  const double white_noise_mm = touched.white_noise_mm;
  double square_sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < residuals_mm.size(); ++i) {
    const double residual = residuals_mm[i];
    const bool is_left_out = !touched.offsets_mm.empty() && !touched.offsets_mm[i];
    if (residual >= 0 || residual < -kDeepest_mm || is_left_out) continue;
    square_sum += residual * residual;
    ++count;
  }
  const double square = count > 0 ? square_sum / count : 0.0;
  // The six parameters of the pose took up a part of the miss, the more the fewer measurements there are.
  const double measurements = touched.points.weight_sum / kCorrelationLength_mm;
  const double taken_up = measurements / std::max(measurements - 6, 1.0);
  return std::sqrt(taken_up * std::max(0.0, square - white_noise_mm * white_noise_mm));
}

double shared_misfit_of(const std::vector<double>& residuals_mm, const WeightedPoints& points) {
  constexpr double kSamePlace_mm = 1.5, kTouch_mm = 1.0;  // further off is lifted or no touch of this bone
  constexpr int kMinPairs = 30, kUnrelated = 4;
  double product_sum = 0, sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < residuals_mm.size(); ++i) {
    if (std::abs(residuals_mm[i]) > kTouch_mm) continue;
    for (std::size_t j = i + 1; j < residuals_mm.size(); ++j) {
      // Stretches that follow one another still share errors of the tip.
      if (points.stretches[j] < points.stretches[i] + kUnrelated || std::abs(residuals_mm[j]) > kTouch_mm)
        continue;
      if ((points.positions_mm[i] - points.positions_mm[j]).squaredNorm() > kSamePlace_mm * kSamePlace_mm)
        continue;
      product_sum += residuals_mm[i] * residuals_mm[j];
      sum += residuals_mm[i] + residuals_mm[j];
      ++count;
    }
  }
  if (count < kMinPairs) return 0;
  const double mean = sum / (2 * count);
  return std::sqrt(std::max(0.0, product_sum / count - mean * mean));
}

// The whole miss, less what the slow errors that come with such white noise make of it.
double excess_misfit_mm(const RegistrationSummary& summary, double white_noise_mm) {
  constexpr double kSlowOfWhite = 0.75;
  return summary.misfit_mm - kSlowOfWhite * white_noise_mm + summary.shared_misfit_mm;
}

// More of it is another bone's surface, however the strokes lie.
constexpr double kExcess_mm = 0.32, kExcessOfNoise = 0.8;
double max_excess_mm(double white_noise_mm) { return kExcess_mm + kExcessOfNoise * white_noise_mm; }

// The log odds that a pose is the right one, by logistic regression of right poses against wrong ones
// (docs/thresholds.md). One that few strokes hold loosely, or that misses them, leads by chance: on another
// person's femur too. Fitted to 290 mm of strokes and more, half of them off the bone; with less, another
// person's bone has less to differ by.
constexpr double kClearLead = 2;
constexpr double kLeadAlone = 25;      // that no other pose was found, or none near, says no more
constexpr double kSideLeadAlone = 20;  // nor that the mirror image comes nowhere near, or needn't be asked
double log_odds_of(const RegistrationSummary& summary, double predicted_error_mm) {
  constexpr double kOfLead = 0.308, kOfError = 4.415, kOfMisfit = 2.505, kOfSideLead = 0.369, kAlways = 9.31;
  constexpr double kLength_mm = 350, kOfShortness = 2.2;
  constexpr double kLeastNoise_mm = 0.05;  // no mesh is truer to its bone
  const VerdictEvidence& evidence = summary.evidence;
  const double noise_mm = std::max(evidence.white_noise_mm, kLeastNoise_mm);
  return kAlways + kOfLead * std::log1p(std::clamp(evidence.lead, 0.0, kLeadAlone)) -
         kOfError * std::log(predicted_error_mm / noise_mm) -
         kOfMisfit * evidence.excess_misfit_mm / noise_mm +
         kOfSideLead * std::min(evidence.side_lead.value_or(kSideLeadAlone), kSideLeadAlone) -
         kOfShortness * std::log(std::max(1.0, kLength_mm / evidence.length_in_use_mm));
}

VerdictEvidence evidence_for(const RegistrationSummary& summary, const TouchedCurves& touched, double lead) {
  VerdictEvidence evidence;
  evidence.length_in_use_mm = touched.length_mm;
  evidence.white_noise_mm = touched.white_noise_mm;
  evidence.excess_misfit_mm = excess_misfit_mm(summary, touched.white_noise_mm);
  evidence.bearable_excess_mm = max_excess_mm(touched.white_noise_mm);
  evidence.lead = lead;
  evidence.needed_log_odds = kNeededLogOdds;
  return evidence;
}

std::string reason_against_size(const StrokeScale& scale) {
  return files::format(
      "the strokes are %.1f %% %s than the bone: the size of the markers, the probe's tip or the camera's "
      "calibration is wrong, or it is another bone",
      100 * std::abs(scale.ratio - 1), scale.ratio > 1 ? "larger" : "smaller");
}

std::string reason_against_odds(const RegistrationSummary& summary) {
  return files::format(
      "strokes that miss the surface by %.2f mm fit another bone too: draw more of them, "
      "on other faces of the notch too",
      summary.misfit_mm);
}

// How the pose stands at the middle of the strokes, where it is known best, and how far off the target lies.
struct AtStrokes {
  double predicted_error_mm, log_odds, target_off_mm;
};

std::vector<std::string> doubts(const RegistrationSummary& summary, const TouchedCurves& touched,
                                const AtStrokes& at_strokes) {
  const VerdictEvidence& evidence = summary.evidence;
  constexpr double kMinInliers = 0.5;
  std::vector<std::string> reasons;
  if (touched.length_mm < kMinLength_mm) {
    reasons.push_back(files::format("too little was touched: draw %.0f mm more",
                                    std::ceil(kMinLength_mm - touched.length_mm)));
  }
  if (differ_in_size(summary.stroke_scale)) reasons.push_back(reason_against_size(summary.stroke_scale));
  if (evidence.excess_misfit_mm > evidence.bearable_excess_mm) {
    reasons.push_back(files::format(
        "the points miss the surface by %.2f mm, more than the tip's noise of %.2f mm explains: "
        "is it this patient's bone?",
        summary.misfit_mm, touched.white_noise_mm));
  }
  if (summary.inlier_fraction < kMinInliers) reasons.push_back("too few of the points lie on this bone");
  const bool is_held = summary.predicted_tre_mm <= kMaxError_mm,
             is_held_at_strokes = at_strokes.predicted_error_mm <= kMaxError_mm,
             is_likely = evidence.log_odds >= evidence.needed_log_odds,
             is_likely_at_strokes = at_strokes.log_odds >= evidence.needed_log_odds;
  if (!is_held && !is_held_at_strokes)
    reasons.push_back("the touched patch does not hold the bone fast: touch other faces of the notch too");
  if (evidence.lead < kClearLead) {
    reasons.push_back("two poses fit almost alike: touch other faces of the notch too");
  } else if (!is_likely && !is_likely_at_strokes) {
    reasons.push_back(reason_against_odds(summary));
  }
  if ((!is_held && is_held_at_strokes) || (!is_likely && is_likely_at_strokes))
    reasons.push_back(
        files::format("the target lies %.0f mm from the middle of the strokes, %.2f mm is its predicted "
                      "error: touch nearer to it",
                      at_strokes.target_off_mm, summary.predicted_tre_mm));
  return reasons;
}

}  // namespace

double white_noise_of(const std::vector<strokes::OrientedPoint>& oriented) {
  std::vector<double> noise_mm;
  for (const strokes::OrientedPoint& point : oriented) noise_mm.push_back(point.fit_rms_mm);
  return geometry::median(std::move(noise_mm), 0);
}

bool differ_in_size(const StrokeScale& scale) {
  constexpr double kMostScaleError = 0.01, kScaleSigmas = 3;
  return std::abs(scale.ratio - 1) > std::max(kMostScaleError, kScaleSigmas * scale.sigma);
}

double share_of_bearable_misfit(const RegistrationSummary& summary, double white_noise_mm) {
  return excess_misfit_mm(summary, white_noise_mm) / max_excess_mm(white_noise_mm);
}

RegistrationSummary summarise(const SurfaceIndex::Data& bone, const PosePool& pool,
                              const TouchedCurves& touched, const RegistrationOptions& options) {
  RegistrationSummary summary;
  summary.point_count = static_cast<int>(touched.curves.size());
  if (pool.empty()) {
    summary.reasons = {"no pose was found that puts the touched curves on this bone"};
    return summary;
  }
  const RefinedPose& best = pool.best();
  const Eigen::Vector3d pivot = best.bone_from_marker * touched.points.centroid_mm;
  summary.has_pose = true;
  summary.marker_from_bone = best.bone_from_marker.inverse();
  summary.covariance =
      about_origin(covariance_about(best, touched.points, bone, pool.prior(), pivot), pivot) +
      touched.drift * touched.drift.transpose();
  const Eigen::Vector3d target = options.target_in_bone_mm.value_or(pivot);
  // Which pose it is, the strokes alone say, right or wrong in size.
  const double held_at_target_mm = predicted_error_mm(summary, target),
               held_at_strokes_mm = predicted_error_mm(summary, pivot);
  const SizeEstimate size = estimate_size(best, touched.points, bone, pool.prior(), pivot);
  summary.stroke_scale = size.scale;
  summary.covariance += about_origin(size.covariance(), pivot);
  summary.predicted_tre_mm = predicted_error_mm(summary, target);
  summary.runner_up_ratio = pool.runner_up()
                                ? std::min(kNoRivalRatio, std::exp(pool.runner_up()->cost - best.cost))
                                : kNoRivalRatio;
  measure_inliers(best, touched.points, summary);
  for (std::size_t i = 0; i < touched.curves.size(); ++i) {
    const Eigen::Vector3d p = best.bone_from_marker * touched.curves[i].position_mm;
    const double distance_mm = bone.field.sample(p).distance_mm;
    const bool is_known = std::abs(distance_mm) < bone.field.band_mm();
    const double offset_mm = touched.offsets_mm.empty() ? 0.0 : touched.offsets_mm[i].value_or(0.0);
    summary.point_residuals_mm.push_back((is_known ? distance_mm : bone.surface.signed_distance_mm(p)) -
                                         offset_mm);
  }
  summary.misfit_mm = misfit_of(summary.point_residuals_mm, touched);
  summary.shared_misfit_mm = shared_misfit_of(best.residuals_mm, touched.points);
  const double lead =
      pool.runner_up() ? lead_of(best.cost, pool.runner_up()->cost, touched.points) : kLeadAlone;
  summary.evidence = evidence_for(summary, touched, lead);
  summary.evidence.error_by_strokes_mm = held_at_target_mm;
  summary.evidence.log_odds = log_odds_of(summary, held_at_target_mm);
  summary.reasons = doubts(summary, touched,
                           {predicted_error_mm(summary, pivot), log_odds_of(summary, held_at_strokes_mm),
                            (target - pivot).norm()});
  if (!ShaftCollision(bone, touched.points)
           .is_possible(best.bone_from_marker.matrix().cast<float>(),
                        best.bone_from_marker.translation_mm.cast<float>())) {
    summary.reasons.push_back(
        "the probe would have come through the bone: is it this patient's bone, and the right side?");
  }
  summary.reliable = summary.reasons.empty();
  return summary;
}

void judge_odds(RegistrationSummary& summary, const std::optional<double>& side_lead,
                double needed_log_odds) {
  VerdictEvidence& evidence = summary.evidence;
  const bool was_likely = evidence.log_odds >= evidence.needed_log_odds;
  evidence.side_lead = side_lead;
  evidence.needed_log_odds = needed_log_odds;
  evidence.log_odds = log_odds_of(summary, evidence.error_by_strokes_mm);
  if (!was_likely || evidence.log_odds >= needed_log_odds) return;
  summary.reliable = false;
  summary.reasons.push_back(reason_against_odds(summary));
}

}  // namespace arthronaut::registration
