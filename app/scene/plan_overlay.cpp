#include "app/scene/plan_overlay.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

namespace arthronaut::scene {

namespace {

using Kind = OverlayLine::Kind;

// Whether the straight line between two pixels, which may be one and the same, keeps off all discs.
bool is_free(const Eigen::Vector2d& from, const Eigen::Vector2d& to, std::span<const ClearDisc> clear) {
  const Eigen::Vector2d along = to - from;
  const double length2 = along.squaredNorm();
  return std::none_of(clear.begin(), clear.end(), [&](const ClearDisc& disc) {
    const double share = length2 > 0 ? std::clamp((disc.center_px - from).dot(along) / length2, 0.0, 1.0) : 0;
    return (from + share * along - disc.center_px).squaredNorm() < disc.radius_px * disc.radius_px;
  });
}

std::optional<Eigen::Vector2d> drawn_pixel(const camera::CameraModel& camera,
                                           const Eigen::Vector3d& point_in_camera_mm,
                                           std::span<const ClearDisc> clear) {
  const auto pixel = camera.project(point_in_camera_mm);
  if (!pixel || !camera.is_inside_view(*pixel) || !is_free(*pixel, *pixel, clear)) return std::nullopt;
  return pixel;
}

// Collects pixels into lines; a new line begins where a pixel is missing or changes sides.
class LineWriter {
 public:
  LineWriter(PlanOverlay& overlay, Kind kind, std::span<const ClearDisc> clear)
      : overlay_(overlay), clear_(clear), line_{kind, false, {}} {}
  ~LineWriter() { finish(); }
  LineWriter(const LineWriter&) = delete;
  LineWriter& operator=(const LineWriter&) = delete;

  void add(const std::optional<Eigen::Vector2d>& pixel, bool is_hidden) {
    if (!pixel) return finish();
    if (!line_.points_px.empty() && !is_free(line_.points_px.back(), *pixel, clear_)) finish();
    if (is_hidden != line_.is_hidden && !line_.points_px.empty()) {
      line_.points_px.push_back(*pixel);  // the two lines meet
      finish();
    }
    line_.is_hidden = is_hidden;
    line_.points_px.push_back(*pixel);
  }
  void finish() {
    if (line_.points_px.size() > 1) overlay_.push_back(line_);
    line_.points_px.clear();
  }

 private:
  PlanOverlay& overlay_;
  std::span<const ClearDisc> clear_;
  OverlayLine line_;
};

}  // namespace

OverlayModel::OverlayModel(std::shared_ptr<const geometry::Surface> surface,
                           const geometry::TriangleMesh& drawn_bone,
                           const std::optional<tunnels::Tunnel>& plan, double length_mm)
    : surface_(std::move(surface)), vertices_mm_(drawn_bone.vertices_mm), triangles_(drawn_bone.triangles) {
  std::map<std::pair<int, int>, int> first_side;
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    const auto& t = triangles_[i];
    const auto vertex = [&](int k) -> const Eigen::Vector3d& {
      return vertices_mm_[static_cast<std::size_t>(t[static_cast<std::size_t>(k)])];
    };
    triangle_normals_.push_back((vertex(1) - vertex(0)).cross(vertex(2) - vertex(0)));
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      const auto key = std::minmax(a, b);
      const auto [known, is_new] = first_side.try_emplace({key.first, key.second}, static_cast<int>(i));
      if (!is_new) edges_.push_back({a, b, known->second, static_cast<int>(i)});
    }
  }
  if (plan) add_plan(*plan, length_mm);
}

