#include "planning/geometry/surface.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <limits>
#include <random>
#include <thread>

#include "planning/geometry/error.h"
#include "planning/geometry/rigid_transform.h"
#include "tests/planning/geometry/shapes.h"

namespace arthronaut::geometry {
namespace {

using test::box;
using test::ellipsoid;

Eigen::Vector3d random_point(std::mt19937& random, double range_mm) {
  std::uniform_real_distribution<double> uniform(-range_mm, range_mm);
  const double x = uniform(random), y = uniform(random), z = uniform(random);
  return {x, y, z};
}

double box_distance(const Eigen::Vector3d& p, const Eigen::Vector3d& half) {
  const Eigen::Vector3d q = p.cwiseAbs() - half;
  return q.cwiseMax(0.0).norm() + std::min(0.0, q.maxCoeff());
}

// A box has a closed form everywhere, edges and corners included, where signs go wrong first.
TEST(Surface, SignedDistanceOfABoxIsExact) {
  const Eigen::Vector3d half(30, 20, 10);
  const Surface surface(box(half));
  std::mt19937 random(1);
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Vector3d p = random_point(random, 60);
    EXPECT_NEAR(surface.signed_distance_mm(p), box_distance(p, half), 1e-9) << p.transpose();
  }
}

// Thin wedges are where the normal of one triangle alone gives the wrong sign.
TEST(Surface, SignIsRightBesideAThinWedge) {
  TriangleMesh wedge;
  // A needle of a tetrahedron: 100 long, 1 thick.
  wedge.vertices_mm = {{0, 0, 0}, {100, 0, 0}, {0, 1, 0.2}, {0, 0, 1}};
  wedge.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  ASSERT_GT(signed_volume_mm3(wedge), 0);
  const Surface surface(wedge);
  std::mt19937 random(2);
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Vector3d p =
        Eigen::Vector3d(50, 0.5, 0.5) + random_point(random, 1).cwiseProduct(Eigen::Vector3d(60, 2, 2));
    // Inside when on the inner side of all four planes.
    bool inside = true;
    for (const auto& t : wedge.triangles) {
      const auto &a = wedge.vertices_mm[t[0]], &b = wedge.vertices_mm[t[1]], &c = wedge.vertices_mm[t[2]];
      inside = inside && (b - a).cross(c - a).dot(p - a) < 0;
    }
    EXPECT_EQ(surface.signed_distance_mm(p) < 0, inside) << p.transpose();
  }
}

// A curved bone-like shape: the implicit function tells inside from outside away from the facets' sagitta.
TEST(Surface, SignIsRightForACurvedClosedMesh) {
  const Eigen::Vector3d radii(40, 30, 25);
  const Surface surface(ellipsoid(radii, 4));
  std::mt19937 random(3);
  for (int i = 0; i < 3000; ++i) {
    const Eigen::Vector3d p = random_point(random, 50);
    const double implicit = p.cwiseQuotient(radii).norm() - 1;
    if (std::abs(implicit) < 0.01) continue;  // the facets lie up to 0.003 radii inside the ellipsoid
    EXPECT_EQ(surface.signed_distance_mm(p) < 0, implicit < 0) << p.transpose();
  }
}

// An STL soup has no shared vertices; its edges must have their normals all the same.
TEST(Surface, TriangleSoupHasTheSameSigns) {
  const Eigen::Vector3d half(30, 20, 10);
  const TriangleMesh shared = box(half);
  TriangleMesh soup;
  for (const auto& t : shared.triangles) {
    const auto base = static_cast<std::int32_t>(soup.vertices_mm.size());
    for (const auto v : t) soup.vertices_mm.push_back(shared.vertices_mm[v]);
    soup.triangles.push_back({base, base + 1, base + 2});
  }
  const Surface surface(soup);
  std::mt19937 random(4);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d p = random_point(random, 60);
    EXPECT_NEAR(surface.signed_distance_mm(p), box_distance(p, half), 1e-9);
  }
}

