#include "planning/segmentation/anatomy_check.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "planning/files/format.h"

namespace arthronaut::segmentation {

namespace {

using bones::BoneKind;
using Eigen::Vector3d;

// Adults of all sizes, with room: the largest sections of 60 published and own femora and tibiae lie between
// 2000 and 5000 mm^2.
constexpr double kLeastSection_mm2 = 1300, kMostSection_mm2 = 7000;
// Less of a bone, from top to bottom, is no bone to plan on; a bone that lies on its side is longer than a
// knee is wide.
constexpr double kLeastLength_mm = 30, kKneeWidth_mm = 110;
constexpr double kMostDepth_mm = 84, kMostWidth_mm = 118, kLyingDown = 1.1;
constexpr double kSectionStep_mm = 2;
// The largest section of a femur lies above its condyles' ends, of a tibia below its plateau.
constexpr double kMostBelowCondyles_mm = 48, kMostAbovePlateau_mm = 26;
// Where the condyles stand apart, above their lower end.
constexpr double kCondylesFrom_mm = 3, kCondylesTo_mm = 16;
constexpr double kLeastGap_mm = 2, kLeastCondyle_mm = 10;
// So far from its joint a bone has become a shaft.
constexpr double kShaftFrom_mm = 55;
constexpr double kShaftFraction = 0.72;

struct Section {
  double area_mm2 = 0;
  std::vector<std::array<Eigen::Vector2d, 2>> segments;
};

// The surface cut across one direction, from its lower end to its upper.
struct Sections {
  double length_mm = 0;
  std::vector<Section> all;  // at (i + 0.5) * kSectionStep_mm

  [[nodiscard]] std::size_t largest() const {
    return static_cast<std::size_t>(
        std::max_element(all.begin(), all.end(),
                         [](const Section& a, const Section& b) { return a.area_mm2 < b.area_mm2; }) -
        all.begin());
  }
  [[nodiscard]] double height_mm(std::size_t i) const {
    return (static_cast<double>(i) + 0.5) * kSectionStep_mm;
  }
  [[nodiscard]] double area_at(double height_mm) const {
    const auto i = static_cast<std::ptrdiff_t>(height_mm / kSectionStep_mm);
    return all[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i, 0, std::ssize(all) - 1))].area_mm2;
  }
};

Sections cut_across(const geometry::TriangleMesh& mesh, const Vector3d& up) {
  const Vector3d u = up.unitOrthogonal(), v = up.cross(u);
  std::vector<Vector3d> in_frame;
  in_frame.reserve(mesh.vertices_mm.size());
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Vector3d& p : mesh.vertices_mm) {
    in_frame.emplace_back(p.dot(u), p.dot(v), p.dot(up));
    low = std::min(low, in_frame.back().z());
    high = std::max(high, in_frame.back().z());
  }
  Sections sections;
  sections.length_mm = high - low;
  constexpr double kLongest_mm = 2000;
  sections.all.resize(1 +
                      static_cast<std::size_t>(std::min(sections.length_mm, kLongest_mm) / kSectionStep_mm));
  for (const auto& t : mesh.triangles) {
    std::array<Vector3d, 3> p;
    for (std::size_t c = 0; c < 3; ++c) p[c] = in_frame[static_cast<std::size_t>(t[c])];
    const auto [least, most] = std::minmax({p[0].z(), p[1].z(), p[2].z()});
    const auto first = static_cast<std::ptrdiff_t>(std::ceil((least - low) / kSectionStep_mm - 0.5)),
               last = std::min(static_cast<std::ptrdiff_t>(std::floor((most - low) / kSectionStep_mm - 0.5)),
                               std::ssize(sections.all) - 1);
    for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(first, 0); i <= last; ++i) {
      const double h = low + sections.height_mm(static_cast<std::size_t>(i));
      std::optional<Eigen::Vector2d> rising, falling;
      for (std::size_t c = 0; c < 3; ++c) {
        const Vector3d &a = p[c], &b = p[(c + 1) % 3];
        if ((a.z() < h) == (b.z() < h)) continue;
        const Vector3d at = a + (h - a.z()) / (b.z() - a.z()) * (b - a);
        (a.z() < h ? rising : falling) = at.head<2>();
      }
      if (!rising || !falling) continue;
      // Outward triangles: the inside lies to the left from `falling` to `rising`.
      Section& section = sections.all[static_cast<std::size_t>(i)];
      section.area_mm2 += 0.5 * (falling->x() * rising->y() - rising->x() * falling->y());
      section.segments.push_back({*falling, *rising});
    }
  }
  for (Section& section : sections.all) section.area_mm2 = std::abs(section.area_mm2);
  return sections;
}

