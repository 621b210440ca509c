#include "planning/segmentation/dark_rim.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <queue>

#include "planning/geometry/error.h"
#include "planning/geometry/quantile.h"
#include "planning/images/contour.h"
#include "planning/images/volume_sampler.h"
#include "planning/images/voxel_mask.h"
#include "planning/segmentation/box_blur.h"

namespace arthronaut::segmentation {

namespace {

using Eigen::Vector3d;

// A profile runs from so deep inside to so far outside, in steps.
constexpr double kStep_mm = 0.25;
constexpr int kInside = 12, kOutside = 16;
// The marrow is what lies deeper than this; the rim begins at most so deep within the border, and at most so
// far outside of it: what is dark further out (a meniscus beyond its cartilage) is not the bone's.
constexpr int kMarrow = 5, kDeepest = 4, kBeginsWithin = 4;
// Of the marrow's grey: what is as dark as cortex (muscle and cartilage are brighter in most sequences), and
// by how much what lies beyond is brighter; and of the noise of a profile.
constexpr float kDark = 0.45F, kLeastRise = 0.15F, kLeastRiseOfNoise = 4;
// From where it has risen so much it goes on rising for so long: the scanner's blur.
constexpr std::size_t kStillRising = 3;
// Normals, and what profiles say, are taken over so much of the border.
constexpr double kNormalRadius_mm = 1.0, kThicknessRadius_mm = 1.5;
// Thicker is no cortex: in mm, and of what is usual about this bone.
constexpr double kThickest_mm = 4.0, kThickest = 1.8;

bool may_be_mr(const images::Volume& volume) {
  return volume.modality == images::Modality::Mr || volume.modality == images::Modality::Unknown;
}

// Grey values between the voxels, and how noisy a value of a profile is.
struct Grey {
  images::VolumeSampler sampler;
  float noise = 0;

