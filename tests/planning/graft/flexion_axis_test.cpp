#include "planning/graft/flexion_axis.h"

#include <gtest/gtest.h>

#include "tests/planning/geometry/shapes.h"

namespace arthronaut::graft {
namespace {

using bones::Side;
using Eigen::Vector3d;

// Two balls of 20 mm, 44 mm apart, as posterior condyles.
geometry::TriangleMesh balls() {
  auto mesh = test::ellipsoid({20, 20, 20}, 4, {-22, 3, -4});
  const auto other = test::ellipsoid({20, 20, 20}, 4, {22, 3, -4});
  const auto first = static_cast<std::int32_t>(mesh.vertices_mm.size());
  mesh.vertices_mm.insert(mesh.vertices_mm.end(), other.vertices_mm.begin(), other.vertices_mm.end());
  for (const auto& t : other.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return mesh;
}

// Spheres through the back of either condyle have its centre, of which only the most posterior points are
// known. The facets of the balls lie up to 0.1 mm inside of them.
TEST(FlexionAxis, RunsThroughTheCentresOfThePosteriorCondyles) {
  for (const Side side : {Side::Right, Side::Left}) {
    const double lateral = side == Side::Right ? -22 : 22;
    const landmarks::Landmarks marks{{"lateral_condyle_posterior", {lateral, 23, -4}},
                                     {"medial_condyle_posterior", {-lateral, 23, -4}},
                                     {"lateral_epicondyle", {2 * lateral, -5, 9}},
                                     {"medial_epicondyle", {-2 * lateral, 5, 9}}};
    const auto axis = flexion_axis(marks, balls(), landmarks::scanner_axes(side));
    ASSERT_TRUE(axis);
    EXPECT_EQ(axis->origin, FlexionAxis::Origin::PosteriorCondyles);
    EXPECT_LT((axis->point_mm - Vector3d(0, 3, -4)).norm(), 0.05);
    EXPECT_LT((axis->direction - Vector3d::UnitX()).norm(), 1e-3);
  }
}

// What somebody placed goes before what is fitted; the epicondyles are the last resort; without them there is
// none.
TEST(FlexionAxis, TakesTheBestThatIsThere) {
  landmarks::Landmarks marks{{"lateral_epicondyle", {-40, 0, 0}}, {"medial_epicondyle", {40, 0, 0}}};
  const auto axes = landmarks::scanner_axes(Side::Right);
  EXPECT_EQ(flexion_axis(marks, {}, axes)->origin, FlexionAxis::Origin::Epicondyles);
  marks["lateral_condyle_center"] = {-22, 3, -4};
  marks["medial_condyle_center"] = {22, 3, -4};
  EXPECT_EQ(flexion_axis(marks, {}, axes)->origin, FlexionAxis::Origin::CondyleCenters);
  EXPECT_FALSE(flexion_axis({}, balls(), axes));
  EXPECT_FALSE(
      flexion_axis({{"lateral_epicondyle", {-4, 0, 0}}, {"medial_epicondyle", {4, 0, 0}}}, {}, axes));
}

// Flexion by 90 deg lays the shin backwards, on either side.
TEST(FlexionAxis, FlexesBackwards) {
  for (const Side side : {Side::Right, Side::Left}) {
    const double lateral = side == Side::Right ? -1 : 1;
    const auto axis = flexion_axis(
        {{"lateral_condyle_center", {22 * lateral, 0, 0}}, {"medial_condyle_center", {-22 * lateral, 0, 0}}},
        {}, landmarks::scanner_axes(side));
    ASSERT_TRUE(axis);
    const Vector3d ankle = femur_from_tibia(*axis, geometry::rad_from_deg(90)) * Vector3d(0, 0, -400);
    EXPECT_LT((ankle - Vector3d(0, 400, 0)).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace arthronaut::graft