// Two parts beside each other in some direction, each as wide as a condyle.
bool falls_in_two(const Section& section) {
  constexpr int kDirections = 12;
  for (int d = 0; d < kDirections; ++d) {
    const double angle = M_PI * d / kDirections;
    const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
    std::vector<std::pair<double, double>> spans;
    for (const auto& segment : section.segments) {
      const double a = along.dot(segment[0]), b = along.dot(segment[1]);
      spans.emplace_back(std::min(a, b), std::max(a, b));
    }
    std::sort(spans.begin(), spans.end());
    if (spans.empty()) continue;
    double start = spans.front().first, end = spans.front().second, first_width = -1;
    for (const auto& [from, to] : spans) {
      if (from > end + kLeastGap_mm) {
        if (first_width < kLeastCondyle_mm) first_width = end - start;
        start = from;
      }
      end = std::max(end, to);
    }
    if (first_width >= kLeastCondyle_mm && end - start >= kLeastCondyle_mm) return true;
  }
  return false;
}

// What does not fit when `up` is the bone's upward direction; empty when all does.
std::string amiss_along(const geometry::TriangleMesh& mesh, BoneKind kind, const Vector3d& up) {
  const Sections sections = cut_across(mesh, up);
  const double length = sections.length_mm;
  const std::size_t largest = sections.largest();
  const double area = sections.all[largest].area_mm2, from_below = sections.height_mm(largest),
               from_above = length - from_below;
  if (area < kLeastSection_mm2)
    return files::format("its largest section is %.0f cm\u00B2: too slender, as a fibula or a splinter",
                         area / 100);
  if (area > kMostSection_mm2)
    return files::format("its largest section is %.0f cm\u00B2: more than one bone, or not in mm",
                         area / 100);
  if (kind == BoneKind::Femur) {
    if (from_below > kMostBelowCondyles_mm)
      return files::format(
          "it goes on for %.0f mm below its widest part, where a femur ends after 15 to 40: "
          "it may hold the tibia as well, or have no condyles",
          from_below);
    bool has_condyles = false;
    for (double h = kCondylesFrom_mm; h <= std::min(kCondylesTo_mm, length); h += kSectionStep_mm)
      has_condyles =
          has_condyles || falls_in_two(sections.all[static_cast<std::size_t>(h / kSectionStep_mm)]);
    if (!has_condyles) return "no two condyles are seen at its lower end";
    if (from_above > kShaftFrom_mm && sections.area_at(length - 6) > kShaftFraction * area)
      return "it does not narrow to a shaft above the condyles";
    return "";
  }
  if (from_above > kMostAbovePlateau_mm)
    return files::format(
        "it goes on for %.0f mm above its widest part, where a tibia ends after 5 to 20: it may "
        "hold a part of the femur, or have no plateau",
        from_above);
  if (from_below > kShaftFrom_mm &&
      sections.area_at(length - from_above - kShaftFrom_mm) > kShaftFraction * area)
    return "it does not narrow to a shaft below the plateau";
  return "";
}

// Fits in a cone about the direction.
bool fits_about(const geometry::TriangleMesh& mesh, BoneKind kind, const Vector3d& axis) {
  const Vector3d u = axis.unitOrthogonal(), v = axis.cross(u);
  constexpr double kLean_rad = 0.5;
  for (int i = 0; i < 8; ++i) {
    const Vector3d lean = std::cos(M_PI / 4 * i) * u + std::sin(M_PI / 4 * i) * v;
    if (amiss_along(mesh, kind, std::cos(kLean_rad) * axis + std::sin(kLean_rad) * lean).empty()) return true;
  }
  return false;
}

// Where a scan or a cut ends a bone its surface is flat. The area of that along one direction.
double cap_area_mm2(const geometry::TriangleMesh& mesh, const Vector3d& axis) {
  constexpr double kFlat = 0.995, kAtEnd_mm = 2.5;
  double end = -std::numeric_limits<double>::infinity(), area = 0;
  for (const Vector3d& p : mesh.vertices_mm) end = std::max(end, p.dot(axis));
  for (const auto& t : mesh.triangles) {
    const Vector3d &a = mesh.vertices_mm[static_cast<std::size_t>(t[0])],
                   &b = mesh.vertices_mm[static_cast<std::size_t>(t[1])],
                   &c = mesh.vertices_mm[static_cast<std::size_t>(t[2])];
    if (a.dot(axis) < end - kAtEnd_mm) continue;
    const Vector3d normal = (b - a).cross(c - a);
    if (normal.dot(axis) > kFlat * normal.norm()) area += 0.5 * normal.norm();
  }
  return area;
}

