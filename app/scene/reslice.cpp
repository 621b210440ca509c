#include "app/scene/reslice.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace arthronaut::scene {

namespace {

using Eigen::Vector3d;

// Where on a row the index lies inside the volume, for one axis: at + x * step in [0, last].
void clip_row(double at, double step, double last, double& from, double& to) {
  if (std::abs(step) < 1e-12) {
    if (at < 0 || at > last) to = from - 1;
    return;
  }
  double enter = -at / step, leave = (last - at) / step;
  if (enter > leave) std::swap(enter, leave);
  from = std::max(from, enter);
  to = std::min(to, leave);
}

float trilinear(const images::Volume& volume, const Vector3d& index) {
  const auto cell = [](double at, int size, double& share) {
    const int whole = std::clamp(static_cast<int>(at), 0, std::max(size - 2, 0));
    share = std::clamp(at - whole, 0.0, 1.0);
    return whole;
  };
  double u = 0, v = 0, w = 0;
  const int i = cell(index.x(), volume.size.x(), u), j = cell(index.y(), volume.size.y(), v),
            k = cell(index.z(), volume.size.z(), w);
  const std::size_t right = volume.size.x() > 1 ? 1 : 0;
  const std::size_t row = volume.size.y() > 1 ? static_cast<std::size_t>(volume.size.x()) : 0;
  const std::size_t slice = volume.size.z() > 1 ? static_cast<std::size_t>(volume.size.x()) *
                                                      static_cast<std::size_t>(volume.size.y())
                                                : 0;
  const float* at = volume.values.data() + volume.index(i, j, k);
  const auto fu = static_cast<float>(u), fv = static_cast<float>(v), fw = static_cast<float>(w);
  const auto line = [&](const float* p) { return p[0] + fu * (p[right] - p[0]); };
  const float a = line(at), b = line(at + row), c = line(at + slice), d = line(at + row + slice);
  const float front = a + fv * (b - a), back = c + fv * (d - c);
  return front + fw * (back - front);
}

}  // namespace

Vector3d SlicePlane::point_at(const Eigen::Vector2d& pixel, const Eigen::Vector2i& size_px) const {
  const Eigen::Vector2d from_center = pixel - 0.5 * (size_px.cast<double>() - Eigen::Vector2d::Ones());
  return center_mm + mm_per_px * (from_center.x() * right + from_center.y() * down);
}

Eigen::Vector2d SlicePlane::pixel_of(const Vector3d& point_mm, const Eigen::Vector2i& size_px) const {
  const Vector3d from_center = (point_mm - center_mm) / mm_per_px;
  return 0.5 * (size_px.cast<double>() - Eigen::Vector2d::Ones()) +
         Eigen::Vector2d(from_center.dot(right), from_center.dot(down));
}

GreyWindow automatic_window(const images::Volume& volume) {
  constexpr std::size_t kLooked = 100'000;
  std::vector<float> values;
  const std::size_t step = std::max<std::size_t>(volume.values.size() / kLooked, 1);
  for (std::size_t i = 0; i < volume.values.size(); i += step) values.push_back(volume.values[i]);
  if (values.empty()) return {};
  const auto quantile = [&](double share) {
    const auto at =
        values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return static_cast<double>(*at);
  };
  const double low = quantile(0.01), high = quantile(0.995);
  return {(low + high) / 2, std::max(high - low, 1.0)};
}

GreyWindow next_window(const GreyWindow& now, const GreyWindow& automatic, images::Modality modality) {
  if (modality == images::Modality::Mr || modality == images::Modality::Other) return automatic;
  if (now == kBoneWindow) return kSoftTissueWindow;
  return now == kSoftTissueWindow ? automatic : kBoneWindow;
}

GreyWindow next_window(const GreyWindow& now, const GreyWindow& automatic, const images::Volume& volume) {
  return images::is_label_map(volume) ? automatic : next_window(now, automatic, volume.modality);
}

