#include "planning/postop/tunnel_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>

#include "planning/geometry/quantile.h"
#include "planning/postop/bore_frame.h"
#include "planning/postop/fit_spread.h"
#include "planning/postop/near_voxels.h"
#include "planning/postop/wall_levels.h"

namespace arthronaut::postop {

namespace {

using Eigen::Vector3d;

constexpr std::size_t kSectors = WallLevels::kSectors;
constexpr double kStretch_mm = 4;
constexpr double kBin_mm = 2;  // of the levels
// From the wall inwards, and from it or from the rim about it outwards.
constexpr double kInward_mm = 1.8, kOutward_mm = 1.2, kBesideWallFrom_mm = 0.6;
// Of the profile that tells whether there is a rim: as far inwards, for what was taken for the wall may be
// the rim's outer side.
constexpr double kProfileTo_mm = 3, kPoint_mm = 0.2;
// Seen with so much blur at first, the wall is found from further off.
constexpr double kFirstBlur_mm = 1.0;
// A station with more metal than this inside the bore or beside its wall is passed over as a whole: what is
// left of its wall is seen one-sidedly, and through the metal's blur.
constexpr double kMetalOfBin = 0.02, kBesideWall_mm = 1.5;
constexpr double kLeastNoise_hu = 6;
// Radii of neighbouring stretches differ by this, one sigma.
constexpr double kRadiusChange_mm = 0.4;
constexpr double kHuber = 2.5;
constexpr double kNoRim_hu = -1e4;  // less dense than anything: what is beyond the wall begins at it

// What the levels make of a voxel's grey.
struct Model {
  double value, slope;  // slope: by the distance from the axis
  double variance;      // of what the levels are made of: beside a cortex that slants there is no one level
};

struct PlacedVoxel {
  PlacedByBore placed;
  const WallVoxel* voxel;
};

struct FittedVoxel {
  PlacedByBore placed;
  std::size_t sector;
  float hu;
  Model model;
};

class Fit {
 public:
  Fit(const std::vector<WallVoxel>& voxels, const Bore& bore, double from_mm, double to_mm, Wall wall)
      : voxels_(voxels),
        near_(voxels),
        wall_(wall),
        frame_(bore.entry_mm, bore.direction, from_mm, to_mm),
        stretches_(frame_.parts_of(kStretch_mm)),
        bins_(frame_.parts_of(kBin_mm)) {
    radius_.assign(stretches_, bore.radius_mm);
  }

  // `known`: not to be sought.
  TunnelFit run(const std::optional<WallProfile>& known) {
    if (known) profile_ = *known;
    if (!profile_.has_rim()) profile_.blur_mm = WallProfile{}.blur_mm;
    if (!settle(kFirstBlur_mm)) return {};
    // The axis that is found with a rim tells better what the rim is.
    constexpr int kRounds = 3;
    for (int round = 0; round < kRounds && !known && wall_ == Wall::Clear; ++round) {
      const bool had_rim = profile_.has_rim();
      const WallProfile seen = explain_wall(mean_profile(), noise_hu_, spread().shared_voxels);
      profile_.wall_sigma_mm = seen.wall_sigma_mm;
      profile_.plain_blur_mm = seen.plain_blur_mm;
      profile_.layer_mm = seen.layer_mm;
      if (!seen.has_rim() && !had_rim) break;
      profile_ = seen.has_rim() ? seen
                                : WallProfile{.plain_blur_mm = seen.plain_blur_mm,
                                              .wall_sigma_mm = seen.wall_sigma_mm,
                                              .layer_mm = seen.layer_mm};
      for (double& radius : radius_) radius += seen.wall_mm + seems_nearer_mm(radius);
      if (!settle(profile_.blur_mm)) return {};
    }
    if (!settle_radii()) return {};
    return result();
  }

