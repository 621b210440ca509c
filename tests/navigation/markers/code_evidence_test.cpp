// Which marker it is, where highlights hide much of its code.
#include "navigation/markers/code_evidence.h"

#include <gtest/gtest.h>

#include "tests/navigation/markers/rendered_marker.h"

namespace arthronaut::markers {
namespace {

using geometry::RigidTransform;

constexpr double kSizeMm = 4;

class Evidence : public ::testing::Test {
 protected:
  // What a picture of marker 0 says of the code with this id, its top-left being corner `turn` of that one's.
  double lead_of(int id, int turn, const RenderedPicture& picture) {
    const Eigen::Quaterniond turned(Eigen::AngleAxisd(-0.5 * geometry::kPi * turn, Eigen::Vector3d::UnitZ()));
    const RigidTransform pose = pose_ * RigidTransform{turned, Eigen::Vector3d::Zero()};
    CodeEvidence evidence;
    has_highlight_ = evidence.add({picture.view(), light_}, camera_, pose, kSizeMm, dictionary_[id], {});
    const std::vector<MarkerCode> declared = {dictionary_[id]};
    return evidence.lead({declared, dictionary_, {}}, 0);
  }
  [[nodiscard]] RenderedPicture picture() const { return {camera_, {{dictionary_[0], kSizeMm, pose_}}}; }
  // A highlight in the middle of a cell.
  void shine(double column, double row, double cells, RenderedPicture& picture) const {
    const Eigen::Vector2d middle = camera_
                                       .project(pose_ * Eigen::Vector3d(((column + 0.5) / 6 - 0.5) * kSizeMm,
                                                                        (0.5 - (row + 0.5) / 6) * kSizeMm, 0))
                                       .value();
    const double cell_px = camera_.central_focal_px() * kSizeMm / 6 / pose_.translation_mm.z();
    picture.shine(middle.x(), middle.y(), cells * cell_px, 900);
  }

  const std::vector<MarkerCode> dictionary_ = codes_4x4_50();
  const LinearTable light_{1.6};
  camera::CameraModel camera_ = small_scope();
  RigidTransform pose_ = facing_pose(0, 0, 16, 15, -10, 20);
  bool has_highlight_ = false;
};

TEST_F(Evidence, NothingIsAskedWithoutAHighlight) {
  lead_of(0, 0, picture());
  EXPECT_FALSE(has_highlight_);
}

// The steps that are left beside two highlights, each over several cells, tell 0 from every other code.
TEST_F(Evidence, TellsACodeByTheStepsBesideHighlights) {
  RenderedPicture shown = picture();
  shine(1.6, 1.9, 0.5, shown);
  shine(3.6, 3.2, 0.5, shown);
  EXPECT_GT(lead_of(0, 0, shown), 2);
  EXPECT_TRUE(has_highlight_);
  for (int id = 0; id < static_cast<int>(dictionary_.size()); ++id) {
    for (int turn = id == 0 ? 1 : 0; turn < 4; ++turn)
      EXPECT_LT(lead_of(id, turn, shown), -2) << id << ", " << turn;
  }
}

// What is hidden altogether may be anything.
TEST_F(Evidence, OfWhatIsHiddenNothingIsSure) {
  RenderedPicture shown = picture();
  shine(2.5, 2.5, 1.3, shown);
  EXPECT_LT(lead_of(0, 0, shown), 2);
}

}  // namespace
}  // namespace arthronaut::markers
