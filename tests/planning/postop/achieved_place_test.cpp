// A tunnel put beside its plan by known ways: told by the bone's own axes, its grid and the bone beside it.
#include "planning/postop/achieved_place.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "planning/phantom/phantom_knee.h"

namespace arthronaut::postop {
namespace {

using landmarks::LandmarkState;
constexpr LandmarkState kConfirmed = LandmarkState::Confirmed;

class AchievedPlaceTest : public ::testing::Test {
 protected:
  [[nodiscard]] static tunnels::PlanSurroundings around(const bones::Bone& bone,
                                                        const landmarks::Landmarks& landmarks) {
    return tunnels::surroundings_of(bone.mesh, bone.kind, landmarks, bones::Side::Right,
                                    std::make_shared<const geometry::Surface>(bone.mesh));
  }
  [[nodiscard]] static AchievedTunnel drilled(const tunnels::Tunnel& tunnel) {
    AchievedTunnel achieved;
    achieved.is_found = achieved.comes_out = true;
    achieved.tunnel = tunnel;
    achieved.entry_sigma_mm = achieved.direction_sigma_rad = 0;
    return achieved;
  }
  struct Known {
    phantom::PhantomKnee knee = phantom::make_phantom_knee({.edge_length_mm = 3});
    tunnels::PlanSurroundings femur = around(knee.femur, knee.femur_landmarks),
                              tibia = around(knee.tibia, knee.tibia_landmarks);
  };
  static const Known& known() {
    static const Known made;
    return made;
  }
  const phantom::PhantomKnee& knee_ = known().knee;
  const tunnels::PlanSurroundings& femur_ = known().femur;
  const tunnels::PlanSurroundings& tibia_ = known().tibia;
};

TEST_F(AchievedPlaceTest, SaysWhichWayTheEntryIsOff) {
  AchievedTunnel achieved = drilled(knee_.femoral_tunnel);
  const landmarks::AnatomicalAxes& axes = femur_.axes.value();
  achieved.tunnel.entry_mm += -1.5 * axes.anterior + 2.5 * axes.proximal + 0.02 * axes.lateral;
  AchievedPlace place = place_of(achieved, knee_.femoral_tunnel, femur_, kConfirmed);
  EXPECT_LT((place.off_mm - Eigen::Vector3d(-1.5, 2.5, 0.02)).norm(), 1e-9);
  EXPECT_EQ(off_in_words(place), "2.5 mm proximal, 1.5 mm posterior");
  place.axes_from = landmarks::AnatomicalAxes::Origin::FromScanner;
  EXPECT_EQ(off_in_words(place), "2.5 mm proximal, 1.5 mm posterior (by the scanner's axes)");
  EXPECT_EQ(off_in_words({}), "in place");
}

// What follows from landmarks that nobody has looked at says so; the bone's shaft is no landmark.
TEST_F(AchievedPlaceTest, SaysThatTheLandmarksAreProposed) {
  AchievedTunnel achieved = drilled(knee_.femoral_tunnel);
  achieved.tunnel.entry_mm += 1.5 * femur_.axes.value().anterior;
  const AchievedPlace place = place_of(achieved, knee_.femoral_tunnel, femur_, LandmarkState::Proposed);
  EXPECT_EQ(off_in_words(place), "1.5 mm anterior (by proposed landmarks)");
  EXPECT_TRUE(grid_in_words(place).ends_with(" % (by proposed landmarks)")) << grid_in_words(place);
  const auto by_shape =
      place_of(achieved, knee_.femoral_tunnel, around(knee_.femur, {}), LandmarkState::Proposed);
  EXPECT_EQ(off_in_words(by_shape).find("landmarks"), std::string::npos);
  EXPECT_EQ(grid_in_words(by_shape), "");
}

// A tenth of the grid's depth shallower and a twentieth of its height lower; on the tibia a tenth posterior.
TEST_F(AchievedPlaceTest, SaysWhereBothAreInTheGrid) {
  const landmarks::FemoralQuadrant& quadrant = femur_.quadrant.value();
  AchievedTunnel achieved = drilled(knee_.femoral_tunnel);
  achieved.tunnel.entry_mm +=
      0.1 * quadrant.depth_mm * quadrant.shallow + 0.05 * quadrant.height_mm * quadrant.low;
  AchievedPlace place = place_of(achieved, knee_.femoral_tunnel, femur_, kConfirmed);
  ASSERT_EQ(place.grid.size(), 2U);
  const auto planned = quadrant.percent_of(knee_.femoral_tunnel.entry_mm);
  EXPECT_NEAR(place.grid[0].planned_percent, planned.deep_shallow, 1e-9);
  EXPECT_NEAR(place.grid[0].achieved_percent, planned.deep_shallow + 10, 1e-9);
  EXPECT_NEAR(place.grid[1].achieved_percent, planned.high_low + 5, 1e-9);
  place.grid = {{"Deep to shallow", 28.4, 31.24}};
  EXPECT_EQ(grid_in_words(place), "deep to shallow 31.2 %, planned 28.4 %");

  const tunnels::PlanSurroundings tibia = around(knee_.tibia, knee_.tibia_landmarks);
  achieved = drilled(knee_.tibial_tunnel);
  achieved.tunnel.entry_mm += 0.1 * tibia.plateau.value().depth_mm * tibia.plateau->posterior;
  place = place_of(achieved, knee_.tibial_tunnel, tibia, kConfirmed);
  ASSERT_EQ(place.grid.size(), 2U);
  EXPECT_EQ(place.grid[0].name, "Anterior to posterior");
  EXPECT_NEAR(place.grid[0].achieved_percent - place.grid[0].planned_percent, 10, 1e-9);
  EXPECT_NEAR(place.grid[1].achieved_percent, place.grid[1].planned_percent, 1e-9);
}

// What a plan of that place and width would be said to leave. A socket that ends before the thin place leaves
// nobody knows how much.
TEST_F(AchievedPlaceTest, SaysHowMuchBoneIsLeftBesideIt) {
  AchievedTunnel achieved = drilled(knee_.femoral_tunnel);
  achieved.tunnel.diameter_mm += 1;
  const auto planned = tunnels::measure(knee_.femoral_tunnel, *femur_.surface),
             wider = tunnels::measure(achieved.tunnel, *femur_.surface);
  const AchievedPlace place = place_of(achieved, knee_.femoral_tunnel, femur_, kConfirmed);
  EXPECT_EQ(place.planned_wall_mm, planned.wall_mm);
  EXPECT_EQ(place.wall_mm, wider.wall_mm);
  achieved.comes_out = false;
  achieved.length_mm = wider.thinnest_station_mm + 0.1;
  EXPECT_TRUE(place_of(achieved, knee_.femoral_tunnel, femur_, kConfirmed).wall_mm);
  achieved.length_mm = wider.thinnest_station_mm - 0.1;
  const AchievedPlace socket = place_of(achieved, knee_.femoral_tunnel, femur_, kConfirmed);
  EXPECT_FALSE(socket.wall_mm);
  EXPECT_EQ(wall_in_words(socket), "");
  EXPECT_EQ(wall_in_words({.planned_wall_mm = 2.61, .wall_mm = 1.84}), "1.8 mm; planned 2.6 mm");
}

// By how far the axis and the diameter may be off; nothing where nobody knows that.
TEST_F(AchievedPlaceTest, SaysHowWellTheBoneBesideItIsKnown) {
  AchievedTunnel achieved = drilled(knee_.femoral_tunnel);
  EXPECT_FALSE(std::isfinite(place_of(achieved, knee_.femoral_tunnel, femur_, kConfirmed).wall_sigma_mm));
  achieved.diameter_sigma_mm = 0.2;
  AchievedPlace place = place_of(achieved, knee_.femoral_tunnel, femur_, kConfirmed);
  EXPECT_NEAR(place.wall_sigma_mm, M_SQRT2 * 0.1, 0.02);
  achieved.entry_sigma_mm = 0.2;
  place = place_of(achieved, knee_.femoral_tunnel, femur_, kConfirmed);
  EXPECT_GT(place.wall_sigma_mm, 0.18);
  EXPECT_LT(place.wall_sigma_mm, 0.3);
  EXPECT_LT(place.least_wall_mm, *place.wall_mm - 0.15);
  EXPECT_GT(place.most_wall_mm, *place.wall_mm + 0.15);
  for (double AchievedTunnel::*const unknown :
       {&AchievedTunnel::entry_sigma_mm, &AchievedTunnel::direction_sigma_rad}) {
    AchievedTunnel other = achieved;
    other.*unknown = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(std::isfinite(place_of(other, knee_.femoral_tunnel, femur_, kConfirmed).wall_sigma_mm));
  }
}

TEST(AchievedSigma, IsNeverNothing) {
  EXPECT_EQ(sigma_in_words(0.123, 2), "\u00B1 0.12");
  EXPECT_EQ(sigma_in_words(0, 1), "\u00B1 0.1");
  EXPECT_EQ(sigma_in_words(std::numeric_limits<double>::infinity(), 2), "\u00B1 not known");
}

// Moved aside bit by bit until its wall leaps from one such bit to the next.
TEST_F(AchievedPlaceTest, SaysARangeOfBoneWhereItGrazesTheSurface) {
  AchievedTunnel achieved = drilled(knee_.tibial_tunnel);
  const Eigen::Vector3d aside = achieved.tunnel.direction.unitOrthogonal();
  std::optional<double> before_mm;
  double leap_mm = 0;
  for (double off_mm = 0; off_mm < 30 && leap_mm < 1; off_mm += 0.05) {
    achieved.tunnel.entry_mm = knee_.tibial_tunnel.entry_mm + off_mm * aside;
    const auto measured = tunnels::measure(achieved.tunnel, *tibia_.surface);
    leap_mm = measured.enters_bone && before_mm ? std::abs(measured.wall_mm - *before_mm) : 0;
    before_mm = measured.enters_bone ? std::optional(measured.wall_mm) : std::nullopt;
  }
  ASSERT_GE(leap_mm, 1);
  achieved.entry_sigma_mm = 0.08;
  achieved.diameter_sigma_mm = 0.02;
  const AchievedPlace place = place_of(achieved, knee_.tibial_tunnel, tibia_, kConfirmed);
  EXPECT_GT(place.wall_sigma_mm, 0.4 * leap_mm);
  EXPECT_GT(place.most_wall_mm - place.least_wall_mm, leap_mm - 0.1);
  EXPECT_EQ(wall_in_words({.planned_wall_mm = 2.61,
                           .wall_mm = 1.84,
                           .wall_sigma_mm = 0.9,
                           .least_wall_mm = -0.2,
                           .most_wall_mm = 1.84}),
            "-0.2 to 1.8 mm, it grazes the bone's surface; planned 2.6 mm");
}

TEST(AchievedLength, SaysWhatGoesOnBeyondASocket) {
  AchievedTunnel achieved;
  achieved.length_mm = 22;
  achieved.comes_out = true;
  EXPECT_EQ(length_in_words(achieved), "22.0 mm");
  achieved.comes_out = false;
  EXPECT_EQ(length_in_words(achieved), "22.0 mm, a socket");
  achieved.beyond_mm = 4.5;
  EXPECT_EQ(length_in_words(achieved), "22.0 mm, a socket; beyond it a bore of 4.5 mm");
  achieved.end_is_seen = false;
  EXPECT_EQ(length_in_words(achieved), "22.0 mm, its end not seen");
}

// A bore that is equally wide all along was said to be "9.1 to 9.1 mm".
TEST(AchievedWidths, SayOnceWhatRoundsToTheSame) {
  EXPECT_EQ(widths_in_words({}), "");
  EXPECT_EQ(widths_in_words({{2, 9.06}, {10, 9.14}}), "9.1 mm");
  EXPECT_EQ(widths_in_words({{2, 9.0, 0.05}, {10, 9.9, 0.06}, {20, 9.2, 0.05}}),
            "9.0 to 9.9 mm, widest 10 mm from the entry");
}

// The widest of several measurements of an even bore lies somewhere: that is noise, and no place of a
// widening.
TEST(AchievedWidths, NameNoPlaceOfAWideningThatTheirErrorsMake) {
  EXPECT_EQ(widths_in_words({{2, 9.0, 0.07}, {10, 9.2, 0.07}, {25, 8.95, 0.07}}), "8.9 to 9.2 mm");
  EXPECT_EQ(widths_in_words({{2, 9.0, 0.02}, {10, 9.2, 0.02}, {25, 8.9, 0.02}}),
            "8.9 to 9.2 mm, widest 10 mm from the entry");
  EXPECT_EQ(widths_in_words({{2, 9.0}, {10, 9.9}, {20, 9.2}}),
            "9.0 to 9.9 mm");  // a file that says no errors
}

// Without landmarks there is no grid, and axes come from the bone's shape.
TEST_F(AchievedPlaceTest, SaysNothingOfAGridThatIsNotThere) {
  const auto shape_alone = around(knee_.femur, {});
  AchievedTunnel achieved = drilled(knee_.femoral_tunnel);
  achieved.tunnel.entry_mm += Eigen::Vector3d(0, 0, 1);
  const AchievedPlace place = place_of(achieved, knee_.femoral_tunnel, shape_alone, kConfirmed);
  EXPECT_TRUE(place.grid.empty());
  EXPECT_EQ(grid_in_words(place), "");
  EXPECT_NEAR(place.off_mm.norm(), 1, 1e-9);
}

}  // namespace
}  // namespace arthronaut::postop