 private:
  // From a blur that sees far to the scanner's own. False where nothing is to be found.
  bool settle(double first_blur_mm) {
    constexpr int kSteps = 24;
    for (int step = 0; step < kSteps; ++step) {
      const double blur = std::max(profile_.blur_mm, first_blur_mm * std::pow(0.8, step));
      take_levels(blur);
      const double moved = improve();
      if (!(moved < 1e3)) return false;
      if (blur == profile_.blur_mm && moved < 0.004) break;
    }
    take_levels(profile_.blur_mm);
    return true;
  }

  // How wide a bore without a rim is follows from how much the images are blurred, which is seen; its axis
  // does not, and would follow marrow that changes beside it. False where nothing is to be found.
  bool settle_radii() {
    if (profile_.has_rim() || wall_ == Wall::Screw || profile_.plain_blur_mm == 0) return true;
    profile_.blur_mm = profile_.plain_blur_mm;
    constexpr int kSteps = 12;
    for (int step = 0; step < kSteps; ++step) {
      take_levels(profile_.blur_mm);
      const double moved = improve(Moves::Radii);
      if (!(moved < 1e3)) return false;
      if (moved < 0.004) break;
    }
    take_levels(profile_.blur_mm);
    return true;
  }

  [[nodiscard]] bool counts(const WallVoxel& voxel, const PlacedByBore& placed) const {
    if (wall_ == Wall::Screw) return true;
    return !voxel.is_metal && !voxel.is_by_metal && metal_of_bin_[placed.bin].mean() < kMetalOfBin;
  }

  [[nodiscard]] std::optional<PlacedByBore> place(const Vector3d& p) const {
    return frame_.place(p, stretches_, bins_);
  }

  // Means well inside and well outside the wall, what they make of each voxel through this blur, and the
  // noise about that.
  void take_levels(double blur) {
    levels_.assign(bins_, {});
    metal_of_bin_.assign(bins_, {});
    placed_.clear();
    const double reach_mm =
        *std::ranges::max_element(radius_) + std::max(kBesideWall_mm, profile_.rim_mm + kOutward_mm);
    for (const WallVoxel& voxel : near_.about(frame_, reach_mm)) {
      const auto placed = place(voxel.p_mm);
      if (!placed || placed->off > reach_mm) continue;
      placed_.push_back({*placed, &voxel});
      if (placed->off < radius_[placed->stretch] + kBesideWall_mm)
        metal_of_bin_[placed->bin].add(voxel.is_metal ? 1 : 0);
    }
    metal_.assign(stretches_, {});
    fitted_.clear();
    for (const auto& [placed, voxel] : placed_) {
      const double off = placed.off - radius_[placed.stretch];
      if (off < -0.4) metal_[placed.stretch].add(voxel->is_metal ? 1 : 0);
      const double beyond = off - profile_.rim_mm;
      if (!counts(*voxel, placed) || beyond > kOutward_mm || off < -kInward_mm - 1) continue;
      WallLevels& levels = levels_[placed.bin];
      const WallGrey grey = grey_at(placed, profile_.blur_mm);
      if (off < -kBesideWallFrom_mm) levels.add_inside(voxel->hu, grey);
      if (off <= -kInward_mm) continue;
      const std::size_t sector = placed.sector(kSectors);
      if (beyond > kBesideWallFrom_mm) levels.add_outside(sector, voxel->hu, grey);
      if (off > 0 && beyond < 0) levels.add_rim(sector, voxel->hu);
      fitted_.push_back({placed, sector, voxel->hu, {}});
    }
    for (WallLevels& levels : levels_) levels.part(profile_.has_rim() ? profile_.rim_hu : kNoRim_hu);
    std::erase_if(fitted_, [&](FittedVoxel& voxel) {
      const auto model = model_at(voxel.placed, voxel.sector, blur);
      if (model) voxel.model = *model;
      return !model;
    });
    std::vector<double> off_model;
    off_model.reserve(fitted_.size());
    for (const auto& [placed, sector, hu, model] : fitted_) off_model.push_back(std::abs(hu - model.value));
    noise_hu_ = std::max(kLeastNoise_hu, 1.4826 * geometry::median(std::move(off_model), 1e3));
  }

