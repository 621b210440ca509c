#include "app/navigate/navigate_choices.h"

#include <gtest/gtest.h>

namespace arthronaut::navigate {
namespace {

// Nothing that was chosen or seen of one bone is left on the other one's screen; what is of the screen or of
// the case stays.
TEST(NavigateChoices, TheOtherBoneBeginsWithoutWhatWasOfThisOne) {
  NavigateChoices choices;
  choices.saline = false;
  choices.video = 3;
  choices.undistorts = true;
  choices.layout = NavigateLayout::Register;
  choices.guidance_seen_s = 99;
  choices.stroke = 4;
  choices.take_other_bone();
  EXPECT_EQ(choices.bone, bones::BoneKind::Tibia);
  EXPECT_FALSE(choices.layout);
  EXPECT_LT(choices.guidance_seen_s, -1e6);
  EXPECT_EQ(choices.stroke, -1);
  EXPECT_TRUE(choices.undistorts && !choices.saline && choices.video == 3);
  choices.take_other_bone();
  EXPECT_EQ(choices.bone, bones::BoneKind::Femur);
}

}  // namespace
}  // namespace arthronaut::navigate