  explicit Grey(const images::Volume& volume) : sampler(volume) {
    std::vector<float> differences;
    const std::size_t stride = std::max<std::size_t>(1, volume.values.size() / 100000);
    for (std::size_t v = 0; v + 1 < volume.values.size(); v += stride)
      differences.push_back(std::abs(volume.values[v + 1] - volume.values[v]));
    // Of normal noise; the mean of three values beside each other, which share voxels, has half of it.
    constexpr float kSigmaOfMedian = 0.954F, kOfThree = 0.5F;
    if (!differences.empty())
      noise = kOfThree * geometry::median_in_place(std::span(differences)) / kSigmaOfMedian;
  }
};

struct Profile {
  bool is_dark_outside = false;     // at once: rim or tendon
  std::optional<double> edge_mm{};  // outwards from the start to the rim's outer edge; nullopt: no rim
};

// outward: unit.
Profile profile_at(const Grey& grey, const Vector3d& start_mm, const Vector3d& outward) {
  constexpr std::size_t kCount = kInside + kOutside + 1;
  std::array<float, kCount> raw{}, values{};
  for (std::size_t s = 0; s < kCount; ++s) {
    const double value = grey.sampler.at(start_mm + (static_cast<double>(s) - kInside) * kStep_mm * outward);
    if (!std::isfinite(value)) return {};
    raw[s] = static_cast<float>(value);
  }
  float marrow = 0;
  for (std::size_t s = 0; s < kCount; ++s) {
    const std::size_t low = s > 0 ? s - 1 : 0, high = std::min(kCount - 1, s + 1);
    float sum = 0;
    for (std::size_t i = low; i <= high; ++i) sum += raw[i];
    values[s] = sum / static_cast<float>(high - low + 1);
    if (s <= kInside - kMarrow) marrow += raw[s] / (kInside - kMarrow + 1);
  }
  if (!(marrow > 0)) return {};
  const float dark = kDark * marrow, rise = std::max(kLeastRise * marrow, kLeastRiseOfNoise * grey.noise);
  std::size_t least = kInside - kDeepest;
  while (least <= kInside + kBeginsWithin && values[least] > dark) ++least;
  if (least > kInside + kBeginsWithin) return {};
  Profile profile;
  profile.is_dark_outside = values[kInside + 2] <= dark;
  std::size_t risen = least;
  for (; risen < kCount && values[risen] < values[least] + rise; ++risen)
    if (values[risen] < values[least]) least = risen;
  if (risen == kCount) return profile;
  const float beyond = *std::max_element(
      values.begin() + static_cast<std::ptrdiff_t>(risen),
      values.begin() + static_cast<std::ptrdiff_t>(std::min(kCount, risen + kStillRising + 1)));
  const float half = 0.5F * (values[least] + beyond);
  std::size_t s = least;
  while (values[s + 1] < half) ++s;
  const float part = (half - values[s]) / (values[s + 1] - values[s]);
  profile.edge_mm = (static_cast<double>(s) + static_cast<double>(part) - kInside) * kStep_mm;
  return profile;
}

DarkRim rim_of(std::vector<double> edges_mm, std::size_t asked) {
  DarkRim rim;
  std::erase_if(edges_mm, [](double edge) { return !(edge > 0); });
  if (asked == 0 || edges_mm.empty()) return rim;
  rim.share = static_cast<double>(edges_mm.size()) / static_cast<double>(asked);
  rim.thickness_mm = geometry::median(std::move(edges_mm));
  return rim;
}

struct BorderVoxel {
  std::size_t voxel = 0;
  Profile profile;
};

// The label's voxels beside others, but for those at the volume's own border, where it is cut off.
std::vector<BorderVoxel> border_of(const Labels& labels, const images::Volume& volume, const Grey& grey,
                                   std::uint8_t label) {
  images::Field soft;
  soft.size = volume.size;
  soft.values.assign(labels.size(), 0.0F);
  for (std::size_t v = 0; v < labels.size(); ++v) soft.values[v] = labels[v] == label ? 1.0F : 0.0F;
  blur_with_box(soft, volume.spacing_mm(), kNormalRadius_mm);
  const Eigen::Matrix3d index_from_mm = volume.lps_from_index.linear().inverse();
  const auto nx = static_cast<std::size_t>(volume.size.x()),
             plane = nx * static_cast<std::size_t>(volume.size.y());
  std::vector<BorderVoxel> border;
  for (int k = 1; k + 1 < volume.size.z(); ++k) {
    for (int j = 1; j + 1 < volume.size.y(); ++j) {
      for (int i = 1; i + 1 < volume.size.x(); ++i) {
        const std::size_t v = volume.index(i, j, k);
        if (labels[v] != label) continue;
        bool is_border = false;
        images::for_each_neighbour(volume.size, v,
                                   [&](std::size_t next) { is_border = is_border || labels[next] != label; });
        if (!is_border) continue;
        const Vector3d gradient(soft.values[v + 1] - soft.values[v - 1],
                                soft.values[v + nx] - soft.values[v - nx],
                                soft.values[v + plane] - soft.values[v - plane]);
        const Vector3d outward = -(index_from_mm.transpose() * gradient);
        if (!(outward.norm() > 1e-6)) continue;
        border.push_back(
            {v, profile_at(grey, volume.lps_from_index * Vector3d(i, j, k), outward.normalized())});
      }
    }
  }
  return border;
}

// How far the label goes on outwards from each voxel of its border.
std::vector<double> reaches_mm(const std::vector<BorderVoxel>& border, const images::Volume& volume,
                               double usual_mm) {
  images::Field sum, weight;
  sum.size = weight.size = volume.size;
  sum.values.assign(volume.values.size(), 0.0F);
  weight.values = sum.values;
  for (const BorderVoxel& at : border) {
    if (!at.profile.edge_mm) continue;
    sum.values[at.voxel] = static_cast<float>(*at.profile.edge_mm);
    weight.values[at.voxel] = 1;
  }
  blur_with_box(sum, volume.spacing_mm(), kThicknessRadius_mm);
  blur_with_box(weight, volume.spacing_mm(), kThicknessRadius_mm);
  std::vector<double> reaches;
  reaches.reserve(border.size());
  for (const BorderVoxel& at : border) {
    const bool is_known = weight.values[at.voxel] > 1e-6F;
    const double around_mm =
        is_known ? static_cast<double>(sum.values[at.voxel] / weight.values[at.voxel]) : usual_mm;
    reaches.push_back(at.profile.edge_mm || at.profile.is_dark_outside
                          ? std::min({around_mm, kThickest * usual_mm, kThickest_mm})
                          : 0.0);
  }
  return reaches;
}

// Every voxel that may be taken joins where the nearest voxel of the border reaches it.
void grow_to(const std::vector<BorderVoxel>& border, const std::vector<double>& reaches,
             const images::Volume& volume, std::uint8_t label, const std::vector<std::uint8_t>& may_be_taken,
             Labels& labels) {
  const auto place = [&](std::size_t v) -> Vector3d {
    const auto nx = static_cast<std::size_t>(volume.size.x()),
               plane = nx * static_cast<std::size_t>(volume.size.y());
    return volume.lps_from_index * Vector3d(static_cast<double>(v % nx), static_cast<double>(v % plane / nx),
                                            static_cast<double>(v / plane));
  };
  struct Step {
    double distance_mm;
    std::size_t voxel, from;  // from: place in the border
    bool operator>(const Step& other) const { return distance_mm > other.distance_mm; }
  };
  std::priority_queue<Step, std::vector<Step>, std::greater<>> waiting;
  std::vector<std::uint8_t> was_reached(labels.size(), 0);
  const auto spread_from = [&](std::size_t v, std::size_t from) {
    const Vector3d source = place(border[from].voxel);
    images::for_each_neighbour(volume.size, v, [&](std::size_t next) {
      if (was_reached[next] || labels[next] == label || !may_be_taken[next]) return;
      const double distance = (place(next) - source).norm();
      if (distance <= kThickest_mm) waiting.push({distance, next, from});
    });
  };
  for (std::size_t b = 0; b < border.size(); ++b) spread_from(border[b].voxel, b);
  std::vector<std::size_t> taken;
  while (!waiting.empty()) {
    const Step step = waiting.top();
    waiting.pop();
    if (was_reached[step.voxel]) continue;
    was_reached[step.voxel] = 1;
    if (step.distance_mm > reaches[step.from]) continue;
    taken.push_back(step.voxel);
    spread_from(step.voxel, step.from);
  }
  for (const std::size_t v : taken) labels[v] = label;
}

}  // namespace

DarkRim take_in_dark_rim(Labels& labels, const images::Volume& volume, std::uint8_t label,
                         std::span<const std::uint8_t> others, std::span<const std::uint8_t> seeds) {
  if (labels.size() != volume.values.size() || (!seeds.empty() && seeds.size() != volume.values.size()))
    throw InvalidInput("the labels are not of the volume's size");
  if (!may_be_mr(volume)) return {};
  const auto border = border_of(labels, volume, Grey(volume), label);
  // Profiles begin at the centres of voxels, within the border.
  const double to_border_mm = 0.5 * volume.spacing_mm().minCoeff();
  std::vector<double> edges_mm;
  for (const BorderVoxel& at : border)
    if (at.profile.edge_mm) edges_mm.push_back(*at.profile.edge_mm - to_border_mm);
  const DarkRim rim = rim_of(std::move(edges_mm), border.size());
  if (!rim.is_seen()) return rim;
  std::vector<std::uint8_t> may_be_taken(labels.size());
  for (std::size_t v = 0; v < labels.size(); ++v)
    may_be_taken[v] =
        (seeds.empty() || seeds[v] == 0) && std::ranges::find(others, labels[v]) == others.end();
  grow_to(border, reaches_mm(border, volume, rim.thickness_mm + to_border_mm), volume, label, may_be_taken,
          labels);
  return rim;
}

DarkRim rim_outside(const geometry::TriangleMesh& surface, const images::Volume& volume) {
  constexpr std::size_t kAsked = 4000;
  if (!may_be_mr(volume)) return {};
  const Grey grey(volume);
  const Vector3d last = (volume.size.array() - 1).cast<double>();
  const Eigen::Affine3d index_from_lps = volume.lps_from_index.inverse();
  const std::size_t stride = std::max<std::size_t>(1, surface.triangles.size() / kAsked);
  std::vector<double> edges;
  std::size_t asked = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); t += stride) {
    const auto& corners = surface.triangles[t];
    const auto corner = [&](std::size_t i) -> const Vector3d& {
      return surface.vertices_mm[static_cast<std::size_t>(corners[i])];
    };
    const Vector3d &a = corner(0), &b = corner(1), &c = corner(2);
    const Vector3d normal = (b - a).cross(c - a), middle = (a + b + c) / 3;
    // Where the images cut the bone off there is nothing outside.
    const Vector3d index = index_from_lps * middle;
    if (!(normal.norm() > 0) || (index.array() < 1).any() || (index.array() > last.array() - 1).any())
      continue;
    ++asked;
    if (const auto edge_mm = profile_at(grey, middle, normal.normalized()).edge_mm) edges.push_back(*edge_mm);
  }
  return rim_of(std::move(edges), asked);
}

}  // namespace arthronaut::segmentation
