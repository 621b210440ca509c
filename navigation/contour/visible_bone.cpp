#include "navigation/contour/visible_bone.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_set>
#include <utility>

#include "planning/geometry/error.h"

namespace arthronaut::contour {

namespace {

constexpr std::size_t kVerticesPerCall = 5000, kTrianglesPerCall = 12000;
constexpr std::size_t kMostTurning = 4000;
constexpr double kCell_px = 8;
constexpr float kFar_mm = 1e9f, kNearest_mm = 3, kFurthest_mm = 90;
// What lies behind an outline is further off than this, or it is a fold of the same surface.
constexpr float kGap_mm = 2.5f;
// The depth of a cell is that of its middle: a surface seen aslant differs by so much within one.
constexpr float kSameSurface_mm = 1.2f;
constexpr float kBulge_mm = 6;
constexpr double kBeside_mm = 0.7;  // how far off the outline it is looked what lies there
constexpr double kRim_px = 16;      // of the view: its own edge is no outline
constexpr double kPlaceApart_mm = 2;
constexpr float kMostAslant = 0.45f;  // cosine between a place's normal and the way to the eye

// One vertex in each cube of this side: the first.
std::vector<SurfacePlace> spread_places(const geometry::TriangleMesh& mesh,
                                        const std::vector<Eigen::Vector3d>& normals) {
  std::vector<SurfacePlace> places;
  std::unordered_set<std::int64_t> taken;
  for (std::size_t i = 0; i < mesh.vertices_mm.size(); ++i) {
    const Eigen::Vector3d& at = mesh.vertices_mm[i];
    if (!(normals[i].norm() > 0.5)) continue;
    std::int64_t cube = 0;
    for (int axis = 0; axis < 3; ++axis)
      cube = cube * 2'097'152 + static_cast<std::int64_t>(std::floor(at[axis] / kPlaceApart_mm)) + 1'048'576;
    if (!taken.insert(cube).second) continue;
    const Eigen::Vector3d u = normals[i].unitOrthogonal();
    places.push_back({at, normals[i], u, normals[i].cross(u)});
  }
  return places;
}

}  // namespace

float VisibleBone::Depths::at(const Eigen::Vector2d& cell) const {
  const int x = static_cast<int>(std::lround(cell.x())), y = static_cast<int>(std::lround(cell.y()));
  if (x < 0 || y < 0 || x >= width || y >= height) return kFar_mm;
  return mm[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
}

void VisibleBone::Depths::fit(const Eigen::Vector2i& image_size_px) {
  width = static_cast<int>(image_size_px.x() / kCell_px) + 1;
  height = static_cast<int>(image_size_px.y() / kCell_px) + 1;
}

VisibleBone::VisibleBone(const geometry::TriangleMesh& mesh) : triangles_(mesh.triangles) {
  if (mesh.empty()) throw InvalidInput("contour: the bone's mesh is empty");
  const std::vector<Eigen::Vector3d> normals = geometry::vertex_normals(mesh);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    vertices_.push_back(mesh.vertices_mm[i].cast<float>());
    normals_.push_back(normals[i].cast<float>());
  }
  places_ = spread_places(mesh, normals);
  places_found_.reserve(places_.size());
  places_seen_.reserve(kMostPlaces);
  seen_.resize(vertices_.size());
  turning_.reserve(kMostTurning);
  found_.reserve(kMostTurning);
  points_.reserve(kMostOutline);
}

void VisibleBone::reserve_for(const Eigen::Vector2i& image_size_px) {
  depths_.fit(image_size_px);
  depths_.mm.reserve(depths_.count());
}

void VisibleBone::restart() {
  stage_ = Stage::Vertices;
  next_ = 0;
  points_.clear();
  places_seen_.clear();
}

int VisibleBone::calls_per_round() const {
  const auto shares = [](std::size_t count, std::size_t per_call) {
    return static_cast<int>((count + per_call - 1) / per_call);
  };
  return shares(vertices_.size(), kVerticesPerCall) + shares(triangles_.size(), kTrianglesPerCall) + 2;
}

bool VisibleBone::advance(const geometry::RigidTransform& camera_from_bone,
                          const camera::CameraModel& camera) {
  switch (stage_) {
    case Stage::Vertices:
      if (next_ == 0) begin(camera_from_bone, camera);
      see_vertices();
      return false;
    case Stage::Depths:
      draw_depths();
      return false;
    case Stage::Outline:
      collect_outline();
      stage_ = Stage::Places;
      return false;
    case Stage::Places:
      collect_places();
      stage_ = Stage::Vertices;
      return true;
  }
  return false;
}

void VisibleBone::begin(const geometry::RigidTransform& camera_from_bone, const camera::CameraModel& camera) {
  view_ = camera_from_bone;
  camera_ = camera;
  depths_.fit(camera.image_size_px());
  depths_.mm.assign(depths_.count(), kFar_mm);
  turning_.clear();
}

void VisibleBone::see_vertices() {
  const std::size_t end = std::min(vertices_.size(), next_ + kVerticesPerCall);
  const Eigen::Matrix3f rotation = view_.matrix().cast<float>();
  const Eigen::Vector3f shift = view_.translation_mm.cast<float>();
  const Eigen::Vector3f eye = view_.inverse().translation_mm.cast<float>();
  for (; next_ < end; ++next_) {
    Vertex& seen = seen_[next_];
    seen.depth_mm = -1;
    const Eigen::Vector3f to_eye = eye - vertices_[next_];
    const float depth = to_eye.norm();
    if (depth > kFurthest_mm || depth < kNearest_mm) continue;
    const Eigen::Vector3f in_camera = rotation * vertices_[next_] + shift;
    if (in_camera.z() < 0.35f * depth) continue;
    const auto pixel = camera_.project(in_camera.cast<double>());
    if (!pixel) continue;
    seen.x = static_cast<float>(pixel->x() / kCell_px);
    seen.y = static_cast<float>(pixel->y() / kCell_px);
    seen.depth_mm = depth;
    seen.facing = normals_[next_].dot(to_eye);
  }
  if (next_ < vertices_.size()) return;
  stage_ = Stage::Depths;
  next_ = 0;
}

void VisibleBone::draw_depths() {
  const std::size_t end = std::min(triangles_.size(), next_ + kTrianglesPerCall);
  for (; next_ < end; ++next_) {
    const auto& corners = triangles_[next_];
    const Vertex& a = seen_[static_cast<std::size_t>(corners[0])];
    const Vertex& b = seen_[static_cast<std::size_t>(corners[1])];
    const Vertex& c = seen_[static_cast<std::size_t>(corners[2])];
    if (a.depth_mm < 0 || b.depth_mm < 0 || c.depth_mm < 0) continue;
    const int facing = (a.facing > 0) + (b.facing > 0) + (c.facing > 0);
    if (facing == 0) continue;
    if (facing < 3 && turning_.size() < kMostTurning) turning_.push_back(static_cast<std::int32_t>(next_));
    draw(a, b, c);
  }
  if (next_ < triangles_.size()) return;
  stage_ = Stage::Outline;
  next_ = 0;
}

void VisibleBone::draw(const Vertex& a, const Vertex& b, const Vertex& c) {
  const float abx = b.x - a.x, aby = b.y - a.y, acx = c.x - a.x, acy = c.y - a.y;
  const float area = abx * acy - aby * acx;
  if (std::abs(area) < 1e-6f) return;
  const int x0 = std::max(0, static_cast<int>(std::ceil(std::min({a.x, b.x, c.x})))),
            x1 = std::min(depths_.width - 1, static_cast<int>(std::floor(std::max({a.x, b.x, c.x})))),
            y0 = std::max(0, static_cast<int>(std::ceil(std::min({a.y, b.y, c.y})))),
            y1 = std::min(depths_.height - 1, static_cast<int>(std::floor(std::max({a.y, b.y, c.y}))));
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      const float px = static_cast<float>(x) - a.x, py = static_cast<float>(y) - a.y;
      const float share_b = (px * acy - py * acx) / area, share_c = (abx * py - aby * px) / area;
      if (share_b < 0 || share_c < 0 || share_b + share_c > 1) continue;
      float& cell = depths_.mm[static_cast<std::size_t>(y) * static_cast<std::size_t>(depths_.width) +
                               static_cast<std::size_t>(x)];
      cell = std::min(cell,
                      a.depth_mm + share_b * (b.depth_mm - a.depth_mm) + share_c * (c.depth_mm - a.depth_mm));
    }
  }
}

