// Where a marker is that a long exposure smears over cells, and how it moved.
#include "navigation/markers/smear_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "tests/navigation/markers/rendered_marker.h"

namespace arthronaut::markers {
namespace {

using geometry::RigidTransform;
using geometry::Vector6d;

constexpr double kSizeMm = 4;

class SmearSearching : public ::testing::Test {
 protected:
  [[nodiscard]] double cell_px() const {
    return camera_.central_focal_px() * kSizeMm / 6 / pose_.translation_mm.z();
  }
  // Every motion of up to this many steps of half a cell along x and y, from a place off by half a cell.
  [[nodiscard]] std::vector<ExposedPose> motions(int steps) const {
    const RigidTransform supposed =
        pose_ * geometry::exp(motion_of(camera_, pose_, {0.4 * cell_px(), -0.3 * cell_px()}));
    std::vector<ExposedPose> all;
    for (int y = -steps; y <= steps; ++y) {
      for (int x = -steps; x <= steps; ++x)
        all.push_back({supposed, motion_of(camera_, supposed, {0.5 * x * cell_px(), 0.5 * y * cell_px()})});
    }
    return all;
  }
  [[nodiscard]] SmearedPlace find(const RenderedPicture& shown, std::span<const ExposedPose> motions) {
    squares_.look_at(shown.view(), camera_);
    return search_.find(squares_.small_picture(), camera_, codes_[0], kSizeMm, {}, motions, 0.8 * cell_px());
  }

  camera::CameraModel camera_ = small_scope();
  std::vector<MarkerCode> codes_ = codes_4x4_50();
  RigidTransform pose_ = facing_pose(0.5, 0.3, 22, 20, 12, 25);
  SquareSearch squares_;
  SmearSearch search_;
};

// The place is good to a third of a cell, the motion to the next of those that are tried: where the direct
// fit comes in from. A smear looks the same run backwards.
TEST_F(SmearSearching, FindsWhereAndHowAMarkerMoved) {
  const auto tried = motions(6);
  for (const Eigen::Vector2d& moved_cells :
       {Eigen::Vector2d(2.1, 0.3), Eigen::Vector2d(-1.2, 2.0), Eigen::Vector2d(0.4, -2.6)}) {
    const Vector6d motion = motion_of(camera_, pose_, cell_px() * moved_cells);
    const RenderedPicture shown(camera_, {{codes_[0], kSizeMm, pose_, motion}});
    const SmearedPlace place = find(shown, tried);
    SCOPED_TRACE(::testing::Message() << "moved by " << moved_cells.transpose() << " cells");
    EXPECT_GT(place.score, 0.8);
    const double cell_mm = kSizeMm / 6;
    const RigidTransform& found = place.exposed.camera_from_marker;
    EXPECT_LT((found.translation_mm - pose_.translation_mm).head<2>().norm() / cell_mm, 0.34);
    const auto off = [&](double sense) {
      return (motion + sense * place.exposed.velocity).head<3>().norm() / cell_mm;
    };
    EXPECT_LT(std::min(off(-1), off(1)), 0.5);
  }
}

// Another marker's smear looks less like it.
TEST_F(SmearSearching, TellsAnotherMarkersSmearFromItsOwn) {
  const Vector6d motion = motion_of(camera_, pose_, {1.6 * cell_px(), 0.8 * cell_px()});
  const auto score = [&](std::size_t code) {
    return find({camera_, {{codes_[code], kSizeMm, pose_, motion}}}, motions(4)).score;
  };
  EXPECT_GT(score(0), score(2) + 0.05);
}

// Where there is nothing but what is evenly lit, nothing looks like it.
TEST_F(SmearSearching, FindsNothingWhereNothingIs) {
  RenderedPicture shown(camera_, {{codes_[0], kSizeMm, pose_}});
  shown.cover(0, 0, 800, 600, 90);
  EXPECT_LT(find(shown, motions(2)).score, 0);
}

}  // namespace
}  // namespace arthronaut::markers
