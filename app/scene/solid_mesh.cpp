#include "app/scene/solid_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace arthronaut::scene {

namespace {

std::array<std::uint8_t, 3> bytes_of(const Color& color) {
  const auto byte = [](float value) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.F, 1.F) * 255));
  };
  return {byte(color.red), byte(color.green), byte(color.blue)};
}

struct Ring {
  Eigen::Vector3d center, side, other;  // side and other span the ring's plane, unit
  double radius;
};

Eigen::Vector3d on_ring(const Ring& ring, int i, int sides) {
  const double angle = 2 * std::numbers::pi * i / sides;
  return std::cos(angle) * ring.side + std::sin(angle) * ring.other;
}

int add_point(SolidMesh& mesh, const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
              const std::array<std::uint8_t, 3>& color) {
  mesh.points_mm.push_back(point.cast<float>());
  mesh.normals.push_back(normal.cast<float>());
  mesh.colors.push_back(color);
  return static_cast<int>(mesh.points_mm.size()) - 1;
}

int add_ring(SolidMesh& mesh, const Ring& ring, int sides, const std::array<std::uint8_t, 3>& color) {
  const int first = static_cast<int>(mesh.points_mm.size());
  for (int i = 0; i < sides; ++i) {
    const Eigen::Vector3d out = on_ring(ring, i, sides);
    add_point(mesh, ring.center + ring.radius * out, out, color);
  }
  return first;
}

void join_rings(SolidMesh& mesh, int from, int to, int sides) {
  for (int i = 0; i < sides; ++i) {
    const int next = (i + 1) % sides;
    mesh.triangles.push_back({from + i, from + next, to + i});
    mesh.triangles.push_back({from + next, to + next, to + i});
  }
}

void add_cap(SolidMesh& mesh, const Ring& ring, const Eigen::Vector3d& normal, int sides,
             const std::array<std::uint8_t, 3>& color) {
  const int middle = add_point(mesh, ring.center, normal, color);
  const int first = static_cast<int>(mesh.points_mm.size());
  for (int i = 0; i < sides; ++i)
    add_point(mesh, ring.center + ring.radius * on_ring(ring, i, sides), normal, color);
  const bool along = ring.side.cross(ring.other).dot(normal) > 0;
  for (int i = 0; i < sides; ++i) {
    const int a = first + i, b = first + (i + 1) % sides;
    mesh.triangles.push_back(along ? std::array{middle, a, b} : std::array{middle, b, a});
  }
}

}  // namespace

void SolidMesh::add(const RodItem& rod) {
  const Eigen::Vector3d axis = rod.to_mm - rod.from_mm;
  if (!(axis.norm() > 1e-9)) return;
  constexpr int kSides = 24;
  const Eigen::Vector3d along = axis.normalized(), side = along.unitOrthogonal(), other = along.cross(side);
  const Ring from{rod.from_mm, side, other, rod.from_diameter_mm / 2};
  const Ring to{rod.to_mm, side, other, rod.to_diameter_mm / 2};
  const auto color = bytes_of(rod.color);
  const int first = add_ring(*this, from, kSides, color);
  join_rings(*this, first, add_ring(*this, to, kSides, color), kSides);
  add_cap(*this, from, -along, kSides, color);
  add_cap(*this, to, along, kSides, color);
}

void SolidMesh::add(const LineItem& line) {
  const std::size_t count = line.points_mm.size();
  if (count < 2) return;
  constexpr int kSides = 6;
  const auto color = bytes_of(line.color);
  Eigen::Vector3d side = Eigen::Vector3d::Zero();
  int first = -1, previous = -1;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t before = i > 0 ? i - 1 : (line.closed ? count - 1 : 0);
    const std::size_t after = i + 1 < count ? i + 1 : (line.closed ? 0 : count - 1);
    Eigen::Vector3d along = line.points_mm[after] - line.points_mm[before];
    if (!(along.norm() > 1e-9)) continue;
    along.normalize();
    // The frame of the ring before, carried on, so that the tube does not twist.
    side = side.isZero() ? Eigen::Vector3d(along.unitOrthogonal())
                         : Eigen::Vector3d(side - side.dot(along) * along);
    if (!(side.norm() > 1e-9)) side = along.unitOrthogonal();
    side.normalize();
    const int ring =
        add_ring(*this, {line.points_mm[i], side, along.cross(side), line.diameter_mm / 2}, kSides, color);
    if (previous >= 0) join_rings(*this, previous, ring, kSides);
    if (first < 0) first = ring;
    previous = ring;
  }
  if (line.closed && first >= 0 && previous != first) join_rings(*this, previous, first, kSides);
}

void SolidMesh::add(const BallItem& ball) {
  constexpr int kSides = 14, kRings = 8;
  const auto color = bytes_of(ball.color);
  int previous = -1;
  for (int i = 0; i <= kRings; ++i) {
    const double angle = std::numbers::pi * i / kRings;
    const int first = static_cast<int>(points_mm.size());
    for (int k = 0; k < kSides; ++k) {
      const double turn = 2 * std::numbers::pi * k / kSides;
      const Eigen::Vector3d out(std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn),
                                -std::cos(angle));
      add_point(*this, ball.center_mm + 0.5 * ball.diameter_mm * out, out, color);
    }
    if (previous >= 0) join_rings(*this, previous, first, kSides);
    previous = first;
  }
}

}  // namespace arthronaut::scene