bool VisibleBone::is_well_inside(const Eigen::Vector2d& pixel) const {
  const camera::Boundary& rim = camera_.boundary();
  return camera_.is_inside_view(pixel) &&
         (rim.radius_px <= 0 || (pixel - rim.center_px).norm() < rim.radius_px - kRim_px);
}

// Nothing before it, and what lies beside it clearly further off.
bool VisibleBone::occludes(const ContourPoint& point) const {
  const auto pixel_at = [&](double along_mm) {
    return camera_.project(view_ * (point.in_bone_mm + along_mm * point.normal_in_bone));
  };
  const auto at = pixel_at(0), outside = pixel_at(kBeside_mm), inside = pixel_at(-kBeside_mm);
  if (!at || !outside || !inside || !is_well_inside(*at)) return false;
  const auto depth = static_cast<float>((view_ * point.in_bone_mm).norm());
  // Inside, the surface itself comes nearer: by sqrt(2 r h) within h of the outline of a ball of radius r.
  if (std::min(depths_.at(*at / kCell_px), depths_.at(*inside / kCell_px)) < depth - kBulge_mm) return false;
  return depths_.at(*outside / kCell_px) > depth + kGap_mm;
}

void VisibleBone::collect_outline() {
  found_.clear();
  for (const std::int32_t triangle : turning_) {
    const auto& corners = triangles_[static_cast<std::size_t>(triangle)];
    // Where facing is zero on the two sides that it changes on.
    Eigen::Vector3f point = Eigen::Vector3f::Zero(), normal = Eigen::Vector3f::Zero();
    float nearer = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto from = static_cast<std::size_t>(corners[i]),
                 to = static_cast<std::size_t>(corners[(i + 1) % 3]);
      const float a = seen_[from].facing, b = seen_[to].facing;
      if ((a > 0) == (b > 0)) continue;
      const float share = a / (a - b);
      point += 0.5f * (vertices_[from] + share * (vertices_[to] - vertices_[from]));
      normal += normals_[from] + share * (normals_[to] - normals_[from]);
      nearer += (seen_[to].depth_mm - seen_[from].depth_mm) * (a > 0 ? 1.0f : -1.0f);
    }
    if (nearer <= 0) continue;  // a hollow: the part that faces the lens lies behind
    const ContourPoint candidate{point.cast<double>(), normal.cast<double>().normalized()};
    if (occludes(candidate)) found_.push_back(candidate);
  }
  points_.clear();
  const std::size_t count = std::min(found_.size(), kMostOutline);
  for (std::size_t i = 0; i < count; ++i) points_.push_back(found_[i * found_.size() / count]);
}

void VisibleBone::collect_places() {
  places_found_.clear();
  const Eigen::Vector3d eye = view_.inverse().translation_mm;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const SurfacePlace& place = places_[i];
    const Eigen::Vector3d to_eye = eye - place.in_bone_mm;
    const double depth_mm = to_eye.norm();
    if (depth_mm < kNearest_mm || depth_mm > kFurthest_mm) continue;
    if (place.normal.dot(to_eye) < kMostAslant * depth_mm) continue;
    const auto at = camera_.project(view_ * place.in_bone_mm);
    if (!at || !is_well_inside(*at)) continue;
    if (depths_.at(*at / kCell_px) < static_cast<float>(depth_mm) - kSameSurface_mm) continue;
    places_found_.push_back(static_cast<std::int32_t>(i));
  }
  places_seen_.clear();
  const std::size_t count = std::min(places_found_.size(), kMostPlaces);
  for (std::size_t i = 0; i < count; ++i)
    places_seen_.push_back(places_found_[i * places_found_.size() / count]);
}

}  // namespace arthronaut::contour
