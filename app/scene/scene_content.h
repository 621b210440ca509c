// What a 3D view shows, as plain data: the view keeps itself like it. Cheap to build anew for every change;
// bones are shared and compared by address.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "planning/geometry/triangle_mesh.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::scene {

struct Color {
  float red = 1, green = 1, blue = 1;
  bool operator==(const Color&) const = default;
};

// Safe for colour-blind eyes (after Okabe and Ito), and each has a shape of its own beside its colour.
inline constexpr Color kBoneColor{0.87F, 0.82F, 0.73F};
inline constexpr Color kSectionColor{0.42F, 0.30F, 0.27F};   // where a bone is cut open
inline constexpr Color kPlanColor{0.34F, 0.71F, 0.91F};      // solid tube, entry ring
inline constexpr Color kAchievedColor{0.90F, 0.62F, 0.00F};  // banded tube
inline constexpr Color kGuideColor{0.94F, 0.89F, 0.26F};     // rod with a cone
inline constexpr Color kCurveColor{0.25F, 0.85F, 0.65F};     // thin line

// What lies on the normal's side of it is cut away.
struct CutPlane {
  Eigen::Vector3d point_mm = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::UnitX();  // unit
  [[nodiscard]] bool cuts_away(const Eigen::Vector3d& x_mm) const { return normal.dot(x_mm - point_mm) > 0; }
  bool operator==(const CutPlane&) const = default;
};

struct BoneItem {
  std::shared_ptr<const geometry::TriangleMesh> mesh;
  Color color = kBoneColor;
  double opacity = 1;
  std::optional<CutPlane> cut = {};  // the section is drawn in one flat colour
  bool operator==(const BoneItem&) const = default;
};

// A rod or, with different ends, a cone.
struct RodItem {
  Eigen::Vector3d from_mm = Eigen::Vector3d::Zero(), to_mm = Eigen::Vector3d::UnitZ();
  double from_diameter_mm = 1, to_diameter_mm = 1;
  Color color;
  bool seen_through_bone = false;  // what the bone hides is drawn faintly over it
};

struct LineItem {
  std::vector<Eigen::Vector3d> points_mm;
  double diameter_mm = 0.6;
  bool closed = false;
  Color color;
  bool seen_through_bone = false;
};

struct BallItem {
  Eigen::Vector3d center_mm = Eigen::Vector3d::Zero();
  double diameter_mm = 2;
  Color color;
  bool seen_through_bone = false;
};

struct VolumeItem;  // drawn_volume.h

struct SceneContent {
  std::vector<BoneItem> bones;
  std::shared_ptr<const VolumeItem> volume = nullptr;  // nullptr: none
  std::vector<RodItem> rods;
  std::vector<LineItem> lines;
  std::vector<BallItem> balls;
};

// Planned: tube from entry to exit and a ring about the entry. `length_mm` is that inside bone.
void add_planned_tunnel(SceneContent& content, const tunnels::Tunnel& tunnel, double length_mm,
                        const Color& color = kPlanColor);
// As drilled: bands.
void add_achieved_tunnel(SceneContent& content, const tunnels::Tunnel& tunnel, double length_mm);
// The drill guide: a rod that ends in a cone at its tip, and its line ahead.
void add_guide(SceneContent& content, const Eigen::Vector3d& tip_mm, const Eigen::Vector3d& direction,
               double ahead_mm);
// Curve points that follow each other closely become lines.
void add_curve_points(SceneContent& content, const std::vector<Eigen::Vector3d>& points_mm);

// The mesh with at most about `max_triangles`, for drawing alone; the mesh itself when it is small enough.
[[nodiscard]] std::shared_ptr<const geometry::TriangleMesh> simplified(const geometry::TriangleMesh& mesh,
                                                                       std::size_t max_triangles = 20'000);

}  // namespace arthronaut::scene
