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
      : overlay_(overlay), clear_(clear), line_{kind, false, {}, 1} {}
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
  constexpr int kRingPoints = 64;
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
  Wall wall;
  wall.direction = plan.direction;
  wall.entry_mm = plan.entry_mm;
  wall.length_mm = length_mm;
  wall.radius_mm = radius;
  Path far_end{Kind::TunnelWall, {}};
  for (int i = 0; i <= kRingPoints; ++i) {
    const double angle = 2 * geometry::kPi * i / kRingPoints;
    const Eigen::Vector3d out = std::cos(angle) * side + std::sin(angle) * other;
    wall.mouth_mm.push_back(ring.points_mm[static_cast<std::size_t>(i)]);
    wall.outward.push_back(out);
    far_end.points_mm.push_back(plan.entry_mm + radius * out + length_mm * plan.direction);
  }
  if (length_mm > 0) {
    wall_ = std::move(wall);
    paths_.push_back(std::move(far_end));
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
  if (wall_) add_body(overlay, camera, camera_from_bone, clear);
  for (const Path& path : paths_) {
    LineWriter line(overlay, path.kind, clear);
    for (const Eigen::Vector3d& point : path.points_mm) {
      const auto pixel = drawn_pixel(camera, camera_from_bone * point, clear);
      line.add(pixel, pixel && is_hidden(eye, point));
    }
  }
  return overlay;
}

// The half of the wall that faces the eye, in pieces that a tool may lie over one by one, and the two lines
// where it turns away: a generator is seen edge on where the eye lies in the plane that touches the wall
// there, that is where its outward direction . (eye - point on the axis) is the radius.
void OverlayModel::add_body(PlanOverlay& overlay, const camera::CameraModel& camera,
                            const geometry::RigidTransform& camera_from_bone,
                            std::span<const ClearDisc> clear) const {
  constexpr int kPieces = 8;
  constexpr std::size_t kTogether = 2;  // generators a face
  const Eigen::Vector3d eye = camera_from_bone.inverse().translation_mm;
  const Eigen::Vector3d to_eye = eye - wall_->entry_mm;
  const Eigen::Vector3d across = (to_eye - to_eye.dot(wall_->direction) * wall_->direction).normalized();
  // The share 0 to 1 of the way from the mouth to the far end, which are not parallel.
  const auto point = [&](std::size_t generator, double share) {
    const Eigen::Vector3d& mouth = wall_->mouth_mm[generator];
    const Eigen::Vector3d end =
        wall_->entry_mm + wall_->radius_mm * wall_->outward[generator] + wall_->length_mm * wall_->direction;
    return Eigen::Vector3d(mouth + share * (end - mouth));
  };
  const auto facing = [&](std::size_t generator) {
    return wall_->outward[generator].dot(to_eye) - wall_->radius_mm;
  };
  const std::size_t count = wall_->outward.size() - 1;
  for (std::size_t g = 0; g < count; g += kTogether) {
    const std::size_t next = std::min(g + kTogether, count);
    const std::size_t middle = (g + next) / 2;
    if (facing(middle) <= 0) continue;
    for (int piece = 0; piece < kPieces; ++piece) {
      const double from = static_cast<double>(piece) / kPieces, to = static_cast<double>(piece + 1) / kPieces;
      const std::array corners{point(g, from), point(next, from), point(next, to), point(g, to)};
      OverlayLine face{Kind::TunnelFace, false, {}, 1};
      for (const Eigen::Vector3d& corner : corners)
        if (const auto pixel = drawn_pixel(camera, camera_from_bone * corner, clear))
          face.points_px.push_back(*pixel);
      if (face.points_px.size() != corners.size()) continue;
      bool is_free_of_tools = true;
      for (std::size_t k = 0; k < corners.size(); ++k)
        is_free_of_tools = is_free_of_tools &&
                           is_free(face.points_px[k], face.points_px[(k + 1) % 4], clear) &&
                           is_free(face.points_px[k], face.points_px[(k + 2) % 4], clear);
      if (!is_free_of_tools) continue;
      const Eigen::Vector3d center = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
      face.is_hidden = is_hidden(eye, center);
      face.shade = static_cast<float>(std::clamp(across.dot(wall_->outward[middle]), 0.0, 1.0));
      overlay.push_back(std::move(face));
    }
  }
  for (std::size_t g = 0; g < count; ++g) {
    const double here = facing(g), there = facing(g + 1);
    if ((here > 0) == (there > 0)) continue;
    const double share = here / (here - there);
    LineWriter line(overlay, Kind::TunnelWall, clear);
    constexpr int kSteps = 36;
    for (int step = 0; step <= kSteps; ++step) {
      const double along = static_cast<double>(step) / kSteps;
      const Eigen::Vector3d at = (1 - share) * point(g, along) + share * point(g + 1, along);
      const auto pixel = drawn_pixel(camera, camera_from_bone * at, clear);
      line.add(pixel, pixel && is_hidden(eye, at));
    }
  }
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
    overlay.push_back({Kind::BoneOutline, false, {*pixel_a, *pixel_b}, 1});
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
