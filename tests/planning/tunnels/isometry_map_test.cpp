#include "planning/tunnels/isometry_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "planning/geometry/error.h"
#include "planning/phantom/phantom_case.h"
#include "planning/phantom/phantom_knee.h"
#include "planning/tunnels/knee_checks.h"

namespace arthronaut::tunnels {
namespace {

using bones::BoneKind;
using Eigen::Vector3d;

// A hinge along x through the origin; the tibia's end hangs 30 mm below it.
const graft::FlexionAxis kHinge{};
const Vector3d kTibial_mm{0, 0, -30};

// The tibia's end runs on a circle of 30 mm from straight below backwards: by the law of cosines.
TEST(LengthChange, IsTheHinges) {
  const LengthChange on_axis = length_change({12, 0, 0}, kTibial_mm, kHinge);
  EXPECT_NEAR(on_axis.change_mm, 0, 1e-9);
  // 6 mm in front of the hinge: nearest in extension, furthest straight behind.
  const LengthChange in_front = length_change({0, -6, 0}, kTibial_mm, kHinge);
  EXPECT_NEAR(in_front.change_mm, 36 - std::sqrt(6 * 6 + 30 * 30), 1e-9);
  EXPECT_NEAR(in_front.longest_at_deg, 90, 1e-9);
  EXPECT_EQ(to_text(in_front), "5.4 mm from 0 to 120 deg, longest at 90.0 deg");
  // 6 mm behind it: the other way round.
  const LengthChange behind = length_change({0, 6, 0}, kTibial_mm, kHinge);
  EXPECT_NEAR(behind.change_mm, std::sqrt(6 * 6 + 30 * 30) - 24, 1e-9);
  EXPECT_NEAR(behind.longest_at_deg, 0, 1e-9);
}

double area_of_bands(const IsometryMap& map) {
  double area_mm2 = 0;
  for (const IsometryBand& band : map.bands) area_mm2 += geometry::surface_area_mm2(band.mesh);
  return area_mm2;
}

// A strip from 6 mm behind the hinge to 6 mm in front of it: what lies in a step has a change within it, the
// steps leave nothing of the strip out, and each line but the lowest has a place on it.
TEST(IsometryMap, CutsTheWallAtItsSteps) {
  geometry::TriangleMesh strip;
  for (int i = -12; i <= 12; ++i) {
    strip.vertices_mm.emplace_back(0, 0.5 * i, 0);
    strip.vertices_mm.emplace_back(1, 0.5 * i, 0);
    if (i == 12) break;
    const std::int32_t at = 2 * (i + 12);
    strip.triangles.push_back({at, at + 1, at + 2});
    strip.triangles.push_back({at + 1, at + 3, at + 2});
  }
  const IsometryMap map = isometry_map(strip, kTibial_mm, kHinge);
  EXPECT_NEAR(map.least_mm, 0, 1e-9);
  EXPECT_NEAR(map.greatest_mm, length_change({0, 6, 0}, kTibial_mm, kHinge).change_mm, 0.05);
  ASSERT_EQ(map.bands.size(), 4U);  // up to 6.6 mm
  EXPECT_NEAR(area_of_bands(map), 12, 1e-6);
  EXPECT_FALSE(map.bands[0].line_at_mm);
  for (const IsometryBand& band : map.bands) {
    EXPECT_NEAR(band.to_mm - band.from_mm, 2, 1e-12);
    for (const Vector3d& at : band.mesh.vertices_mm) {
      const double change_mm = length_change(at, kTibial_mm, kHinge).change_mm;
      EXPECT_GT(change_mm, band.from_mm - 0.01);
      EXPECT_LT(change_mm, band.to_mm + 0.01);
    }
    if (&band == &map.bands.front()) continue;
    ASSERT_TRUE(band.line_at_mm);
    EXPECT_NEAR(length_change(*band.line_at_mm, kTibial_mm, kHinge).change_mm, band.from_mm, 0.01);
  }
  EXPECT_TRUE(isometry_map({}, kTibial_mm, kHinge).bands.empty());
  EXPECT_THROW((void)isometry_map(strip, kTibial_mm, kHinge, {.step_mm = 0}), InvalidInput);
  // What changes by 4 mm and more, as one.
  const IsometryMap coarse = isometry_map(strip, kTibial_mm, kHinge, {.step_mm = 2, .one_from_mm = 4});
  ASSERT_EQ(coarse.bands.size(), 3U);
  EXPECT_TRUE(std::isinf(coarse.bands.back().to_mm));
  EXPECT_NEAR(area_of_bands(coarse), 12, 1e-6);
}

// Of triangles that share corners.
int pieces_of(const geometry::TriangleMesh& mesh) {
  std::vector<std::size_t> piece(mesh.vertices_mm.size());
  for (std::size_t i = 0; i < piece.size(); ++i) piece[i] = i;
  for (bool has_changed = true; has_changed;) {
    has_changed = false;
    for (const auto& triangle : mesh.triangles) {
      const auto of = [&](std::size_t k) -> std::size_t& {
        return piece[static_cast<std::size_t>(triangle[k])];
      };
      const std::size_t least = std::min({of(0), of(1), of(2)});
      for (std::size_t k = 0; k < 3; ++k) has_changed |= of(k) != least, of(k) = least;
    }
  }
  return static_cast<int>(std::set<std::size_t>(piece.begin(), piece.end()).size());
}

class IsometryOfKnee : public ::testing::Test {
 protected:
  cases::Case knee_ = phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 3}), "test");
  std::shared_ptr<const geometry::Surface> femur_ =
      std::make_shared<const geometry::Surface>(knee_.bones.at(BoneKind::Femur).mesh);
  PlanSurroundings of_femur_ = surroundings_of(knee_.bones.at(BoneKind::Femur).mesh, BoneKind::Femur,
                                               knee_.landmarks.at(BoneKind::Femur), knee_.side, femur_);
};

