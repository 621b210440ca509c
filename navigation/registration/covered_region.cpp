#include "navigation/registration/covered_region.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace arthronaut::registration {

namespace {

constexpr double kThinnest_mm = -4, kThickest_mm = 5;
// The contact's law is about half a millimetre wide: coarser steps could pass the right thickness by.
constexpr double kCoarseStep_mm = 0.5, kFineStep_mm = 0.25;
constexpr int kCoarseIterations = 6, kFineIterations = 15;
// The thickness is held when it is known this well, and enough was touched on both sides of the border.
constexpr double kMaxSigma_mm = 0.4, kMinMeasurements = 4;

std::uint64_t key_of(const Eigen::Array3i& cell) {
  const auto part = [](int c) { return static_cast<std::uint64_t>(c + (1 << 20)) & 0x1fffff; };
  return part(cell.x()) | part(cell.y()) << 21 | part(cell.z()) << 42;
}

Eigen::Array3i cell_of(const Eigen::Vector3d& point_mm, double width_mm) {
  return (point_mm.array() / width_mm).floor().cast<int>();
}

// One pose of the pool with the thickness that suits it best.
struct PoseFit {
  RefinedPose pose;
  TouchedPoints points;
  std::vector<bool> is_covered;
  double covered_sum = 0, bare_sum = 0;
  bool is_held = false;
  double thickness_mm = 0, sigma_mm = 0;
  geometry::Vector6d drift_per_mm = geometry::Vector6d::Zero();

  [[nodiscard]] bool touches_bare() const { return bare_sum > kMinMeasurements * kCorrelationLength_mm; }
  [[nodiscard]] bool touches_both() const {
    return touches_bare() && covered_sum > kMinMeasurements * kCorrelationLength_mm;
  }
};

class Fit {
 public:
  Fit(const PreparedBone::Data& bone, const TouchedPoints& points, const CoverMap& map, const MarkerPrior& prior)
      : bone_(bone), map_(map), prior_(prior) {
    result_.points = points;
  }

  [[nodiscard]] PoseFit from(const RefinedPose& start) {
    assign(start);
    result_.pose = refined(start, 0, kFineIterations);
    if (!result_.touches_bare() || result_.covered_sum <= 0) return result_;
    search_coarsely();
    // What lies on the region shows better from here.
    assign(result_.pose);
    search_finely();
    return result_;
  }

 private:
  void assign(const RefinedPose& pose) {
    const TouchedPoints& points = result_.points;
    result_.is_covered.clear();
    result_.covered_sum = result_.bare_sum = 0;
    for (std::size_t i = 0; i < points.positions_mm.size(); ++i) {
      result_.is_covered.push_back(map_.covers(pose.bone_from_marker * points.positions_mm[i]));
      (result_.is_covered.back() ? result_.covered_sum : result_.bare_sum) += points.weights[i];
    }
  }

  [[nodiscard]] RefinedPose refined(const RefinedPose& start, double thickness_mm, int iterations) {
    TouchedPoints& points = result_.points;
    points.offsets_mm.assign(points.positions_mm.size(), 0.0);
    for (std::size_t i = 0; i < points.offsets_mm.size(); ++i) {
      if (result_.is_covered[i]) points.offsets_mm[i] = thickness_mm;
    }
    return refine([this](const Eigen::Vector3d& p) { return bone_.field.sample(p); }, points, start.bone_from_marker,
                  start.model, prior_, iterations);
  }

  // From 0 outwards, each from the one before: the pose moves along with the thickness.
  void search_coarsely() {
    const RefinedPose start = result_.pose;
    profile_ = {{0.0, start.cost}};
    for (const double step_mm : {kCoarseStep_mm, -kCoarseStep_mm}) {
      RefinedPose pose = start;
      for (double thickness = step_mm; thickness >= kThinnest_mm && thickness <= kThickest_mm; thickness += step_mm) {
        pose.model = {};
        assign(pose);
        pose = refined(pose, thickness, kCoarseIterations);
        profile_.push_back({thickness, pose.cost});
        if (pose.cost >= result_.pose.cost) continue;
        result_.pose = pose;
        result_.thickness_mm = thickness;
      }
    }
  }

  // A parabola through the likelihood around the best gives its place and its width.
  void search_finely() {
    std::array<RefinedPose, 3> near;  // a step thinner, here, a step thicker
    const auto at = [&](int side) {
      return refined(result_.pose, result_.thickness_mm + side * kFineStep_mm, kFineIterations);
    };
    near = {at(-1), at(0), at(1)};
    while (near[0].cost < near[1].cost && result_.thickness_mm > kThinnest_mm) {
      result_.thickness_mm -= kFineStep_mm;
      near = {at(-1), std::move(near[0]), std::move(near[1])};
    }
    while (near[2].cost < near[1].cost && result_.thickness_mm < kThickest_mm) {
      result_.thickness_mm += kFineStep_mm;
      near = {std::move(near[1]), std::move(near[2]), at(1)};
    }
    const double measurements = result_.points.weight_sum / kCorrelationLength_mm;
    const double rise = (near[2].cost - near[0].cost) * measurements;
    const double curvature = (near[0].cost - 2 * near[1].cost + near[2].cost) * measurements / (kFineStep_mm * kFineStep_mm);
    const bool is_inside = result_.thickness_mm > kThinnest_mm && result_.thickness_mm < kThickest_mm;
    if (curvature > 0 && is_inside) {
      result_.thickness_mm += std::clamp(-0.5 * rise / (curvature * kFineStep_mm), -kFineStep_mm, kFineStep_mm);
      result_.sigma_mm = std::max(1 / std::sqrt(curvature), width_of_profile(measurements));
      result_.drift_per_mm =
          geometry::log(near[2].bone_from_marker * near[0].bone_from_marker.inverse()) / (2 * kFineStep_mm);
      result_.is_held = result_.touches_both() && result_.sigma_mm < kMaxSigma_mm;
    }
    result_.pose = refined(near[1], result_.thickness_mm, kFineIterations);
  }

