#include "app/navigate/touched_picture.h"

#include <gtest/gtest.h>

#include "tests/planning/geometry/shapes.h"

namespace arthronaut::navigate {
namespace {

// A box of 20 mm with its upper face at z = 0.
geometry::TriangleMesh box() {
  geometry::TriangleMesh mesh = test::box({10, 10, 10});
  for (Eigen::Vector3d& p : mesh.vertices_mm) p.z() -= 10;
  return mesh;
}

class TouchedPictureTest : public ::testing::Test {
 protected:
  // One stroke on the box, one 5 mm above it.
  TouchedPictureTest() {
    strokes::Curves drawn;
    for (int i = 0; i < 5; ++i) {
      drawn.push_back({.curve = 0, .time_s = {}, .position_mm = {static_cast<double>(i), 0, 0}});
      drawn.push_back({.curve = 1, .time_s = {}, .position_mm = {static_cast<double>(i), 0, 5}});
    }
    std::ranges::stable_sort(drawn, {}, &strokes::CurvePoint::curve);
    state_.drawn = std::make_shared<const strokes::Curves>(drawn);
  }
  [[nodiscard]] std::vector<scene::Color> colors() {
    scene::SceneContent content;
    TouchedPicture().add_strokes(content, state_, surface_, -1);
    std::vector<scene::Color> found;
    for (const auto& line : content.lines) found.push_back(line.color);
    return found;
  }
  geometry::Surface surface_{box()};
  operation::RegistrationState state_;
};

// The pose that runs along is fitted to the strokes: what lies on the bone by it may have been drawn in the
// air, and is not shown as touched. A registration that stands tells them apart.
TEST_F(TouchedPictureTest, NothingIsTouchedBeforeARegistrationIsSure) {
  auto online = std::make_shared<registration::OnlineResult>();
  online->registration.has_pose = true;
  online->state = registration::OnlineState::Candidate;
  state_.online = online;
  EXPECT_EQ(colors(), (std::vector<scene::Color>{kDrawnColor, kOffColor}));
  auto registration = std::make_shared<registration::RegistrationSummary>();
  registration->has_pose = registration->reliable = true;
  state_.in_force.registration = registration;
  state_.in_force.standing = operation::Standing::Stands;
  EXPECT_EQ(colors(), (std::vector<scene::Color>{scene::kCurveColor, kOffColor}));
  state_.in_force.standing = operation::Standing::NotReliable;
  EXPECT_EQ(colors(), (std::vector<scene::Color>{kDrawnColor, kOffColor}));
}

}  // namespace
}  // namespace arthronaut::navigate
