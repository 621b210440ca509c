#include <gtest/gtest.h>

#include "navigation/lens/rim.h"
#include "tests/navigation/lens/rim_picture.h"

namespace arthronaut::lens {

// A ray that begins outside the picture has nothing to read, wherever it leads.
TEST(RimProfile, ReadsNothingAboutACentreOutsideThePicture) {
  const RimTruth truth;
  const RimPicture picture = draw(truth);
  for (const Eigen::Vector2d& center_px :
       {Eigen::Vector2d(1200, 270), Eigen::Vector2d(-240, 270), Eigen::Vector2d(480, 790),
        Eigen::Vector2d(480, -250), Eigen::Vector2d(480, 0), Eigen::Vector2d(959.9, 539.9)}) {
    RimProfile profile;
    measure_rim(picture.view(), {center_px, truth.radius_px}, 0.85, 1.15, profile);
    EXPECT_EQ(profile.clipped_share, 1) << center_px.transpose();
  }
}

// A circle so small that its rays begin at the centre is looked for no further than that.
TEST(RimProfile, ReadsNothingBehindTheCentre) {
  const RimPicture picture = draw({});
  RimProfile profile;
  measure_rim(picture.view(), {{2.5, 2.5}, 3}, 0.85, 1.15, profile);
  EXPECT_EQ(profile.clipped_share, 1);
}

}  // namespace arthronaut::lens