  // By how much the thicknesses scatter that are about as likely. Where the likelihood is flat or has several tops, one of
  // them alone looks sharper than what is known.
  [[nodiscard]] double width_of_profile(double measurements) const {
    double sum = 0, square_sum = 0;
    for (const auto& [thickness, cost] : profile_) {
      const double weight = std::exp(std::min(0.0, (result_.pose.cost - cost) * measurements));
      const double away = thickness - result_.thickness_mm;
      sum += weight;
      square_sum += weight * away * away;
    }
    // The thickness itself is one of them.
    return std::sqrt(square_sum / (1 + sum));
  }

  struct Likelihood {
    double thickness_mm, cost;
  };

  const PreparedBone::Data& bone_;
  const CoverMap& map_;
  const MarkerPrior& prior_;
  PoseFit result_;
  std::vector<Likelihood> profile_;  // of the coarse search
};

TouchedPoints bare_points(const PoseFit& fit) {
  const TouchedPoints& points = fit.points;
  TouchedPoints bare;
  for (std::size_t i = 0; i < points.positions_mm.size(); ++i) {
    if (fit.is_covered[i]) continue;
    bare.positions_mm.push_back(points.positions_mm[i]);
    bare.weights.push_back(points.weights[i]);
    bare.stretches.push_back(points.stretches[i]);
    bare.weight_sum += points.weights[i];
    bare.centroid_mm += points.weights[i] * points.positions_mm[i];
  }
  if (bare.weight_sum > 0) bare.centroid_mm /= bare.weight_sum;
  return bare;
}

std::string formatted(const char* format, double first, double second) {
  char text[160];
  std::snprintf(text, sizeof text, format, first, second);
  return text;
}

}  // namespace

CoverMap::CoverMap(const PreparedBone::Data& bone, const CoveredRegion& region) : bone_(bone), reach_mm_(region.reach_mm) {
  if (!(reach_mm_ > 0)) return;
  for (const Eigen::Vector3d& point : region.points_mm) cells_[key_of(cell_of(point, reach_mm_))].push_back(point);
}

bool CoverMap::covers(const Eigen::Vector3d& point_in_bone_mm) const {
  if (cells_.empty() || !point_in_bone_mm.allFinite()) return false;
  // A lifted tip, or one on thick cartilage, is over the same place as one on the bone.
  const DistanceField::Sample sample = bone_.field.sample(point_in_bone_mm);
  const Eigen::Vector3d place_mm = point_in_bone_mm - sample.distance_mm * sample.gradient;
  const Eigen::Array3i middle = cell_of(place_mm, reach_mm_);
  constexpr std::array<int, 3> kSteps{0, -1, 1};  // the middle first, where it is found most often
  for (const int x : kSteps) {
    for (const int y : kSteps) {
      for (const int z : kSteps) {
        const auto cell = cells_.find(key_of(middle + Eigen::Array3i(x, y, z)));
        if (cell == cells_.end()) continue;
        const bool is_near = std::any_of(cell->second.begin(), cell->second.end(), [&](const Eigen::Vector3d& point) {
          return (point - place_mm).squaredNorm() < reach_mm_ * reach_mm_;
        });
        if (is_near) return true;
      }
    }
  }
  return false;
}

std::optional<double> CoverFit::offset_mm(const CoverMap& map, const Eigen::Vector3d& point_in_bone_mm) const {
  if ((!is_solved && !is_left_out) || !map.covers(point_in_bone_mm)) return 0.0;
  if (is_left_out) return std::nullopt;
  return thickness_mm;
}

CoverFit fit_cover(const PreparedBone::Data& bone, PosePool& pool, const TouchedPoints& points, const CoverMap& map) {
  CoverFit cover;
  cover.points = points;
  if (pool.empty()) return cover;
  std::vector<PoseFit> fits;
  for (const RefinedPose& pose : pool.poses()) fits.push_back(Fit(bone, points, map, pool.prior()).from(pose));
  const PoseFit& best = *std::min_element(fits.begin(), fits.end(), [](const PoseFit& l, const PoseFit& r) {
    return l.pose.cost < r.pose.cost;
  });
  cover.cost = best.pose.cost;
  cover.has_bare = best.touches_bare();
  cover.is_solved = best.is_held;
  cover.is_left_out = best.covered_sum > 0 && cover.has_bare && !best.is_held;
  cover.thickness_mm = best.thickness_mm;
  cover.sigma_mm = best.sigma_mm;
  cover.drift_per_mm = best.drift_per_mm;
  cover.points = cover.is_left_out ? bare_points(best) : best.points;
  std::vector<RefinedPose> poses;
  for (PoseFit& fit : fits) poses.push_back(fit.pose);
  pool.replace(std::move(poses), points.centroid_mm);
  if (cover.is_left_out) pool.refine_all(cover.points, kFineIterations);
  if (best.covered_sum <= 0) {
    cover.assumption = "no stroke lies on the covered region";
  } else if (!cover.has_bare) {
    cover.assumption = "the covered region was taken to lie on the mesh: nothing but it was touched";
  } else if (cover.is_solved) {
    cover.assumption = formatted("the covered region lies %.1f mm off the mesh, one sigma %.1f mm: solved from the strokes",
                                 cover.thickness_mm, cover.sigma_mm);
  } else {
    cover.assumption = "the covered region was left out: the strokes don't hold its thickness";
  }
  return cover;
}

}  // namespace arthronaut::registration
