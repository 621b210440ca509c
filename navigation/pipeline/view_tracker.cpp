#include "navigation/pipeline/view_tracker.h"

#include <algorithm>
#include <cmath>

#include "navigation/pipeline/frozen_picture.h"
#include "planning/geometry/error.h"

namespace arthronaut::pipeline {

namespace {

std::string size_text(int width, int height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

}  // namespace

struct ViewTracker::State {
  State(const ViewTrackerOptions& with, std::unique_ptr<markers::MarkerTracker> with_markers)
      : options(with),
        lens_tracker({.calibration = with.calibration}),
        markers(std::move(with_markers)),
        frozen(with.frozen_after_s),
        turn_radius_px((with.calibration.principal_point_px - with.calibration.rotation_center_px).norm()) {
    // Throws here rather than in the first frame.
    (void)camera::CameraModel(options.calibration, 0, options.refractive_index, options.fluid_model);
  }

  void follow_lens(PictureObservation& view) {
    mark_was_seen = mark_was_seen || view.lens.mark == lens::MarkState::Found;
    const bool angle_is_usable = options.follow_lens && mark_was_seen;
    const double angle_rad =
        angle_is_usable ? options.calibration.lens_angle_rad(view.lens.mark_angle_deg) : 0;
    view.camera =
        camera::CameraModel(options.calibration, angle_rad, options.refractive_index, options.fluid_model);
    view.intrinsics_are_known = !options.follow_lens || are_known(view.lens);
  }

  // The angle does not help while the focal length is not known. A scope whose principal point lies on the
  // axis of rotation needs no mark; for others the chord that two sigma of the angle span must stay small
  // while the mark is not seen: a hand turns the lens by ten degrees in a tenth of a second.
  [[nodiscard]] bool are_known(const lens::LensObservation& lens) const {
    if (lens.zoom == lens::ZoomState::Unknown || lens.zoom == lens::ZoomState::Changed) return false;
    if (lens.zoom_or_slip) return false;
    if (lens.mark == lens::MarkState::Found) return true;
    const double two_sigma_deg = mark_was_seen ? std::min(2 * lens.mark_sigma_deg, 180.0) : 180.0;
    const double chord_px = 2 * turn_radius_px * std::sin(geometry::rad_from_deg(two_sigma_deg) / 2);
    return chord_px <= options.max_principal_point_error_px;
  }

  // Whether a marker that was found lies in a part of the picture that was not renewed.
  [[nodiscard]] bool has_standing_marker(const std::vector<markers::MarkerObservation>& seen) const {
    return std::any_of(seen.begin(), seen.end(), [&](const markers::MarkerObservation& marker) {
      return marker.is_tracked() && frozen.stands_still(marker.corners_px);
    });
  }

  ViewTrackerOptions options;
  lens::LensTracker lens_tracker;
  std::unique_ptr<markers::MarkerTracker> markers;
  FrozenPicture frozen;
  double turn_radius_px;
  bool mark_was_seen = false;
  std::vector<std::uint8_t> gray;
};

ViewTracker::ViewTracker(const ViewTrackerOptions& options, std::unique_ptr<markers::MarkerTracker> markers)
    : state_(std::make_unique<State>(options, std::move(markers))) {}

ViewTracker::~ViewTracker() = default;

void ViewTracker::observe(const camera::Frame& frame, PictureObservation& view) {
  State& s = *state_;
  const Eigen::Vector2i& size = s.options.calibration.image_size_px;
  if (frame.width != size.x() || frame.height != size.y()) {
    throw InvalidInput("picture " + std::to_string(frame.index) + " is " +
                       size_text(frame.width, frame.height) + " pixels, but the camera was calibrated at " +
                       size_text(size.x(), size.y()) + ": set the source to that size, or calibrate anew");
  }
  const camera::GrayView picture = camera::luma_of(frame, s.gray);

  view.frame_index = frame.index;
  view.timestamp_ns = frame.timestamp_ns;
  view.is_frozen = s.frozen.observe(picture, frame.timestamp_ns);
  const FrozenPicture::Signs& signs = s.frozen.signs();
  view.is_repeating = signs.is_repeating;
  view.is_torn = signs.is_torn;
  view.is_blank = signs.is_blank;
  view.repeat_share = signs.repeat_share;
  view.shown_for_ns = signs.shown_for_ns;
  view.lens = s.lens_tracker.observe(picture, frame.timestamp_ns);
  s.follow_lens(view);
  const auto markers = s.markers->track(picture, view.camera, frame.timestamp_ns);
  view.markers.assign(markers.begin(), markers.end());
  view.is_torn = s.has_standing_marker(view.markers) || view.is_torn;
  // Its parts are of two moments: no pose of it is to be trusted, nor one part set against the other.
  if (view.is_torn) view.intrinsics_are_known = false;
  const auto candidates = s.markers->candidates();
  view.candidates.assign(candidates.begin(), candidates.end());
}

void append_pose_rows(const PictureObservation& view, std::vector<strokes::PoseRow>& rows) {
  for (const markers::MarkerObservation& marker : view.markers) {
    if (!view.stands_for(marker)) continue;
    strokes::PoseRow row;
    row.frame = view.frame_index;
    row.time_s = static_cast<double>(view.timestamp_ns) * 1e-9;
    row.marker_id = marker.id;
    row.camera_from_marker = marker.camera_from_marker;
    row.rms_px = marker.rms_px;
    if (view.lens.mark == lens::MarkState::Found) row.mark_angle_deg = view.lens.mark_angle_deg;
    rows.push_back(row);
  }
}

}  // namespace arthronaut::pipeline
