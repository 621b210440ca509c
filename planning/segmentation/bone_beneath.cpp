#include "planning/segmentation/bone_beneath.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "planning/files/format.h"
#include "planning/geometry/quantile.h"
#include "planning/images/volume_sampler.h"

namespace arthronaut::segmentation {

namespace {

using Eigen::Vector3d;
using Outcome = BoneBeneath::Outcome;

constexpr double kStep_mm = 0.5;
// Muscle is below 80 HU, with its noise averaged; a cortex or its subchondral plate, blurred by thick slices,
// above.
constexpr double kDeepestCt_mm = 3.0, kLeastBone_hu = 150;
// Beneath the cortex, which is dark in an MR whatever lies within it.
constexpr double kMarrowFrom_mm = 2.0, kMarrowTo_mm = 4.0;
// Of the marrow's grey: what differs by less is marrow; and the spread of what remains, as a sigma, above
// which nothing can be told.
constexpr double kLeastOff = 0.35, kLeastOffOfSigma = 3.0, kMostSpread = 0.2;
constexpr double kSigmaOfMedian = 1.4826;
// Outside of the bone: what is as bright as marrow there, as fat is, would be as bright in a leak.
constexpr double kOutsideFrom_mm = 1.5, kOutsideTo_mm = 3.0, kMostAlike = 0.1;
// Flat ends: so near to the end along an axis of the images, and facing along it.
constexpr double kAtEnd_mm = 3.0, kFacing = 0.9;
// Values are averaged over neighbours so often: some 2 mm of a surface of 1 mm edges.
constexpr int kSmoothings = 4;
constexpr std::size_t kFewest = 200;

struct Vertices {
  std::vector<Vector3d> normals;
  std::vector<double> areas_mm2;
  std::vector<std::vector<std::int32_t>> neighbours;
};

Vertices vertices_of(const geometry::TriangleMesh& mesh) {
  Vertices vertices{geometry::vertex_normals(mesh), std::vector<double>(mesh.vertices_mm.size()),
                    std::vector<std::vector<std::int32_t>>(mesh.vertices_mm.size())};
  for (const auto& t : mesh.triangles) {
    const Vector3d& a = mesh.vertices_mm[static_cast<std::size_t>(t[0])];
    const double area = 0.5 * (mesh.vertices_mm[static_cast<std::size_t>(t[1])] - a)
                                  .cross(mesh.vertices_mm[static_cast<std::size_t>(t[2])] - a)
                                  .norm();
    for (std::size_t c = 0; c < 3; ++c) {
      vertices.areas_mm2[static_cast<std::size_t>(t[c])] += area / 3;
      vertices.neighbours[static_cast<std::size_t>(t[c])].push_back(t[(c + 1) % 3]);
    }
  }
  return vertices;
}

// Where the bone is cut off, by the images or by whoever painted it.
std::vector<bool> flat_ends(const geometry::TriangleMesh& mesh, const Vertices& vertices,
                            const images::Volume& images) {
  std::vector<bool> is_end(mesh.vertices_mm.size(), false);
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {-1.0, 1.0}) {
      const Vector3d along = sign * images.lps_from_index.linear().col(axis).normalized();
      double end = -1e300;
      for (const Vector3d& p : mesh.vertices_mm) end = std::max(end, p.dot(along));
      for (std::size_t v = 0; v < is_end.size(); ++v)
        is_end[v] = is_end[v] || (mesh.vertices_mm[v].dot(along) > end - kAtEnd_mm &&
                                  vertices.normals[v].dot(along) > kFacing);
    }
  return is_end;
}

// A value of each vertex, not a number where there is none, averaged over its neighbours.
void smooth(std::vector<double>& values, const Vertices& vertices) {
  std::vector<double> before;
  for (int i = 0; i < kSmoothings; ++i) {
    before = values;
    for (std::size_t v = 0; v < values.size(); ++v) {
      if (!std::isfinite(before[v])) continue;
      double sum = before[v];
      int count = 1;
      for (const std::int32_t next : vertices.neighbours[v])
        if (const double value = before[static_cast<std::size_t>(next)]; std::isfinite(value)) {
          sum += value;
          ++count;
        }
      values[v] = sum / count;
    }
  }
}

// The densest of what lies beneath, noise averaged along the profile.
double densest(const images::VolumeSampler& grey, const Vector3d& at_mm, const Vector3d& inward) {
  double most = -1e300;
  for (double depth = 0; depth + 2 * kStep_mm <= kDeepestCt_mm + 1e-9; depth += kStep_mm) {
    double sum = 0;
    for (int i = 0; i < 3; ++i) sum += grey.at(at_mm + (depth + i * kStep_mm) * inward);
    if (!std::isfinite(sum)) return geometry::kNotKnown;
    most = std::max(most, sum / 3);
  }
  return most;
}

double mean_along(const images::VolumeSampler& grey, const Vector3d& at_mm, const Vector3d& along,
                  double from_mm, double to_mm) {
  double sum = 0;
  int count = 0;
  for (double depth = from_mm; depth <= to_mm + 1e-9; depth += kStep_mm, ++count)
    sum += grey.at(at_mm + depth * along);
  return sum / count;  // not a number beyond the images
}

// The marrow's grey at a place: a plane, as a coil that is nearer to one side leaves it.
struct Field {
  Vector3d center_mm = Vector3d::Zero();
  Eigen::Vector4d plane = Eigen::Vector4d::Zero();
  double spread = 0;  // of what belongs to it, as a sigma and a share of it
  [[nodiscard]] static Eigen::Vector4d row(const Vector3d& p) { return {1, p.x(), p.y(), p.z()}; }
  // How far a value there is off, as a share; not a number where there is none, or no plane.
  [[nodiscard]] double off(double value, const Vector3d& at_mm) const {
    const double expected = plane.dot(row(at_mm - center_mm));
    return expected > 0 ? value / expected - 1 : geometry::kNotKnown;
  }
  [[nodiscard]] double most_off() const { return std::max(kLeastOff, kLeastOffOfSigma * spread); }
};

// Fitted to those of the values that belong together; those of a leak, fewer, do not.
Field field_through(const std::vector<Vector3d>& places_mm, const std::vector<double>& values) {
  std::vector<double> known = values;
  std::erase_if(known, [](double value) { return !std::isfinite(value); });
  Field field;
  for (const Vector3d& place : places_mm) field.center_mm += place / static_cast<double>(places_mm.size());
  field.plane[0] = geometry::median(std::move(known));
  constexpr int kRounds = 6;
  constexpr double kBelongs = 2.5;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<double> sizes;
    for (std::size_t v = 0; v < values.size(); ++v)
      if (const double off = field.off(values[v], places_mm[v]); std::isfinite(off))
        sizes.push_back(std::abs(off));
    field.spread = kSigmaOfMedian * geometry::median(std::move(sizes));
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    for (std::size_t v = 0; v < values.size(); ++v) {
      if (!(std::abs(field.off(values[v], places_mm[v])) <= kBelongs * field.spread)) continue;
      const Eigen::Vector4d row = Field::row(places_mm[v] - field.center_mm);
      normal += row * row.transpose();
      right += values[v] * row;
    }
    const Eigen::Vector4d plane = normal.ldlt().solve(right);
    if (!plane.allFinite()) break;
    field.plane = plane;
  }
  return field;
}

