// A bone as another scan would show it: lying otherwise, of the other side, cut off elsewhere, noisy.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "planning/bones/mesh_repair.h"
#include "planning/geometry/triangle_mesh.h"

namespace arthronaut::test {

// turn may mirror: then the triangles are turned over, so that they look outwards.
inline geometry::TriangleMesh lying(geometry::TriangleMesh mesh, const Eigen::Matrix3d& turn,
                                    const Eigen::Vector3d& shift_mm) {
  for (auto& v : mesh.vertices_mm) v = turn * v + shift_mm;
  if (turn.determinant() < 0) {
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  }
  return mesh;
}

// What lies below offset_mm along the unit normal, closed by a plane face.
inline geometry::TriangleMesh cut_off(const geometry::TriangleMesh& mesh, const Eigen::Vector3d& normal,
                                      double offset_mm) {
  geometry::TriangleMesh cut;
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> made;  // a vertex kept is {it, it}
  const auto point = [&](std::int32_t i) -> const Eigen::Vector3d& {
    return mesh.vertices_mm[static_cast<std::size_t>(i)];
  };
  const auto vertex = [&](std::int32_t a, std::int32_t b) {
    const auto [low, high] = std::minmax(a, b);
    const auto [at, is_new] =
        made.try_emplace({low, high}, static_cast<std::int32_t>(cut.vertices_mm.size()));
    if (is_new) {
      const double below = offset_mm - point(low).dot(normal), step = (point(high) - point(low)).dot(normal);
      const double share = a == b ? 0 : below / step;
      cut.vertices_mm.push_back(point(low) + share * (point(high) - point(low)));
    }
    return at->second;
  };
  for (const auto& t : mesh.triangles) {
    std::vector<std::int32_t> polygon;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t a = t[k], b = t[(k + 1) % 3];
      const bool keeps_a = point(a).dot(normal) < offset_mm, keeps_b = point(b).dot(normal) < offset_mm;
      if (keeps_a) polygon.push_back(vertex(a, a));
      if (keeps_a != keeps_b) polygon.push_back(vertex(a, b));
    }
    for (std::size_t k = 2; k < polygon.size(); ++k)
      cut.triangles.push_back({polygon[0], polygon[k - 1], polygon[k]});
  }
  return bones::mend_mesh(cut).mesh;
}

inline geometry::TriangleMesh noisy(geometry::TriangleMesh mesh, double sigma_mm, std::mt19937& random) {
  std::normal_distribution<double> normal(0, sigma_mm);
  for (auto& v : mesh.vertices_mm) v += Eigen::Vector3d(normal(random), normal(random), normal(random));
  return mesh;
}

inline Eigen::Matrix3d random_turn(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const double w = normal(random), x = normal(random), y = normal(random), z = normal(random);
  return Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
}

// One of the ways in which the same bone may be given.
struct OtherScan {
  std::string how;
  geometry::TriangleMesh mesh;
  Eigen::Matrix3d turn;
  Eigen::Vector3d shift_mm;
  bool is_noisy = false;
};

// Turned anyhow; mirrored; with 0.2 mm of noise; cut off at 65, 80 and 110 mm of the joint's end where more
// is there, straight and slanting by up to 20 degrees, and of the slanting ones one more with noise. `away`:
// from the joint's end into the shaft.
inline std::vector<OtherScan> other_scans(const geometry::TriangleMesh& mesh, const Eigen::Vector3d& away,
                                          std::uint32_t seed) {
  constexpr double kNoise_mm = 0.2;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> around(-3.14159, 3.14159), slant(0.2, 0.35);  // 12 to 20 degrees
  std::normal_distribution<double> far(0, 100);
  std::vector<OtherScan> scans;
  const auto add = [&](std::string how, const geometry::TriangleMesh& part, bool is_mirrored, bool is_noisy) {
    Eigen::Matrix3d turn = random_turn(random);
    if (is_mirrored) turn.col(0) *= -1;
    const Eigen::Vector3d shift(far(random), far(random), far(random));
    scans.push_back({std::move(how), lying(part, turn, shift), turn, shift, is_noisy});
  };
  add("turned", mesh, false, false);
  add("mirrored", mesh, true, false);
  add("noisy", noisy(mesh, kNoise_mm, random), false, true);
  double low = 1e9, high = -1e9;
  for (const auto& v : mesh.vertices_mm) low = std::min(low, v.dot(away)), high = std::max(high, v.dot(away));
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  double count = 0;
  for (const auto& v : mesh.vertices_mm) {
    if (v.dot(away) < low + 50) middle += v, count += 1;
  }
  middle /= count;
  for (const double left_mm : {65.0, 80.0, 110.0}) {
    if (low + left_mm > high - 3) continue;
    const Eigen::Vector3d at = middle + (low + left_mm - middle.dot(away)) * away;
    const Eigen::Vector3d axis = Eigen::AngleAxisd(around(random), away) * away.unitOrthogonal();
    const Eigen::Vector3d leaning = Eigen::AngleAxisd(slant(random), axis) * away;
    const std::string left = std::to_string(static_cast<int>(left_mm)) + " mm left";
    const auto slanting = cut_off(mesh, leaning, at.dot(leaning));
    add(left, cut_off(mesh, away, at.dot(away)), false, false);
    add(left + ", slanting", slanting, false, false);
    add(left + ", slanting, noisy", noisy(slanting, kNoise_mm, random), false, true);
  }
  return scans;
}

}  // namespace arthronaut::test
