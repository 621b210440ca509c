#include "planning/postop/tunnel_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "planning/geometry/quantile.h"
#include "planning/postop/fit_spread.h"
#include "planning/postop/wall_picture.h"

namespace arthronaut::postop {

namespace {

using Eigen::Vector3d;

constexpr std::size_t kSectors = WallLevels::kSectors;
constexpr double kStretch_mm = 4;
// The numbers: the axis' four, the blur, and from here on the radii.
constexpr Eigen::Index kBlur = 4, kRadii = 5;
// Seen with so much blur at first, the wall is found from further off.
constexpr double kFirstBlur_mm = 1.0;
// Radii of neighbouring stretches differ by this, one sigma.
constexpr double kRadiusChange_mm = 0.4;

class Fit {
 public:
  Fit(const std::vector<WallVoxel>& voxels, const Bore& bore, double from_mm, double to_mm, Wall wall)
      : wall_(wall),
        bore_(shape_of(BoreFrame(bore.entry_mm, bore.direction, from_mm, to_mm), bore.radius_mm)),
        picture_(voxels, bore_, wall) {}

  // `known`: not to be sought, but for the blur where that is to be fitted.
  TunnelFit run(const std::optional<WallProfile>& known, Blur blur) {
    if (known) bore_.profile = *known;
    see_through_blur(WallProfile{}.blur_mm);
    if (!settle(kFirstBlur_mm)) return {};
    // The axis that is found with a rim tells better what the rim is.
    constexpr int kRounds = 3;
    for (int round = 0; round < kRounds && !known && wall_ == Wall::Clear; ++round) {
      const bool had_rim = bore_.profile.has_rim();
      const WallProfile seen = seen_wall();
      bore_.profile.wall_sigma_mm = seen.wall_sigma_mm;
      bore_.profile.plain_blur_mm = seen.plain_blur_mm;
      bore_.profile.layer_mm = seen.layer_mm;
      if (!seen.has_rim() && !had_rim) break;
      bore_.profile = seen.has_rim() ? seen
                                     : WallProfile{.plain_blur_mm = seen.plain_blur_mm,
                                                   .wall_sigma_mm = seen.wall_sigma_mm,
                                                   .layer_mm = seen.layer_mm};
      for (double& radius : bore_.radius_mm) radius += seen.wall_mm + bore_.seems_nearer_mm(radius);
      if (!settle(bore_.profile.blur_mm)) return {};
    }
    // How wide a bore without a rim is, and where it lies in bone that changes beside it, follows from how
    // much the images are blurred, which is seen by now.
    if (see_through_blur(bore_.profile.blur_mm) && !settle(bore_.profile.blur_mm)) return {};
    // Through which blur all of the wall is explained best, cortex, too, which tells the most.
    fits_blur_ = blur == Blur::Fitted && wall_ == Wall::Clear && !bore_.profile.has_rim();
    if (fits_blur_ && !settle(bore_.profile.blur_mm)) return {};
    return result();
  }

 private:
  // Cortex beside the bore makes its wall look sharper and further in: where that is to be seen, by the
  // voxels alone that lie as deep as marrow; else by all of them, which tell more.
  [[nodiscard]] WallProfile seen_wall() const {
    const double noise_hu = picture_.profile_noise_hu(), shared = spread().shared_voxels;
    const WallProfile all = explain_wall(picture_.mean_profile(0), noise_hu, shared),
                      deep = explain_wall(picture_.mean_profile(kDeep_mm), noise_hu, shared);
    return all.is_like(deep) ? all : deep;
  }

  // From a blur that sees far to the scanner's own. False where nothing is to be found.
  bool settle(double first_blur_mm) {
    constexpr int kSteps = 24;
    for (int step = 0; step < kSteps; ++step) {
      const double blur = fits_blur_ ? bore_.profile.blur_mm
                                     : std::max(bore_.profile.blur_mm, first_blur_mm * std::pow(0.8, step));
      picture_.take(blur);
      const double moved = improve();
      if (!(moved < 1e3)) return false;
      if ((fits_blur_ || blur == bore_.profile.blur_mm) && moved < 0.004) break;
    }
    picture_.take(bore_.profile.blur_mm);
    return true;
  }

