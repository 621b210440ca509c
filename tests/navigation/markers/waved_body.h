// A body with three markers that is waved before the small scope of rendered_marker.h, and what the product's
// tracker says of every picture.
#pragma once

#include <cmath>
#include <vector>

#include "navigation/markers/body_pose.h"
#include "tests/navigation/markers/rendered_marker.h"

namespace arthronaut::markers {

inline geometry::RigidTransform turned_by(const Eigen::Vector3d& axis, double deg,
                                          const Eigen::Vector3d& at_mm) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(geometry::rad_from_deg(deg), axis.normalized())), at_mm};
}

// Plates side by side, the outer ones turned outwards by 25 degrees. Their places are known exactly.
inline Body waved_body() {
  Body body;
  body.id = 2;
  body.markers = {{2, 3.0, {}, 0.0, 0.0},
                  {12, 3.0, turned_by({0, 1, 0}, 25, {5.2, 1.0, -1.2}), 0.0, 0.0},
                  {22, 2.5, turned_by({0, 1, 0}, -25, {-5.0, 0.5, -1.2}), 0.0, 0.0}};
  return body;
}

struct WavedFrame {
  geometry::RigidTransform camera_from_body;
  std::vector<MarkerObservation> observations;  // of the body's markers, in their order
};

// A slow wave, swung by up to 30 degrees at 30 pictures a second; each picture is rendered anew and tracked.
inline std::vector<WavedFrame> tracked_wave(const Body& body, int frames, unsigned seed) {
  const camera::CameraModel camera = small_scope();
  std::vector<DeclaredMarker> declared;
  for (const tools::BodyMarker& marker : body.markers) declared.push_back({marker.marker_id, marker.size_mm});
  const auto tracker = make_tracker(declared);
  std::vector<WavedFrame> wave;
  for (int i = 0; i < frames; ++i) {
    const double t = i / 30.0 + 0.1 * seed;
    WavedFrame frame;
    frame.camera_from_body =
        facing_pose(1.0 * std::sin(1.3 * t), 0.8 * std::cos(0.9 * t), 19 + 2 * std::sin(0.7 * t),
                    30 * std::sin(0.9 * t), 30 * std::cos(0.7 * t), 35 * std::sin(0.35 * t));
    std::vector<PlacedMarker> placed;
    for (const tools::BodyMarker& marker : body.markers)
      placed.push_back({codes_4x4_50()[static_cast<std::size_t>(marker.marker_id)], marker.size_mm,
                        frame.camera_from_body * marker.body_from_marker});
    PictureOptions options;
    options.seed = seed * 1000 + static_cast<unsigned>(i);
    const RenderedPicture picture(camera, placed, options);
    const auto seen = tracker->track(picture.view(), camera, i * std::int64_t{33'333'333});
    frame.observations.assign(seen.begin(), seen.end());
    wave.push_back(std::move(frame));
  }
  return wave;
}

}  // namespace arthronaut::markers
