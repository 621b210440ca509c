#include "navigation/registration/given_registration.h"

#include <gmock/gmock.h>

#include "tests/planning/geometry/shapes.h"

namespace arthronaut::registration {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// A bone of 80 x 60 x 50 mm, its marker 2 mm off its end, and a registration by which it is relied on.
class GivenRegistration : public ::testing::Test {
 protected:
  GivenRegistration() {
    given_.has_pose = given_.reliable = true;
    given_.reasons.clear();
    given_.marker_from_bone.translation_mm = {-42, 0, 0};
    given_.point_count = 300;
    given_.predicted_tre_mm = 0.4;
    given_.covariance.topLeftCorner<3, 3>() = 0.4 * 0.4 / 3 * Eigen::Matrix3d::Identity();
  }
  std::vector<std::string> reasons() {
    RegistrationSummary judged = given_;
    judge_given(judged, {surface_, tools_, bones::BoneKind::Femur, Eigen::Vector3d(0, 0, 25)});
    EXPECT_EQ(judged.reliable, judged.reasons.empty());
    return judged.reasons;
  }
  geometry::Surface surface_{test::ellipsoid({40, 30, 25}, 3)};
  tools::ToolSet tools_ = tools::standard_tools();
  RegistrationSummary given_;
};

TEST_F(GivenRegistration, OneThatFitsItsBoneIsReliedOn) { EXPECT_THAT(reasons(), IsEmpty()); }

// The truth of a simulation is of no points and exact.
TEST_F(GivenRegistration, NoPointsAndNoErrorAreNotHeldAgainstIt) {
  given_.point_count = 0;
  given_.predicted_tre_mm = 0;
  given_.covariance.setZero();
  EXPECT_THAT(reasons(), IsEmpty());
}

// Whatever the file says of itself.
TEST_F(GivenRegistration, Hazard1ABoneFarFromItsMarkerIsNotReliable) {
  given_.marker_from_bone.translation_mm = {-690, 0, 0};
  EXPECT_THAT(reasons(), ElementsAre(HasSubstr("puts the femur 650 mm away from the marker")));
  given_.marker_from_bone.translation_mm = {0, 0, 0};
  EXPECT_THAT(reasons(), ElementsAre(HasSubstr("puts the femur's marker 25 mm inside the bone")));
}

// An outside tracker's array stands on an arm of its own, and its frame may be the screw's.
TEST_F(GivenRegistration, AnOutsideTrackersMarkerMayStandOff) {
  tools_.tracker.emplace();
  given_.marker_from_bone.translation_mm = {-240, 0, 0};
  EXPECT_THAT(reasons(), IsEmpty());
  given_.marker_from_bone.translation_mm = {0, 0, 0};
  EXPECT_THAT(reasons(), IsEmpty());
  given_.marker_from_bone.translation_mm = {-690, 0, 0};
  EXPECT_THAT(reasons(), ElementsAre(HasSubstr("650 mm away")));
}

// Of several markers one may stand out on an arm; what counts is that one of them is on the bone.
TEST_F(GivenRegistration, OneOfSeveralMarkersOnTheBoneIsEnough) {
  tools::BodyMarker on_arm, on_bone;
  on_arm.body_from_marker.translation_mm = {70, 0, 0};
  tools_.world_markers.front().markers = {on_arm, on_bone};
  EXPECT_THAT(reasons(), IsEmpty());
  tools_.world_markers.front().markers = {on_arm};
  EXPECT_THAT(reasons(), ElementsAre(HasSubstr("72 mm away")));
}

TEST_F(GivenRegistration, AnErrorAboveTheLimitIsNotReliable) {
  given_.predicted_tre_mm = 7.5;
  given_.covariance.topLeftCorner<3, 3>() = 7.5 * 7.5 / 3 * Eigen::Matrix3d::Identity();
  EXPECT_THAT(reasons(), ElementsAre(HasSubstr("predicted error is 7.50 mm, more than 1.2 mm")));
}

// Small where its strokes were, and too large where the tunnel is planned.
TEST_F(GivenRegistration, AnErrorAboveTheLimitAtTheEntryIsNotReliable) {
  given_.covariance(3, 3) = 0.06 * 0.06;  // rad: 1.5 mm at 25 mm
  EXPECT_THAT(reasons(), ElementsAre(HasSubstr("at the planned entry is 1.55 mm")));
}

TEST_F(GivenRegistration, PointsThatMissTheBoneAreNotReliable) {
  given_.rms_mm = 4;
  EXPECT_THAT(reasons(), ElementsAre(HasSubstr("its points miss the bone by 4.00 mm")));
}

// The sigma beside the plan is the covariance's: it would be shown far too small.
TEST_F(GivenRegistration, ACovarianceThatKnowsMoreThanItsErrorIsNotReliable) {
  given_.predicted_tre_mm = 1.1;
  EXPECT_THAT(reasons(), ElementsAre(HasSubstr("predicts an error of 1.10 mm, and its covariance none above "
                                               "0.40 mm")));
}

// It keeps its own reasons, and one without a pose has nothing to be judged by.
TEST_F(GivenRegistration, ItsOwnReasonsStay) {
  given_.reliable = false;
  given_.reasons = {"two poses fit almost alike"};
  EXPECT_THAT(reasons(), ElementsAre("two poses fit almost alike"));
  given_ = {};
  EXPECT_THAT(reasons(), ElementsAre("no registration was run"));
}

}  // namespace
}  // namespace arthronaut::registration
