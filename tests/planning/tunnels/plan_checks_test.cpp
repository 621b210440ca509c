#include "planning/tunnels/plan_checks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "tests/planning/geometry/shapes.h"

namespace arthronaut::tunnels {
namespace {

using bones::BoneKind;
using Verdict = PlanCheck::Verdict;

TunnelGeometry inside(double length_mm, double wall_mm) {
  return {.enters_bone = true,
          .entry_on_surface_mm = {0, 0, 0},
          .exit_mm = {0, 0, length_mm},
          .length_mm = length_mm,
          .wall_mm = wall_mm};
}

PlanCheck named(const std::vector<PlanCheck>& checks, const std::string& name) {
  const auto found =
      std::find_if(checks.begin(), checks.end(), [&](const auto& check) { return check.name == name; });
  if (found == checks.end()) ADD_FAILURE() << "no check " << name;
  return found == checks.end() ? PlanCheck{} : *found;
}

// 10 mm deep and 20 mm high, the corner at the origin: percentages can be read off.
PlanSurroundings with_quadrant() {
  PlanSurroundings surroundings;
  surroundings.quadrant = {
      .corner_mm = {0, 0, 0}, .shallow = {0, -1, 0}, .low = {0, 0, -1}, .depth_mm = 10, .height_mm = 20};
  return surroundings;
}

// The limits and what happens on either side of them.
TEST(PlanChecks, JudgesTheFemoralLength) {
  const Tunnel tunnel{.bone = BoneKind::Femur};
  EXPECT_EQ(named(check_plan(tunnel, inside(30.0, 5), {}), "Length").verdict, Verdict::Fine);
  EXPECT_EQ(named(check_plan(tunnel, inside(29.9, 5), {}), "Length").verdict, Verdict::Look);
  EXPECT_THAT(named(check_plan(tunnel, inside(24.9, 5), {}), "Length").text,
              ::testing::HasSubstr("shorter than 25 mm"));
}

TEST(PlanChecks, JudgesTheWall) {
  const Tunnel tunnel{.bone = BoneKind::Femur};
  EXPECT_EQ(named(check_plan(tunnel, inside(35, 2.0), {}), "Wall").verdict, Verdict::Fine);
  EXPECT_EQ(named(check_plan(tunnel, inside(35, 1.9), {}), "Wall").verdict, Verdict::Look);
  EXPECT_EQ(named(check_plan(tunnel, inside(35, 0.9), {}), "Wall").verdict, Verdict::Wrong);
  EXPECT_THAT(named(check_plan(tunnel, inside(35, -0.02), {}), "Wall").text, ::testing::StartsWith("0.0 mm"));
  EXPECT_THAT(named(check_plan(tunnel, inside(35, -0.1), {}), "Wall").text,
              ::testing::HasSubstr("breaks out"));
}

// A slanting mouth reaches before the entry: there is no depth below zero to read.
TEST(PlanChecks, NamesTheMouthsWhereTheWallIsThinnestThere) {
  const Tunnel tunnel{.bone = BoneKind::Femur};
  auto geometry = inside(35, 3);
  geometry.thinnest_station_mm = 12.3;
  EXPECT_EQ(named(check_plan(tunnel, geometry, {}), "Wall").text, "3.0 mm at 12.3 mm of depth");
  geometry.thinnest_station_mm = -4;
  EXPECT_EQ(named(check_plan(tunnel, geometry, {}), "Wall").text, "3.0 mm at the mouth");
  geometry.thinnest_station_mm = 37;
  EXPECT_EQ(named(check_plan(tunnel, geometry, {}), "Wall").text, "3.0 mm at the exit");
}

// How far down it goes decides what is done about it.
TEST(PlanChecks, SaysOverHowMuchOfTheTunnelABreachGoes) {
  const auto text_of = [](const std::vector<Eigen::Vector2d>& profile_mm) {
    PlanSurroundings known;
    known.surface = std::make_shared<const geometry::Surface>(test::prism(profile_mm, 40, {-10, 10}));
    const Tunnel tunnel{
        .bone = BoneKind::Femur, .entry_mm = {0, 0, 0}, .direction = {0, 0, 1}, .diameter_mm = 9};
    return named(check_plan(tunnel, measure(tunnel, *known.surface), known), "Wall").text;
  };
  EXPECT_EQ(text_of({{5.5, 0}, {2.75, 3}, {25, 30}, {-40, 30}, {-40, 0}}),
            "-1.8 mm at 3.0 mm of depth: breaks out of the bone over 4.0 mm, from 1.1 to 5.1 mm of depth");
  EXPECT_THAT(text_of({{3, 0}, {3, 30}, {-40, 30}, {-40, 0}}),
              ::testing::EndsWith("over 30.0 mm, from the mouth to the exit"));
  EXPECT_THAT(
      text_of({{3.5, 0}, {3.5, 5}, {5.5, 10}, {5.5, 25}, {3.5, 30}, {-40, 30}, {-40, 0}}),
      ::testing::EndsWith("over 7.5 mm, from the mouth to 7.5 mm of depth and over 2.5 mm, from 27.5 mm of "
                          "depth to the exit"));
  // Three of 2 mm and their slants: nobody reads a list.
  EXPECT_THAT(text_of({{3.5, 4},
                       {3.5, 6},
                       {5.5, 6.2},
                       {5.5, 13.8},
                       {3.5, 14},
                       {3.5, 16},
                       {5.5, 16.2},
                       {5.5, 23.8},
                       {3.5, 24},
                       {3.5, 26},
                       {5.5, 26.2},
                       {5.5, 30},
                       {-40, 30},
                       {-40, 0},
                       {5.5, 0},
                       {5.5, 3.8}}),
              ::testing::EndsWith(
                  "breaks out of the bone in 3 places, over 6.6 mm in all, from 3.9 mm to 26.1 mm of depth"));
}

// The limits of the back wall are the femur's: a tibial tunnel thins out at its slanting exit.
TEST(PlanChecks, JudgesTheTibialWallMoreMildly) {
  const Tunnel tunnel{.bone = BoneKind::Tibia, .direction = {0.4, 0, -0.9}};
  EXPECT_EQ(named(check_plan(tunnel, inside(40, 1.5), {}), "Wall").verdict, Verdict::Fine);
  EXPECT_EQ(named(check_plan(tunnel, inside(40, 0.5), {}), "Wall").verdict, Verdict::Look);
}

// The norm of the quadrant is met in its middle, and left on each side with its own word.
TEST(PlanChecks, JudgesThePlaceInTheQuadrant) {
  const Tunnel tunnel{.bone = BoneKind::Femur};
  auto geometry = inside(35, 5);
  geometry.entry_on_surface_mm = {3, -2.84, -7.14};
  auto checks = check_plan(tunnel, geometry, with_quadrant());
  EXPECT_EQ(named(checks, "Deep to shallow").verdict, Verdict::Fine);
  EXPECT_EQ(named(checks, "Deep to shallow").text, "28.4 %");
  EXPECT_EQ(named(checks, "High to low").text, "35.7 %");
  geometry.entry_on_surface_mm = {3, -4.5, -2.0};
  checks = check_plan(tunnel, geometry, with_quadrant());
  EXPECT_EQ(named(checks, "Deep to shallow").verdict, Verdict::Look);
  EXPECT_EQ(named(checks, "Deep to shallow").text, "45.0 %: shallower than 33.5 %");
  EXPECT_EQ(named(checks, "High to low").text, "10.0 %: higher than 28.8 %");
}

// A grid of Blumensaat's line alone touches the outline of the surface: the numbers say so beside themselves.
TEST(PlanChecks, SayThatTheGridIsFromTheOutline) {
  const Tunnel tunnel{.bone = BoneKind::Femur};
  auto geometry = inside(35, 5);
  geometry.entry_on_surface_mm = {3, -2.84, -7.14};
  PlanSurroundings known = with_quadrant();
  known.landmarks = {{"blumensaat_anterior", {0, 0, 0}}, {"blumensaat_posterior", {0, 10, 0}}};
  EXPECT_EQ(named(check_plan(tunnel, geometry, known), "High to low").text, "35.7 %; grid from the outline");
  for (const char* end : {"deep", "shallow", "low"})
    known.landmarks["lateral_condyle_" + std::string(end)] = {0, 0, 0};
  EXPECT_EQ(named(check_plan(tunnel, geometry, known), "High to low").text, "35.7 %");
}

// Every number to compare with says where it comes from, and norms can be changed.
TEST(PlanChecks, NameTheirSourcesAndFollowChangedNorms) {
  const Tunnel tunnel{.bone = BoneKind::Femur};
  for (const auto& check : check_plan(tunnel, inside(35, 5), with_quadrant()))
    EXPECT_TRUE(!check.source.empty() || check.verdict == Verdict::NotChecked) << check.name;
  PlanNorms strict;
  strict.short_femoral_tunnel_mm = 36;
  EXPECT_EQ(named(check_plan(tunnel, inside(35, 5), {}, strict), "Length").verdict, Verdict::Look);
}

// Howell's angle, seen from the front.
TEST(PlanChecks, JudgesTheTibiasCoronalAngle) {
  const auto scanner = landmarks::scanner_axes(bones::Side::Right);
  EXPECT_NEAR(coronal_angle_deg({0, 0, -1}, scanner), 90, 1e-12);
  EXPECT_NEAR(coronal_angle_deg({1, 5, -1}, scanner), 45, 1e-12);
  PlanSurroundings known;
  known.axes = scanner;
  Tunnel tunnel{.bone = BoneKind::Tibia, .direction = Eigen::Vector3d(0.41, -0.3, -1).normalized()};
  EXPECT_EQ(named(check_plan(tunnel, inside(40, 5), known), "Coronal angle").verdict, Verdict::Fine);
  tunnel.direction = Eigen::Vector3d(0.2, -0.3, -1).normalized();
  EXPECT_EQ(named(check_plan(tunnel, inside(40, 5), known), "Coronal angle").verdict, Verdict::Look);
}

// The angle is the bone's: a patient who lies turned by 30 deg in the scanner has the same tunnel and the
// same angle.
TEST(PlanChecks, TakesTheCoronalAngleInTheBonesOwnAxes) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.5, Eigen::Vector3d(0.3, 0.8, 0.5).normalized()).matrix();
  auto axes = landmarks::scanner_axes(bones::Side::Right);
  const Eigen::Vector3d direction = Eigen::Vector3d(0.41, -0.3, -1).normalized();
  const double straight = coronal_angle_deg(direction, axes);
  axes.anterior = turn * axes.anterior;
  axes.proximal = turn * axes.proximal;
  axes.lateral = turn * axes.lateral;
  EXPECT_NEAR(coronal_angle_deg(turn * direction, axes), straight, 1e-9);
  const auto check = named(check_plan({.bone = BoneKind::Tibia}, inside(40, 5), {}), "Coronal angle");
  EXPECT_EQ(check.verdict, Verdict::NotChecked);
}

