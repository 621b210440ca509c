// A marker tracker that sees what the test says, and pictures that show nothing: the pipeline's own work with
// known truth.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "navigation/pipeline/navigation_pipeline.h"

namespace arthronaut::test {

class ScriptedMarkers : public markers::MarkerTracker {
 public:
  explicit ScriptedMarkers(std::vector<markers::MarkerObservation>* script) : script_(script) {}
  std::span<const markers::MarkerObservation> track(const camera::GrayView&, const camera::CameraModel&,
                                                    std::int64_t) override {
    return *script_;
  }
  void reset() override {}

 private:
  std::vector<markers::MarkerObservation>* script_;  // the test's
};

inline markers::MarkerObservation seen(int id, const geometry::RigidTransform& camera_from_marker,
                                       const geometry::Matrix6d& covariance = geometry::Matrix6d::Zero()) {
  markers::MarkerObservation marker;
  marker.id = id;
  marker.state = markers::MarkerState::Tracked;
  marker.corners_px.fill(Eigen::Vector2d::Zero());  // nowhere
  marker.camera_from_marker = camera_from_marker;
  marker.covariance = covariance;
  return marker;
}

inline markers::MarkerObservation lost(int id, markers::MarkerState why) {
  markers::MarkerObservation marker;
  marker.id = id;
  marker.state = why;
  return marker;
}

// 160 x 120: small, so that tests are quick. The rotation centre lies off the principal point.
inline camera::Calibration small_calibration() {
  camera::Calibration calibration;
  calibration.image_size_px = {160, 120};
  calibration.focal_px = 50;
  calibration.principal_point_px = {82, 61};
  calibration.rotation_center_px = {74, 58};
  calibration.distortion_xi = -0.2;
  calibration.boundary = {{80, 60}, 55};
  return calibration;
}

// A plain picture whose grey value tells it from others.
inline camera::Frame plain_frame(std::int64_t index, std::uint8_t gray) {
  camera::Frame frame;
  frame.index = index;
  frame.timestamp_ns = index * 1'000'000'000 / 60;
  frame.width = 160;
  frame.height = 120;
  frame.bgr.assign(static_cast<std::size_t>(3 * frame.width * frame.height), gray);
  return frame;
}

// A plain lit view inside the rim that small_calibration() has: its zoom is known.
inline camera::Frame round_frame(std::int64_t index, std::uint8_t gray) {
  camera::Frame frame = plain_frame(index, 0);
  const camera::Boundary rim = small_calibration().boundary;
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      const double open =
          std::clamp(rim.radius_px - (Eigen::Vector2d(x, y) - rim.center_px).norm() + 0.5, 0.0, 1.0);
      const auto value = static_cast<std::uint8_t>(gray * std::pow(open, 1 / 2.2));
      std::fill_n(frame.bgr.begin() + 3 * (y * frame.width + x), 3, value);
    }
  }
  return frame;
}

// World marker 0 of the femur, probe 2 with a tip, guide 3 with an axis. All is known exactly.
inline pipeline::PipelineOptions scripted_options() {
  pipeline::PipelineOptions options;
  options.calibration = small_calibration();
  options.calibration.covariance = camera::CameraCovariance::Zero();
  options.follow_lens = false;
  options.tools.world_markers = {{bones::BoneKind::Femur, 0, 4.0}};
  tools::Tool probe;
  probe.name = "probe";
  probe.marker_id = 2;
  probe.tip_mm = Eigen::Vector3d(1, -30, -5);
  probe.tip_covariance_mm2 = Eigen::Matrix3d::Zero();
  tools::Tool guide;
  guide.name = "femoral guide";
  guide.marker_id = 3;
  guide.axis = tools::ToolAxis{{0, -25, -4}, {0, -1, 0}};
  guide.axis_point_sigma_mm = guide.axis_direction_sigma_deg = 0.0;
  options.tools.tools = {probe, guide};
  return options;
}

// A drill with a marker of its own, 6.
inline tools::Tool scripted_drill() {
  tools::Tool drill;
  drill.name = "drill";
  drill.marker_id = 6;
  drill.kind = tools::ToolKind::Drill;
  drill.tip_mm = Eigen::Vector3d(0, -40, -4);
  drill.axis = tools::ToolAxis{*drill.tip_mm, -Eigen::Vector3d::UnitY()};
  return drill;
}

}  // namespace arthronaut::test