  [[nodiscard]] std::optional<Model> model_at(const PlacedByBore& placed, std::size_t sector,
                                              double blur) const {
    const WallLevels& levels = levels_[placed.bin];
    if (!levels.has_inside() || !levels.has_outside(sector)) return std::nullopt;
    const WallGrey grey = grey_at(placed, blur);
    const double a = levels.inside_hu(), b = levels.outside_hu(sector), rim = rim_hu(b);
    return Model{a * grey.inside + rim * grey.rim + b * grey.beyond,
                 a * grey.inside_slope + rim * grey.rim_slope + b * grey.beyond_slope,
                 std::max(levels.inside().variance(), levels.outside(sector).variance())};
  }

  [[nodiscard]] WallGrey grey_at(const PlacedByBore& placed, double blur) const {
    const double radius = radius_[placed.stretch];
    return wall_grey(placed.off - radius + seems_nearer_mm(radius), profile_.rim_mm, blur);
  }
  // A round wall looks as a flat one does that lies nearer to the axis: at a circle's edge less than half of
  // what the blur brings there comes from within.
  [[nodiscard]] double seems_nearer_mm(double radius) const {
    return profile_.blur_mm * profile_.blur_mm / (2 * radius);
  }

  // Of the rim where `beyond_hu` is beyond it: in bone that is denser there is none.
  [[nodiscard]] double rim_hu(double beyond_hu) const {
    return profile_.has_rim() ? std::max(profile_.rim_hu, beyond_hu) : beyond_hu;
  }

  // The mean grey by the distance from the wall, of the cells with marrow beyond it. Each of them puts about
  // as much into every point, so the levels are means of theirs, and wall and rim are theirs.
  [[nodiscard]] std::vector<WallPoint> mean_profile() const {
    std::vector<double> sizes, greys, off_greys;
    for (const WallLevels& levels : levels_) {
      for (std::size_t sector = 0; sector < kSectors; ++sector) {
        if (!levels.has_outside(sector)) continue;
        sizes.push_back(levels.outside(sector).count);
        greys.push_back(levels.outside(sector).mean());
      }
    }
    const double full = 0.5 * geometry::median(std::move(sizes), 0), grey = geometry::median(greys, 0);
    for (const double one : greys) off_greys.push_back(std::abs(one - grey));
    const double far_off = std::max(50.0, 3 * geometry::median(std::move(off_greys), 0));
    std::vector<Level> means(static_cast<std::size_t>(std::lround(2 * kProfileTo_mm / kPoint_mm)));
    for (const WallVoxel& voxel : voxels_) {
      const auto placed = place(voxel.p_mm);
      if (!placed || !counts(voxel, *placed)) continue;
      const Level& out = levels_[placed->bin].outside(placed->sector(kSectors));
      if (!levels_[placed->bin].has_inside() || out.count < full || std::abs(out.mean() - grey) > far_off)
        continue;
      const double at = (placed->off - radius_[placed->stretch] + kProfileTo_mm) / kPoint_mm;
      if (at < 0 || at >= static_cast<double>(means.size())) continue;
      means[static_cast<std::size_t>(at)].add(voxel.hu);
    }
    std::vector<WallPoint> points;
    for (std::size_t i = 0; i < means.size(); ++i)
      if (means[i].count > 0)
        points.push_back({kPoint_mm * (static_cast<double>(i) + 0.5) - kProfileTo_mm, means[i].mean(),
                          static_cast<double>(means[i].count)});
    return points;
  }

