#include "navigation/lens/lens_tracker.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "navigation/lens/angle_filter.h"
#include "navigation/lens/mark.h"
#include "navigation/lens/rim.h"

namespace arthronaut::lens {
namespace {

// Rays reach this far about the rim, as shares of the radius: a tooth either way is at most 6 %.
constexpr double kInner = 0.92, kOuter = 1.075;
constexpr double kAcceptFree = 0.86;   // score of a mark whose shape is not known yet
constexpr double kAcceptKnown = 0.80;  // of one whose shape is
// The best candidate leads clearly when its score does, or when the triangle leaves it this much less to
// explain: a mark scores 0.99, the squares of a board and shadows at the rim 0.95 at most.
constexpr double kClearLead = 0.06, kClearMisfitRatio = 5, kLeastMisfit = 0.02;
constexpr int kFramesToLearn = 5;
constexpr int kFramesToJump = 8;  // a mark far from where it was expected, before it is believed
constexpr int kFramesToSlip = 6;  // off the track before it is told; a clear rim needs two
constexpr int kFramesBetweenSearches = 4;
constexpr double kDarkShare = 0.4;    // of the rays: the scene is too dark to tell the rim
constexpr double kNearEnough_px = 4;  // an error of the rays' centre that costs 0.02 px
constexpr double kClearCoverage_deg = 240, kMostZoom = 0.005;
constexpr double kJumpedZoom = 0.02;  // four times what a search from nothing is accurate to
constexpr double kLitAbove = 14;      // grey values above the mask: as search_circle() tells light from it

// The shape of this scope's mark: the mean over the first clear sightings.
struct LearntShape {
  MarkPolarity polarity = MarkPolarity::Unknown;
  MarkShape mean;
  int sightings = 0;
  [[nodiscard]] bool is_known() const { return sightings >= kFramesToLearn; }
  void add(const MarkCandidate& seen) {
    if (seen.polarity != polarity) *this = {seen.polarity, {}, 0};
    ++sightings;
    mean.half_width_deg += (seen.shape.half_width_deg - mean.half_width_deg) / sightings;
    mean.height += (seen.shape.height - mean.height) / sightings;
  }
};

bool leads_clearly(const MarkCandidate& best, const MarkCandidate& second) {
  return second.score <= best.score - kClearLead ||
         1 - second.score > kLeastMisfit + kClearMisfitRatio * (1 - best.score);
}

// Where the circle stood, and for how many frames it has been off that.
struct CircleTrack {
  camera::Boundary reference;
  int frames = 0, off_track = 0;
};

}  // namespace

struct LensTracker::State {
  LensTrackerOptions options;
  LensObservation observation;
  RimProfile profile;
  DentProfile dents;
  SearchScratch scratch;
  AngleFilter filter;
  LearntShape shape;
  CircleTrack track;
  Eigen::Vector2i size_px{0, 0};
  bool has_circle = false;
  camera::Boundary last_circle;  // that was found
  int lost_frames = 0;           // since
  std::int64_t last_found_ns = 0;
  std::int64_t last_calibrated_ns = 0;  // when the rim was last seen with the calibrated radius
  double mask_level = 0;                // outside of it then
  int jump_frames = 0;
  double jump_angle_deg = 0;

