#include "navigation/calibration/ruler_sightings.h"

#include <algorithm>

#include "navigation/camera/medium.h"
#include "navigation/pipeline/frozen_picture.h"
#include "navigation/pipeline/view_tracker.h"
#include "planning/geometry/error.h"

namespace arthronaut::calibration {
namespace {

// The medium to try when the stated one recognises nothing: that of the calibration if a fluid was stated, a
// fluid if not. Anything between the two is recognised with either.
double other_index(const RulerSightingsOptions& options) {
  const double dry = options.calibration.refractive_index;
  return options.refractive_index > 1.1 * dry ? dry : dry * camera::kSalineIndex;
}

// What is measured in a picture that repeats the one before. Corners of two pictures of one moment differ by
// hundredths of a pixel: a codec's, not a sensor's.
constexpr double kSameCorners_px = 0.01;

bool are_same(const std::array<Eigen::Vector2d, 4>& a, const std::array<Eigen::Vector2d, 4>& b) {
  for (std::size_t i = 0; i < a.size(); ++i)
    if ((a[i] - b[i]).norm() > kSameCorners_px) return false;
  return true;
}

bool both_tracked(const std::array<markers::MarkerObservation, 2>& markers) {
  return markers[0].is_tracked() && markers[1].is_tracked();
}

}  // namespace

struct RulerSightings::State {
  explicit State(const RulerSightingsOptions& with)
      : options(with), lens_tracker({.calibration = with.calibration}), other(other_index(with)) {
    // Throws here rather than in the first frame.
    (void)camera::CameraModel(options.calibration, 0, options.refractive_index);
    const Ruler& ruler = options.ruler;
    const markers::DeclaredMarker declared[] = {{ruler.first_id, ruler.size_mm},
                                                {ruler.second_id, ruler.size_mm}};
    as_stated = markers::make_tracker(declared);
    as_other = markers::make_tracker(declared);
    sightings.reserve(std::min<std::size_t>(options.most, 300));
  }

  [[nodiscard]] double mark_angle_deg() const {
    return options.follow_lens ? seen.lens.mark_angle_deg : options.calibration.reference_mark_angle_deg;
  }

  void find_markers(markers::MarkerTracker& tracker, const camera::GrayView& picture, double index,
                    std::int64_t timestamp_ns) {
    const camera::CameraModel camera(options.calibration,
                                     options.calibration.lens_angle_rad(mark_angle_deg()), index);
    const auto found = tracker.track(picture, camera, timestamp_ns);
    std::copy(found.begin(), found.end(), seen.markers.begin());
  }

  // Most fundamental first: what shows no moment of now, or is of another focal length, says nothing, and
  // neither do the markers' corners without the lens angle.
  [[nodiscard]] std::string reason_against() const {
    const pipeline::FrozenPicture::Signs& signs = frozen.signs();
    if (is_frozen) return "the picture is frozen";
    if (signs.is_repeating || repeats_last()) return "the picture repeats itself";
    if (signs.is_torn) return "the picture is torn";
    const bool is_other_zoom =
        seen.lens.zoom == lens::ZoomState::Unknown || seen.lens.zoom == lens::ZoomState::Changed;
    if (options.follow_lens &&
        (is_other_zoom || seen.lens.zoom_or_slip || seen.lens.mark != lens::MarkState::Found))
      return lens::reason_text(seen.lens);
    for (const auto& marker : seen.markers)
      if (!marker.is_tracked())
        return "marker " + std::to_string(marker.id) + ": " + std::string(markers::to_text(marker.state));
    return "";
  }

  // A view counts once, however often its source sends it.
  [[nodiscard]] bool repeats_last() const {
    return !sightings.empty() && both_tracked(seen.markers) &&
           are_same(sightings.back().first_px, seen.markers[0].corners_px) &&
           are_same(sightings.back().second_px, seen.markers[1].corners_px);
  }

  RulerSightingsOptions options;
  lens::LensTracker lens_tracker;
  pipeline::FrozenPicture frozen{pipeline::ViewTrackerOptions().frozen_after_s};
  bool is_frozen = false;
  double other;  // index
  std::unique_ptr<markers::MarkerTracker> as_stated, as_other;
  std::vector<std::uint8_t> gray;
  RulerLook seen;
  std::vector<RulerSighting> sightings;
  std::size_t frame_count = 0;
};

RulerSightings::RulerSightings(const RulerSightingsOptions& options)
    : state_(std::make_unique<State>(options)) {}
RulerSightings::~RulerSightings() = default;
RulerSightings::RulerSightings(RulerSightings&&) noexcept = default;
RulerSightings& RulerSightings::operator=(RulerSightings&&) noexcept = default;

const RulerLook& RulerSightings::look(const camera::Frame& frame) {
  State& s = *state_;
  const Eigen::Vector2i& size = s.options.calibration.image_size_px;
  if (frame.width != size.x() || frame.height != size.y())
    throw InvalidInput("frame " + std::to_string(frame.index) + " is " + std::to_string(frame.width) + " x " +
                       std::to_string(frame.height) + " pixels, but the camera was calibrated at " +
                       std::to_string(size.x()) + " x " + std::to_string(size.y()));
  camera::gray_from(frame, s.gray);
  const camera::GrayView picture{s.gray.data(), frame.width, frame.height, frame.width};
  ++s.frame_count;
  s.is_frozen = s.frozen.observe(picture, frame.timestamp_ns);
  s.seen.lens = s.lens_tracker.observe(picture, frame.timestamp_ns);
  s.find_markers(*s.as_stated, picture, s.options.refractive_index, frame.timestamp_ns);
  if (!both_tracked(s.seen.markers)) {
    const auto stated = s.seen.markers;
    s.find_markers(*s.as_other, picture, s.other, frame.timestamp_ns);
    if (!both_tracked(s.seen.markers)) s.seen.markers = stated;  // its reasons are the ones to tell
  }
  s.seen.reason = s.reason_against();
  s.seen.is_taken = s.seen.reason.empty() && !is_full();
  if (s.seen.is_taken)
    s.sightings.push_back({s.mark_angle_deg(), s.seen.markers[0].corners_px, s.seen.markers[1].corners_px});
  else if (s.seen.reason.empty())
    s.seen.reason = "enough frames were taken";
  return s.seen;
}

void RulerSightings::clear() {
  state_->sightings.clear();
  state_->frame_count = 0;
}

const std::vector<RulerSighting>& RulerSightings::sightings() const { return state_->sightings; }
std::size_t RulerSightings::frame_count() const { return state_->frame_count; }
bool RulerSightings::is_full() const { return state_->sightings.size() >= state_->options.most; }
const RulerSightingsOptions& RulerSightings::options() const { return state_->options; }

}  // namespace arthronaut::calibration
