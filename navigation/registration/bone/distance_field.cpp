#include "navigation/registration/bone/distance_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "planning/geometry/error.h"
#include "planning/geometry/triangle_distance.h"

namespace arthronaut::registration {

namespace {

using geometry::TriangleMesh;

std::array<Eigen::Vector3d, 3> corners_of(const TriangleMesh& mesh, std::int32_t triangle) {
  const auto& indices = mesh.triangles[static_cast<std::size_t>(triangle)];
  return {mesh.vertices_mm[static_cast<std::size_t>(indices[0])],
          mesh.vertices_mm[static_cast<std::size_t>(indices[1])],
          mesh.vertices_mm[static_cast<std::size_t>(indices[2])]};
}

// Finds each node's nearest triangle: exactly beside the surface, then outwards from node to node in order of
// distance, each node trying its neighbour's triangle. Nodes beyond the band are never touched.
class NearestTriangles {
 public:
  NearestTriangles(const TriangleMesh& mesh, const Eigen::Vector3d& origin_mm, double spacing_mm,
                   const Eigen::Vector3i& size, double band_mm)
      : mesh_(mesh),
        origin_mm_(origin_mm),
        spacing_mm_(spacing_mm),
        size_(size),
        buckets_(static_cast<std::size_t>(band_mm / bucket_mm()) + 2) {
    const auto count = static_cast<std::size_t>(size.x()) * static_cast<std::size_t>(size.y()) *
                       static_cast<std::size_t>(size.z());
    squared_mm2_.assign(count, std::numeric_limits<float>::max());
    triangle_.assign(count, -1);
  }

  void run() {
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) seed(static_cast<std::int32_t>(t));
    for (std::size_t i = 0; i < triangle_.size(); ++i) {
      if (triangle_[i] >= 0) push(i);
    }
    for (std::size_t b = 0; b < buckets_.size(); ++b) {
      for (std::size_t k = 0; k < buckets_[b].size(); ++k) spread(buckets_[b][k], b);
      buckets_[b] = {};
    }
  }

  [[nodiscard]] std::int32_t triangle_at(std::size_t node) const { return triangle_[node]; }
  [[nodiscard]] Eigen::Vector3d position_mm(std::size_t node) const {
    const auto nx = static_cast<std::size_t>(size_.x()), ny = static_cast<std::size_t>(size_.y());
    return origin_mm_ + spacing_mm_ * Eigen::Vector3d(static_cast<double>(node % nx),
                                                      static_cast<double>(node / nx % ny),
                                                      static_cast<double>(node / nx / ny));
  }

 private:
  [[nodiscard]] double bucket_mm() const { return 0.25 * spacing_mm_; }

  void push(std::size_t node) {
    const auto bucket = static_cast<std::size_t>(std::sqrt(squared_mm2_[node]) / bucket_mm());
    if (bucket < buckets_.size()) buckets_[bucket].push_back(static_cast<std::uint32_t>(node));
  }

  bool offer(std::size_t node, std::int32_t triangle) {
    const double squared =
        geometry::nearest_on_triangle(position_mm(node), corners_of(mesh_, triangle)).squared_mm2;
    if (squared >= squared_mm2_[node]) return false;
    squared_mm2_[node] = static_cast<float>(squared);
    triangle_[node] = triangle;
    return true;
  }

  void seed(std::int32_t triangle) {
    const auto corners = corners_of(mesh_, triangle);
    const Eigen::Vector3d low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
    const Eigen::Vector3d high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
    const Eigen::Vector3i first = (((low - origin_mm_) / spacing_mm_).array() - 0.5).ceil().cast<int>();
    const Eigen::Vector3i last = (((high - origin_mm_) / spacing_mm_).array() + 0.5).floor().cast<int>();
    for (int z = first.z(); z <= last.z(); ++z) {
      for (int y = first.y(); y <= last.y(); ++y) {
        for (int x = first.x(); x <= last.x(); ++x) offer(index(x, y, z), triangle);
      }
    }
  }

  void spread(std::uint32_t node, std::size_t bucket) {
    const auto nearest = static_cast<std::size_t>(std::sqrt(squared_mm2_[node]) / bucket_mm());
    if (nearest < bucket) return;  // was found nearer since, and has been spread then
    const auto nx = static_cast<std::uint32_t>(size_.x()), ny = static_cast<std::uint32_t>(size_.y()),
               nz = static_cast<std::uint32_t>(size_.z());
    const std::uint32_t x = node % nx, y = node / nx % ny, z = node / nx / ny;
    const std::int32_t triangle = triangle_[node];
    const auto try_node = [&](bool exists, std::size_t neighbour) {
      if (exists && triangle_[neighbour] != triangle && offer(neighbour, triangle)) push(neighbour);
    };
    try_node(x > 0, node - 1);
    try_node(x + 1 < nx, node + 1);
    try_node(y > 0, node - nx);
    try_node(y + 1 < ny, node + nx);
    try_node(z > 0, node - std::size_t{nx} * ny);
    try_node(z + 1 < nz, node + std::size_t{nx} * ny);
  }