// Nearest over all triangles by brute force is the truth.
TEST(Surface, ClosestPointIsTheNearestOfAllTriangles) {
  const TriangleMesh mesh = ellipsoid({40, 30, 25}, 2);
  const Surface surface(mesh);
  std::mt19937 random(5);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d p = random_point(random, 60);
    const SurfacePoint nearest = surface.closest_point(p);
    double least = std::numeric_limits<double>::infinity();
    for (const auto& t : mesh.triangles) {
      TriangleMesh one;
      one.vertices_mm = {mesh.vertices_mm[t[0]], mesh.vertices_mm[t[1]], mesh.vertices_mm[t[2]]};
      // Dense samples of the triangle bound its distance from above.
      for (int a = 0; a <= 12; ++a) {
        for (int b = 0; a + b <= 12; ++b) {
          const Eigen::Vector3d s =
              (a * one.vertices_mm[0] + b * one.vertices_mm[1] + (12 - a - b) * one.vertices_mm[2]) / 12;
          least = std::min(least, (s - p).norm());
        }
      }
    }
    EXPECT_LE((nearest.point_mm - p).norm(), least + 1e-9);
    const auto& t = mesh.triangles.at(static_cast<std::size_t>(nearest.triangle));
    const Eigen::Vector3d& a = mesh.vertices_mm[t[0]];
    EXPECT_NEAR(nearest.normal.dot(nearest.point_mm - a), 0, 1e-9);
    EXPECT_NEAR(nearest.normal.norm(), 1, 1e-12);
  }
}

// At a vertex and on an edge several triangles are equally near: whichever way the tree is built, the first
// one is told.
TEST(Surface, ClosestPointIsOfTheFirstOfSeveralTriangles) {
  const TriangleMesh mesh = box({30, 20, 10});
  const Surface surface(mesh);
  for (std::size_t v = 0; v < mesh.vertices_mm.size(); ++v) {
    const auto first = std::ranges::find_if(mesh.triangles, [&](const auto& t) {
      return std::ranges::count(t, static_cast<std::int32_t>(v)) > 0;
    });
    const SurfacePoint nearest = surface.closest_point(1.5 * mesh.vertices_mm[v]);
    EXPECT_EQ(nearest.point_mm, mesh.vertices_mm[v]);
    EXPECT_EQ(nearest.triangle, first - mesh.triangles.begin());
  }
}

// A point that is not finite has no nearest one; whoever asks must get an answer that is not out of bounds.
TEST(Surface, ClosestPointToNowhereIsOfSomeTriangle) {
  const Surface surface(box({30, 20, 10}));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const SurfacePoint nearest = surface.closest_point({nan, 0, 0});
  EXPECT_GE(nearest.triangle, 0);
  EXPECT_LT(nearest.triangle, 12);
}

// Entry and exit of a drill: in order of distance, with the normals against and along the ray.
TEST(Surface, RayHitsAreInOrder) {
  const Surface surface(box({30, 20, 10}));
  const auto hits = surface.all_hits({-100, 3, 4}, {7, 0, 0});
  ASSERT_EQ(hits.size(), 2U);
  EXPECT_NEAR(hits[0].distance_mm, 70, 1e-9);
  EXPECT_NEAR(hits[1].distance_mm, 130, 1e-9);
  EXPECT_NEAR(hits[0].normal.x(), -1, 1e-12);
  EXPECT_NEAR(hits[1].normal.x(), 1, 1e-12);
  EXPECT_NEAR((hits[1].point_mm - Eigen::Vector3d(30, 3, 4)).norm(), 0, 1e-9);
  const auto first = surface.first_hit({-100, 3, 4}, {1, 0, 0});
  ASSERT_TRUE(first);
  EXPECT_NEAR(first->distance_mm, 70, 1e-9);
  EXPECT_FALSE(surface.first_hit({-100, 3, 4}, {-1, 0, 0}));
  EXPECT_FALSE(surface.first_hit({-100, 33, 4}, {1, 0, 0}));
}

