#include "navigation/registration/online/online_registration.h"

#include <algorithm>
#include <cmath>

#include "navigation/registration/bone/reachable_region.h"
#include "navigation/registration/curve_registration.h"
#include "navigation/registration/online/coach.h"
#include "navigation/registration/online/stroke_set.h"
#include "navigation/registration/search/curve_checks.h"
#include "navigation/registration/search/global_search.h"
#include "navigation/registration/search/pose_pool.h"
#include "navigation/registration/verdict/confidence.h"
#include "planning/files/format.h"
#include "planning/geometry/quantile.h"

namespace arthronaut::registration {

namespace {

using geometry::RigidTransform;

constexpr std::size_t kPointCount = 500;
constexpr double kMinLengthToSearch_mm = 25;
// Pairs to search with at each update: many while nothing is found, one as a watchdog later.
constexpr int kPairsWhileCollecting = 6, kPairsAfterwards = 1;
// What was found is a step away from where the last solution left it.
constexpr int kIterationsWhileCollecting = 6, kIterationsAfterwards = 3, kIterationsOfStanding = 3,
              kIterationsAlongStrokes = 2;
constexpr std::size_t kJudgedPoses = 3;
constexpr int kAgreeingSolutions = 5;

}  // namespace

std::string_view to_text(OnlineState state) {
  switch (state) {
    case OnlineState::Collecting:
      return "collecting";
    case OnlineState::Candidate:
      return "candidate";
    case OnlineState::Confirmed:
      return "confirmed";
  }
  return "unknown";
}

struct OnlineRegistration::State {
  State(std::shared_ptr<const SurfaceIndex> prepared, const OnlineOptions& online_options)
      : bone(std::move(prepared)),
        options(online_options),
        setting(bone->data(), options_of(online_options)),
        pool(bone->data(), prior_of(online_options), setting.start_noise()),
        standing(pool) {
    if (setting.cartilage) fitter.emplace(bone->data(), *setting.cartilage, pool.prior());
    aim();
  }

  void aim() {
    setting.options.target_in_bone_mm = options.target_in_bone_mm;
    reachable.clear();
    if (options.target_in_bone_mm)
      reachable = find_reachable_samples(bone->data(), *options.target_in_bone_mm);
  }

  static MarkerPrior prior_of(const OnlineOptions& options) {
    MarkerPrior prior;
    prior.use = options.use_marker_prior;
    return prior;
  }

  static RegistrationOptions options_of(const OnlineOptions& options) {
    RegistrationOptions registering{options.seed, options.use_marker_prior, options.target_in_bone_mm};
    registering.cartilage = options.cartilage;
    return registering;
  }

  // Strokes were taken away, or brought back: what was found with others is to be found anew. A doubt about
  // the side stays until then.
  void forget_what_was_judged() {
    is_changed = true;
    side_checked_mm = 0;
  }
  void check_side();
  void solve();
  void fit_cover();
  void remember_solution();
  void judge_state();
  void describe_strokes();
  [[nodiscard]] Eigen::Vector3d target_mm() const;
  // How far off the mesh the bone is touched there; nullopt where that is not known.
  [[nodiscard]] std::optional<double> offset_mm(const Eigen::Vector3d& point_in_bone_mm) const {
    return setting.cartilage ? cartilage.offset_mm(*setting.cartilage, point_in_bone_mm) : 0.0;
  }
  [[nodiscard]] int agreement_count() const;