  [[nodiscard]] std::size_t index(int x, int y, int z) const {
    return static_cast<std::size_t>(x) +
           static_cast<std::size_t>(size_.x()) *
               (static_cast<std::size_t>(y) +
                static_cast<std::size_t>(size_.y()) * static_cast<std::size_t>(z));
  }

  const TriangleMesh& mesh_;
  Eigen::Vector3d origin_mm_;
  double spacing_mm_;
  Eigen::Vector3i size_;
  std::vector<float> squared_mm2_;
  std::vector<std::int32_t> triangle_;
  std::vector<std::vector<std::uint32_t>> buckets_;  // nodes by distance
};

}  // namespace

DistanceField::DistanceField(const TriangleMesh& mesh, const DistanceFieldOptions& options)
    : spacing_mm_(options.spacing_mm), band_mm_(options.band_mm) {
  if (mesh.empty()) throw InvalidInput("the bone's mesh has no triangles");
  for (const Eigen::Vector3d& vertex : mesh.vertices_mm) {
    if (!vertex.allFinite()) throw InvalidInput("the bone's mesh holds a number that is not finite");
  }
  const geometry::Bounds bounds = geometry::bounds_of(mesh);
  const Eigen::Vector3d size_mm = bounds.size_mm().array() + 2 * band_mm_;
  spacing_mm_ =
      std::max(spacing_mm_, std::cbrt(size_mm.prod() / static_cast<double>(options.max_node_count)));
  origin_mm_ = bounds.min_mm.array() - band_mm_ - spacing_mm_;
  size_ = (size_mm / spacing_mm_).array().ceil().cast<int>() + 3;

  NearestTriangles nearest(mesh, origin_mm_, spacing_mm_, size_, band_mm_);
  nearest.run();
  const geometry::PseudoNormals normals(mesh);
  nodes_.resize(static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y()) *
                static_cast<std::size_t>(size_.z()));
  const auto saturated = static_cast<std::int16_t>(std::lround(band_mm_ / kStep_mm));
  // Each row starts outside; beyond the band the sign is that of the last node before.
  const auto row_length = static_cast<std::size_t>(size_.x());
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const std::int16_t before = i % row_length == 0 ? saturated : nodes_[i - 1];
    nodes_[i] = before < 0 ? static_cast<std::int16_t>(-saturated) : saturated;
    const std::int32_t triangle = nearest.triangle_at(i);
    if (triangle < 0) continue;
    const Eigen::Vector3d position = nearest.position_mm(i);
    const geometry::NearestOnTriangle found =
        geometry::nearest_on_triangle(position, corners_of(mesh, triangle));
    const bool inside = (position - found.point_mm).dot(normals.at(triangle, found.part)) < 0;
    const double distance_mm = std::min(std::sqrt(found.squared_mm2), band_mm_);
    nodes_[i] = static_cast<std::int16_t>(std::lround((inside ? -distance_mm : distance_mm) / kStep_mm));
  }
}

DistanceField::DistanceField(ByteReader& bytes) {
  for (int axis = 0; axis < 3; ++axis) origin_mm_[axis] = bytes.read<double>();
  for (int axis = 0; axis < 3; ++axis) size_[axis] = bytes.read<std::int32_t>();
  spacing_mm_ = bytes.read<double>();
  band_mm_ = bytes.read<double>();
  nodes_ = bytes.read_many<std::int16_t>();
  const bool is_grid = (size_.array() > 1).all() && spacing_mm_ > 0 && band_mm_ > 0;
  if (!is_grid ||
      std::uint64_t{nodes_.size()} != static_cast<std::uint64_t>(size_.cast<std::int64_t>().prod())) {
    throw InvalidInput("no distance field");
  }
}

void DistanceField::write_to(ByteWriter& bytes) const {
  for (int axis = 0; axis < 3; ++axis) bytes.write(origin_mm_[axis]);
  for (int axis = 0; axis < 3; ++axis) bytes.write(std::int32_t{size_[axis]});
  bytes.write(spacing_mm_);
  bytes.write(band_mm_);
  bytes.write(nodes_);
}

CoarseDistanceField::CoarseDistanceField(const DistanceField& field) {
  constexpr double kMaxNodes = 4e6;
  const double spacing_mm = std::max(1.0, std::cbrt(field.size_mm().prod() / kMaxNodes));
  nodes_per_mm_ = static_cast<float>(1 / spacing_mm);
  step_mm_ = static_cast<float>(field.band_mm() / 127);
  origin_mm_ = field.origin_mm().cast<float>();
  size_ = (field.size_mm() / spacing_mm).array().floor().cast<int>() + 1;
  nodes_.reserve(static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y()) *
                 static_cast<std::size_t>(size_.z()));
  for (int z = 0; z < size_.z(); ++z) {
    for (int y = 0; y < size_.y(); ++y) {
      for (int x = 0; x < size_.x(); ++x) {
        const Eigen::Vector3d node = field.origin_mm() + spacing_mm * Eigen::Vector3d(x, y, z);
        nodes_.push_back(
            static_cast<std::int8_t>(std::lround(field.sample(node).distance_mm / field.band_mm() * 127)));
      }
    }
  }
}

}  // namespace arthronaut::registration
