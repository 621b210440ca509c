// An operation's source on drawn pictures: a ball for a bone, a marker before it, and a lens that looks
// about.
#pragma once

#include <memory>
#include <utility>

#include "navigation/operation/operation.h"
#include "navigation/simulator/solids.h"
#include "navigation/sources/frame_source.h"
#include "tests/navigation/contour/rendered_bone.h"

namespace arthronaut::test {

inline constexpr double kBallMarker_mm = 6;

inline operation::OperationSetup ball_setup() {
  operation::OperationSetup setup;
  setup.surface = std::make_shared<geometry::Surface>(contour::ball_mesh());
  return setup;
}

inline operation::SourceSetup ball_source() {
  operation::SourceSetup source;
  source.kind = sources::SourceKind::Recording;
  source.pipeline.calibration = contour::small_camera();
  source.pipeline.refractive_index = 1.3345;
  source.pipeline.follow_lens = false;
  source.pipeline.tools.world_markers = {{bones::BoneKind::Femur, 0, kBallMarker_mm}};
  return source;
}

class BallPictures {
 public:
  // moved_mm: of the bone under its marker. Valid until the next call.
  camera::Frame& next(double moved_mm = 0) {
    const geometry::RigidTransform camera_from_bone =
        contour::before_the_lens(0.08 * std::sin(0.06 * static_cast<double>(count_)));
    const geometry::RigidTransform before_it{
        Eigen::Quaterniond(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX())), {-13, 0, 27}};
    simulator::PlateShape plate;
    plate.half_size_mm.setConstant(4);
    plate.markers = {{{0, 0}, kBallMarker_mm, simulator::marker_cells(0)}};
    camera::Frame& frame = picture_.picture(
        camera_from_bone * geometry::RigidTransform{Eigen::Quaterniond::Identity(), {moved_mm, 0, 0}},
        simulator::make_plate(camera_from_bone * contour::before_the_lens().inverse() * before_it, plate));
    frame.index = count_;
    frame.timestamp_ns = ++count_ * 1'000'000'000 / 15;
    return frame;
  }

 private:
  contour::RenderedBone picture_{contour::ball_mesh()};
  std::int64_t count_ = 0;
};

// The bone lies where the first picture shows it: of an operation that has seen that one alone.
inline operation::GiveRegistration registered_as_seen(const operation::Operation& operation) {
  operation::GiveRegistration give;
  give.registration.has_pose = give.registration.reliable = true;
  give.registration.reasons.clear();
  give.registration.covariance = geometry::Matrix6d::Identity() * 1e-4;
  give.registration.predicted_tre_mm = 0.3;
  give.registration.marker_from_bone =
      operation.frame().camera_from_world.target_from_source.inverse() * contour::before_the_lens();
  give.of = operation.now();
  return give;
}
// The same, known before the source runs.
inline operation::GiveRegistration registered_beforehand() {
  operation::Operation operation(ball_setup());
  operation.start_source(ball_source());
  BallPictures pictures;
  operation.process(pictures.next());
  return registered_as_seen(operation);
}

// So many pictures; from moves_at on the bone lies 1 mm from where it lay under its marker.
class BallSource : public sources::FrameSource {
 public:
  explicit BallSource(std::int64_t count, std::int64_t moves_at = 1'000'000)
      : count_(count), moves_at_(moves_at) {
    info_.name = "ball";
    info_.image_size_px = contour::small_camera().image_size_px;
  }
  [[nodiscard]] const sources::SourceInfo& info() const override { return info_; }
  [[nodiscard]] camera::FramePtr next() override {
    if (next_ == count_) return nullptr;
    return std::make_shared<const camera::Frame>(pictures_.next(next_++ >= moves_at_ ? 1 : 0));
  }

 private:
  sources::SourceInfo info_;
  BallPictures pictures_;
  std::int64_t count_, moves_at_, next_ = 0;
};

}  // namespace arthronaut::test
