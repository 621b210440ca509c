// A wet ball of 14 mm with a boss on it, drawn by the simulator at a third of the usual size: a bone whose
// outline and surface are known.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <utility>

#include "navigation/camera/frame.h"
#include "navigation/simulator/renderer.h"
#include "navigation/simulator/simulated_operation.h"

namespace arthronaut::contour {

inline constexpr double kBall_mm = 14;

// Vertices about 0.7 mm apart, triangles counter-clockwise from outside. boss_mm: how far its front stands
// out.
inline geometry::TriangleMesh ball_mesh(double boss_mm = 3) {
  geometry::TriangleMesh mesh;
  const double g = (1 + std::sqrt(5.0)) / 2;
  for (const double a : {-1.0, 1.0})
    for (const double b : {-g, g}) {
      mesh.vertices_mm.emplace_back(a, b, 0);
      mesh.vertices_mm.emplace_back(0, a, b);
      mesh.vertices_mm.emplace_back(b, 0, a);
    }
  const auto& v = mesh.vertices_mm;
  for (std::int32_t i = 0; i < 12; ++i)
    for (std::int32_t j = i + 1; j < 12; ++j)
      for (std::int32_t k = j + 1; k < 12; ++k) {
        const auto at = [&](std::int32_t n) { return v[static_cast<std::size_t>(n)]; };
        if ((at(i) - at(j)).norm() > 2.1 || (at(j) - at(k)).norm() > 2.1 || (at(i) - at(k)).norm() > 2.1)
          continue;
        const bool is_outward = (at(j) - at(i)).cross(at(k) - at(i)).dot(at(i)) > 0;
        mesh.triangles.push_back(is_outward ? std::array{i, j, k} : std::array{i, k, j});
      }
  for (int level = 0; level < 4; ++level) {
    std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles;
    const auto middle = [&](std::int32_t a, std::int32_t b) {
      const auto key = std::minmax(a, b);
      const auto [found, is_new] =
          middles.try_emplace(key, static_cast<std::int32_t>(mesh.vertices_mm.size()));
      if (is_new)
        mesh.vertices_mm.push_back(mesh.vertices_mm[static_cast<std::size_t>(a)] +
                                   mesh.vertices_mm[static_cast<std::size_t>(b)]);
      return found->second;
    };
    std::vector<std::array<std::int32_t, 3>> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::int32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    for (Eigen::Vector3d& vertex : mesh.vertices_mm) vertex.normalize();
    mesh.triangles = std::move(finer);
  }
  for (Eigen::Vector3d& vertex : mesh.vertices_mm) {
    const Eigen::Vector3d unit = vertex.normalized();
    const double away = (unit - Eigen::Vector3d(0.3, 0.1, -0.95).normalized()).norm();
    vertex = unit * (kBall_mm + boss_mm * std::exp(-away * away / 0.08));
  }
  return mesh;
}

inline camera::Calibration small_camera() {
  camera::Calibration camera = simulator::standard_camera();
  camera.image_size_px = {640, 360};
  camera.focal_px /= 3;
  camera.principal_point_px = (camera.principal_point_px.array() + 0.5) / 3 - 0.5;
  camera.rotation_center_px = (camera.rotation_center_px.array() + 0.5) / 3 - 0.5;
  camera.boundary.center_px = (camera.boundary.center_px.array() + 0.5) / 3 - 0.5;
  camera.boundary.radius_px /= 3;
  return camera;
}

// The bone before the lens, turned a little, all of it in view.
inline geometry::RigidTransform before_the_lens(double turn_rad = 0) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(turn_rad, Eigen::Vector3d(0.3, 1, 0.1).normalized())),
          {1.5, -1, 42}};
}

class RenderedBone {
 public:
  explicit RenderedBone(const geometry::TriangleMesh& mesh)
      : bone_(mesh, 5), renderer_(&bone_, simulator::SensorOptions{}), camera_(small_camera(), 0, 1.3345) {}

  // The picture's luma; valid until the next call.
  camera::GrayView draw(const geometry::RigidTransform& camera_from_bone) {
    const camera::Frame& frame = picture(camera_from_bone);
    camera::gray_from(frame, luma_);
    return {luma_.data(), frame.width, frame.height, frame.width};
  }
  // With something before it, if any; without index and time.
  camera::Frame& picture(const geometry::RigidTransform& camera_from_bone,
                         std::unique_ptr<simulator::Solid> before_it = nullptr) {
    simulator::Scene scene;
    if (before_it != nullptr) scene.solids.push_back(std::move(before_it));
    scene.has_bone = true;
    scene.camera_from_bone = camera_from_bone;
    scene.exposure = 700;
    renderer_.render(scene, camera_, small_camera().reference_mark_angle_deg, ++count_, frame_);
    return frame_;
  }
  [[nodiscard]] const camera::CameraModel& camera() const { return camera_; }

 private:
  simulator::BoneView bone_;
  simulator::Renderer renderer_;
  camera::CameraModel camera_;
  camera::Frame frame_;
  std::vector<std::uint8_t> luma_;
  std::uint64_t count_ = 0;
};

}  // namespace arthronaut::contour