void OverlayModel::add_plan(const tunnels::Tunnel& plan, double length_mm) {
  constexpr int kRingPoints = 64, kWallLines = 8;
  constexpr double kStep_mm = 1.0, kLift_mm = 0.15, kBefore_mm = 10;
  const Eigen::Vector3d side = plan.direction.unitOrthogonal(), other = plan.direction.cross(side);
  const double radius = plan.diameter_mm / 2;
  // The mouth of the tunnel: the drill's cylinder where it meets the bone, cast from before the entry.
  Path ring{Kind::EntryRing, {}};
  for (int i = 0; i <= kRingPoints; ++i) {
    const double angle = 2 * geometry::kPi * i / kRingPoints;
    const Eigen::Vector3d out = std::cos(angle) * side + std::sin(angle) * other;
    const Eigen::Vector3d start = plan.entry_mm + radius * out - kBefore_mm * plan.direction;
    const auto hit = surface_->first_hit(start, plan.direction);
    const bool near = hit && hit->distance_mm < 2 * kBefore_mm;
    ring.points_mm.push_back(near ? Eigen::Vector3d(hit->point_mm - kLift_mm * plan.direction)
                                  : Eigen::Vector3d(plan.entry_mm + radius * out));
  }
  for (int i = 0; i < kWallLines; ++i) {
    const std::size_t at = static_cast<std::size_t>(i * kRingPoints / kWallLines);
    Path wall{Kind::TunnelWall, {}};
    for (double along = 0; along <= length_mm; along += kStep_mm)
      wall.points_mm.push_back(ring.points_mm[at] + along * plan.direction);
    paths_.push_back(std::move(wall));
  }
  Path axis{Kind::TunnelAxis, {}};
  for (double along = -kBefore_mm; along <= length_mm; along += kStep_mm)
    axis.points_mm.push_back(plan.entry_mm + along * plan.direction);
  paths_.push_back(std::move(axis));
  paths_.push_back(std::move(ring));
}

bool OverlayModel::is_hidden(const Eigen::Vector3d& eye_mm, const Eigen::Vector3d& point_mm) const {
  constexpr double kTolerance_mm = 0.5;
  const Eigen::Vector3d ray = point_mm - eye_mm;
  const double distance = ray.norm();
  if (distance < 1e-6) return false;
  const auto hit = surface_->first_hit(eye_mm, ray / distance);
  return hit && hit->distance_mm < distance - kTolerance_mm;
}

PlanOverlay OverlayModel::project(const camera::CameraModel& camera,
                                  const geometry::RigidTransform& camera_from_bone,
                                  std::span<const ClearDisc> clear) const {
  PlanOverlay overlay;
  const Eigen::Vector3d eye = camera_from_bone.inverse().translation_mm;
  add_outline(overlay, camera, camera_from_bone, clear);
  for (const Path& path : paths_) {
    LineWriter line(overlay, path.kind, clear);
    for (const Eigen::Vector3d& point : path.points_mm) {
      const auto pixel = drawn_pixel(camera, camera_from_bone * point, clear);
      line.add(pixel, pixel && is_hidden(eye, point));
    }
  }
  return overlay;
}

void OverlayModel::add_outline(PlanOverlay& overlay, const camera::CameraModel& camera,
                               const geometry::RigidTransform& camera_from_bone,
                               std::span<const ClearDisc> clear) const {
  const Eigen::Vector3d eye = camera_from_bone.inverse().translation_mm;
  std::vector<bool> faces_eye(triangles_.size());
  for (std::size_t i = 0; i < triangles_.size(); ++i)
    faces_eye[i] =
        triangle_normals_[i].dot(eye - vertices_mm_[static_cast<std::size_t>(triangles_[i][0])]) > 0;
  for (const Edge& edge : edges_) {
    if (faces_eye[static_cast<std::size_t>(edge.left)] == faces_eye[static_cast<std::size_t>(edge.right)])
      continue;
    const Eigen::Vector3d& a = vertices_mm_[static_cast<std::size_t>(edge.from)];
    const Eigen::Vector3d& b = vertices_mm_[static_cast<std::size_t>(edge.to)];
    const auto pixel_a = drawn_pixel(camera, camera_from_bone * a, clear);
    const auto pixel_b = drawn_pixel(camera, camera_from_bone * b, clear);
    if (!pixel_a || !pixel_b || !is_free(*pixel_a, *pixel_b, clear) || is_hidden(eye, 0.5 * (a + b)))
      continue;
    overlay.push_back({Kind::BoneOutline, false, {*pixel_a, *pixel_b}});
  }
}

void add_curves(PlanOverlay& overlay, const camera::CameraModel& camera,
                std::span<const Eigen::Vector3d> points_in_camera_mm, double max_hop_mm,
                std::span<const ClearDisc> clear) {
  LineWriter line(overlay, Kind::Curve, clear);
  for (std::size_t i = 0; i < points_in_camera_mm.size(); ++i) {
    if (i > 0 && (points_in_camera_mm[i] - points_in_camera_mm[i - 1]).norm() > max_hop_mm) line.finish();
    line.add(drawn_pixel(camera, points_in_camera_mm[i], clear), false);
  }
}

}  // namespace arthronaut::scene