// The wall is what the check of the entry's place calls so, all of it on the lateral side of the notch.
TEST_F(IsometryOfKnee, TakesTheLateralWallAlone) {
  const geometry::TriangleMesh wall = lateral_wall(*femur_, *of_femur_.axes, of_femur_.extents);
  EXPECT_GT(geometry::surface_area_mm2(wall), 200);
  EXPECT_LT(geometry::surface_area_mm2(wall), 1500);
  const BoneExtents& extents = of_femur_.extents;
  const double middle_mm = 0.5 * (extents.medial_mm + extents.lateral_mm);
  for (const Vector3d& at : wall.vertices_mm) {
    EXPECT_GT(at.dot(of_femur_.axes->lateral), middle_mm);
    EXPECT_LT(femur_->closest_point(at).normal.dot(of_femur_.axes->lateral), 0);
  }
  EXPECT_TRUE(lateral_wall(*femur_, *of_femur_.axes, of_femur_.extents, [] { return true; }).empty());
  EXPECT_EQ(pieces_of(wall), 1);
}

// The lateral flank of the groove in front of the notch faces medially and has the medial flank across, but
// it is no wall of the notch: straight behind the gap between the two there is bone.
TEST_F(IsometryOfKnee, LeavesOutTheGroove) {
  const landmarks::AnatomicalAxes& axes = *of_femur_.axes;
  const geometry::TriangleMesh wall = lateral_wall(*femur_, axes, of_femur_.extents);
  const BoneExtents& extents = of_femur_.extents;
  for (const Vector3d& at : wall.vertices_mm) {
    const auto across = femur_->first_hit(at - 1.0 * axes.lateral, -axes.lateral);
    ASSERT_TRUE(across);
    const Vector3d middle = 0.5 * (at + across->point_mm);
    const auto behind = femur_->first_hit(middle, -axes.anterior);
    EXPECT_FALSE(behind && behind->distance_mm < extents.anterior_mm - extents.posterior_mm - 2)
        << at.transpose();
  }
}

// The map says of a place what the check says of a plan whose femoral tunnel begins there: the same number,
// the same angle, the same words; and the step that the place is drawn in holds it.
TEST_F(IsometryOfKnee, SaysOfAPlaceWhatTheCheckSaysOfATunnelThere) {
  const geometry::TriangleMesh& tibia = knee_.bones.at(BoneKind::Tibia).mesh;
  KneeSurroundings knee;
  put_femur(knee, knee_.bones.at(BoneKind::Femur).mesh, of_femur_);
  put_tibia(knee, surroundings_of(tibia, BoneKind::Tibia, knee_.landmarks.at(BoneKind::Tibia), knee_.side));
  ASSERT_TRUE(knee.axis);
  const Tunnel tibial = knee_.plan.tunnels.at(BoneKind::Tibia);
  const TunnelGeometry in_tibia = measure(tibial, geometry::Surface(tibia));
  ASSERT_TRUE(in_tibia.enters_bone);
  const geometry::TriangleMesh wall = lateral_wall(*femur_, *of_femur_.axes, of_femur_.extents);
  const IsometryMap map = isometry_map(wall, in_tibia.entry_on_surface_mm, *knee.axis);
  ASSERT_GT(map.bands.size(), 2U);
  EXPECT_NEAR(area_of_bands(map), geometry::surface_area_mm2(wall), 1e-6);
  int asked = 0;
  for (const IsometryBand& band : map.bands) {
    for (std::size_t i = 0; i < band.mesh.triangles.size(); i += 97) {
      Vector3d at = Vector3d::Zero();
      for (const std::int32_t corner : band.mesh.triangles[i])
        at += band.mesh.vertices_mm[static_cast<std::size_t>(corner)] / 3;
      Tunnel femoral = knee_.plan.tunnels.at(BoneKind::Femur);
      femoral.entry_mm = at;
      const TunnelGeometry in_femur = measure(femoral, *femur_);
      if (!in_femur.enters_bone || (in_femur.entry_on_surface_mm - at).norm() > 0.01) continue;
      const auto checks = check_knee(BoneKind::Femur, {&femoral, &in_femur, &tibial, &in_tibia}, knee);
      const auto check = std::ranges::find(checks, "Length over flexion", &PlanCheck::name);
      ASSERT_NE(check, checks.end());
      const LengthChange here = length_change(at, in_tibia.entry_on_surface_mm, *knee.axis);
      EXPECT_NEAR(here.change_mm, *check->value, 0.01);
      EXPECT_TRUE(check->text.starts_with(
          to_text(length_change(in_femur.entry_on_surface_mm, in_tibia.entry_on_surface_mm, *knee.axis))))
          << check->text;
      EXPECT_GT(*check->value, band.from_mm - 0.1);
      EXPECT_LT(*check->value, band.to_mm + 0.1);
      ++asked;
    }
  }
  EXPECT_GT(asked, 20);
}

}  // namespace
}  // namespace arthronaut::tunnels