  // `by_eighth`: what each eighth of each stretch alone puts into both.
  void assemble(Eigen::MatrixXd& normal, Eigen::VectorXd& right,
                std::vector<PartOfFit>* by_eighth = nullptr) const {
    const auto n = static_cast<Eigen::Index>(4 + stretches_);
    normal = Eigen::MatrixXd::Zero(n, n);
    right = Eigen::VectorXd::Zero(n);
    if (by_eighth)
      by_eighth->assign(stretches_ * kSectors, {Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)});
    for (const auto& [placed, sector, hu, model] : fitted_) {
      const double residual = hu - model.value,
                   sigma = std::sqrt(0.5 * (noise_hu_ * noise_hu_ + model.variance)),
                   weight =
                       std::min(1.0, kHuber * sigma / std::max(1e-9, std::abs(residual))) / (sigma * sigma);
      // The distance from the axis falls when the axis comes nearer.
      Eigen::Matrix<double, 5, 1> row;
      row << -placed.across_u, -placed.across_v, -placed.along * placed.across_u / frame_.half_mm(),
          -placed.along * placed.across_v / frame_.half_mm(), -1;
      row *= model.slope;
      const auto r = static_cast<Eigen::Index>(4 + placed.stretch);
      const auto add = [&](Eigen::MatrixXd& to_normal, Eigen::VectorXd& to_right) {
        to_normal.topLeftCorner<4, 4>() += weight * row.head<4>() * row.head<4>().transpose();
        to_normal.block<4, 1>(0, r) += weight * row[4] * row.head<4>();
        to_normal(r, r) += weight * row[4] * row[4];
        to_right.head<4>() += weight * residual * row.head<4>();
        to_right[r] += weight * residual * row[4];
      };
      add(normal, right);
      if (!by_eighth) continue;
      PartOfFit& eighth = (*by_eighth)[placed.stretch * kSectors + sector];
      add(eighth.normal, eighth.right);
    }
    const auto mirror = [n](Eigen::MatrixXd& of) {
      of.bottomLeftCorner(n - 4, 4) = of.topRightCorner(4, n - 4).transpose();
    };
    mirror(normal);
    if (by_eighth)
      for (PartOfFit& eighth : *by_eighth) mirror(eighth.normal);
    const double stiff = 1 / (kRadiusChange_mm * kRadiusChange_mm);
    for (Eigen::Index s = 4; s + 1 < n; ++s) {
      const double change =
          radius_[static_cast<std::size_t>(s - 3)] - radius_[static_cast<std::size_t>(s - 4)];
      normal(s, s) += stiff;
      normal(s + 1, s + 1) += stiff;
      normal(s, s + 1) -= stiff;
      normal(s + 1, s) -= stiff;
      right[s] += stiff * change;
      right[s + 1] -= stiff * change;
    }
    normal.diagonal().array() += 1e-3;
  }

  enum class Moves { All, Radii };
  // One step; how far it went, mm.
  double improve(Moves moves = Moves::All) {
    Eigen::MatrixXd normal;
    Eigen::VectorXd right;
    assemble(normal, right);
    const auto radii = static_cast<Eigen::Index>(stretches_);
    Eigen::VectorXd change = Eigen::VectorXd::Zero(4 + radii);
    if (moves == Moves::All)
      change = normal.ldlt().solve(right);
    else
      change.tail(radii) = normal.bottomRightCorner(radii, radii).ldlt().solve(right.tail(radii));
    constexpr double kMost_mm = 0.5;
    const double most = change.cwiseAbs().maxCoeff();
    if (!std::isfinite(most)) return std::numeric_limits<double>::infinity();
    if (most > kMost_mm) change *= kMost_mm / most;
    frame_.move(change.head<4>());
    for (std::size_t s = 0; s < stretches_; ++s)
      radius_[s] = std::clamp(radius_[s] + change[static_cast<Eigen::Index>(4 + s)], 1.0, 10.0);
    return change.cwiseAbs().maxCoeff();
  }

