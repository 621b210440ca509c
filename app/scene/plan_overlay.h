// The plan as lines over a picture of the arthroscope, exact under distortion: points are projected by the
// one camera model, frame by frame, with that frame's camera and pose. What the bone hides is marked as
// hidden.
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "navigation/camera/camera_model.h"
#include "planning/geometry/rigid_transform.h"
#include "planning/geometry/surface.h"
#include "planning/geometry/triangle_mesh.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::scene {

struct OverlayLine {
  // TunnelWall: where the tunnel's wall is seen edge on, and its far end. TunnelFace: a piece of the wall
  // that faces the eye, as a filled polygon.
  enum class Kind {
    BoneOutline,
    EntryRing,
    TunnelWall,
    TunnelAxis,
    TunnelFace,
    Curve
  } kind = Kind::BoneOutline;
  bool is_hidden = false;                  // behind the bone's surface
  std::vector<Eigen::Vector2d> points_px;  // raw pixels of the frame, two or more; of a face four
  float shade = 1;  // of a face: 1 faces the eye, 0 is seen edge on; seen along the axis
};
using PlanOverlay = std::vector<OverlayLine>;

// A place that nothing is drawn over: the tip of a tool, a piece of its shaft. No line crosses it, not even
// between two of its points.
struct ClearDisc {
  Eigen::Vector2d center_px;
  double radius_px = 0;
};

// Prepared for one bone and one plan. Immutable: any number of threads.
class OverlayModel {
 public:
  // `plan` may be absent: the outline alone is drawn then. length_mm: inside bone.
  OverlayModel(std::shared_ptr<const geometry::Surface> surface, const geometry::TriangleMesh& drawn_bone,
               const std::optional<tunnels::Tunnel>& plan, double length_mm);

  // Lines inside the circular view, none over `clear`.
  [[nodiscard]] PlanOverlay project(const camera::CameraModel& camera,
                                    const geometry::RigidTransform& camera_from_bone,
                                    std::span<const ClearDisc> clear) const;

 private:
  struct Edge {
    int from, to, left, right;  // vertices, and the triangles on its two sides
  };
  struct Path {
    OverlayLine::Kind kind;
    std::vector<Eigen::Vector3d> points_mm;
  };
  void add_plan(const tunnels::Tunnel& plan, double length_mm);
  void add_body(PlanOverlay& overlay, const camera::CameraModel& camera,
                const geometry::RigidTransform& camera_from_bone, std::span<const ClearDisc> clear) const;
  [[nodiscard]] bool is_hidden(const Eigen::Vector3d& eye_mm, const Eigen::Vector3d& point_mm) const;
  void add_outline(PlanOverlay& overlay, const camera::CameraModel& camera,
                   const geometry::RigidTransform& camera_from_bone, std::span<const ClearDisc> clear) const;

  std::shared_ptr<const geometry::Surface> surface_;
  std::vector<Eigen::Vector3d> vertices_mm_, triangle_normals_;
  std::vector<std::array<std::int32_t, 3>> triangles_;
  std::vector<Edge> edges_;
  // The tunnel's wall, generator by generator: where it leaves the bone's surface at the mouth, and which way
  // is out of the tunnel there.
  struct Wall {
    std::vector<Eigen::Vector3d> mouth_mm, outward;
    Eigen::Vector3d direction = Eigen::Vector3d::UnitZ(), entry_mm = Eigen::Vector3d::Zero();
    double length_mm = 0, radius_mm = 0;
  };
  std::vector<Path> paths_;
  std::optional<Wall> wall_;
};

// Points of curves, given in the camera frame, as lines that break where two points are more than max_hop_mm
// apart.
void add_curves(PlanOverlay& overlay, const camera::CameraModel& camera,
                std::span<const Eigen::Vector3d> points_in_camera_mm, double max_hop_mm,
                std::span<const ClearDisc> clear);

}  // namespace arthronaut::scene
