#include "navigation/registration/search/cartilage_offset.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "navigation/registration/bone/cell_key.h"
#include "planning/files/format.h"

namespace arthronaut::registration {

namespace {

constexpr double kThinnest_mm = -4, kThickest_mm = 5;
// The contact's density is about half a millimetre wide: coarser steps could pass the right thickness by.
constexpr double kCoarseStep_mm = 0.5, kFineStep_mm = 0.25;
constexpr int kCoarseIterations = 6, kFineIterations = 8;
constexpr std::size_t kCoarsePointCount = 250, kMaxPoses = 8;
// The thickness is held when it is known this well, and enough was touched on both sides of the border.
constexpr double kMaxSigma_mm = 0.4, kMinMeasurements = 4;

Eigen::Vector3i cell_of(const Eigen::Vector3d& point_mm, double width_mm) {
  return (point_mm / width_mm).array().floor().cast<int>();
}

// Which of the points lie on the region, as a pose puts them.
struct Assignment {
  Assignment(const CartilageMap& map, const WeightedPoints& points,
             const geometry::RigidTransform& bone_from_marker) {
    for (std::size_t i = 0; i < points.positions_mm.size(); ++i) {
      is_on_cartilage.push_back(map.covers(bone_from_marker * points.positions_mm[i]));
      (is_on_cartilage.back() ? cartilage_sum : bare_sum) += points.weights[i];
    }
  }
  [[nodiscard]] bool touches_bare() const { return bare_sum > kMinMeasurements * kCorrelationLength_mm; }
  [[nodiscard]] bool touches_both() const {
    return touches_bare() && cartilage_sum > kMinMeasurements * kCorrelationLength_mm;
  }

  std::vector<bool> is_on_cartilage;
  double cartilage_sum = 0, bare_sum = 0;
};

// One pose with the thickness that suits it best.
struct PoseFit {
  RefinedPose pose;
  WeightedPoints points;
  Assignment assignment;
  bool is_held = false;
  double thickness_mm = 0, sigma_mm = 0, profile_width_mm = 0;
  geometry::Vector6d drift_per_mm = geometry::Vector6d::Zero();
};

class Fit {
 public:
  Fit(const SurfaceIndex::Data& bone, const CartilageMap& map, const MarkerPrior& prior,
      const WeightedPoints& points)
      : bone_(bone), map_(map), prior_(prior), points_(points) {}

  [[nodiscard]] PoseFit from(const RefinedPose& start) const {
    // Where the mesh has too much, half of the points are buried until the thickness is known; where it lacks
    // some, a model that lets points be buried goes astray. Which it is shows afterwards.
    PoseFit as_lacking = from_noise(start, NoiseModel::kRarelyBuried_per_mm);
    PoseFit as_too_much = from_noise(start, NoiseModel::kOftenBuried_per_mm);
    return as_too_much.pose.cost < as_lacking.pose.cost ? as_too_much : as_lacking;
  }
  [[nodiscard]] PoseFit on_from(const RefinedPose& pose, double thickness_mm, double profile_width_mm) const {
    PoseFit fit = started(with_buried(pose, NoiseModel::kRarelyBuried_per_mm), thickness_mm);
    if (!has_cartilage_to_fit(fit)) return on_bare_bone(pose);
    fit.thickness_mm = thickness_mm;
    fit.profile_width_mm = profile_width_mm;
    search_finely(fit);
    return fit;
  }

 private:
  // With the right thickness in the points nothing is buried; before it is known, anything may be.
  [[nodiscard]] static RefinedPose with_buried(RefinedPose pose, double density_per_mm) {
    pose.model.buried_density_per_mm = density_per_mm;
    return pose;
  }
  [[nodiscard]] PoseFit from_noise(const RefinedPose& start, double buried_density_per_mm) const {
    PoseFit fit = started(with_buried(start, buried_density_per_mm), 0);
    if (!has_cartilage_to_fit(fit)) return on_bare_bone(start);
    search_coarsely(fit);
    fit.pose = with_buried(fit.pose, NoiseModel::kRarelyBuried_per_mm);
    // What lies on the region shows better from here.
    fit.assignment = Assignment(map_, points_, fit.pose.bone_from_marker);
    search_finely(fit);
    return fit;
  }
  [[nodiscard]] PoseFit on_bare_bone(const RefinedPose& start) const {
    return started(with_buried(start, NoiseModel::kRarelyBuried_per_mm), 0);
  }
  [[nodiscard]] static bool has_cartilage_to_fit(const PoseFit& fit) {
    return fit.assignment.touches_bare() && fit.assignment.cartilage_sum > 0;
  }