  std::shared_ptr<const SurfaceIndex> bone;
  OnlineOptions options;
  SearchSetting setting;
  std::vector<bool> reachable;  // samples of the bone, by the tunnel's entry; empty without one
  StrokeSet strokes;
  PosePool pool;      // of the search, which knows the mesh alone
  PosePool standing;  // of the last solution: the same, or with cartilage its poses with their thicknesses
  std::optional<CartilageFitter> fitter;
  WeightedPoints points;      // of the last solution
  CartilageFit cartilage;     // of the last solution; nothing of it holds without options.cartilage
  double cover_tried_mm = 0;  // the stroke length when all thicknesses were tried the last time
  double solved_length_mm = 0;
  bool is_changed = false;                // strokes were excluded, undone or cleared since the last solution
  SideJudgement side;                     // as the last check, before a confirmation, told
  double side_checked_mm = 0;             // the stroke length then; 0 when there was none
  bool judges_all = false;                // the next update is to
  std::vector<RigidTransform> solutions;  // marker_from_bone, each with new stroke, newest last
  OnlineResult result;
};

Eigen::Vector3d OnlineRegistration::State::target_mm() const {
  if (options.target_in_bone_mm) return *options.target_in_bone_mm;
  return standing.empty() ? Eigen::Vector3d::Zero() : standing.best().bone_from_marker * points.centroid_mm;
}

// To try all thicknesses takes long: that is done until something is found, and later on now and then.
void OnlineRegistration::State::fit_cover() {
  constexpr double kLengthRatio = 1.25;
  const double length_mm = strokes.length_in_use_mm();
  const bool anew =
      result.state == OnlineState::Collecting || is_changed || length_mm > kLengthRatio * cover_tried_mm;
  if (anew) cover_tried_mm = length_mm;
  cartilage = fitter->fit(standing, points, anew);
  points = cartilage.points;
}

void OnlineRegistration::State::solve() {
  result.bone_is_in_doubt = false;
  const strokes::Curves curves = strokes.curves_in_use();
  const std::vector<strokes::OrientedPoint> oriented = strokes.oriented_in_use();
  points = choose_points(curves, kPointCount);
  const WeightedPoints smooth = choose_points(curves, kPointCount, oriented);
  // While drawing, few points are no objection: more are coming, and the length says how many are missing.
  const std::vector<std::string> objections =
      objections_to(curves, bone->data().bounds.size_mm().norm(), {.min_point_count = 1});
  if (strokes.length_in_use_mm() < kMinLengthToSearch_mm || !objections.empty()) {
    pool.clear();
    if (fitter) fitter->forget();
  } else {
    GlobalSearchOptions search;
    search.seed = options.seed + result.revision;  // other pairs each time
    search.use_marker_prior = options.use_marker_prior;
    const bool is_found = result.state != OnlineState::Collecting;
    search.curve_pair_count = is_found ? kPairsAfterwards : kPairsWhileCollecting;
    search.keep_count = is_found ? 4 : 40;
    // Where the plan is first, then everywhere, in turn.
    if (!is_found && !reachable.empty() && result.revision % 2 == 1) search.reachable = &reachable;
    search.both_ways = !is_found;
    pool.add(search_globally(bone->data(), oriented, smooth, search), smooth, search.seed);
    pool.refine_all(smooth, is_found ? kIterationsAfterwards : kIterationsWhileCollecting);
  }
  // What stands is judged by the samples, as register_curves does.
  std::vector<RefinedPose> foremost = pool.poses();
  if (foremost.size() > kJudgedPoses) foremost.resize(kJudgedPoses);
  standing.replace(std::move(foremost), points.centroid_mm);
  standing.refine_all(points, kIterationsOfStanding);
  std::vector<std::optional<double>> offsets_mm;
  cartilage = {};
  if (fitter && !standing.empty()) {
    fit_cover();
  }
  const double white_noise_mm = white_noise_of(oriented);
  if (!standing.empty()) {
    standing.fit_best_along_strokes(
        points, {.white_noise_mm = white_noise_mm, .iterations_by_field = kIterationsAlongStrokes});
  }
  if (fitter && !standing.empty())
    offsets_mm = cartilage.offsets_mm(*setting.cartilage, curves, standing.best().bone_from_marker);
  const TouchedCurves touched{curves,
                              points,
                              cartilage.kept_share * strokes.length_in_use_mm(),
                              white_noise_mm,
                              std::move(offsets_mm),
                              cartilage.drift()};
  result.registration = summarise(bone->data(), standing, touched, setting.options);
  if (fitter && !standing.empty()) cartilage.add_to(result.registration);
  if (!result.registration.has_pose) {
    result.registration.reasons = objections;
    if (objections.empty())
      result.registration.reasons = {"no pose was found yet that puts the strokes on the bone"};
    return;
  }
  result.bone_is_in_doubt = touched.length_mm >= kMinLength_mm &&
                            (share_of_bearable_misfit(result.registration, white_noise_mm) > 1 ||
                             differ_in_size(result.registration.stroke_scale));
  const Eigen::Matrix3d turn = result.registration.covariance.bottomRightCorner<3, 3>();
  Eigen::Matrix3d across = Eigen::Matrix3d::Identity();
  if (options.direction_in_bone) across = geometry::cross_matrix(options.direction_in_bone->normalized());
  result.predicted_angle_deg =
      geometry::deg_from_rad(std::sqrt((across * turn * across.transpose()).trace()));
}

void OnlineRegistration::State::remember_solution() {
  constexpr std::size_t kRemembered = kAgreeingSolutions;
  if (!result.registration.has_pose) return;
  solutions.push_back(result.registration.marker_from_bone);
  if (solutions.size() > kRemembered) solutions.erase(solutions.begin());
}

// How many of the last solutions, one after the other, agree with the newest at the target; itself included.
int OnlineRegistration::State::agreement_count() const {
  constexpr double kDistance_mm = 1.0, kAngle_deg = 1.5;
  int count = 0;
  for (auto it = solutions.rbegin(); it != solutions.rend(); ++it, ++count) {
    const RigidTransform& newest = solutions.back();
    const double angle_deg =
        geometry::deg_from_rad(geometry::rotation_angle_rad(newest.rotation.conjugate() * it->rotation));
    if ((*it * target_mm() - newest * target_mm()).norm() > kDistance_mm || angle_deg > kAngle_deg) break;
  }
  return count;
}

// Which side's bone it is shows late: with few strokes the wrong one fits too. So it is asked when all else
// would confirm, until something is confirmed, and again when half as much again was drawn. Where the answer
// is what stands in the way, a little more stroke gives the same one, and asking takes twenty times an
// update.
void OnlineRegistration::State::check_side() {
  constexpr double kAgainWhenConfirmed = 1.5, kAgainWhenRefused = 1.1;
  const double needed_log_odds = judges_all ? kNeededLogOdds : kNeededLogOddsWhileDrawing;
  const RegistrationSummary& found = result.registration;
  const auto is_refused_as_before = [&] {
    if (side.verdict != SideVerdict::Own) return true;
    RegistrationSummary judged = found;
    judge_odds(judged, side.lead, needed_log_odds);
    return !judged.reliable;
  };
  const double again = result.state == OnlineState::Confirmed
                           ? kAgainWhenConfirmed
                           : (is_refused_as_before() ? kAgainWhenRefused : 0);
  const bool is_due = side_checked_mm == 0 || judges_all || result.length_mm > again * side_checked_mm;
  if (is_due && agreement_count() >= kAgreeingSolutions && found.reliable &&
      found.evidence.log_odds >= needed_log_odds) {
    // Costs compare only between searches of the same kind, over the same points.
    constexpr int kRounds = 2;
    const strokes::Curves curves = strokes.curves_in_use();
    const SearchOutcome own = search_and_summarise(setting, curves, kRounds);
    side = judge_side(setting, curves, own, !judges_all);
    side_checked_mm = result.length_mm;
  }
  if (!result.registration.has_pose) return;
  judge_odds(result.registration, side_checked_mm > 0 ? std::optional(side.lead) : std::nullopt,
             needed_log_odds);
  if (side.verdict == SideVerdict::Own) return;
  result.bone_is_in_doubt = true;
  result.registration.reliable = false;
  result.registration.reasons.insert(result.registration.reasons.begin(),
                                     std::string(reason_against(side.verdict)));
}

void OnlineRegistration::State::judge_state() {
  constexpr double kCandidateInliers = 0.5;
  const RegistrationSummary& registration = result.registration;
  result.state = OnlineState::Collecting;
  if (!registration.has_pose) return;
  if (registration.runner_up_ratio < kAlikeRatio || registration.inlier_fraction < kCandidateInliers) return;
  const bool is_confirmed = registration.reliable && agreement_count() >= kAgreeingSolutions;
  result.state = is_confirmed ? OnlineState::Confirmed : OnlineState::Candidate;
}

void OnlineRegistration::State::describe_strokes() {
  result.strokes.clear();
  const RigidTransform bone_from_marker = result.registration.marker_from_bone.inverse();
  for (const Stroke& stroke : strokes.all()) {
    StrokeInfo info;
    info.curve = stroke.points.front().curve;
    info.point_count = static_cast<int>(stroke.points.size());
    info.length_mm = stroke.length_mm;
    info.is_excluded = stroke.is_excluded;
    if (result.registration.has_pose) {
      std::vector<double> misses_mm;
      for (const strokes::CurvePoint& point : stroke.points) {
        const Eigen::Vector3d p = bone_from_marker * point.position_mm;
        misses_mm.push_back(std::abs(bone->data().field.sample(p).distance_mm - offset_mm(p).value_or(0.0)));
      }
      info.median_residual_mm = geometry::median(std::move(misses_mm), 0);
    }
    result.strokes.push_back(info);
  }
}

OnlineRegistration::OnlineRegistration(std::shared_ptr<const SurfaceIndex> bone, const OnlineOptions& options)
    : state_(std::make_unique<State>(std::move(bone), options)) {}
OnlineRegistration::~OnlineRegistration() = default;

void OnlineRegistration::add_points(std::span<const strokes::CurvePoint> points, bool is_excluded) {
  state_->strokes.add_points(points, is_excluded);
}

void OnlineRegistration::aim_at(const std::optional<Eigen::Vector3d>& target_in_bone_mm,
                                const std::optional<Eigen::Vector3d>& direction_in_bone) {
  state_->options.target_in_bone_mm = target_in_bone_mm;
  state_->options.direction_in_bone = direction_in_bone;
  state_->aim();
}

void OnlineRegistration::judge_all() { state_->judges_all = true; }

bool OnlineRegistration::exclude_stroke(int curve, bool is_excluded) {
  if (!state_->strokes.exclude(curve, is_excluded)) return false;
  state_->forget_what_was_judged();
  return true;
}

bool OnlineRegistration::undo_stroke() {
  if (!state_->strokes.undo()) return false;
  state_->forget_what_was_judged();
  return true;
}

void OnlineRegistration::clear() {
  state_->strokes.clear();
  state_->solutions.clear();
  state_->pool.clear();
  if (state_->fitter) state_->fitter->forget();
  state_->side = {};
  state_->forget_what_was_judged();
}

const OnlineResult& OnlineRegistration::update() {
  State& state = *state_;
  // Measuring a stroke with its noise taken out costs more than adding up the steps of its points, which is
  // never less.
  const double missing_mm =
      state.options.refine_every_mm - (state.strokes.length_in_use_mm() - state.solved_length_mm);
  const bool is_asked = state.is_changed || state.judges_all;
  if (state.strokes.unmeasured_mm() < missing_mm && !is_asked) return state.result;
  state.strokes.measure();
  const double length_mm = state.strokes.length_in_use_mm();
  const bool has_new_stroke = length_mm - state.solved_length_mm >= state.options.refine_every_mm;
  if (!has_new_stroke && !is_asked) return state.result;

  ++state.result.revision;
  state.solve();
  state.solved_length_mm = state.result.length_mm = length_mm;
  if (state.is_changed) state.solutions.clear();  // agreement has to be earned again
  // Of hardly more stroke than the last solution: it takes that one's place and earns no agreement.
  if (!has_new_stroke && !state.solutions.empty()) state.solutions.pop_back();
  state.remember_solution();
  state.check_side();
  state.describe_strokes();
  state.is_changed = state.judges_all = false;
  state.judge_state();
  state.result.coach =
      advise(state.result, {state.bone->data(), state.standing, state.points, state.target_mm(),
                            state.agreement_count(), kAgreeingSolutions, state.options.refine_every_mm});
  return state.result;
}

const OnlineResult& OnlineRegistration::result() const { return state_->result; }
strokes::Curves OnlineRegistration::curves_in_use() const { return state_->strokes.curves_in_use(); }

}  // namespace arthronaut::registration