  [[nodiscard]] std::vector<Stretch> described(const Eigen::MatrixXd& covariance) const {
    std::vector<Stretch> result(stretches_);
    const std::vector<SeenWall> seen = seen_walls(levels_, stretches_, profile_.has_rim());
    for (std::size_t s = 0; s < stretches_; ++s) {
      Stretch& stretch = result[s];
      stretch.from_entry_mm =
          frame_.middle_from_entry_mm() - frame_.half_mm() +
          (static_cast<double>(s) + 0.5) * 2 * frame_.half_mm() / static_cast<double>(stretches_);
      stretch.diameter_mm = 2 * radius_[s];
      const auto r = static_cast<Eigen::Index>(4 + s);
      stretch.sigma_mm = 2 * std::sqrt(std::max(0.0, covariance(r, r)));
      stretch.seen_share = seen[s].share;
      stretch.metal_share = metal_[s].mean();
      stretch.inside_hu = seen[s].inside_hu;
      stretch.outside_hu = seen[s].outside_hu;
    }
    return result;
  }

  [[nodiscard]] FitSpread spread() const {
    Eigen::MatrixXd normal;
    Eigen::VectorXd right;
    std::vector<PartOfFit> by_eighth;
    assemble(normal, right, &by_eighth);
    return spread_of(normal, by_eighth);
  }

  [[nodiscard]] TunnelFit result() const {
    TunnelFit fit;
    const FitSpread known = spread();
    if (!known.by_noise.allFinite() || !known.by_disagreement.allFinite()) return fit;
    fit.is_fitted = true;
    fit.freedom = known.freedom;
    fit.point_mm = frame_.middle();
    fit.direction = frame_.direction();
    Eigen::Matrix<double, 2, 4> at_entry = Eigen::Matrix<double, 2, 4>::Zero();
    at_entry(0, 0) = at_entry(1, 1) = 1;
    at_entry(0, 2) = at_entry(1, 3) = -frame_.middle_from_entry_mm() / frame_.half_mm();
    const auto the_larger = [&](const auto& sigma_of) {
      return std::max(sigma_of(known.by_noise), sigma_of(known.by_disagreement));
    };
    fit.entry_sigma_mm = the_larger([&](const Eigen::MatrixXd& covariance) {
      return std::sqrt((at_entry * covariance.topLeftCorner<4, 4>() * at_entry.transpose()).trace());
    });
    fit.direction_sigma_rad = the_larger([&](const Eigen::MatrixXd& covariance) {
      return std::sqrt(covariance(2, 2) + covariance(3, 3)) / frame_.half_mm();
    });
    fit.stretches = described(known.by_noise);
    std::vector<double> radii;
    Eigen::VectorXd share = Eigen::VectorXd::Zero(known.by_noise.rows());
    for (std::size_t s = 0; s < stretches_; ++s) {
      const Stretch& stretch = fit.stretches[s];
      if (stretch.sigma_mm >= 0.5 || stretch.seen_share <= 0.3) continue;
      radii.push_back(0.5 * stretch.diameter_mm);
      share[static_cast<Eigen::Index>(4 + s)] = 1;
    }
    fit.radius_mm = geometry::median(radii, radius_[stretches_ / 2]);
    fit.profile = profile_;
    if (radii.empty()) return fit;
    share /= share.sum();
    fit.diameter_sigma_mm =
        2 * std::hypot(profile_.wall_sigma_mm, the_larger([&](const Eigen::MatrixXd& covariance) {
                         return std::sqrt(share.dot(covariance * share));
                       }));
    return fit;
  }

  const std::vector<WallVoxel>& voxels_;
  NearVoxels near_;
  Wall wall_;
  BoreFrame frame_;
  std::size_t stretches_, bins_;
  std::vector<double> radius_;
  std::vector<WallLevels> levels_;  // by bins
  std::vector<Level> metal_, metal_of_bin_;
  std::vector<PlacedVoxel> placed_;
  std::vector<FittedVoxel> fitted_;
  double noise_hu_ = 25;
  WallProfile profile_;
};

}  // namespace

TunnelFit fit_tunnel(const std::vector<WallVoxel>& voxels, const Bore& bore, double from_mm, double to_mm,
                     Wall wall, const std::optional<WallProfile>& known) {
  return Fit(voxels, bore, from_mm, to_mm, wall).run(known);
}

}  // namespace arthronaut::postop