  void forget();
  bool find_circle(const camera::GrayView& frame);
  bool fit_near(const camera::GrayView& frame, const camera::Boundary& found);
  bool measure_and_fit(const camera::GrayView& frame, const camera::Boundary& expected, double gate_share);
  void watch_circle();
  void watch_zoom(const camera::GrayView& frame);
  [[nodiscard]] bool has_track() const {
    return options.calibration && options.calibration->image_size_px == size_px;
  }
  void find_mark();
  MarkState choose_mark(MarkCandidate& chosen);
  bool believe_jump(const MarkCandidate& candidate);
  [[nodiscard]] MarkPolarity wanted_polarity() const;
};

void LensTracker::State::forget() {
  observation = {};
  filter = {};
  shape = {};
  track = {};
  has_circle = false;
  last_circle = {};
  lost_frames = 0;
  jump_frames = 0;
}

MarkPolarity LensTracker::State::wanted_polarity() const {
  if (options.polarity != MarkPolarity::Unknown) return options.polarity;
  return shape.is_known() ? shape.polarity : MarkPolarity::Unknown;
}

bool LensTracker::State::measure_and_fit(const camera::GrayView& frame, const camera::Boundary& expected,
                                         double gate_share) {
  measure_rim(frame, expected, kInner, kOuter, profile);
  const CircleFit fit = fit_circle(profile, gate_share * expected.radius_px);
  observation.circle_coverage_deg = fit.coverage_deg;
  if (!fit.ok) return false;
  observation.circle = fit.circle;
  return true;
}

bool LensTracker::State::fit_near(const camera::GrayView& frame, const camera::Boundary& found) {
  if (!measure_and_fit(frame, found, 0.03)) return false;
  // Rays about a centre that is a few pixels off see the rim as well; further off they are laid anew.
  const bool is_near = (observation.circle.center_px - found.center_px).norm() < kNearEnough_px &&
                       std::abs(observation.circle.radius_px - found.radius_px) < kNearEnough_px;
  return is_near || measure_and_fit(frame, observation.circle, 0.015);
}

bool LensTracker::State::find_circle(const camera::GrayView& frame) {
  // What hides the rim does so for seconds: to look for it from nothing in every frame would only cost time.
  // But a rim that a lit scene loses at once may have jumped.
  const bool is_time_to_search = lost_frames % kFramesBetweenSearches == kFramesBetweenSearches - 1;
  const bool is_measured = has_circle && !is_time_to_search;
  if (is_measured) {
    if (measure_and_fit(frame, observation.circle, 0.015)) return true;
    if (profile.dark_share > kDarkShare || lost_frames > 0) return false;
  }
  if (!has_circle && options.calibration &&
      options.calibration->image_size_px == Eigen::Vector2i(frame.width, frame.height)) {
    const camera::Boundary at_rest = options.calibration->boundary;
    // The rim moves by less than 2 % over a turn of the lens, unless it slipped: then the search below finds
    // it.
    if (measure_and_fit(frame, at_rest, 0.03)) return measure_and_fit(frame, observation.circle, 0.015);
  }
  const std::optional<camera::Boundary> found = search_circle(frame, scratch);
  if (found && fit_near(frame, *found)) return true;
  // Too little rim: go on with the circle as it was, for the sake of the mark.
  const bool is_measured_still = is_measured && !found;
  return has_circle && !is_measured_still && measure_and_fit(frame, last_circle, 0.015);
}

// Zoom changes the radius; a slipped coupler moves the centre off the track that the lens's turning gives it.
void LensTracker::State::watch_circle() {
  if (!observation.circle_found || observation.circle_coverage_deg < 180) return;
  const camera::Boundary& seen = observation.circle;
  double allowed_px = 4;
  if (has_track()) {
    const camera::Calibration& c = *options.calibration;
    track.reference = c.boundary;
    if (observation.mark == MarkState::Found)
      track.reference.center_px =
          c.turned(c.boundary.center_px, c.lens_angle_rad(observation.mark_angle_deg));
    else
      allowed_px += 2 * (c.boundary.center_px - c.rotation_center_px).norm();
  } else if (track.frames == 0) {
    track.reference = seen;
  }
  ++track.frames;
  observation.off_track_px = (seen.center_px - track.reference.center_px).norm();
  observation.radius_ratio = seen.radius_px / track.reference.radius_px;
  const bool is_zoomed = std::abs(observation.radius_ratio - 1) > kMostZoom;
  const bool is_off = is_zoomed || observation.off_track_px > allowed_px;
  // A rim that is seen nearly all round is no mistake; half of one may be.
  const int weight = observation.circle_coverage_deg > kClearCoverage_deg ? kFramesToSlip / 2 : 1;
  track.off_track =
      is_off ? std::min(track.off_track + weight, 2 * kFramesToSlip) : std::max(track.off_track - 2, 0);
  observation.zoom_or_slip = track.off_track >= kFramesToSlip;
  if (!observation.zoom_or_slip)
    observation.rim = RimState::OnTrack;
  else if (is_off)
    observation.rim = is_zoomed ? RimState::Zoomed : RimState::Slipped;
  if (!options.calibration && !is_off) {
    track.reference.center_px += 0.2 * (seen.center_px - track.reference.center_px);
    track.reference.radius_px += (seen.radius_px - track.reference.radius_px) / std::min(track.frames, 300);
  }
}

// Of this very frame: a wrong focal length is wrong from the first picture on.
void LensTracker::State::watch_zoom(const camera::GrayView& frame) {
  if (!has_track() || options.calibration->boundary.radius_px <= 0) {
    observation.zoom = ZoomState::NotWatched;
    return;
  }
  if (observation.circle_found) {
    const double ratio = observation.circle.radius_px / options.calibration->boundary.radius_px;
    const bool is_calibrated = std::abs(ratio - 1) <= kMostZoom;
    observation.zoom = is_calibrated ? ZoomState::AsCalibrated : ZoomState::Changed;
    observation.radius_ratio = ratio;
    if (is_calibrated) {
      last_calibrated_ns = observation.timestamp_ns;
      mask_level = profile.dark_level;
    }
    return;
  }
  // Nobody turns the zoom in the moment for which a scene is dark; but where the mask was it must be dark
  // too: a rim that a lit picture does not show has gone out of it.
  const bool is_hidden = profile.dark_share > kDarkShare && profile.dark_level <= mask_level + kLitAbove;
  // Zoomed out at one blow the rim lies where rays do not reach, and its surroundings are as dark.
  const auto elsewhere = is_hidden && lost_frames == 1 ? search_circle(frame, scratch) : std::nullopt;
  const bool has_jumped =
      elsewhere && std::abs(elsewhere->radius_px / options.calibration->boundary.radius_px - 1) > kJumpedZoom;
  const double hidden_s = static_cast<double>(observation.timestamp_ns - last_calibrated_ns) * 1e-9;
  const bool is_held = observation.zoom == ZoomState::AsCalibrated && is_hidden && !has_jumped &&
                       hidden_s <= options.stale_after_s;
  if (!is_held) observation.zoom = ZoomState::Unknown;
}

bool LensTracker::State::believe_jump(const MarkCandidate& candidate) {
  const bool same_place =
      jump_frames > 0 && std::abs(difference_deg(candidate.angle_deg, jump_angle_deg)) < 5;
  jump_frames = same_place ? jump_frames + 1 : 1;
  jump_angle_deg = candidate.angle_deg;
  return jump_frames >= kFramesToJump;
}

MarkState LensTracker::State::choose_mark(MarkCandidate& chosen) {
  const MarkPolarity polarity = wanted_polarity();
  const double reach_deg = std::min(3 * filter.sigma_deg() + 2.5, 25.0);
  if (filter.is_running() && shape.is_known()) {
    chosen = follow_mark(dents, shape.polarity, shape.mean, filter.angle_deg(), reach_deg);
    if (chosen.score >= kAcceptKnown) {
      jump_frames = 0;
      return MarkState::Found;
    }
  }
  const MarkShape* known = shape.is_known() ? &shape.mean : nullptr;
  const MarkCandidates all = find_marks(dents, polarity, known);
  const double accept = known ? kAcceptKnown + 0.05 : kAcceptFree;
  MarkState at_place = MarkState::NotSeen;
  if (filter.is_running())
    at_place = judge_place(dents, filter.angle_deg(), known ? known->half_width_deg : 2.0);
  else if (profile.dark_share > kDarkShare)
    at_place = MarkState::Dark;
  if (all.count == 0 || all.items[0].score < accept) return at_place;

  chosen = all.items[0];
  if (filter.is_running()) {
    for (int k = 0; k < all.count; ++k) {
      const MarkCandidate& near = all.items[static_cast<std::size_t>(k)];
      if (near.score >= accept && std::abs(difference_deg(near.angle_deg, filter.angle_deg())) < reach_deg) {
        chosen = near;
        jump_frames = 0;
        return MarkState::Found;
      }
    }
    // Elsewhere than expected. Where it was expected the rim is clean: then it has moved. Else wait.
    if (all.count > 1 && !leads_clearly(chosen, all.items[1])) return MarkState::Ambiguous;
    if (!believe_jump(chosen) && at_place != MarkState::NotSeen) return at_place;
    filter = {};
    return MarkState::Found;
  }
  // A lit tooth outside the rim can't be made by a scene; a dark dent can.
  if (all.count > 1 && !leads_clearly(chosen, all.items[1])) {
    if (all.items[0].polarity == all.items[1].polarity) return MarkState::Ambiguous;
    if (chosen.polarity != MarkPolarity::BrightOutward) chosen = all.items[1];
  }
  return MarkState::Found;
}

void LensTracker::State::find_mark() {
  dents_of(profile, observation.circle, dents);
  MarkCandidate chosen;
  observation.mark = choose_mark(chosen);
  if (observation.mark != MarkState::Found) return;
  if (!shape.is_known()) shape.add(chosen);
  filter.update(chosen.angle_deg, std::max(0.1, chosen.sigma_deg));
  observation.polarity = chosen.polarity;
  last_found_ns = observation.timestamp_ns;
}

std::string_view to_text(MarkState state) {
  switch (state) {
    case MarkState::Found:
      return "found";
    case MarkState::NoCircle:
      return "no round image border";
    case MarkState::Dark:
      return "too dark beside the rim";
    case MarkState::Covered:
      return "the mark is covered";
    case MarkState::Ambiguous:
      return "two marks look alike";
    case MarkState::NotSeen:
      return "no mark on the rim";
  }
  return "unknown";
}

std::string_view to_text(ZoomState state) {
  switch (state) {
    case ZoomState::NotWatched:
      return "zoom not watched";
    case ZoomState::Unknown:
      return "zoom unknown";
    case ZoomState::AsCalibrated:
      return "zoom as calibrated";
    case ZoomState::Changed:
      return "another zoom than calibrated";
  }
  return "unknown";
}

std::string reason_text(const LensObservation& lens) {
  char text[160] = "";
  const double larger_percent = 100 * (lens.radius_ratio - 1);
  if (lens.rim == RimState::Zoomed || lens.zoom == ZoomState::Changed)
    std::snprintf(text, sizeof text, "the view is %.1f %% %s than calibrated: zoom back, or calibrate again",
                  std::abs(larger_percent), larger_percent > 0 ? "larger" : "smaller");
  else if (lens.rim == RimState::Slipped)
    std::snprintf(text, sizeof text,
                  "the view lies %.0f px beside its track: seat the scope in the coupler, or calibrate again",
                  lens.off_track_px);
  else if (lens.zoom == ZoomState::Unknown)
    return "zoom unknown: the rim of the view is not seen, so the focal length is not known";
  else if (lens.zoom_or_slip)
    return "another zoom, or the coupler slipped";  // of a record, which holds no more
  else if (lens.mark != MarkState::Found)
    return "lens mark: " + std::string(to_text(lens.mark)) +
           (lens.is_stale ? ", the lens angle is not known" : ", its last angle is held while it is sure");
  return text;
}

LensTracker::LensTracker(const LensTrackerOptions& options) : state_(std::make_unique<State>()) {
  state_->options = options;
}
LensTracker::~LensTracker() = default;
LensTracker::LensTracker(LensTracker&&) noexcept = default;
LensTracker& LensTracker::operator=(LensTracker&&) noexcept = default;

void LensTracker::reset() { state_->forget(); }

const LensObservation& LensTracker::observe(const camera::GrayView& frame, std::int64_t timestamp_ns) {
  State& state = *state_;
  LensObservation& seen = state.observation;
  if (state.size_px != Eigen::Vector2i(frame.width, frame.height)) {
    state.forget();
    state.size_px = {frame.width, frame.height};
  }
  const double elapsed_s = std::max(0.0, static_cast<double>(timestamp_ns - seen.timestamp_ns) * 1e-9);
  seen.timestamp_ns = timestamp_ns;
  state.filter.predict(elapsed_s);

  seen.circle_found = state.find_circle(frame);
  state.lost_frames = seen.circle_found ? 0 : state.lost_frames + 1;
  if (seen.circle_found) state.last_circle = seen.circle;
  seen.circle = state.last_circle;
  state.has_circle = state.has_circle || seen.circle_found;
  if (state.has_circle)
    state.find_mark();
  else
    seen.mark = MarkState::NoCircle;
  if (!seen.circle_found && seen.mark != MarkState::Found)
    seen.mark =
        state.has_circle && state.profile.dark_share > kDarkShare ? MarkState::Dark : MarkState::NoCircle;
  state.watch_circle();
  state.watch_zoom(frame);

  seen.mark_angle_deg = state.filter.angle_deg();
  seen.mark_sigma_deg = state.filter.sigma_deg();
  const double lost_s = static_cast<double>(timestamp_ns - state.last_found_ns) * 1e-9;
  seen.is_stale = !state.filter.is_running() || lost_s > state.options.stale_after_s;
  // Whatever was learnt may have been wrong: after so long without it, begin again.
  if (seen.is_stale && state.shape.is_known()) state.shape = {};
  return seen;
}

LensObservation observe_still(const camera::GrayView& picture) {
  LensTracker tracker;
  return tracker.observe(picture, 0);
}

}  // namespace arthronaut::lens
