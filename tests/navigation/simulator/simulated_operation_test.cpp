#include "navigation/simulator/simulated_operation.h"

#include <gtest/gtest.h>

#include "navigation/calibration/calibration.h"
#include "navigation/camera/frame.h"
#include "navigation/lens/lens_tracker.h"
#include "navigation/markers/marker_tracker.h"
#include "planning/geometry/error.h"
#include "tests/benchmarks/aruco_tracker.h"
#include "tests/navigation/simulator/phantom_options.h"

namespace arthronaut::simulator {
namespace {

camera::GrayView gray_view(const camera::Frame& frame, std::vector<std::uint8_t>& memory) {
  camera::gray_from(frame, memory);
  return {memory.data(), frame.width, frame.height, frame.width};
}

// In every phase the tracker finds world marker and tool in the frames, and the lens mark, and gives their
// relative pose: within 0.6 mm and 0.8 degrees for one plain detection without any refinement against blur
// (0.3 mm, 0.35 degrees were seen).
TEST(SimulatedOperation, ShowsMarkersThatCanBeTracked) {
  SimulationOptions options = phantom_options();
  options.frame_count = 4;
  for (const Phase phase : {Phase::Pivot, Phase::Scratch, Phase::Drill}) {
    SimulatedOperation operation(options, phase);
    EXPECT_EQ(operation.info().frame_count, 4);
    EXPECT_EQ(operation.info().kind, sources::SourceKind::Simulation);
    const auto declared = markers::declared_markers(options.tools);
    std::vector<std::uint8_t> memory;
    // The guide comes into view while it approaches: its first frame may lack it.
    for (int i = 0; const camera::FramePtr frame = operation.next(); ++i) {
      EXPECT_EQ(frame->index, i);
      const camera::GrayView gray = gray_view(*frame, memory);
      const FrameTruth& truth = operation.truth();
      const lens::LensObservation lens = lens::observe_still(gray);
      ASSERT_EQ(lens.mark, lens::MarkState::Found) << i;
      EXPECT_LT(std::abs(std::remainder(lens.mark_angle_deg - truth.mark_angle_deg, 360.0)), 0.3);
      const camera::CameraModel camera(options.camera, options.camera.lens_angle_rad(truth.mark_angle_deg),
                                       options.refractive_index);
      const auto seen = markers::make_aruco_tracker(declared)->track(gray, camera, frame->timestamp_ns);
      std::vector<geometry::RigidTransform> measured, exact;
      for (const auto& marker : truth.markers) {
        for (const auto& observation : seen) {
          if (observation.id != marker.id) continue;
          EXPECT_TRUE(observation.is_tracked() || (phase == Phase::Drill && i == 0))
              << "marker " << marker.id << " in phase " << static_cast<int>(phase) << ", frame " << i << ": "
              << markers::to_text(observation.state);
          if (!observation.is_tracked()) continue;
          measured.push_back(observation.camera_from_marker);
          exact.push_back(marker.camera_from_marker);
        }
      }
      if (phase == Phase::Drill && i == 0) continue;
      if (measured.size() != 2) continue;
      const auto error = (measured[0].inverse() * measured[1]).inverse() * (exact[0].inverse() * exact[1]);
      EXPECT_LT(error.translation_mm.norm(), 0.6);
      EXPECT_LT(geometry::deg_from_rad(geometry::rotation_angle_rad(error.rotation)), 0.8);
    }
  }
}

// The stills of the board calibrate the camera that took them.
TEST(SimulatedOperation, ShowsABoardThatCalibrates) {
  const SimulationOptions options = phantom_options();
  SimulatedOperation operation(options, Phase::Calibrate);
  std::vector<calibration::CalibrationPicture> pictures;
  std::vector<std::uint8_t> memory;
  while (const camera::FramePtr frame = operation.next()) {
    pictures.push_back(calibration::observe_picture(std::to_string(frame->index), gray_view(*frame, memory)));
  }
  ASSERT_EQ(pictures.size(), 5u);
  calibration::CalibrationOptions calibration_options;
  calibration_options.square_mm = options.square_mm;
  calibration_options.leave_one_out = false;
  const auto summary = calibration::calibrate(pictures, calibration_options);
  ASSERT_TRUE(summary.is_usable());
  // As asked of a calibration of the path-traced stills.
  EXPECT_NEAR(summary.record.calibration.focal_px, options.camera.focal_px, 0.003 * options.camera.focal_px);
  EXPECT_NEAR(summary.record.calibration.distortion_xi, options.camera.distortion_xi, 0.006);
}

// The tunnel is as far off the plan as the options say.
TEST(SimulatedOperation, DrillsAsBadlyAsAsked) {
  SimulationOptions options = phantom_options();
  options.drill_error_mm = 1.5;
  options.drill_error_deg = 3;
  const SimulatedOperation operation(options, Phase::Drill);
  const tunnels::Tunnel drilled = operation.drilled_tunnel();
  EXPECT_NEAR(geometry::deg_from_rad(geometry::angle_between_rad(drilled.direction, options.plan.direction)),
              3, 1e-6);
  const Eigen::Vector3d off = options.plan.entry_mm - drilled.entry_mm;
  const double across = (off - off.dot(drilled.direction) * drilled.direction).norm();
  // Across the tunnel; the entry itself slides along the slanted bone.
  EXPECT_NEAR(across, 1.5, 0.1);
}

// Two operations with the same options give the same frames, and the phases of one share the world marker.
TEST(SimulatedOperation, IsDeterministicAndOfOnePiece) {
  SimulationOptions options = phantom_options();
  options.frame_count = 2;
  SimulatedOperation first(options, Phase::Scratch), again(options, Phase::Scratch),
      drill(options, Phase::Drill);
  EXPECT_EQ(first.next()->bgr, again.next()->bgr);
  EXPECT_EQ(first.marker_from_bone().translation_mm, drill.marker_from_bone().translation_mm);
}

// Options out of range are told.
TEST(SimulatedOperation, RefusesNonsense) {
  SimulationOptions options;
  options.frames_per_second = 0;
  EXPECT_THROW(SimulatedOperation(options, Phase::Calibrate), InvalidInput);
}

}  // namespace
}  // namespace arthronaut::simulator