  // Without a rim: by which the wall looks most like this, else this. Whether it was another before.
  bool see_through_blur(double otherwise_mm) {
    const double before_mm = bore_.profile.blur_mm;
    if (!bore_.profile.has_rim())
      bore_.profile.blur_mm = bore_.profile.plain_blur_mm > 0 ? bore_.profile.plain_blur_mm : otherwise_mm;
    return bore_.profile.blur_mm != before_mm;
  }

  // `by_eighth`: what each eighth of each stretch alone puts into both.
  void assemble(Eigen::MatrixXd& normal, Eigen::VectorXd& right,
                std::vector<PartOfFit>* by_eighth = nullptr) const {
    const auto n = kRadii + static_cast<Eigen::Index>(bore_.stretches());
    normal = Eigen::MatrixXd::Zero(n, n);
    right = Eigen::VectorXd::Zero(n);
    if (by_eighth)
      by_eighth->assign(bore_.stretches() * kSectors,
                        {Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)});
    std::vector<OwnOfCell> own = picture_.own_of_cells(n);
    for (const auto& [placed, sector, cell, voxel, grey, model] : picture_.fitted()) {
      const double residual = voxel->hu - model.value, weight = picture_.weight_of(residual, model.variance);
      // The distance from the axis falls when the axis comes nearer.
      Eigen::Matrix<double, kRadii, 1> row;
      row << -placed.across_u, -placed.across_v, -placed.along * placed.across_u / bore_.frame.half_mm(),
          -placed.along * placed.across_v / bore_.frame.half_mm(), 0;
      row *= model.slope;
      if (fits_blur_) row[kBlur] = model.by_blur;
      const double by_radius = -model.slope;
      const auto r = kRadii + static_cast<Eigen::Index>(placed.stretch);
      const auto add = [&](Eigen::MatrixXd& to_normal, Eigen::VectorXd& to_right) {
        to_normal.topLeftCorner<kRadii, kRadii>() += weight * row * row.transpose();
        to_normal.block<kRadii, 1>(0, r) += weight * by_radius * row;
        to_normal(r, r) += weight * by_radius * by_radius;
        to_right.head<kRadii>() += weight * residual * row;
        to_right[r] += weight * residual * by_radius;
      };
      own[cell].with_others.topRows<kRadii>() += weight * row * model.bone.transpose();
      own[cell].with_others.row(r) += weight * by_radius * model.bone.transpose();
      own[cell].normal += weight * model.bone * model.bone.transpose();
      own[cell].right += weight * residual * model.bone;
      add(normal, right);
      if (!by_eighth) continue;
      PartOfFit& eighth = (*by_eighth)[placed.stretch * kSectors + sector];
      add(eighth.normal, eighth.right);
    }
    const auto mirror = [n](Eigen::MatrixXd& of) {
      of.bottomLeftCorner(n - kRadii, kRadii) = of.topRightCorner(kRadii, n - kRadii).transpose();
    };
    mirror(normal);
    if (by_eighth)
      for (PartOfFit& eighth : *by_eighth) mirror(eighth.normal);
    for (std::size_t cell = 0; cell < own.size(); ++cell) {
      own[cell].take_out_of(normal, right);
      if (!by_eighth) continue;
      PartOfFit& eighth = (*by_eighth)[picture_.eighth_of(cell)];
      own[cell].take_out_of(eighth.normal, eighth.right);
    }
    const double stiff = 1 / (kRadiusChange_mm * kRadiusChange_mm);
    for (Eigen::Index s = kRadii; s + 1 < n; ++s) {
      const auto stretch = static_cast<std::size_t>(s - kRadii);
      const double change = bore_.radius_mm[stretch + 1] - bore_.radius_mm[stretch];
      normal(s, s) += stiff;
      normal(s + 1, s + 1) += stiff;
      normal(s, s + 1) -= stiff;
      normal(s + 1, s) -= stiff;
      right[s] += stiff * change;
      right[s + 1] -= stiff * change;
    }
    normal.diagonal().array() += 1e-3;
  }

  // One step; how far it went, mm.
  double improve() {
    Eigen::MatrixXd normal;
    Eigen::VectorXd right;
    assemble(normal, right);
    Eigen::VectorXd change = normal.ldlt().solve(right);
    constexpr double kMost_mm = 0.5;
    const double most = change.cwiseAbs().maxCoeff();
    if (!std::isfinite(most)) return std::numeric_limits<double>::infinity();
    if (most > kMost_mm) change *= kMost_mm / most;
    bore_.frame.move(change.head<4>());
    for (std::size_t s = 0; s < bore_.stretches(); ++s)
      bore_.radius_mm[s] =
          std::clamp(bore_.radius_mm[s] + change[kRadii + static_cast<Eigen::Index>(s)], 1.0, 10.0);
    if (fits_blur_)
      bore_.profile.plain_blur_mm = bore_.profile.blur_mm =
          std::clamp(bore_.profile.blur_mm + change[kBlur], kLeastSeenBlur_mm, kMostSeenBlur_mm);
    return change.cwiseAbs().maxCoeff();
  }