  [[nodiscard]] PoseFit started(const RefinedPose& start, double thickness_mm) const {
    PoseFit fit{start, points_, Assignment(map_, points_, start.bone_from_marker)};
    fit.pose = refined(fit.points, fit.assignment, start, thickness_mm, kFineIterations);
    return fit;
  }

  // Leaves the offsets in the points.
  [[nodiscard]] RefinedPose refined(WeightedPoints& points, const Assignment& assignment,
                                    const RefinedPose& start, double thickness_mm, int iterations) const {
    points.offsets_mm.assign(points.positions_mm.size(), 0.0);
    for (std::size_t i = 0; i < points.offsets_mm.size(); ++i) {
      if (assignment.is_on_cartilage[i]) points.offsets_mm[i] = thickness_mm;
    }
    return refine(bone_.field, points, start.bone_from_marker, start.model, prior_, iterations);
  }

  // On a part of the points; from 0 outwards, each from the one before: the pose moves along with the
  // thickness.
  void search_coarsely(PoseFit& fit) const {
    WeightedPoints points = draw_points(points_, kCoarsePointCount, 1);
    const auto at = [&](const RefinedPose& start, double thickness_mm) {
      RefinedPose wide = start;
      wide.model = {};
      wide.model.buried_density_per_mm = fit.pose.model.buried_density_per_mm;
      const Assignment assignment(map_, points, start.bone_from_marker);
      return refined(points, assignment, wide, thickness_mm, kCoarseIterations);
    };
    RefinedPose best = at(fit.pose, 0);
    std::vector<Likelihood> profile{{0, best.cost}};
    for (const double step_mm : {kCoarseStep_mm, -kCoarseStep_mm}) {
      RefinedPose pose = fit.pose;
      for (double thickness = step_mm; thickness >= kThinnest_mm && thickness <= kThickest_mm;
           thickness += step_mm) {
        pose = at(pose, thickness);
        profile.push_back({thickness, pose.cost});
        if (pose.cost >= best.cost) continue;
        best = pose;
        fit.thickness_mm = thickness;
      }
    }
    fit.pose.bone_from_marker = best.bone_from_marker;
    fit.pose.model = best.model;
    fit.profile_width_mm = width_of(profile, {fit.thickness_mm, best.cost});
  }

  // A parabola through the likelihood around the best gives its place and its width.
  void search_finely(PoseFit& fit) const {
    const auto at = [&](const RefinedPose& start, double thickness_mm) {
      return refined(fit.points, fit.assignment, start, thickness_mm, kFineIterations);
    };
    const auto beside = [&](int side) { return at(fit.pose, fit.thickness_mm + side * kFineStep_mm); };
    fit.pose = at(fit.pose, fit.thickness_mm);
    std::array<RefinedPose, 3> near{beside(-1), fit.pose, beside(1)};  // a step thinner, here, a step thicker
    while (near[0].cost < near[1].cost && fit.thickness_mm > kThinnest_mm) {
      fit.thickness_mm -= kFineStep_mm;
      near = {beside(-1), std::move(near[0]), std::move(near[1])};
    }
    while (near[2].cost < near[1].cost && fit.thickness_mm < kThickest_mm) {
      fit.thickness_mm += kFineStep_mm;
      near = {std::move(near[1]), std::move(near[2]), beside(1)};
    }
    const double rise = (near[2].cost - near[0].cost) * measurements();
    const double curvature =
        (near[0].cost - 2 * near[1].cost + near[2].cost) * measurements() / (kFineStep_mm * kFineStep_mm);
    const bool is_inside = fit.thickness_mm > kThinnest_mm && fit.thickness_mm < kThickest_mm;
    if (curvature > 0 && is_inside) {
      fit.thickness_mm += std::clamp(-0.5 * rise / (curvature * kFineStep_mm), -kFineStep_mm, kFineStep_mm);
      fit.sigma_mm = std::max(1 / std::sqrt(curvature), fit.profile_width_mm);
      fit.drift_per_mm =
          geometry::log(near[2].bone_from_marker * near[0].bone_from_marker.inverse()) / (2 * kFineStep_mm);
      fit.is_held = fit.assignment.touches_both() && fit.sigma_mm < kMaxSigma_mm;
    }
    fit.pose = at(near[1], fit.thickness_mm);
  }