// Of what is known of the surroundings: the share that is as bright as the marrow.
double share_alike(const geometry::TriangleMesh& mesh, const Vertices& vertices,
                   const images::VolumeSampler& grey, const Field& field) {
  std::size_t alike = 0, known = 0;
  for (std::size_t v = 0; v < mesh.vertices_mm.size(); ++v) {
    const double off =
        field.off(mean_along(grey, mesh.vertices_mm[v], vertices.normals[v], kOutsideFrom_mm, kOutsideTo_mm),
                  mesh.vertices_mm[v]);
    if (!std::isfinite(off)) continue;
    ++known;
    if (std::abs(off) <= field.most_off()) ++alike;
  }
  return known > 0 ? static_cast<double>(alike) / static_cast<double>(known) : 1;
}

// The largest patch of those without bone.
void measure_patch(const geometry::TriangleMesh& mesh, const Vertices& vertices,
                   const std::vector<bool>& is_without, BoneBeneath& found) {
  std::vector<bool> was_seen(is_without.size(), false);
  std::vector<std::size_t> waiting;
  for (std::size_t first = 0; first < is_without.size(); ++first) {
    if (!is_without[first] || was_seen[first]) continue;
    double area_mm2 = 0;
    Vector3d sum = Vector3d::Zero();
    was_seen[first] = true;
    waiting.assign(1, first);
    while (!waiting.empty()) {
      const std::size_t v = waiting.back();
      waiting.pop_back();
      area_mm2 += vertices.areas_mm2[v];
      sum += vertices.areas_mm2[v] * mesh.vertices_mm[v];
      for (const std::int32_t next : vertices.neighbours[v]) {
        const auto n = static_cast<std::size_t>(next);
        if (!is_without[n] || was_seen[n]) continue;
        was_seen[n] = true;
        waiting.push_back(n);
      }
    }
    if (area_mm2 / 100 <= found.area_cm2) continue;
    found.area_cm2 = area_mm2 / 100;
    found.center_mm = sum / area_mm2;
  }
}

