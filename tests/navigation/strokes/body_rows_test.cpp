#include "navigation/strokes/body_rows.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "navigation/strokes/curves.h"

namespace arthronaut::strokes {
namespace {

using geometry::RigidTransform;

RigidTransform turned(const Eigen::Vector3d& axis, double deg, const Eigen::Vector3d& at_mm) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(geometry::rad_from_deg(deg), axis.normalized())), at_mm};
}

// A world of two markers, a probe of three, a guide of one.
class BodyRows : public ::testing::Test {
 protected:
  BodyRows() {
    tools_.world_markers = {{bones::BoneKind::Femur, 0, 4.0}};
    tools_.world_markers[0].markers = {{0, 4.0, {}}, {10, 3.0, turned({1, 0, 0}, 10, {0, 8, 1})}};
    tools::Tool probe{"probe", 2, 4.0, Eigen::Vector3d(0, -20, -5), std::nullopt};
    probe.markers = {{2, 4.0, {}},
                     {12, 4.0, turned({0, 1, 0}, 25, {6, 2, -1.5})},
                     {22, 3.0, turned({0, 1, 0}, -25, {-6, 1, -1.2})}};
    tools_.tools = {probe, {"guide", 3, 4.0, std::nullopt, std::nullopt}};
    std::uniform_real_distribution<double> side(-3, 3), tilt(-30, 30);
    for (std::int64_t frame = 0; frame < 30; ++frame) {
      // The faces look at the camera.
      const RigidTransform facing{Eigen::Quaterniond(0, 1, 0, 0), {side(random_), side(random_), 24}};
      world_.push_back(facing * turned({1, 1, 0}, tilt(random_), {5, 0, 0}));
      probe_.push_back(facing * turned({1, -1, 0}, tilt(random_), {-5, 0, 0}));
      for (const tools::BodyMarker& marker : tools_.world_markers[0].markers)
        add(frame, marker.marker_id, world_.back() * marker.body_from_marker);
      for (const tools::BodyMarker& marker : tools_.tools[0].markers)
        add(frame, marker.marker_id, probe_.back() * marker.body_from_marker);
      add(frame, 3, probe_.back());
    }
  }
  void add(std::int64_t frame, int id, const RigidTransform& pose) {
    PoseRow row;
    row.frame = frame;
    row.time_s = static_cast<double>(frame) / 30;
    row.marker_id = id;
    row.camera_from_marker = pose;
    row.rms_px = 0.2;
    rows_.push_back(row);
  }
  static double apart(const RigidTransform& a, const RigidTransform& b) {
    return geometry::log(a.inverse() * b).norm();
  }

  std::mt19937 random_{9};
  tools::ToolSet tools_;
  std::vector<RigidTransform> world_, probe_;
  std::vector<PoseRow> rows_;
};

// One row a body and frame, where the body is; what is of one marker stays as it was.
TEST_F(BodyRows, HasOneRowABody) {
  const auto rows = body_rows(rows_, tools_);
  ASSERT_EQ(rows.size(), 3 * world_.size());
  for (const PoseRow& row : rows) {
    const auto i = static_cast<std::size_t>(row.frame);
    EXPECT_LT(apart(row.camera_from_marker, row.marker_id == 0 ? world_[i] : probe_[i]), 1e-6)
        << row.marker_id;
    EXPECT_NEAR(row.rms_px, 0.2, 1e-9);
  }
}

// Whichever of its markers are seen, the body is where it is; a bent one that contradicts the only other is
// no pose, and beside two that agree it is left out.
TEST_F(BodyRows, FollowsTheMarkersThatAreSeen) {
  std::vector<PoseRow> some;
  for (PoseRow row : rows_) {
    const bool is_hidden =
        (row.frame % 3 == 0 && row.marker_id == 2) || (row.frame % 3 == 1 && row.marker_id != 22);
    if (is_hidden && row.marker_id != 0 && row.marker_id != 10) continue;
    if (row.marker_id == 12)
      row.camera_from_marker = row.camera_from_marker * turned({1, 0, 0}, 20, {2, 0, 0});
    some.push_back(row);
  }
  for (const PoseRow& row : body_rows(some, tools_)) {
    if (row.marker_id != 2) continue;
    EXPECT_NE(row.frame % 3, 0) << "12 and 22 disagree and nothing tells which is wrong";
    EXPECT_LT(apart(row.camera_from_marker, probe_[static_cast<std::size_t>(row.frame)]), 1e-6);
  }
}

// What is no pose for guidance is none here: a marker that was out of its place is not believed alone in the
// frames after it, until it lies where another one has it again.
TEST_F(BodyRows, AMarkerThatWasOutOfPlaceIsNotBelievedAlone) {
  std::vector<PoseRow> some;
  for (PoseRow row : rows_) {
    const bool is_bent = row.frame == 0, is_alone = row.frame == 1 || row.frame == 3;
    if (is_alone && (row.marker_id == 2 || row.marker_id == 22)) continue;
    if (is_bent && row.marker_id == 12)
      row.camera_from_marker = row.camera_from_marker * turned({1, 0, 0}, 20, {2, 0, 0});
    some.push_back(row);
  }
  std::vector<std::int64_t> frames;
  for (const PoseRow& row : body_rows(some, tools_))
    if (row.marker_id == 2 && row.frame < 4) frames.push_back(row.frame);
  EXPECT_EQ(frames, (std::vector<std::int64_t>{0, 2, 3})) << "in frame 1 it stands alone";
}

// The tip that digitise finds is that of the bodies.
TEST_F(BodyRows, LeadToTheTip) {
  StrokeOptions all;
  all.min_length_mm = 0;
  all.max_hop_mm = 1e3;
  const Curves curves = digitise(rows_, tools_, bones::BoneKind::Femur, "probe", all);
  ASSERT_EQ(curves.size(), world_.size());
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const Eigen::Vector3d tip_mm = world_[i].inverse() * (probe_[i] * *tools_.tools[0].tip_mm);
    EXPECT_LT((curves[i].position_mm - tip_mm).norm(), 1e-5);
  }
}

TEST_F(BodyRows, KnowWhoseMarkerItIs) {
  EXPECT_EQ(body_id_of(22, tools_), 2);
  EXPECT_EQ(body_id_of(10, tools_), 0);
  EXPECT_EQ(body_id_of(3, tools_), 3);
  EXPECT_EQ(body_id_of(41, tools_), 41);
}

}  // namespace
}  // namespace arthronaut::strokes
