#include "app/scene/notch_cut.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace arthronaut::scene {

namespace {

// How far into the distal end a condyle reaches, and the slices that it is looked at in.
constexpr double kCondyles_mm = 35, kSlice_mm = 1.5;

// The middle of the notch along the lateral axis, from the shape alone.
double notch_at(const geometry::TriangleMesh& femur, const landmarks::AnatomicalAxes& axes) {
  double distal = std::numeric_limits<double>::infinity();
  for (const auto& vertex : femur.vertices_mm) distal = std::min(distal, vertex.dot(axes.proximal));
  double medial = std::numeric_limits<double>::infinity(), lateral = -medial, anterior = 0;
  std::size_t count = 0;
  for (const auto& vertex : femur.vertices_mm) {
    if (vertex.dot(axes.proximal) > distal + kCondyles_mm) continue;
    medial = std::min(medial, vertex.dot(axes.lateral));
    lateral = std::max(lateral, vertex.dot(axes.lateral));
    anterior += vertex.dot(axes.anterior);
    ++count;
  }
  anterior /= static_cast<double>(count);
  // The lowest bone of each slice of the middle half, behind the trochlea: the condyles, and between them the
  // roof.
  const double from = medial + 0.25 * (lateral - medial), to = lateral - 0.25 * (lateral - medial);
  std::vector<double> lowest(static_cast<std::size_t>(std::max((to - from) / kSlice_mm, 1.0)) + 1,
                             std::numeric_limits<double>::infinity());
  for (const auto& vertex : femur.vertices_mm) {
    const double at = vertex.dot(axes.lateral), height = vertex.dot(axes.proximal);
    if (at < from || at > to || height > distal + kCondyles_mm || vertex.dot(axes.anterior) > anterior)
      continue;
    double& slice = lowest[static_cast<std::size_t>((at - from) / kSlice_mm)];
    slice = std::min(slice, height);
  }
  double roof = -std::numeric_limits<double>::infinity();
  for (const double height : lowest)
    if (height < std::numeric_limits<double>::infinity()) roof = std::max(roof, height);
  double first = 0, last = 0;
  bool is_open = false;
  for (std::size_t i = 0; i < lowest.size(); ++i) {
    if (!(lowest[i] > roof - 3)) continue;
    const double middle = from + (static_cast<double>(i) + 0.5) * kSlice_mm;
    if (!is_open) first = middle;
    last = middle;
    is_open = true;
  }
  return is_open ? (first + last) / 2 : (medial + lateral) / 2;
}

}  // namespace

std::optional<CutPlane> notch_cut(const geometry::TriangleMesh& femur, const landmarks::AnatomicalAxes& axes,
                                  const landmarks::Landmarks& landmarks) {
  if (femur.vertices_mm.empty()) return std::nullopt;
  const auto apex = landmarks.find("notch_apex");
  if (apex != landmarks.end()) return CutPlane{apex->second, -axes.lateral};
  const Eigen::Vector3d somewhere = femur.vertices_mm.front();
  const Eigen::Vector3d point =
      somewhere + (notch_at(femur, axes) - somewhere.dot(axes.lateral)) * axes.lateral;
  return CutPlane{point, -axes.lateral};
}

}  // namespace arthronaut::scene
