#include "planning/landmarks/anatomical_axes.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <random>
#include <tuple>
#include <vector>

namespace arthronaut::landmarks {
namespace {

using Eigen::Vector3d;
using Origin = AnatomicalAxes::Origin;

// A right knee that lies turned in the scanner.
const Eigen::Matrix3d kTurn = Eigen::AngleAxisd(0.4, Vector3d(1, -2, 0.5).normalized()).matrix();

Landmarks femur_landmarks(const Eigen::Matrix3d& turn) {
  return {{"medial_epicondyle", turn * Vector3d(40, 0, 0)},
          {"lateral_epicondyle", turn * Vector3d(-40, 0, 0)},
          {"medial_condyle_posterior", turn * Vector3d(25, 30, 0)},
          {"lateral_condyle_posterior", turn * Vector3d(-25, 30, 0)}};
}

// A box of these half edges about the origin.
geometry::TriangleMesh box(const Vector3d& half_mm, const Eigen::Matrix3d& turn) {
  geometry::TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices_mm.push_back(turn * Vector3d((i & 1) ? half_mm.x() : -half_mm.x(),
                                               (i & 2) ? half_mm.y() : -half_mm.y(),
                                               (i & 4) ? half_mm.z() : -half_mm.z()));
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

void expect_axes(const AnatomicalAxes& axes, const Vector3d& anterior, const Vector3d& proximal,
                 const Vector3d& lateral) {
  EXPECT_LT((axes.anterior - anterior).norm(), 1e-9);
  EXPECT_LT((axes.proximal - proximal).norm(), 1e-9);
  EXPECT_LT((axes.lateral - lateral).norm(), 1e-9);
}

// Each of these triangles in four, `times` over.
void refine(geometry::TriangleMesh& mesh, const std::vector<std::size_t>& triangles, int times) {
  std::vector<std::array<int, 3>> coarse;
  for (const std::size_t i : triangles) coarse.push_back(mesh.triangles[i]);
  for (std::size_t n = triangles.size(); n-- > 0;)
    mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(triangles[n]));
  for (; times > 0; --times) {
    std::vector<std::array<int, 3>> fine;
    for (const auto& t : coarse) {
      std::array<int, 3> middles{};
      for (std::size_t k = 0; k < 3; ++k) {
        middles[k] = static_cast<int>(mesh.vertices_mm.size());
        mesh.vertices_mm.push_back(0.5 * (mesh.vertices_mm[static_cast<std::size_t>(t[k])] +
                                          mesh.vertices_mm[static_cast<std::size_t>(t[(k + 1) % 3])]));
      }
      fine.push_back({t[0], middles[0], middles[2]});
      fine.push_back({t[1], middles[1], middles[0]});
      fine.push_back({t[2], middles[2], middles[1]});
      fine.push_back(middles);
    }
    coarse = fine;
  }
  mesh.triangles.insert(mesh.triangles.end(), coarse.begin(), coarse.end());
}

// A short stump, the most of it above the joint: neither its end nor its cut face outweighs the rest by being
// made of more triangles.
TEST(AnatomicalAxes, DoNotHangOnHowFinelyAPartIsTriangulated) {
  const std::vector<std::size_t> below{0, 1}, above{2, 3};
  for (const auto& [face, lowest_mm, upright] :
       {std::tuple{below, -20.0, true}, std::tuple{above, -26.0, false}}) {
    for (const int times : {0, 4}) {
      geometry::TriangleMesh stump = box({40, 30, 23}, Eigen::Matrix3d::Identity());
      for (Vector3d& v : stump.vertices_mm) v.z() += 23 + lowest_mm;
      refine(stump, face, times);
      const auto axes = anatomical_axes(bones::BoneKind::Femur, bones::Side::Right,
                                        femur_landmarks(Eigen::Matrix3d::Identity()), stump);
      EXPECT_EQ(axes.origin == Origin::FromLandmarks, upright) << lowest_mm << ", " << times;
    }
  }
}

// The bone's own landmarks are followed wherever the patient lies.
TEST(AnatomicalAxes, Hazard31FollowTheBonesLandmarks) {
  const AnatomicalAxes axes =
      anatomical_axes(bones::BoneKind::Femur, bones::Side::Right, femur_landmarks(kTurn), {});
  EXPECT_EQ(axes.origin, Origin::FromLandmarks);
  expect_axes(axes, kTurn * -Vector3d::UnitY(), kTurn * Vector3d::UnitZ(), kTurn * -Vector3d::UnitX());
  const Landmarks tibia = {{"plateau_medial", Vector3d(-38, 0, 0)},
                           {"plateau_lateral", Vector3d(38, 0, 0)},
                           {"plateau_anterior", Vector3d(0, -25, 1)},
                           {"plateau_posterior", Vector3d(0, 25, -1)}};
  const AnatomicalAxes left = anatomical_axes(bones::BoneKind::Tibia, bones::Side::Left, tibia, {});
  EXPECT_EQ(left.origin, Origin::FromLandmarks);
  EXPECT_LT((left.lateral - Vector3d::UnitX()).norm(), 1e-9);
  EXPECT_GT(left.proximal.z(), 0.99);
  EXPECT_LT(left.anterior.y(), -0.99);
}

// Without landmarks a long bone's shaft is proximal; a stump has none, and then the scanner's axes are said
// to be the scanner's.
TEST(AnatomicalAxes, Hazard31FallBackToTheShaftAndThenToTheScanner) {
  const AnatomicalAxes shaft =
      anatomical_axes(bones::BoneKind::Femur, bones::Side::Right, {}, box({30, 28, 90}, kTurn));
  EXPECT_EQ(shaft.origin, Origin::FromShaft);
  EXPECT_LT((shaft.proximal - kTurn * Vector3d::UnitZ()).norm(), 1e-9);
  EXPECT_NEAR(shaft.lateral.dot(shaft.proximal), 0, 1e-12);
  for (const auto& mesh : {box({40, 30, 42}, kTurn), geometry::TriangleMesh()}) {
    const AnatomicalAxes scanner = anatomical_axes(bones::BoneKind::Femur, bones::Side::Left, {}, mesh);
    EXPECT_EQ(scanner.origin, Origin::FromScanner);
    expect_axes(scanner, -Vector3d::UnitY(), Vector3d::UnitZ(), Vector3d::UnitX());
  }
  EXPECT_EQ(to_text(Origin::FromScanner), "the scanner's axes");
}

// Medial and lateral mixed up would mirror every word: such landmarks are not believed.
TEST(AnatomicalAxes, Hazard31DoNotBelieveMixedUpLandmarks) {
  Landmarks mixed = femur_landmarks(Eigen::Matrix3d::Identity());
  std::swap(mixed["medial_epicondyle"], mixed["lateral_epicondyle"]);
  const AnatomicalAxes axes = anatomical_axes(bones::BoneKind::Femur, bones::Side::Right, mixed, {});
  EXPECT_EQ(axes.origin, Origin::FromScanner);
}

// The landmarks of the shaft are right whichever side is which: they must not vouch for the joint's.
TEST(AnatomicalAxes, Hazard31TheShaftDoesNotVouchForMixedUpLandmarks) {
  Landmarks mixed = femur_landmarks(kTurn);
  mixed["shaft_distal"] = kTurn * Vector3d(0, 0, 60);
  mixed["shaft_proximal"] = kTurn * Vector3d(0, 0, 150);
  geometry::TriangleMesh femur = box({30, 28, 90}, kTurn);
  for (Vector3d& vertex : femur.vertices_mm) vertex += kTurn * Vector3d(0, 0, 80);
  const auto axes_of = [&](const Landmarks& landmarks) {
    return anatomical_axes(bones::BoneKind::Femur, bones::Side::Right, landmarks, femur);
  };
  EXPECT_EQ(axes_of(mixed).origin, Origin::FromLandmarks);
  for (const char* part : {"epicondyle", "condyle_posterior"})
    std::swap(mixed[std::string("medial_") + part], mixed[std::string("lateral_") + part]);
  const AnatomicalAxes axes = axes_of(mixed);
  EXPECT_EQ(axes.origin, Origin::FromShaft);
  EXPECT_GT(axes.lateral.dot(kTurn * -Vector3d::UnitX()), 0.5);
  EXPECT_GT(axes.anterior.dot(kTurn * -Vector3d::UnitY()), 0.5);
}

// For lines that run anyhow: two unit vectors at right angles across it, each within 55 degrees of what it is
// named after (the worst is a line that runs amid all three axes).
TEST(AnatomicalAxes, Hazard31TwoDirectionsAcrossALineAreNamedByTheNearest) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  const AnatomicalAxes axes = scanner_axes(bones::Side::Left);
  const auto axis_of = [&](AnatomicalDirection direction) {
    return direction == AnatomicalDirection::Anterior   ? axes.anterior
           : direction == AnatomicalDirection::Proximal ? axes.proximal
                                                        : axes.lateral;
  };
  for (int i = 0; i < 500; ++i) {
    const Vector3d line = Vector3d(normal(random), normal(random), normal(random)).normalized();
    const PlaneAxes plane = axes_across(axes, line);
    EXPECT_NEAR(plane.up.norm(), 1, 1e-12);
    EXPECT_NEAR(plane.side.norm(), 1, 1e-12);
    EXPECT_NEAR(plane.up.dot(line), 0, 1e-12);
    EXPECT_NEAR(plane.side.dot(line), 0, 1e-12);
    EXPECT_NEAR(plane.side.dot(plane.up), 0, 1e-12);
    EXPECT_NE(plane.up_is, plane.side_is);
    EXPECT_GT(plane.up.dot(axis_of(plane.up_is)), std::cos(0.97));
    EXPECT_GT(plane.side.dot(axis_of(plane.side_is)), std::cos(0.97));
  }
  // A femoral tunnel runs to the side: proximal and anterior. A tibial one runs down: anterior and lateral.
  EXPECT_EQ(axes_across(axes, Vector3d(0.8, -0.1, 0.59).normalized()).side_is, AnatomicalDirection::Anterior);
  const PlaneAxes tibial = axes_across(axes, Vector3d(-0.4, -0.4, -0.8).normalized());
  EXPECT_EQ(tibial.up_is, AnatomicalDirection::Anterior);
  EXPECT_EQ(tibial.side_is, AnatomicalDirection::Lateral);
}

}  // namespace
}  // namespace arthronaut::landmarks
