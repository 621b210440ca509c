#include "planning/segmentation/fibula.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

namespace arthronaut::segmentation {

namespace {

using images::Volume;
using images::VoxelMask;

// A section of the fibula, and how far its middle lies from the shaft's. The tibia's is larger.
constexpr double kLeastSection_mm2 = 30, kLargestSection_mm2 = 650, kLargestShare = 0.6;
constexpr double kNearest_mm = 15, kFurthest_mm = 60;
// So far along the bone both must lie apart, and so little may the fibula's middle move from slice to slice.
constexpr double kLeastApart_mm = 6, kMostShift = 1.5;
// At the top of the plateau its two halves lie apart, too.
constexpr double kBelowPlateau_mm = 5;
// Where a voxel is bone in part it is darker than bone, and would lead over the outside of both: what is no
// deeper than this is flooded last.
constexpr double kSkin_mm = 1.5;
// Of what is taken off, against the tibia that stays.
constexpr double kLeastTaken_mm3 = 800, kLargestTaken = 0.35;

enum Label : std::uint8_t { kFree = 0, kTibia = 1, kFibula = 2 };

struct Slice {
  std::vector<std::size_t> tibia, fibula;  // voxels of the solid
  Eigen::Vector3d fibula_mm = Eigen::Vector3d::Zero();
};

class Parting {
 public:
  Parting(const Volume& volume, const BoneSolid& solid)
      : volume_(volume), solid_(solid), depths_mm_(images::depths_mm(solid.mask, volume.spacing_mm())) {
    // Of the directions, whatever the steps along them are.
    volume_.lps_from_index.linear().colwise().normalized().row(2).cwiseAbs().maxCoeff(&axis_);
    rises_ = volume_.lps_from_index.linear()(2, axis_) > 0;
    step_mm_ = volume_.spacing_mm()[axis_];
    const Eigen::Vector3d spacing = volume_.spacing_mm();
    pixel_mm2_ = spacing[(axis_ + 1) % 3] * spacing[(axis_ + 2) % 3];
  }

  // The longest run of slices that fall in two, below the plateau.
  [[nodiscard]] std::vector<Slice> slices_apart() const {
    const double plateau_mm = profile_of(volume_, solid_).largest_at_mm() - kBelowPlateau_mm;
    std::vector<Slice> best, run;
    const int count = solid_.mask.size[axis_];
    for (int n = 0; n < count; ++n) {
      auto slice = slice_at(rises_ ? n : count - 1 - n, plateau_mm);
      const bool goes_on = slice && !run.empty() &&
                           (slice->fibula_mm - run.back().fibula_mm).norm() < kMostShift * (step_mm_ + 1);
      if (!goes_on) run.clear();
      if (slice) run.push_back(std::move(*slice));
      if (run.size() > best.size()) best = run;
    }
    if (static_cast<double>(best.size()) * step_mm_ < kLeastApart_mm) best.clear();
    return best;
  }

  // By grey values, dark before bright, each of a level as far as the other at a time.
  [[nodiscard]] std::vector<std::uint8_t> flood(const std::vector<Slice>& apart) const {
    std::vector<std::uint8_t> labels(solid_.mask.inside.size(), kFree);
    std::array<std::vector<std::size_t>, kLevels> waiting;
    const auto begin_at = [&](const std::vector<std::size_t>& voxels, Label label) {
      for (const std::size_t v : voxels) labels[v] = label, waiting[0].push_back(v);
    };
    for (const Slice& slice : apart) begin_at(slice.tibia, kTibia), begin_at(slice.fibula, kFibula);
    for (std::size_t level = 0; level < kLevels; ++level) {
      // What is darker than what led to it is flooded with it.
      for (std::size_t next = 0; next < waiting[level].size(); ++next) {
        const std::size_t from = waiting[level][next];
        images::for_each_neighbour(solid_.mask.size, from, [&](std::size_t v) {
          if (!solid_.mask.inside[v] || labels[v] != kFree) return;
          labels[v] = labels[from];
          waiting[std::max(level, level_of(v))].push_back(v);
        });
      }
      waiting[level] = {};
    }
    return labels;
  }