// The first of all hits, whatever lies behind it: from inside and outside, from far away, through vertices
// and edges, where triangles that touch there are told apart by their order alone.
TEST(Surface, FirstHitIsTheFirstOfAllHits) {
  const TriangleMesh mesh = ellipsoid({40, 25, 30}, 3);
  const Surface surface(mesh);
  std::mt19937 random(7);
  int met = 0;
  const auto expect_same = [&](const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
    const auto all = surface.all_hits(origin, direction);
    const auto first = surface.first_hit(origin, direction);
    ASSERT_EQ(first.has_value(), !all.empty());
    if (!first) return;
    ++met;
    const double far = first->distance_mm;
    EXPECT_FALSE(surface.first_hit(origin, direction, 0.999 * far - 1e-9)) << "it lies further off";
    const auto near_enough = surface.first_hit(origin, direction, 1.001 * far + 1e-9);
    ASSERT_TRUE(near_enough);
    EXPECT_EQ(near_enough->triangle, first->triangle);
    EXPECT_EQ(first->triangle, all.front().triangle);
    EXPECT_EQ(first->point_mm, all.front().point_mm);
    EXPECT_EQ(first->distance_mm, all.front().distance_mm);
  };
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector3d origin = random_point(random, i % 3 == 0 ? 2000 : 60),
                          vertex = mesh.vertices_mm[static_cast<std::size_t>(i)];
    expect_same(origin, -origin + random_point(random, 20));
    expect_same(origin, vertex - origin);
    expect_same(vertex, origin - vertex);
    expect_same(origin, origin);
  }
  EXPECT_GT(met, 600);
}

// The origin on the surface counts as hit at distance 0: a tunnel starts where the surgeon picked.
TEST(Surface, OriginOnTheSurfaceIsAHit) {
  const Surface surface(box({30, 20, 10}));
  const auto hits = surface.all_hits({-30, 3, 4}, {1, 0, 0});
  ASSERT_EQ(hits.size(), 2U);
  EXPECT_NEAR(hits[0].distance_mm, 0, 1e-9);
  EXPECT_NEAR(hits[1].distance_mm, 60, 1e-9);
}

// A ray through a vertex or along a diagonal must neither slip through nor pretend to cross twice.
TEST(Surface, RayThroughEdgesAndVerticesCrossesOnce) {
  const Surface surface(box({30, 20, 10}));
  // Through the middle of the x faces, where their diagonals pass.
  EXPECT_EQ(surface.all_hits({-100, 0, 0}, {1, 0, 0}).size(), 2U);
  const Surface round(ellipsoid({30, 30, 30}, 3));
  const TriangleMesh mesh = ellipsoid({30, 30, 30}, 3);
  for (std::size_t v = 0; v < mesh.vertices_mm.size(); v += 7) {
    const Eigen::Vector3d direction = -mesh.vertices_mm[v];
    EXPECT_EQ(round.all_hits(3 * mesh.vertices_mm[v], direction).size(), 2U) << v;
  }
}

TEST(Surface, RefusesWhatHasNoSurface) {
  EXPECT_THROW(Surface{TriangleMesh{}}, InvalidInput);
  TriangleMesh line;
  line.vertices_mm = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  line.triangles = {{0, 1, 2}};
  EXPECT_THROW(Surface{line}, InvalidInput);
  TriangleMesh out_of_range = box({1, 1, 1});
  out_of_range.triangles[3][1] = 8;
  EXPECT_THROW(Surface{out_of_range}, InvalidInput);
}

// Triangle numbers speak of the mesh that was given, whatever was left out.
TEST(Surface, DegenerateTrianglesAreLeftOut) {
  TriangleMesh mesh = box({30, 20, 10});
  mesh.triangles.insert(mesh.triangles.begin(), {0, 0, 1});
  const Surface surface(mesh);
  const SurfacePoint top = surface.closest_point({5, 5, 50});
  EXPECT_TRUE(top.triangle == 3 || top.triangle == 4) << top.triangle;
}

// Built once, read by the guidance and the view at the same time.
TEST(Surface, ManyThreadsMayAsk) {
  const Eigen::Vector3d half(30, 20, 10);
  const Surface surface(box(half));
  std::atomic<int> wrong{0};
  std::vector<std::thread> threads;
  for (unsigned t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      std::mt19937 random(t);
      for (int i = 0; i < 500; ++i) {
        const Eigen::Vector3d p = random_point(random, 60);
        wrong += std::abs(surface.signed_distance_mm(p) - box_distance(p, half)) > 1e-9;
      }
    });
  }
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace arthronaut::geometry