// On which sides of the bone's middle, along the patient's axes.
std::string place_of(const Vector3d& at_mm, const geometry::Bounds& bone) {
  constexpr double kAside = 1.0 / 3;  // of half the bone
  constexpr std::array<std::array<const char*, 2>, 3> kSides{
      {{"on the patient's right", "on the patient's left"}, {"in front", "behind"}, {"below", "above"}}};
  const Vector3d share = (at_mm - bone.center_mm()).cwiseQuotient(0.5 * bone.size_mm());
  std::string words;
  for (const std::size_t axis : {1U, 0U, 2U}) {
    const double along = share[static_cast<Eigen::Index>(axis)];
    if (std::abs(along) > kAside) words += (words.empty() ? "" : ", ") + std::string(kSides[axis][along > 0]);
  }
  return words.empty() ? "in its middle" : words;
}

BoneBeneath not_checked(std::string reason) {
  BoneBeneath found;
  found.reason = std::move(reason);
  return found;
}

}  // namespace

BoneBeneath bone_beneath(const geometry::TriangleMesh& surface, const images::Volume& images) {
  if (surface.empty()) return not_checked("there is no surface");
  const bool is_ct = images.modality == images::Modality::Ct;
  if (images.modality == images::Modality::Other) return not_checked("the images are neither CT nor MR");
  const Vertices vertices = vertices_of(surface);
  const std::vector<bool> is_end = flat_ends(surface, vertices, images);
  const images::VolumeSampler grey(images);
  std::vector<double> values(surface.vertices_mm.size(), geometry::kNotKnown);
  for (std::size_t v = 0; v < values.size(); ++v) {
    if (is_end[v]) continue;
    const Vector3d inward = -vertices.normals[v];
    values[v] = is_ct ? densest(grey, surface.vertices_mm[v], inward)
                      : mean_along(grey, surface.vertices_mm[v], inward, kMarrowFrom_mm, kMarrowTo_mm);
  }
  if (std::count_if(values.begin(), values.end(), [](double value) { return std::isfinite(value); }) <
      static_cast<std::ptrdiff_t>(kFewest))
    return not_checked("too little of the surface lies within the images");
  smooth(values, vertices);
  std::vector<bool> is_without(values.size(), false);
  std::string blind;  // why a leak might not be seen
  if (is_ct) {
    for (std::size_t v = 0; v < values.size(); ++v) is_without[v] = values[v] < kLeastBone_hu;
  } else {
    const Field field = field_through(surface.vertices_mm, values);
    if (!(field.spread <= kMostSpread))
      return not_checked(files::format(
          "the grey values beneath the surface vary by %.0f %%, so that a leak would not stand out",
          100 * field.spread));
    for (std::size_t v = 0; v < values.size(); ++v)
      is_without[v] = std::abs(field.off(values[v], surface.vertices_mm[v])) > field.most_off();
    if (const double alike = share_alike(surface, vertices, grey, field); alike > kMostAlike)
      blind = files::format(
          "%.0f %% of what surrounds the bone is as bright as its marrow, as fat is: a leak "
          "into it would not stand out",
          100 * alike);
  }
  BoneBeneath found = not_checked(blind);
  measure_patch(surface, vertices, is_without, found);
  if (found.area_cm2 >= kLeastLeak_cm2) {
    found.outcome = Outcome::NotEverywhere;
    found.reason = place_of(found.center_mm, geometry::bounds_of(surface));
  } else if (blind.empty()) {
    found.outcome = Outcome::Everywhere;
  }
  return found;
}

}  // namespace arthronaut::segmentation