struct Direction {
  Vector3d axis;
  const char* name;
};
const std::array<Direction, 4>& sideways() {
  static const std::array<Direction, 4> directions{{{Vector3d::UnitY(), "backwards"},
                                                    {-Vector3d::UnitY(), "forwards"},
                                                    {Vector3d::UnitX(), "to the patient's left"},
                                                    {-Vector3d::UnitX(), "to the patient's right"}}};
  return directions;
}

std::string wrong_axes(BoneKind kind, const char* name) {
  return std::string("its shaft points ") + name + ", not " + (kind == BoneKind::Femur ? "up" : "down") +
         ": the axes of the file are not the patient's (LPS); look at what wrote it";
}

}  // namespace

std::string wrong_axes_doubt(BoneKind kind, const Vector3d& shaft) {
  Direction nearest{Vector3d::UnitZ(), "up"};
  const auto is_nearer = [&](const Direction& way) { return shaft.dot(way.axis) > shaft.dot(nearest.axis); };
  if (const Direction down{-Vector3d::UnitZ(), "down"}; is_nearer(down)) nearest = down;
  for (const Direction& side : sideways())
    if (is_nearer(side)) nearest = side;
  return wrong_axes(kind, nearest.name);
}

std::vector<std::string> anatomy_doubts(const geometry::TriangleMesh& mesh, BoneKind kind,
                                        std::span<const Vector3d> image_ends) {
  if (mesh.empty()) return {"it has no surface"};
  const geometry::Bounds bounds = geometry::bounds_of(mesh);
  // However it leans or lies.
  if (const double most = bounds.size_mm().maxCoeff(), up = bounds.size_mm().z();
      most < kLeastLength_mm || (up < kLeastLength_mm && most < kKneeWidth_mm))
    return {files::format("only %.0f mm of it are there, from top to bottom: too little for a tunnel", up)};
  // The shaft's cut end tells how a bone lies, whatever shape the rest has.
  constexpr double kLeastCap_mm2 = 350, kMostOtherCap = 0.4;
  const double sign = kind == BoneKind::Femur ? 1 : -1;
  const double expected = cap_area_mm2(mesh, sign * Vector3d::UnitZ());
  const auto is_cut_at = [&](const Direction& side) {
    constexpr double kSameSide = 0.9;
    if (std::ranges::any_of(image_ends, [&](const Vector3d& out) { return out.dot(side.axis) > kSameSide; }))
      return false;
    const double cap = cap_area_mm2(mesh, side.axis);
    return cap > kLeastCap_mm2 && expected < kMostOtherCap * cap;
  };
  // No knee is so deep from front to back, or so wide, unless it lies on its side or, with its shaft cut
  // where it must be, is rolled outwards.
  const Vector3d size = bounds.size_mm();
  const bool is_deep = size.y() > kMostDepth_mm && size.y() > kLyingDown * size.z(),
             is_wide = size.x() > kMostWidth_mm && size.x() > kLyingDown * size.z();
  const auto ends_upright = [&] {
    return expected > kLeastCap_mm2 && std::none_of(sideways().begin(), sideways().end(), is_cut_at);
  };
  if ((is_deep || is_wide) && !ends_upright())
    return {wrong_axes(kind, is_deep ? "forwards or backwards" : "sideways")};
  const std::string amiss = amiss_along(mesh, kind, Vector3d::UnitZ());
  if (amiss.empty()) return {};
  // Not asked of a bone that fits upright: the end of a volume may have cut it flat in front.
  for (const Direction& side : sideways()) {
    if (is_cut_at(side) &&
        (amiss_along(mesh, kind, sign * side.axis).empty() || fits_about(mesh, kind, sign * side.axis)))
      return {wrong_axes_doubt(kind, side.axis)};
  }
  if (fits_about(mesh, kind, Vector3d::UnitZ())) return {};
  return {"it does not look like a " + std::string(bones::to_text(kind)) + ": " + amiss};
}

}  // namespace arthronaut::segmentation