// A tunnel beside the bone has one message and no numbers.
TEST(PlanChecks, SayOnlyThatItMisses) {
  const auto checks = check_plan({}, {}, with_quadrant());
  ASSERT_EQ(checks.size(), 1U);
  EXPECT_EQ(checks[0].verdict, Verdict::Wrong);
}

// A tunnel of one bundle is held against what studies found of that bundle: the middle of AM is no place for
// PL.
TEST(PlanChecks, ABundleIsHeldAgainstItsOwnNorm) {
  auto geometry = inside(35, 5);
  geometry.entry_on_surface_mm = {3, -2.42, -4.32};  // 24.2 and 21.6 %
  const Tunnel am{.bone = BoneKind::Femur, .diameter_mm = 6, .bundle = norms::Bundle::Anteromedial};
  const Tunnel pl{.bone = BoneKind::Femur, .diameter_mm = 6, .bundle = norms::Bundle::Posterolateral};
  const Tunnel whole{.bone = BoneKind::Femur, .diameter_mm = 6};
  const auto of_am = check_plan(am, geometry, with_quadrant());
  EXPECT_EQ(named(of_am, "High to low").verdict, Verdict::Fine);
  EXPECT_THAT(named(of_am, "High to low").source, ::testing::HasSubstr("AM: "));
  EXPECT_EQ(named(check_plan(pl, geometry, with_quadrant()), "High to low").verdict, Verdict::Look);
  EXPECT_EQ(named(check_plan(whole, geometry, with_quadrant()), "High to low").verdict, Verdict::Look);
  // 6 mm is small for the whole ligament; of a bundle nobody has said.
  EXPECT_EQ(named(of_am, "Diameter").verdict, Verdict::Note);
  EXPECT_EQ(named(check_plan(whole, geometry, {}), "Diameter").verdict, Verdict::Look);
}

TEST(TunnelKey, NamesTheTunnelAndNeverOneOfTwo) {
  EXPECT_EQ(name_of(BoneKind::Tibia), "tibia");
  EXPECT_EQ(name_of({BoneKind::Femur, norms::Bundle::Anteromedial}), "femur AM");
  EXPECT_EQ(name_of({BoneKind::Tibia, norms::Bundle::Posterolateral}), "tibia PL");
  EXPECT_NE(TunnelKey(BoneKind::Femur), TunnelKey(BoneKind::Femur, norms::Bundle::Anteromedial));
}

}  // namespace
}  // namespace arthronaut::tunnels