void reslice(const images::Volume& volume, const SlicePlane& plane, const Eigen::Vector2i& size_px,
             const GreyWindow& window, std::vector<std::uint8_t>& grey) {
  const auto width = static_cast<std::size_t>(std::max(size_px.x(), 0));
  grey.assign(width * static_cast<std::size_t>(std::max(size_px.y(), 0)), 0);
  if (volume.values.empty()) return;
  const Eigen::Affine3d index_from_lps = volume.lps_from_index.inverse();
  const Vector3d step = index_from_lps.linear() * (plane.mm_per_px * plane.right);
  const Vector3d last = (volume.size - Eigen::Vector3i::Ones()).cast<double>();
  const auto scale = static_cast<float>(255 / std::max(window.width, 1e-6));
  const auto offset = static_cast<float>(window.level - window.width / 2);
  for (int y = 0; y < size_px.y(); ++y) {
    const Vector3d start = index_from_lps * plane.point_at({0, y}, size_px);
    double from = 0, to = size_px.x() - 1;
    for (int axis = 0; axis < 3; ++axis) clip_row(start[axis], step[axis], last[axis], from, to);
    std::uint8_t* row = grey.data() + static_cast<std::size_t>(y) * width;
    for (int x = static_cast<int>(std::ceil(from - 1e-9)); x <= std::floor(to + 1e-9); ++x) {
      const float value = (trilinear(volume, start + x * step) - offset) * scale;
      row[x] = static_cast<std::uint8_t>(std::clamp(value, 0.F, 255.F) + 0.5F);
    }
  }
}

std::optional<double> value_at(const images::Volume& volume, const Vector3d& point_mm) {
  const Vector3d index = volume.lps_from_index.inverse() * point_mm;
  const Vector3d last = (volume.size - Eigen::Vector3i::Ones()).cast<double>();
  if (volume.values.empty() || (index.array() < -1e-9).any() || (index.array() > last.array() + 1e-9).any())
    return std::nullopt;
  return trilinear(volume, index.cwiseMax(0).cwiseMin(last));
}

std::vector<std::pair<Vector3d, Vector3d>> outline_of(const geometry::TriangleMesh& mesh,
                                                      const Vector3d& point_mm, const Vector3d& normal) {
  std::vector<float> side(mesh.vertices_mm.size());
  const double offset = normal.dot(point_mm);
  for (std::size_t i = 0; i < side.size(); ++i)
    side[i] = static_cast<float>(normal.dot(mesh.vertices_mm[i]) - offset);
  std::vector<std::pair<Vector3d, Vector3d>> segments;
  for (const auto& triangle : mesh.triangles) {
    std::array<std::size_t, 3> v{};
    int above = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      v[k] = static_cast<std::size_t>(triangle[k]);
      above += side[v[k]] > 0 ? 1 : 0;
    }
    if (above == 0 || above == 3) continue;
    // The corner that stands alone on its side: both of its edges are crossed.
    std::size_t alone = 0;
    while ((side[v[alone]] > 0) != (above == 1)) ++alone;
    const auto crossing = [&](std::size_t other) -> Vector3d {
      const double a = side[v[alone]], b = side[v[other]];
      return mesh.vertices_mm[v[alone]] +
             a / (a - b) * (mesh.vertices_mm[v[other]] - mesh.vertices_mm[v[alone]]);
    };
    segments.emplace_back(crossing((alone + 1) % 3), crossing((alone + 2) % 3));
  }
  return segments;
}

std::string orientation_letters(const Vector3d& direction) {
  struct Part {
    double size;
    char letter;
  };
  std::array<Part, 3> parts{Part{std::abs(direction.x()), direction.x() > 0 ? 'L' : 'R'},
                            Part{std::abs(direction.y()), direction.y() > 0 ? 'P' : 'A'},
                            Part{std::abs(direction.z()), direction.z() > 0 ? 'H' : 'F'}};
  std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.size > b.size; });
  constexpr double kOblique = 0.342;  // sin 20 degrees
  std::string letters(1, parts[0].letter);
  for (std::size_t i = 1; i < 3; ++i)
    if (parts[i].size > kOblique * direction.norm()) letters += parts[i].letter;
  return letters;
}

}  // namespace arthronaut::scene
