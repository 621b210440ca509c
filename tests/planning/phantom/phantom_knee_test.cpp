#include "planning/phantom/phantom_knee.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "planning/geometry/error.h"
#include "planning/geometry/rigid_transform.h"
#include "planning/geometry/surface.h"
#include "planning/landmarks/insertion_grids.h"
#include "planning/phantom/phantom_case.h"
#include "planning/tunnels/plan_checks.h"

namespace arthronaut::phantom {
namespace {

using bones::Side;
using Eigen::Vector3d;

// Coarse: the tests ask about shape, which the sampling does not change.
PhantomKnee make_knee(std::uint64_t seed, Side side = Side::Right) {
  return make_phantom_knee({.side = side, .seed = seed, .edge_length_mm = 2.0});
}

// The same, made once for all tests of a run.
const PhantomKnee& knee_of(std::uint64_t seed, Side side = Side::Right) {
  static std::map<std::pair<std::uint64_t, Side>, PhantomKnee> knees;
  const auto key = std::pair(seed, side);
  if (!knees.contains(key)) knees.emplace(key, make_knee(seed, side));
  return knees.at(key);
}

// Every edge between exactly two triangles that run along it in opposite directions: closed, and oriented one
// way.
bool is_closed_and_oriented(const geometry::TriangleMesh& mesh) {
  std::map<std::pair<std::int32_t, std::int32_t>, int> half_edges;
  for (const auto& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) ++half_edges[{t[i], t[(i + 1) % 3]}];
  }
  return std::all_of(half_edges.begin(), half_edges.end(), [&](const auto& half) {
    const auto other = half_edges.find({half.first.second, half.first.first});
    return half.second == 1 && other != half_edges.end() && other->second == 1;
  });
}

double angle_deg(const Vector3d& a, const Vector3d& b) {
  return geometry::deg_from_rad(geometry::angle_between_rad(a, b));
}

// The simulator and registration take the meshes as they are: a hole or a flipped triangle would be their
// fault then.
TEST(PhantomKnee, MeshesAreClosedOutwardAndWithoutSlivers) {
  for (const std::uint64_t seed : {1, 3}) {
    const auto& knee = knee_of(seed);
    for (const auto* bone : {&knee.femur, &knee.tibia}) {
      EXPECT_TRUE(is_closed_and_oriented(bone->mesh)) << bone->source;
      EXPECT_GT(geometry::signed_volume_mm3(bone->mesh), 5e4);
      for (const auto& t : bone->mesh.triangles) {
        const auto& v = bone->mesh.vertices_mm;
        const Vector3d a = v[static_cast<std::size_t>(t[0])], b = v[static_cast<std::size_t>(t[1])],
                       c = v[static_cast<std::size_t>(t[2])];
        ASSERT_GT((b - a).cross(c - a).norm(), 1e-6);
      }
    }
  }
}

// The same seed is the same knee, bit for bit; another seed is another knee.
TEST(PhantomKnee, FollowsItsSeed) {
  const auto &once = knee_of(3), &other = knee_of(4);
  const auto again = make_knee(3);
  EXPECT_EQ(once.femur.mesh.vertices_mm, again.femur.mesh.vertices_mm);
  EXPECT_EQ(once.tibia.mesh.triangles, again.tibia.mesh.triangles);
  EXPECT_EQ(once.femoral_tunnel.direction, again.femoral_tunnel.direction);
  EXPECT_NE(once.femur.mesh.vertices_mm.size(), other.femur.mesh.vertices_mm.size());
}

// Meshes mirrored by accident are the classic error of the field: the left knee is the mirror image, still
// outward.
TEST(PhantomKnee, LeftIsTheMirrorImageOfRight) {
  const auto &right = knee_of(2), &left = knee_of(2, Side::Left);
  const auto mirrored = [](const Vector3d& p) { return Vector3d(-p.x(), p.y(), p.z()); };
  ASSERT_EQ(left.femur.mesh.vertices_mm.size(), right.femur.mesh.vertices_mm.size());
  for (std::size_t i = 0; i < left.femur.mesh.vertices_mm.size(); ++i) {
    ASSERT_EQ(left.femur.mesh.vertices_mm[i], mirrored(right.femur.mesh.vertices_mm[i]));
  }
  EXPECT_GT(geometry::signed_volume_mm3(left.femur.mesh), 0);
  for (const auto& [name, position] : right.tibia_landmarks) {
    EXPECT_EQ(left.tibia_landmarks.at(name), mirrored(position)) << name;
  }
  EXPECT_EQ(left.femoral_tunnel.direction, mirrored(right.femoral_tunnel.direction));
  EXPECT_EQ(left.tibial_tunnel.entry_mm, mirrored(right.tibial_tunnel.entry_mm));
}

// LPS: a right knee's lateral side is at -x, the front at -y, the femur above the tibia.
TEST(PhantomKnee, StandsInThePatientsAxes) {
  const auto& knee = knee_of(1);
  const auto& femur = knee.femur_landmarks;
  const auto& tibia = knee.tibia_landmarks;
  EXPECT_LT(femur.at("lateral_epicondyle").x(), -30);
  EXPECT_GT(femur.at("medial_epicondyle").x(), 30);
  EXPECT_GT(femur.at("lateral_condyle_posterior").y(), 20);
  EXPECT_LT(tibia.at("tuberosity").y(), -10);
  EXPECT_LT(tibia.at("lateral_eminence").x(), tibia.at("medial_eminence").x());
  EXPECT_LT(femur.at("native_footprint").x(), femur.at("notch_apex").x());
  EXPECT_LT((femur.at("lateral_epicondyle") + femur.at("medial_epicondyle")).norm() / 2, 6.0);
  // Bone meets no bone: the cartilage's gap of 2 to 8 mm is between the lowest of the femur and the plateau
  // below.
  const geometry::Surface tibia_surface(knee.tibia.mesh);
  double gap = 1e9;
  for (const auto& v : knee.femur.mesh.vertices_mm) gap = std::min(gap, tibia_surface.signed_distance_mm(v));
  EXPECT_GT(gap, 0.5);
  EXPECT_LT(gap, 8);
}

// Landmarks are touched by the simulated probe: they must be where the bone is.
TEST(PhantomKnee, LandmarksLieOnTheMesh) {
  for (const std::uint64_t seed : {1, 2}) {
    const auto& knee = knee_of(seed);
    const geometry::Surface femur(knee.femur.mesh), tibia(knee.tibia.mesh);
    for (const auto& [name, p] : knee.femur_landmarks)
      EXPECT_LT(std::abs(femur.signed_distance_mm(p)), 0.05) << name;
    for (const auto& [name, p] : knee.tibia_landmarks)
      EXPECT_LT(std::abs(tibia.signed_distance_mm(p)), 0.05) << name;
    EXPECT_EQ(knee.femur_landmarks.size(), 8U);
    EXPECT_EQ(knee.tibia_landmarks.size(), 8U);
  }
}

// Sizes of adults: epicondylar width 70 to 92 mm, condyles 54 to 72 mm deep, notch 15 to 24 mm wide at the
// footprint, plateau 66 to 86 mm wide; medial condyle the lower; roof 26 to 46 degrees (Howell 1995).
TEST(PhantomKnee, HasTheSizeOfAnAdultKnee) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    const auto& knee = knee_of(seed);
    const auto& femur = knee.femur_landmarks;
    const auto bounds = geometry::bounds_of(knee.femur.mesh);
    const double width = femur.at("medial_epicondyle").x() - femur.at("lateral_epicondyle").x();
    EXPECT_GT(width, 70);
    EXPECT_LT(width, 92);
    EXPECT_GT(bounds.size_mm().y(), 54);
    EXPECT_LT(bounds.size_mm().y(), 72);
    EXPECT_GT(bounds.size_mm().z(), 80);  // shaft to about 90 mm above the joint
    const geometry::Surface surface(knee.femur.mesh);
    const Vector3d wall = femur.at("native_footprint");
    const auto opposite = surface.first_hit(wall + Vector3d(1, 0, 0), Vector3d::UnitX());
    ASSERT_TRUE(opposite);
    EXPECT_GT(opposite->distance_mm + 1, 15);
    EXPECT_LT(opposite->distance_mm + 1, 24);
    const auto plateau = knee.tibia_landmarks;
    const double plateau_width = plateau.at("plateau_medial").x() - plateau.at("plateau_lateral").x();
    EXPECT_GT(plateau_width, 66);
    EXPECT_LT(plateau_width, 86);
    double lateral_low = 1e9, medial_low = 1e9;
    for (const auto& v : knee.femur.mesh.vertices_mm) {
      if (v.x() < 0) lateral_low = std::min(lateral_low, v.z());
      if (v.x() > 0) medial_low = std::min(medial_low, v.z());
    }
    EXPECT_LT(medial_low, lateral_low - 0.3);
    const double roof =
        angle_deg(femur.at("blumensaat_posterior") - femur.at("blumensaat_anterior"), Vector3d::UnitZ());
    EXPECT_GT(roof, 26);
    EXPECT_LT(roof, 46);
  }
}

