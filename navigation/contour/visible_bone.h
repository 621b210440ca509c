// What of the bone the lens sees by the registration: its outline, points at which the surface turns away
// from the lens before something that lies clearly further off, and places on the surface between. Found bit
// by bit over a fixed number of frames, so that no frame pays for all of it.
//
// A point of the smooth surface is on the contour where its normal n stands across the line of sight
// (Hertzmann, "Introduction to 3D non-photorealistic rendering", 1999): inside a triangle whose corners'
// n . (eye - v) differ in sign. It occludes where the part that faces the lens is the nearer one. What hides
// it, and what lies behind it, is read off a coarse picture of depths.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "navigation/camera/camera_model.h"
#include "planning/geometry/rigid_transform.h"
#include "planning/geometry/triangle_mesh.h"

namespace arthronaut::contour {

struct ContourPoint {
  Eigen::Vector3d in_bone_mm = Eigen::Vector3d::Zero();
  // Unit, of the surface there: across the line of sight, so a bone that lies t further shows this piece of
  // contour n . t further along n, at its own depth.
  Eigen::Vector3d normal_in_bone = Eigen::Vector3d::UnitZ();
};

// A place on the bone's surface, with a plane to compare pictures in. Always the same for a mesh.
struct SurfacePlace {
  Eigen::Vector3d in_bone_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit; u, v and it are right-handed
  Eigen::Vector3d u = Eigen::Vector3d::UnitX(), v = Eigen::Vector3d::UnitY();
};

// Allocates nothing after the construction and reserve_for(). One thread at a time; deterministic.
class VisibleBone {
 public:
  static constexpr std::size_t kMostOutline = 160, kMostPlaces = 96;

  // mesh: closed, outward, bone frame, mm. Throws InvalidInput when it is empty.
  explicit VisibleBone(const geometry::TriangleMesh& mesh);

  // Pictures of up to that size will come; without it the first one allocates.
  void reserve_for(const Eigen::Vector2i& image_size_px);
  // One share of the work; with the last one, outline() and places_seen() become those of the pose and camera
  // that the first share was given. Returns whether they have. A frame without a pose does not call it.
  bool advance(const geometry::RigidTransform& camera_from_bone, const camera::CameraModel& camera);
  // Begins anew: another registration. Nothing is seen until it is through.
  void restart();

  [[nodiscard]] const std::vector<ContourPoint>& outline() const { return points_; }
  [[nodiscard]] const std::vector<SurfacePlace>& places() const { return places_; }  // all there are
  // Indices of those that are seen, no more than kMostPlaces, spread over the picture.
  [[nodiscard]] const std::vector<std::int32_t>& places_seen() const { return places_seen_; }
  // In how many calls one round is through.
  [[nodiscard]] int calls_per_round() const;

 private:
  enum class Stage { Vertices, Depths, Outline, Places };
  struct Vertex {
    float x = 0, y = 0;   // in cells of the depths
    float depth_mm = -1;  // distance from the eye; below 0: not seen by the lens
    float facing = 0;     // n . (eye - v); above 0: faces the lens
  };
  struct Depths {  // nearest distance from the eye by cell
    int width = 0, height = 0;
    std::vector<float> mm;
    void fit(const Eigen::Vector2i& image_size_px);
    [[nodiscard]] std::size_t count() const {
      return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    }
    [[nodiscard]] float at(const Eigen::Vector2d& cell) const;
  };

  void begin(const geometry::RigidTransform& camera_from_bone, const camera::CameraModel& camera);
  void see_vertices();
  void draw_depths();
  void draw(const Vertex& a, const Vertex& b, const Vertex& c);
  void collect_outline();
  void collect_places();
  [[nodiscard]] bool occludes(const ContourPoint& point) const;
  [[nodiscard]] bool is_well_inside(const Eigen::Vector2d& pixel) const;

  std::vector<Eigen::Vector3f> vertices_, normals_;
  std::vector<std::array<std::int32_t, 3>> triangles_;
  Stage stage_ = Stage::Vertices;
  std::size_t next_ = 0;  // vertex or triangle
  geometry::RigidTransform view_;
  camera::CameraModel camera_;
  std::vector<Vertex> seen_;
  Depths depths_;
  std::vector<std::int32_t> turning_;  // triangles that the contour crosses
  std::vector<ContourPoint> found_, points_;
  std::vector<SurfacePlace> places_;
  std::vector<std::int32_t> places_found_, places_seen_;
};

}  // namespace arthronaut::contour