  [[nodiscard]] std::vector<Stretch> described(const FitSpread& known) const {
    std::vector<Stretch> result(bore_.stretches());
    const std::vector<SeenWall> seen =
        seen_walls(picture_.levels(), bore_.stretches(), bore_.profile.has_rim());
    for (std::size_t s = 0; s < bore_.stretches(); ++s) {
      Stretch& stretch = result[s];
      stretch.from_entry_mm =
          bore_.frame.middle_from_entry_mm() - bore_.frame.half_mm() +
          (static_cast<double>(s) + 0.5) * 2 * bore_.frame.half_mm() / static_cast<double>(bore_.stretches());
      stretch.diameter_mm = 2 * bore_.radius_mm[s];
      const auto r = kRadii + static_cast<Eigen::Index>(s);
      stretch.noise_sigma_mm = 2 * std::sqrt(std::max(0.0, known.by_noise(r, r)));
      stretch.diameter_sigma_mm =
          2 * std::hypot(bore_.profile.wall_sigma_mm,
                         std::sqrt(std::max({0.0, known.by_noise(r, r), known.by_disagreement(r, r)})));
      stretch.seen_share = seen[s].share;
      stretch.metal_share = picture_.metal_share(s);
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
    fit.point_mm = bore_.frame.middle();
    fit.direction = bore_.frame.direction();
    Eigen::Matrix<double, 2, 4> at_entry = Eigen::Matrix<double, 2, 4>::Zero();
    at_entry(0, 0) = at_entry(1, 1) = 1;
    at_entry(0, 2) = at_entry(1, 3) = -bore_.frame.middle_from_entry_mm() / bore_.frame.half_mm();
    const auto the_larger = [&](const auto& sigma_of) {
      return std::max(sigma_of(known.by_noise), sigma_of(known.by_disagreement));
    };
    fit.entry_sigma_mm = the_larger([&](const Eigen::MatrixXd& covariance) {
      return std::sqrt((at_entry * covariance.topLeftCorner<4, 4>() * at_entry.transpose()).trace());
    });
    fit.direction_sigma_rad = the_larger([&](const Eigen::MatrixXd& covariance) {
      return std::sqrt(covariance(2, 2) + covariance(3, 3)) / bore_.frame.half_mm();
    });
    fit.stretches = described(known);
    std::vector<double> radii;
    Eigen::VectorXd share = Eigen::VectorXd::Zero(known.by_noise.rows());
    for (std::size_t s = 0; s < bore_.stretches(); ++s) {
      const Stretch& stretch = fit.stretches[s];
      if (stretch.noise_sigma_mm >= 0.5 || stretch.seen_share <= 0.3) continue;
      radii.push_back(0.5 * stretch.diameter_mm);
      share[kRadii + static_cast<Eigen::Index>(s)] = 1;
    }
    fit.radius_mm = geometry::median(radii, bore_.radius_mm[bore_.stretches() / 2]);
    fit.profile = bore_.profile;
    if (radii.empty()) return fit;
    share /= share.sum();
    fit.diameter_sigma_mm =
        2 * std::hypot(bore_.profile.wall_sigma_mm, the_larger([&](const Eigen::MatrixXd& covariance) {
                         return std::sqrt(share.dot(covariance * share));
                       }));
    return fit;
  }

  static BoreShape shape_of(const BoreFrame& frame, double radius_mm) {
    return {frame, std::vector<double>(frame.parts_of(kStretch_mm), radius_mm)};
  }

  Wall wall_;
  bool fits_blur_ = false;
  BoreShape bore_;
  WallPicture picture_;
};

}  // namespace

TunnelFit fit_tunnel(const std::vector<WallVoxel>& voxels, const Bore& bore, double from_mm, double to_mm,
                     Wall wall, const std::optional<WallProfile>& known, Blur blur) {
  return Fit(voxels, bore, from_mm, to_mm, wall).run(known, blur);
}

}  // namespace arthronaut::postop