// The footprints stand where the studies have them, read with the same grids that judge a surgeon's plan; on
// the femur the wall is flat enough that the grid's own plane and the wall agree within half a percent.
TEST(PhantomKnee, FootprintsStandAtThePublishedPercentages) {
  for (const Side side : {Side::Left, Side::Right}) {
    const auto& knee = knee_of(1, side);
    const auto quadrant = landmarks::femoral_quadrant(knee.femur.mesh, knee.femur_landmarks, side);
    ASSERT_TRUE(quadrant);
    const auto femur = quadrant->percent_of(knee.femur_landmarks.at("native_footprint"));
    EXPECT_NEAR(femur.deep_shallow, 28, 0.5);
    EXPECT_NEAR(femur.high_low, 35, 0.5);
    const auto grid = landmarks::tibial_grid(knee.tibia_landmarks);
    ASSERT_TRUE(grid);
    const auto tibia = grid->percent_of(knee.tibia_landmarks.at("native_footprint"));
    EXPECT_NEAR(tibia.anterior_posterior, 41, 0.5);
    EXPECT_NEAR(tibia.medial_lateral, 47, 0.5);
  }
}

// The built-in plan is one that a surgeon would take: through the footprints, long enough, with bone all
// around, out through the lateral femur and the anteromedial tibia.
TEST(PhantomKnee, PlanIsAnatomical) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    const auto& knee = knee_of(seed);
    const auto femur = tunnels::measure(knee.femoral_tunnel, geometry::Surface(knee.femur.mesh));
    ASSERT_TRUE(femur.enters_bone);
    EXPECT_LT((femur.entry_on_surface_mm - knee.femur_landmarks.at("native_footprint")).norm(), 0.05);
    EXPECT_GE(femur.length_mm, 30);
    EXPECT_LE(femur.length_mm, 40);
    EXPECT_GE(femur.wall_mm, 2);
    EXPECT_LT(femur.exit_mm.x(), -25);
    EXPECT_GT(femur.exit_mm.z(), femur.entry_on_surface_mm.z() + 8);
    EXPECT_LT(femur.exit_mm.y(), femur.entry_on_surface_mm.y());
    const auto tibia = tunnels::measure(knee.tibial_tunnel, geometry::Surface(knee.tibia.mesh));
    ASSERT_TRUE(tibia.enters_bone);
    EXPECT_GE(tibia.length_mm, 35);
    EXPECT_LE(tibia.length_mm, 45);
    // Bone all around; the thinnest place is under the flank of the medial eminence, beside the mouth.
    EXPECT_GT(tibia.wall_mm, 0.5);
    EXPECT_GT(tibia.exit_mm.x(), tibia.entry_on_surface_mm.x());
    EXPECT_LT(tibia.exit_mm.y(), tibia.entry_on_surface_mm.y());
    const double to_plateau = 90 - angle_deg(knee.tibial_tunnel.direction, -Vector3d::UnitZ());
    EXPECT_GT(to_plateau, 45);
    EXPECT_LT(to_plateau, 65);
  }
}

// A sampling that would take minutes, or show nothing, is refused.
TEST(PhantomKnee, RefusesSillyEdges) {
  EXPECT_THROW((void)make_phantom_knee({.edge_length_mm = 0.0}), InvalidInput);
  EXPECT_THROW((void)make_phantom_knee({.edge_length_mm = std::nan("")}), InvalidInput);
}

// What the workstation opens by itself: both bones, marks and tunnels, of the right side.
TEST(PhantomCase, HoldsTheWholeKnee) {
  const auto& knee = knee_of(1, Side::Left);
  const auto phantom_case = case_of(knee, "Phantom");
  EXPECT_EQ(phantom_case.side, Side::Left);
  EXPECT_EQ(phantom_case.bones.size(), 2U);
  EXPECT_EQ(phantom_case.landmarks.at(bones::BoneKind::Tibia), knee.tibia_landmarks);
  EXPECT_EQ(phantom_case.plan.tunnels.at(bones::BoneKind::Femur).entry_mm, knee.femoral_tunnel.entry_mm);
}

}  // namespace
}  // namespace arthronaut::phantom
