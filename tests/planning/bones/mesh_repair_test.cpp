#include "planning/bones/mesh_repair.h"

#include <gtest/gtest.h>

#include <random>

#include "planning/geometry/error.h"
#include "planning/geometry/surface.h"
#include "tests/planning/geometry/shapes.h"

namespace arthronaut::bones {
namespace {

using geometry::TriangleMesh;

const Eigen::Vector3d kRadii(40, 30, 25);

TriangleMesh bone() { return test::ellipsoid(kRadii, 3); }

void append(TriangleMesh& mesh, const TriangleMesh& other) {
  const auto base = static_cast<std::int32_t>(mesh.vertices_mm.size());
  mesh.vertices_mm.insert(mesh.vertices_mm.end(), other.vertices_mm.begin(), other.vertices_mm.end());
  for (const auto& t : other.triangles) mesh.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
}

void expect_the_bone(const MeshRepair& repair) {
  EXPECT_TRUE(repair.report.is_closed);
  EXPECT_EQ(repair.mesh.triangles.size(), bone().triangles.size());
  EXPECT_EQ(repair.mesh.vertices_mm.size(), bone().vertices_mm.size());
  EXPECT_NEAR(geometry::signed_volume_mm3(repair.mesh), geometry::signed_volume_mm3(bone()), 1e-3);
  EXPECT_NEAR(repair.report.volume_mm3, geometry::signed_volume_mm3(bone()), 1e-3);
}

TEST(MeshRepair, AFineMeshIsLeftAlone) {
  const MeshRepair repair = mend_mesh(bone());
  expect_the_bone(repair);
  EXPECT_TRUE(repair.report.lines().empty());
  EXPECT_TRUE(repair.report.doubts().empty());
  EXPECT_EQ(repair.mesh.vertices_mm, bone().vertices_mm);
}

TEST(MeshRepair, ASoupIsJoined) {
  TriangleMesh soup;
  for (const auto& t : bone().triangles) {
    const auto base = static_cast<std::int32_t>(soup.vertices_mm.size());
    for (const auto v : t) soup.vertices_mm.push_back(bone().vertices_mm[v]);
    soup.triangles.push_back({base, base + 1, base + 2});
  }
  const MeshRepair repair = mend_mesh(soup);
  expect_the_bone(repair);
  EXPECT_EQ(repair.report.vertices_merged, soup.vertices_mm.size() - bone().vertices_mm.size());
}

TEST(MeshRepair, InsideOutIsTurned) {
  TriangleMesh mesh = bone();
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  const MeshRepair repair = mend_mesh(mesh);
  expect_the_bone(repair);
  EXPECT_TRUE(repair.report.was_inside_out);
}

TEST(MeshRepair, TrianglesThatLookInwardsAreTurnedAndCounted) {
  TriangleMesh mesh = bone();
  for (std::size_t t = 5; t < mesh.triangles.size(); t += 50)
    std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  const MeshRepair repair = mend_mesh(mesh);
  expect_the_bone(repair);
  EXPECT_EQ(repair.report.triangles_flipped, (mesh.triangles.size() - 5 + 49) / 50);
  EXPECT_FALSE(repair.report.was_inside_out);
}

TEST(MeshRepair, TheLargestPartIsKept) {
  TriangleMesh mesh =
      test::ellipsoid({5, 5, 5}, 4, {80, 0, 0});  // more triangles than the bone, and less surface
  append(mesh, bone());
  const MeshRepair repair = mend_mesh(mesh);
  expect_the_bone(repair);
  EXPECT_EQ(repair.report.parts_found, 2U);
  EXPECT_EQ(repair.report.triangles_of_other_parts, 5120U);
  EXPECT_FALSE(repair.report.doubts().empty());  // that many triangles of something else deserve a look
}

TEST(MeshRepair, SmallHolesAreFilled) {
  TriangleMesh mesh = bone();
  mesh.triangles.erase(mesh.triangles.begin() + 100);
  mesh.triangles.erase(mesh.triangles.begin() + 700, mesh.triangles.begin() + 704);
  const MeshRepair repair = mend_mesh(mesh);
  EXPECT_TRUE(repair.report.is_closed);
  EXPECT_GE(repair.report.holes_filled, 2U);
  EXPECT_NEAR(repair.report.volume_mm3, geometry::signed_volume_mm3(bone()), 0.01 * repair.report.volume_mm3);
  EXPECT_TRUE(repair.report.doubts().empty());
}

// The cut end of a shaft: the cap must be flat, at the cut.
TEST(MeshRepair, ACutShaftGetsAFlatCap) {
  TriangleMesh mesh = test::ellipsoid({40, 30, 25}, 5);
  std::erase_if(mesh.triangles, [&](const auto& t) {
    return mesh.vertices_mm[t[0]].x() > 20 || mesh.vertices_mm[t[1]].x() > 20 ||
           mesh.vertices_mm[t[2]].x() > 20;
  });
  const MeshRepair repair = mend_mesh(mesh);
  EXPECT_TRUE(repair.report.is_closed);
  EXPECT_EQ(repair.report.holes_filled, 1U);
  EXPECT_GT(repair.report.vertices_unused, 0U);
  const geometry::Surface surface(repair.mesh);
  EXPECT_LT(surface.signed_distance_mm({15, 0, 0}), 0);
  EXPECT_GT(surface.signed_distance_mm({22, 0, 0}), 0);
  const double filled = repair.report.filled_area_fraction * geometry::surface_area_mm2(repair.mesh);
  // An ellipse of half axes 30 and 25 times sqrt(1 - 1/4).
  EXPECT_NEAR(filled, geometry::kPi * 30 * 25 * 0.75, 0.05 * filled);
}

// A sheet has no inside: it is closed somehow, and the doubt is said.
TEST(MeshRepair, AnOpenSheetRaisesADoubt) {
  TriangleMesh mesh = bone();
  std::erase_if(mesh.triangles, [&](const auto& t) { return mesh.vertices_mm[t[0]].z() < 5; });
  const MeshRepair repair = mend_mesh(mesh);
  EXPECT_FALSE(repair.report.doubts().empty());
}

// A triangle that stands on an edge like a fin, as segmentation leaves them.
TEST(MeshRepair, AFinIsCutOff) {
  TriangleMesh mesh = bone();
  const auto& t = mesh.triangles[200];
  mesh.vertices_mm.push_back(1.2 * mesh.vertices_mm[t[0]]);
  mesh.triangles.push_back({t[0], t[1], static_cast<std::int32_t>(mesh.vertices_mm.size()) - 1});
  const MeshRepair repair = mend_mesh(mesh);
  EXPECT_EQ(repair.report.edges_not_manifold, 1U);
  expect_the_bone(repair);
}

// A point in the middle of an edge that one neighbour uses and the other does not, with a flat triangle in
// between.
TEST(MeshRepair, TrianglesWithoutAnAreaGo) {
  TriangleMesh mesh = test::box({32, 16, 8});
  mesh.triangles.push_back({0, 0, 1});  // a line
  mesh.triangles.push_back(mesh.triangles[4]);
  const auto [a, b, c] = mesh.triangles[0];
  mesh.vertices_mm.push_back((mesh.vertices_mm[a] + mesh.vertices_mm[b]) / 2);
  mesh.triangles[0] = {a, 8, c};
  mesh.triangles.push_back({8, b, c});
  mesh.triangles.push_back({b, 8, a});
  const MeshRepair repair = mend_mesh(mesh);
  EXPECT_TRUE(repair.report.is_closed);
  EXPECT_EQ(repair.report.triangles_degenerate, 2U);
  EXPECT_EQ(repair.report.triangles_duplicate, 1U);
  EXPECT_NEAR(repair.report.volume_mm3, 64.0 * 32 * 16, 1e-6);
  for (const auto& t : repair.mesh.triangles) {
    const auto& p = repair.mesh.vertices_mm;
    EXPECT_GT((p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]).norm(), 1.0);
  }
}

TEST(MeshRepair, RefusesWhatIsNoMesh) {
  EXPECT_THROW((void)mend_mesh({}), InvalidInput);
  TriangleMesh bad = bone();
  bad.triangles[0][0] = -1;
  EXPECT_THROW((void)mend_mesh(bad), InvalidInput);
  bad = bone();
  bad.vertices_mm[0].x() = std::numeric_limits<double>::infinity();
  EXPECT_THROW((void)mend_mesh(bad), InvalidInput);
}

// Triangles at random among the points: nothing to be proud of, but never a crash, and closed when it says
// so.
TEST(MeshRepair, NonsenseIsSurvived) {
  std::mt19937 random(11);
  for (int round = 0; round < 30; ++round) {
    TriangleMesh mesh = test::ellipsoid(kRadii, 1);
    std::uniform_int_distribution<std::int32_t> vertex(
        0, static_cast<std::int32_t>(mesh.vertices_mm.size()) - 1);
    for (int i = 0; i < 1 + round; ++i) {
      mesh.triangles[static_cast<std::size_t>(vertex(random))] = {vertex(random), vertex(random),
                                                                  vertex(random)};
    }
    try {
      const MeshRepair repair = mend_mesh(mesh);
      EXPECT_EQ(repair.report.triangles_now, repair.mesh.triangles.size());
      EXPECT_TRUE(!repair.report.is_closed || geometry::signed_volume_mm3(repair.mesh) >= 0);
    } catch (const InvalidInput&) {
    }
  }
}

}  // namespace
}  // namespace arthronaut::bones