  struct Likelihood {
    double thickness_mm, cost;
  };

  // By how much the thicknesses scatter that are about as likely. Where the likelihood is flat or has several
  // tops, one of them alone looks sharper than what is known.
  [[nodiscard]] double width_of(const std::vector<Likelihood>& profile, const Likelihood& best) const {
    double sum = 0, square_sum = 0;
    for (const Likelihood& one : profile) {
      const double weight = std::exp((best.cost - one.cost) * measurements());
      const double away = one.thickness_mm - best.thickness_mm;
      sum += weight;
      square_sum += weight * away * away;
    }
    return std::sqrt(square_sum / sum);
  }

  [[nodiscard]] double measurements() const { return points_.weight_sum / kCorrelationLength_mm; }

  const SurfaceIndex::Data& bone_;
  const CartilageMap& map_;
  const MarkerPrior& prior_;
  const WeightedPoints& points_;
};

// The best of each place, best first, less what has fallen behind beyond hope.
std::vector<PoseFit> ranked(std::vector<PoseFit> fits, const WeightedPoints& points) {
  constexpr double kHopeless = 25;
  std::stable_sort(fits.begin(), fits.end(),
                   [](const PoseFit& l, const PoseFit& r) { return l.pose.cost < r.pose.cost; });
  std::vector<PoseFit> kept;
  for (PoseFit& fit : fits) {
    if (kept.size() == kMaxPoses) break;
    if (kept.size() > 1 && lead_of(kept.front().pose.cost, fit.pose.cost, points) > kHopeless) break;
    const bool is_new = std::all_of(kept.begin(), kept.end(), [&](const PoseFit& other) {
      return are_different(fit.pose.bone_from_marker, other.pose.bone_from_marker, points.centroid_mm);
    });
    if (is_new) kept.push_back(std::move(fit));
  }
  return kept;
}

WeightedPoints bare_points(const PoseFit& fit) {
  const WeightedPoints& points = fit.points;
  WeightedPoints bare;
  for (std::size_t i = 0; i < points.positions_mm.size(); ++i) {
    if (fit.assignment.is_on_cartilage[i]) continue;
    bare.positions_mm.push_back(points.positions_mm[i]);
    bare.weights.push_back(points.weights[i]);
    bare.stretches.push_back(points.stretches[i]);
    bare.path_mm.push_back(points.path_mm[i]);
    bare.shaft_directions.push_back(points.shaft_directions[i]);
    bare.weight_sum += points.weights[i];
    bare.centroid_mm += points.weights[i] * points.positions_mm[i];
  }
  if (bare.weight_sum > 0) bare.centroid_mm /= bare.weight_sum;
  return bare;
}

// What the best says about the region; the others are put beside it.
CartilageFit summarised(const std::vector<PoseFit>& fits, PosePool& pool, const WeightedPoints& points) {
  const PoseFit& best = fits.front();
  CartilageFit cartilage;
  cartilage.cost = best.pose.cost;
  cartilage.has_bare = best.assignment.touches_bare();
  cartilage.is_solved = best.is_held;
  cartilage.is_left_out = best.assignment.cartilage_sum > 0 && cartilage.has_bare && !best.is_held;
  cartilage.thickness_mm = best.thickness_mm;
  cartilage.sigma_mm = best.sigma_mm;
  cartilage.drift_per_mm = best.drift_per_mm;
  cartilage.points = cartilage.is_left_out ? bare_points(best) : best.points;
  cartilage.kept_share = points.weight_sum > 0 ? cartilage.points.weight_sum / points.weight_sum : 0;
  std::vector<RefinedPose> poses;
  for (const PoseFit& fit : fits) poses.push_back(fit.pose);
  pool.replace(std::move(poses), points.centroid_mm);
  if (cartilage.is_left_out) pool.refine_all(cartilage.points, kFineIterations);
  if (best.assignment.cartilage_sum <= 0) {
    cartilage.assumption = "no stroke lies on the cartilage";
  } else if (!cartilage.has_bare) {
    cartilage.assumption = "the cartilage was taken to lie on the mesh: nothing but it was touched";
  } else if (cartilage.is_solved) {
    cartilage.assumption =
        files::format("the cartilage lies %.1f mm off the mesh, one sigma %.1f mm: solved from the strokes",
                      cartilage.thickness_mm, cartilage.sigma_mm);
  } else {
    cartilage.assumption = "the cartilage was left out: the strokes don't hold its thickness";
  }
  return cartilage;
}

}  // namespace

CartilageMap::CartilageMap(const SurfaceIndex::Data& bone, const CartilageRegion& region)
    : bone_(bone), reach_mm_(region.reach_mm) {
  if (!(reach_mm_ > 0)) return;
  for (const Eigen::Vector3d& point : region.points_mm)
    cells_[cell_key(cell_of(point, reach_mm_))].push_back(point);
}

bool CartilageMap::covers(const Eigen::Vector3d& point_in_bone_mm) const {
  if (cells_.empty() || !point_in_bone_mm.allFinite()) return false;
  // A lifted tip, or one on thick cartilage, is over the same place as one on the bone.
  const DistanceField::Sample sample = bone_.field.sample(point_in_bone_mm);
  const Eigen::Vector3d place_mm = point_in_bone_mm - sample.distance_mm * sample.gradient;
  const Eigen::Vector3i middle = cell_of(place_mm, reach_mm_);
  constexpr std::array<int, 3> kSteps{0, -1, 1};  // the middle first, where it is found most often
  for (const int x : kSteps) {
    for (const int y : kSteps) {
      for (const int z : kSteps) {
        const auto cell = cells_.find(cell_key(middle + Eigen::Vector3i(x, y, z)));
        if (cell == cells_.end()) continue;
        const bool is_near =
            std::any_of(cell->second.begin(), cell->second.end(), [&](const Eigen::Vector3d& point) {
              return (point - place_mm).squaredNorm() < reach_mm_ * reach_mm_;
            });
        if (is_near) return true;
      }
    }
  }
  return false;
}

std::optional<double> CartilageFit::offset_mm(const CartilageMap& map,
                                              const Eigen::Vector3d& point_in_bone_mm) const {
  if ((!is_solved && !is_left_out) || !map.covers(point_in_bone_mm)) return 0.0;
  if (is_left_out) return std::nullopt;
  return thickness_mm;
}

std::optional<double> cartilage_offset_mm(const RegistrationSummary& registration,
                                          const CartilageRegion& region,
                                          const Eigen::Vector3d& place_in_bone_mm) {
  if (registration.cartilage_use == CartilageUse::None) return 0.0;
  const double square_reach = region.reach_mm > 0 ? region.reach_mm * region.reach_mm : 0.0;
  const bool is_on_cartilage = std::any_of(
      region.points_mm.begin(), region.points_mm.end(),
      [&](const Eigen::Vector3d& point) { return (point - place_in_bone_mm).squaredNorm() < square_reach; });
  if (!is_on_cartilage) return 0.0;
  if (registration.cartilage_use == CartilageUse::LeftOut) return std::nullopt;
  return registration.cartilage_thickness_mm;
}

std::vector<std::optional<double>> CartilageFit::offsets_mm(
    const CartilageMap& map, const strokes::Curves& curves,
    const geometry::RigidTransform& bone_from_marker) const {
  std::vector<std::optional<double>> offsets_mm;
  for (const strokes::CurvePoint& point : curves) {
    offsets_mm.push_back(offset_mm(map, bone_from_marker * point.position_mm));
  }
  return offsets_mm;
}

void CartilageFit::add_to(RegistrationSummary& summary) const {
  summary.cartilage_use = is_solved     ? CartilageUse::Solved
                          : is_left_out ? CartilageUse::LeftOut
                                        : CartilageUse::None;
  if (is_solved) summary.cartilage_thickness_mm = thickness_mm;
  summary.assumptions.push_back(assumption);
  if (!has_bare) {
    summary.reliable = false;
    summary.reasons.push_back("all strokes lie on the cartilage: touch what is bare too");
  }
}

CartilageFit CartilageFitter::fit(PosePool& pool, const WeightedPoints& points, bool anew) {
  const Fit fit(bone_, map_, prior_, points);
  std::vector<PoseFit> fits;
  for (const Known& known : known_)
    fits.push_back(fit.on_from(known.pose, known.thickness_mm, known.profile_width_mm));
  if (anew || known_.empty()) {
    for (const RefinedPose& pose : pool.poses()) fits.push_back(fit.from(pose));
  }
  fits = ranked(std::move(fits), points);
  known_.clear();
  for (const PoseFit& one : fits) known_.push_back({one.pose, one.thickness_mm, one.profile_width_mm});
  return summarised(fits, pool, points);
}

}  // namespace arthronaut::registration
