#include <algorithm>
#include <cmath>
#include <random>

#include "navigation/registration/bone/reachable_region.h"
#include "navigation/registration/curve_registration.h"
#include "navigation/registration/registration.h"
#include "navigation/registration/search/cartilage_offset.h"
#include "navigation/registration/search/curve_checks.h"
#include "navigation/registration/search/global_search.h"
#include "navigation/registration/search/pose_pool.h"
#include "navigation/registration/verdict/confidence.h"
#include "navigation/strokes/stroke_tangents.h"

namespace arthronaut::registration {

namespace {

constexpr int kMaxRounds = 7;

// How much better the best pose explains the points than the best different one, in units of independent
// measurements.
double lead_of_best(const PosePool& pool, const WeightedPoints& points) {
  if (pool.empty()) return 0;
  constexpr double kNoRival = 100;
  if (pool.runner_up() == nullptr) return kNoRival;
  return lead_of(pool.best().cost, pool.runner_up()->cost, points);
}

// Found beyond doubt: no need to search on. Either nothing else comes near, or the searches, each with other
// pairs, come to the same pose again and again: a better one would have been found as easily. Without the
// marker there are so many poses that a wrong one may be found twice before the right one is, and lead until
// then.
bool is_found(const PosePool& pool, const WeightedPoints& points, int round, bool has_marker) {
  constexpr double kClearLead = 17, kClearLeadLater = 8, kClearLeadOfTwice = 4, kLeadOfOften = 1;
  constexpr double kClearLeadWithoutMarker = 30;
  constexpr int kOften = 3, kOftenWithoutMarker = 5;
  const double lead = lead_of_best(pool, points);
  const int count = pool.best_find_count();
  if (!has_marker)
    return lead > (round == 0 ? kClearLeadWithoutMarker : kClearLeadLater) ||
           (count >= kOftenWithoutMarker && lead > kLeadOfOften);
  return lead > (round == 0 ? kClearLead : kClearLeadLater) || (count > 1 && lead > kClearLeadOfTwice) ||
         (count >= kOften && lead > kLeadOfOften);
}

// Starts around a pose, some millimetres and degrees away: a rival that lies near it is easily missed by the
// search, and is the one that a small residual hides best.
std::vector<Hypothesis> neighbours_of(const geometry::RigidTransform& bone_from_marker,
                                      const Eigen::Vector3d& centroid_mm, std::uint64_t seed) {
  constexpr int kCount = 24;
  constexpr double kDistance_mm = 6, kAngle_rad = 0.35;
  std::mt19937_64 random(seed);
  const auto vector = [&random](double length) {
    const auto uniform = [&random] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; };
    Eigen::Vector3d v;
    do v = {uniform(), uniform(), uniform()};
    while (v.squaredNorm() > 1);
    return Eigen::Vector3d(length * v);
  };
  const Eigen::Vector3d center = bone_from_marker * centroid_mm;
  std::vector<Hypothesis> neighbours(kCount);
  for (Hypothesis& neighbour : neighbours) {
    const Eigen::Vector3d turn = vector(kAngle_rad);
    const Eigen::Quaterniond rotation(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
    neighbour.bone_from_marker.rotation = rotation * bone_from_marker.rotation;
    neighbour.bone_from_marker.translation_mm =
        center + vector(kDistance_mm) + rotation * (bone_from_marker.translation_mm - center);
  }
  return neighbours;
}

std::string describe_reach(const SurfaceIndex::Data& bone, const std::vector<bool>& reachable,
                           const Eigen::Vector3d& touched_mm) {
  constexpr float kNear_mm = 12;
  if (reachable.empty()) return "the planned entry is not on this bone: the whole bone was searched";
  for (std::size_t i = 0; i < reachable.size(); ++i) {
    const float away_mm = (bone.pairs.samples()[i].point_mm - touched_mm.cast<float>()).norm();
    if (reachable[i] && away_mm < kNear_mm) return "the strokes lie within reach of the planned entry";
  }
  return "the strokes lie out of reach of the planned entry: the whole bone was searched";
}

// The curves as they would be had the bone been its own mirror image. The marker's face stays its face.
strokes::Curves mirrored(strokes::Curves curves) {
  for (strokes::CurvePoint& point : curves) {
    point.position_mm.x() = -point.position_mm.x();
    if (point.shaft_direction) point.shaft_direction->x() = -point.shaft_direction->x();
  }
  return curves;
}

}  // namespace

SearchSetting::SearchSetting(const SurfaceIndex::Data& searched_bone,
                             const RegistrationOptions& registration_options)
    : bone(searched_bone), options(registration_options) {
  if (options.plan_entry_in_bone_mm) reachable = find_reachable_samples(bone, *options.plan_entry_in_bone_mm);
  if (options.cartilage) cartilage.emplace(bone, *options.cartilage);
}

NoiseModel SearchSetting::start_noise() const {
  NoiseModel noise;
  if (cartilage) noise.buried_density_per_mm = NoiseModel::kOftenBuried_per_mm;
  return noise;
}

SearchOutcome search_and_summarise(const SearchSetting& setting, const strokes::Curves& curves,
                                   int max_rounds) {
  const SurfaceIndex::Data& bone = setting.bone;
  const RegistrationOptions& options = setting.options;
  constexpr std::size_t kPointCount = 800;
  constexpr int kPairsEachRound = 8, kIterationsEachRound = 5, kFinalIterations = 12;
  // Without the marker many more poses are possible, and the right one's rough score is often not among the
  // hundred best.
  const std::size_t hypotheses_each_round = options.use_marker_prior ? 72 : 320;
  const std::vector<strokes::OrientedPoint> oriented = strokes::oriented_points(curves);
  // The search goes by smoothed points, which hold less noise, so that the right pose stands out sooner. What
  // is found is fitted to the samples: those lifted for a moment are smoothed into soft tissue otherwise.
  const WeightedPoints smooth = choose_points(curves, kPointCount, oriented);
  MarkerPrior prior;
  prior.use = options.use_marker_prior;
  PosePool pool(bone, prior, setting.start_noise());
  for (int round = 0; round < max_rounds; ++round) {
    const std::uint64_t seed = options.seed * kMaxRounds + static_cast<std::uint64_t>(round);
    const bool is_near_plan = round == 0 && !setting.reachable.empty();
    pool.add(search_globally(bone, oriented, smooth,
                             {.seed = seed,
                              .use_marker_prior = options.use_marker_prior,
                              .curve_pair_count = kPairsEachRound,
                              .keep_count = hypotheses_each_round,
                              .reachable = is_near_plan ? &setting.reachable : nullptr}),
             smooth, seed);
    pool.refine_all(smooth, kIterationsEachRound);
    if (is_found(pool, smooth, round, options.use_marker_prior)) break;
  }
  WeightedPoints points = choose_points(curves, kPointCount);
  const double white_noise_mm = white_noise_of(oriented);
  const AlongStrokesOptions last_fit{
      .white_noise_mm = white_noise_mm, .iterations_by_field = 4, .iterations_by_mesh = 2};
  if (!pool.empty()) {
    const std::uint64_t seed = options.seed * kMaxRounds;
    pool.add(neighbours_of(pool.best().bone_from_marker, smooth.centroid_mm, seed), smooth, seed);
    pool.refine_all(smooth, kIterationsEachRound);
    pool.refine_all(points, kFinalIterations);
    pool.fit_best_along_strokes(points, last_fit);
  }
  SearchOutcome outcome;
  outcome.measurements = points.weight_sum / kCorrelationLength_mm;
  if (!pool.empty()) outcome.cost = pool.best().cost;
  CartilageFit cartilage;
  std::vector<std::optional<double>> offsets_mm;
  if (setting.cartilage && !pool.empty()) {
    cartilage = CartilageFitter(bone, *setting.cartilage, prior).fit(pool, points, true);
    points = cartilage.points;
    pool.fit_best_along_strokes(points, last_fit);
    offsets_mm = cartilage.offsets_mm(*setting.cartilage, curves, pool.best().bone_from_marker);
    outcome.cost = cartilage.cost;  // not of fewer points where the region was left out
  }
  outcome.summary = summarise(bone, pool,
                              {curves, points, cartilage.kept_share * strokes::smoothed_length_mm(curves),
                               white_noise_mm, std::move(offsets_mm), cartilage.drift()},
                              options);
  if (setting.cartilage && outcome.summary.has_pose) cartilage.add_to(outcome.summary);
  if (options.plan_entry_in_bone_mm && !pool.empty()) {
    outcome.summary.assumptions.push_back(
        describe_reach(bone, setting.reachable, pool.best().bone_from_marker * points.centroid_mm));
  }
  const double misfit_share =
      outcome.summary.has_pose ? share_of_bearable_misfit(outcome.summary, white_noise_mm) : 1e9;
  constexpr double kManyMeasurements = 60, kSmallShare = 0.7, kAmpleLead = 20;
  outcome.fits = misfit_share <= 1;
  // A thickness that is free, or points that are left out, let other shapes fit well too.
  outcome.fits_amply = !setting.cartilage && misfit_share < kSmallShare &&
                       outcome.measurements > kManyMeasurements && lead_of_best(pool, points) > kAmpleLead;
  return outcome;
}

std::string_view reason_against(SideVerdict verdict) {
  switch (verdict) {
    case SideVerdict::Own:
      return "";
    case SideVerdict::Other:
      return "the curves fit the mirror image of this bone: it is the bone of the other side";
    case SideVerdict::Unclear:
      break;
  }
  return "the mirror image of this bone fits almost alike: is it this patient's bone, and the right side? "
         "Touch other faces of "
         "the notch too";
}

SideJudgement judge_side(const SearchSetting& setting, const strokes::Curves& curves,
                         const SearchOutcome& found, bool more_may_come) {
  // A few strokes can't give a clear lead: there, less of one is telling enough. While drawing, the own side
  // has to lead by more, since a bone that is much like its mirror image fits the wrong way round by chance.
  constexpr double kSideLead = 3, kSideLeadOfEach = 0.05;
  constexpr double kOwnLeadWhileDrawing = 8, kOwnLeadOfEachWhileDrawing = 0.1;
  // To name the right reason is worth a little more, above all where the search has no marker to go by or a
  // thickness is free.
  constexpr int kRounds = 3, kRoundsToName = 4;
  const bool is_easy = setting.options.use_marker_prior && !setting.cartilage;
  const int rounds = found.summary.reliable ? kRounds : is_easy ? kRoundsToName : kMaxRounds;
  const SearchOutcome image = search_and_summarise(setting, mirrored(curves), rounds);
  const double image_lead = (found.cost - image.cost) * image.measurements;
  const double other_lead = std::min(kSideLead, kSideLeadOfEach * image.measurements);
  if (image.fits && image_lead > other_lead) return {SideVerdict::Other, -image_lead};
  const double own_lead =
      more_may_come ? std::min(kOwnLeadWhileDrawing, kOwnLeadOfEachWhileDrawing * image.measurements)
                    : other_lead;
  return {image_lead > -own_lead ? SideVerdict::Unclear : SideVerdict::Own, -image_lead};
}

RegistrationSummary register_curves(const SurfaceIndex& prepared, const strokes::Curves& curves,
                                    const RegistrationOptions& options) {
  const SurfaceIndex::Data& bone = prepared.data();
  RegistrationSummary summary;
  summary.point_count = static_cast<int>(curves.size());
  summary.reasons = objections_to(curves, bone.bounds.size_mm().norm());
  if (!summary.reasons.empty()) return summary;

  const SearchSetting setting(bone, options);
  SearchOutcome found = search_and_summarise(setting, curves, kMaxRounds);
  if (!found.summary.has_pose || found.fits_amply) return found.summary;
  const auto [side, side_lead] = judge_side(setting, curves, found);
  judge_odds(found.summary, side_lead, kNeededLogOdds);
  if (side == SideVerdict::Own) return found.summary;
  found.summary.reliable = false;
  // What misses its own surface may be anybody's bone, whatever its mirror image does.
  std::vector<std::string>& reasons = found.summary.reasons;
  const bool is_first = side == SideVerdict::Other || found.fits;
  reasons.insert(is_first ? reasons.begin() : reasons.end(), std::string(reason_against(side)));
  return found.summary;
}

double predicted_error_mm(const RegistrationSummary& registration, const Eigen::Vector3d& point_in_bone_mm) {
  Eigen::Matrix<double, 3, 6> move;
  move << Eigen::Matrix3d::Identity(), -geometry::cross_matrix(point_in_bone_mm);
  return std::sqrt(std::max(0.0, (move * registration.covariance * move.transpose()).trace()));
}

}  // namespace arthronaut::registration