 private:
  static constexpr std::size_t kLevels = 128;
  static constexpr double kDarkest_hu = -100, kBrightest_hu = 1400;

  [[nodiscard]] std::size_t level_of(std::size_t voxel) const {
    if (depths_mm_[voxel] < kSkin_mm) return kLevels - 1;
    const Eigen::Vector3i at = solid_.box.first + solid_.mask.index_of(voxel);
    const double grey = volume_.values[volume_.index(at.x(), at.y(), at.z())];
    const double share = (grey - kDarkest_hu) / (kBrightest_hu - kDarkest_hu);
    return static_cast<std::size_t>(std::clamp(share, 0.0, 1.0) * (kLevels - 1));
  }

  [[nodiscard]] std::optional<Slice> slice_at(int level, double plateau_mm) const {
    const int u = (axis_ + 1) % 3, v = (axis_ + 2) % 3;
    VoxelMask face(Eigen::Vector3i(solid_.mask.size[u], solid_.mask.size[v], 1));
    const auto voxel_of = [&](std::size_t pixel) {
      Eigen::Vector3i at;
      at[axis_] = level;
      at[u] = static_cast<int>(pixel % static_cast<std::size_t>(face.size.x()));
      at[v] = static_cast<int>(pixel / static_cast<std::size_t>(face.size.x()));
      return solid_.mask.index(at.x(), at.y(), at.z());
    };
    for (std::size_t p = 0; p < face.inside.size(); ++p) face.inside[p] = solid_.mask.inside[voxel_of(p)];
    const auto pieces =
        images::connected_pieces(face, static_cast<std::size_t>(kLeastSection_mm2 / pixel_mm2_) + 1);
    if (pieces.size() != 2) return std::nullopt;
    const double shaft_mm2 = static_cast<double>(pieces[0].count) * pixel_mm2_,
                 beside_mm2 = static_cast<double>(pieces[1].count) * pixel_mm2_;
    if (beside_mm2 > std::min(kLargestSection_mm2, kLargestShare * shaft_mm2)) return std::nullopt;
    const auto middle_of = [&](const images::VoxelPiece& piece) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (const std::size_t p : piece.voxels) sum += solid_.lps_of(volume_, voxel_of(p));
      return Eigen::Vector3d(sum / static_cast<double>(piece.count));
    };
    Slice slice;
    slice.fibula_mm = middle_of(pieces[1]);
    const double aside_mm = (slice.fibula_mm - middle_of(pieces[0])).norm();
    if (slice.fibula_mm.z() > plateau_mm || aside_mm < kNearest_mm || aside_mm > kFurthest_mm)
      return std::nullopt;
    for (const std::size_t p : pieces[0].voxels) slice.tibia.push_back(voxel_of(p));
    for (const std::size_t p : pieces[1].voxels) slice.fibula.push_back(voxel_of(p));
    return slice;
  }

  const Volume& volume_;
  const BoneSolid& solid_;
  std::vector<float> depths_mm_;
  int axis_ = 2;  // of the volume, along which superior is
  bool rises_ = true;
  double step_mm_ = 1, pixel_mm2_ = 1;
};

}  // namespace

PartedFibula part_fibula(const Volume& volume, BoneSolid& tibia) {
  PartedFibula result;
  const Parting parting(volume, tibia);
  const std::vector<Slice> apart = parting.slices_apart();
  if (apart.empty()) return result;
  const std::vector<std::uint8_t> labels = parting.flood(apart);
  const auto count_of = [&](Label label) { return static_cast<double>(std::ranges::count(labels, label)); };
  const double voxel_mm3 = std::abs(volume.lps_from_index.linear().determinant());
  const double taken = count_of(kFibula);
  if (taken * voxel_mm3 < kLeastTaken_mm3 || taken > kLargestTaken * count_of(kTibia)) {
    result.outcome = PartedFibula::Outcome::NotParted;
    return result;
  }
  for (std::size_t v = 0; v < labels.size(); ++v) {
    if (labels[v] != kFibula) continue;
    result.taken_mm.push_back(tibia.lps_of(volume, v));
    tibia.mask.inside[v] = 0;
  }
  result.outcome = PartedFibula::Outcome::Parted;
  return result;
}

}  // namespace arthronaut::segmentation
