#include "planning/postop/tunnel_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "planning/geometry/quantile.h"

namespace arthronaut::postop {

namespace {

using Eigen::Vector3d;

constexpr int kSectors = 8;
constexpr double kStretch_mm = 4;
constexpr double kBin_mm = 2;  // of the levels
// From the wall inwards and outwards. A bored bone heals with a dense rim, thin as a cortex: further out the
// grey is the marrow's again.
constexpr double kInward_mm = 1.8, kOutward_mm = 1.2, kBesideWallFrom_mm = 0.6;
constexpr double kBesideMetal_mm = 1.5;
// Near the bone's own surface its own edge is in the picture.
constexpr double kLeastDepth_mm = 0.9;
// The scanner's blur, voxel included.
constexpr double kFirstBlur_mm = 1.0, kBlur_mm = 0.5;
// A station with more metal than this inside the bore or beside its wall is passed over as a whole: what is
// left of its wall is seen one-sidedly, and through the metal's blur.
constexpr double kMetalOfBin = 0.02, kBesideWall_mm = 1.5;
// Neighbouring voxels share their noise.
constexpr double kCorrelated = 4;
constexpr double kLeastNoise_hu = 6;
// Differences that are no chance.
constexpr double kSeenSigmas = 3, kSeen_hu = 15;
// Radii of neighbouring stretches differ by this, one sigma.
constexpr double kRadiusChange_mm = 0.4;
constexpr double kHuber = 2.5;

struct Axis {
  Vector3d middle, direction, u, v;

  void set_direction(const Vector3d& d) {
    direction = d.normalized();
    u = direction.unitOrthogonal();
    v = direction.cross(u);
  }
};

struct Placed {
  double along, off;          // from the axis' middle; from the axis
  double across_u, across_v;  // unit
  std::size_t stretch, bin, sector;
};

struct Level {
  double sum = 0, squares = 0;
  int count = 0;
  void add(double v) {
    sum += v;
    squares += v * v;
    ++count;
  }
  void add(const Level& other) {
    sum += other.sum;
    squares += other.squares;
    count += other.count;
  }
  [[nodiscard]] double mean() const { return count > 0 ? sum / count : 0; }
  [[nodiscard]] double variance() const {
    return count > 1 ? std::max(0.0, squares / count - mean() * mean()) : 1e6;
  }
};

double cumulated(double z) { return 0.5 * std::erfc(-z * M_SQRT1_2); }
double density(double z) { return std::exp(-0.5 * z * z) / std::sqrt(2 * M_PI); }

class Fit {
 public:
  Fit(const std::vector<WallVoxel>& voxels, const Bore& bore, double from_mm, double to_mm, Wall wall)
      : voxels_(voxels), wall_(wall), half_mm_(0.5 * (to_mm - from_mm)) {
    axis_.set_direction(bore.direction);
    axis_.middle = bore.entry_mm + 0.5 * (from_mm + to_mm) * axis_.direction;
    from_entry_mm_ = 0.5 * (from_mm + to_mm);
    stretches_ = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(2 * half_mm_ / kStretch_mm)));
    bins_ = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(2 * half_mm_ / kBin_mm)));
    radius_.assign(stretches_, bore.radius_mm);
  }

  TunnelFit run() {
    constexpr int kSteps = 24;
    bool is_settled = false;
    for (int step = 0; step < kSteps; ++step) {
      const double blur = std::max(kBlur_mm, kFirstBlur_mm * std::pow(0.8, step));
      take_levels(blur);
      const double moved = improve(blur);
      if (!(moved < 1e3)) return {};
      is_settled = blur == kBlur_mm && moved < 0.004;
      if (is_settled) break;
    }
    take_levels(kBlur_mm);
    return result();
  }

 private:
  [[nodiscard]] bool counts(const WallVoxel& voxel, const Placed& placed) const {
    if (wall_ == Wall::Screw) return true;
    return !voxel.is_metal && !voxel.is_by_metal && metal_of_bin_[placed.bin].mean() < kMetalOfBin;
  }

  [[nodiscard]] std::optional<Placed> place(const Vector3d& p) const {
    Placed placed{};
    const Vector3d w = p - axis_.middle;
    placed.along = w.dot(axis_.direction);
    if (std::abs(placed.along) >= half_mm_) return std::nullopt;
    const double a = w.dot(axis_.u), b = w.dot(axis_.v);
    placed.off = std::hypot(a, b);
    const double share = (placed.along + half_mm_) / (2 * half_mm_);
    placed.stretch = static_cast<std::size_t>(share * static_cast<double>(stretches_));
    placed.bin = static_cast<std::size_t>(share * static_cast<double>(bins_));
    if (placed.off > 1e-9) {
      placed.across_u = a / placed.off;
      placed.across_v = b / placed.off;
    }
    placed.sector = static_cast<std::size_t>((std::atan2(b, a) / M_PI + 1) * 0.5 * kSectors) % kSectors;
    return placed;
  }

  // Means well inside and well outside the wall, and the noise about what they predict.
  void take_levels(double blur) {
    inside_.assign(bins_, {});
    metal_of_bin_.assign(bins_, {});
    for (const WallVoxel& voxel : voxels_) {
      const auto placed = place(voxel.p_mm);
      if (placed && placed->off < radius_[placed->stretch] + kBesideWall_mm)
        metal_of_bin_[placed->bin].add(voxel.is_metal ? 1 : 0);
    }
    outside_.assign(bins_ * kSectors, {});
    metal_.assign(stretches_, {});
    placed_.clear();
    for (std::size_t i = 0; i < voxels_.size(); ++i) {
      const auto placed = place(voxels_[i].p_mm);
      if (!placed) continue;
      const double off = placed->off - radius_[placed->stretch];
      if (off < -0.4) metal_[placed->stretch].add(voxels_[i].is_metal ? 1 : 0);
      if (!counts(voxels_[i], *placed) || off > kOutward_mm || off < -kInward_mm - 1) continue;
      if (off < -kBesideWallFrom_mm) inside_[placed->bin].add(voxels_[i].hu);
      if (off > kBesideWallFrom_mm) outside_[placed->bin * kSectors + placed->sector].add(voxels_[i].hu);
      if (off > -kInward_mm) placed_.emplace_back(*placed, voxels_[i].hu);
    }
    std::vector<double> off_model;
    for (const auto& [placed, hu] : placed_) {
      if (const auto model = model_at(placed, blur)) off_model.push_back(std::abs(hu - model->value));
    }
    noise_hu_ = std::max(kLeastNoise_hu, 1.4826 * geometry::median(std::move(off_model), 1e3));
  }

  struct Model {
    double value, slope;  // slope: by the distance from the axis
    double variance;      // of what the levels are made of: beside a cortex that slants there is no one level
  };
  [[nodiscard]] std::optional<Model> model_at(const Placed& placed, double blur) const {
    const Level &in = inside_[placed.bin], &out = outside_[placed.bin * kSectors + placed.sector];
    if (in.count < 8 || out.count < 4) return std::nullopt;
    const double z = (placed.off - radius_[placed.stretch]) / blur, a = in.mean(), b = out.mean();
    return Model{a + (b - a) * cumulated(z), (b - a) * density(z) / blur,
                 std::max(in.variance(), out.variance())};
  }

  void assemble(double blur, Eigen::MatrixXd& normal, Eigen::VectorXd& right) const {
    const auto n = static_cast<Eigen::Index>(4 + stretches_);
    normal = Eigen::MatrixXd::Zero(n, n);
    right = Eigen::VectorXd::Zero(n);
    for (const auto& [placed, hu] : placed_) {
      const auto model = model_at(placed, blur);
      if (!model) continue;
      const double residual = hu - model->value,
                   sigma = std::sqrt(0.5 * (noise_hu_ * noise_hu_ + model->variance)),
                   weight =
                       std::min(1.0, kHuber * sigma / std::max(1e-9, std::abs(residual))) / (sigma * sigma);
      // The distance from the axis falls when the axis comes nearer.
      Eigen::Matrix<double, 5, 1> row;
      row << -placed.across_u, -placed.across_v, -placed.along * placed.across_u / half_mm_,
          -placed.along * placed.across_v / half_mm_, -1;
      row *= model->slope;
      const auto r = static_cast<Eigen::Index>(4 + placed.stretch);
      normal.topLeftCorner<4, 4>() += weight * row.head<4>() * row.head<4>().transpose();
      normal.block<4, 1>(0, r) += weight * row[4] * row.head<4>();
      normal(r, r) += weight * row[4] * row[4];
      right.head<4>() += weight * residual * row.head<4>();
      right[r] += weight * residual * row[4];
    }
    normal.bottomLeftCorner(n - 4, 4) = normal.topRightCorner(4, n - 4).transpose();
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

  // One step; how far it went, mm.
  double improve(double blur) {
    Eigen::MatrixXd normal;
    Eigen::VectorXd right;
    assemble(blur, normal, right);
    Eigen::VectorXd change = normal.ldlt().solve(right);
    constexpr double kMost_mm = 0.5;
    const double most = change.cwiseAbs().maxCoeff();
    if (!std::isfinite(most)) return std::numeric_limits<double>::infinity();
    if (most > kMost_mm) change *= kMost_mm / most;
    axis_.middle += change[0] * axis_.u + change[1] * axis_.v;
    axis_.set_direction(axis_.direction + (change[2] * axis_.u + change[3] * axis_.v) / half_mm_);
    for (std::size_t s = 0; s < stretches_; ++s)
      radius_[s] = std::clamp(radius_[s] + change[static_cast<Eigen::Index>(4 + s)], 1.0, 10.0);
    return change.cwiseAbs().maxCoeff();
  }

  [[nodiscard]] std::vector<Stretch> described(const Eigen::MatrixXd& covariance) const {
    std::vector<Stretch> result(stretches_);
    std::vector<double> seen(stretches_, 0), darker(stretches_, 0), all(stretches_, 0), in(stretches_, 0),
        out(stretches_, 0);
    std::vector<Level> within(stretches_), beside(stretches_ * kSectors);
    for (std::size_t bin = 0; bin < bins_; ++bin) {
      const std::size_t s = std::min(stretches_ - 1, (2 * bin + 1) * stretches_ / (2 * bins_));
      within[s].add(inside_[bin]);
      for (std::size_t sector = 0; sector < kSectors; ++sector)
        beside[s * kSectors + sector].add(outside_[bin * kSectors + sector]);
    }
    for (std::size_t s = 0; s < stretches_; ++s) {
      const Level& a = within[s];
      for (std::size_t sector = 0; sector < kSectors; ++sector) {
        const Level& b = beside[s * kSectors + sector];
        if (b.count < 4) continue;
        const double weight = b.count;
        all[s] += weight;
        if (a.count < 8) continue;
        const double contrast = std::abs(b.mean() - a.mean()),
                     sigma = std::sqrt(kCorrelated * (a.variance() / a.count + b.variance() / b.count));
        if (contrast < std::max(kSeen_hu, kSeenSigmas * sigma)) continue;
        seen[s] += weight;
        darker[s] += b.mean() > a.mean() ? weight : -weight;
        in[s] += weight * a.mean();
        out[s] += weight * b.mean();
      }
    }
    for (std::size_t s = 0; s < stretches_; ++s) {
      Stretch& stretch = result[s];
      stretch.from_entry_mm = from_entry_mm_ - half_mm_ +
                              (static_cast<double>(s) + 0.5) * 2 * half_mm_ / static_cast<double>(stretches_);
      stretch.diameter_mm = 2 * radius_[s];
      const auto r = static_cast<Eigen::Index>(4 + s);
      stretch.sigma_mm = 2 * std::sqrt(std::max(0.0, covariance(r, r)));
      stretch.seen_share = all[s] > 0 ? std::abs(darker[s]) / all[s] : 0;
      stretch.metal_share = metal_[s].mean();
      stretch.inside_hu = seen[s] > 0 ? in[s] / seen[s] : 0;
      stretch.outside_hu = seen[s] > 0 ? out[s] / seen[s] : 0;
    }
    return result;
  }

  [[nodiscard]] TunnelFit result() const {
    TunnelFit fit;
    Eigen::MatrixXd normal;
    Eigen::VectorXd right;
    assemble(kBlur_mm, normal, right);
    const Eigen::MatrixXd covariance = kCorrelated * normal.inverse();
    if (!covariance.allFinite()) return fit;
    fit.is_fitted = true;
    fit.point_mm = axis_.middle;
    fit.direction = axis_.direction;
    Eigen::Matrix<double, 2, 4> at_entry = Eigen::Matrix<double, 2, 4>::Zero();
    at_entry(0, 0) = at_entry(1, 1) = 1;
    at_entry(0, 2) = at_entry(1, 3) = -from_entry_mm_ / half_mm_;
    const Eigen::Matrix4d of_axis = covariance.topLeftCorner<4, 4>();
    fit.entry_sigma_mm = std::sqrt((at_entry * of_axis * at_entry.transpose()).trace());
    fit.direction_sigma_rad = std::sqrt(of_axis(2, 2) + of_axis(3, 3)) / half_mm_;
    fit.stretches = described(covariance);
    std::vector<double> radii;
    for (const Stretch& stretch : fit.stretches)
      if (stretch.sigma_mm < 0.5 && stretch.seen_share > 0.3) radii.push_back(0.5 * stretch.diameter_mm);
    fit.radius_mm = geometry::median(radii, radius_[stretches_ / 2]);
    return fit;
  }

  const std::vector<WallVoxel>& voxels_;
  Wall wall_;
  double half_mm_, from_entry_mm_ = 0;
  Axis axis_{};
  std::size_t stretches_ = 1, bins_ = 1;
  std::vector<double> radius_;
  std::vector<Level> inside_, outside_, metal_, metal_of_bin_;
  std::vector<std::pair<Placed, float>> placed_;
  double noise_hu_ = 25;
};

}  // namespace

std::vector<WallVoxel> wall_voxels(const images::Volume& postop,
                                   const geometry::RigidTransform& plan_from_postop, const BoneGrid& grid,
                                   const Bore& bore, double length_mm, double reach_mm) {
  const geometry::RigidTransform postop_from_plan = plan_from_postop.inverse();
  const Eigen::Affine3d index_from_lps = postop.lps_from_index.inverse();
  Vector3d low = Vector3d::Constant(1e9), high = -low;
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d u = bore.direction.unitOrthogonal(), v = bore.direction.cross(u);
    const Vector3d p = bore.entry_mm + (corner & 1 ? length_mm + 2 : -2) * bore.direction +
                       (corner & 2 ? reach_mm : -reach_mm) * u + (corner & 4 ? reach_mm : -reach_mm) * v;
    const Vector3d index = index_from_lps * (postop_from_plan * p);
    low = low.cwiseMin(index);
    high = high.cwiseMax(index);
  }
  const Eigen::Vector3i first = low.array().floor().cast<int>().max(0),
                        last = high.array().ceil().cast<int>().min(postop.size.array() - 1);
  const Eigen::Vector3i beside = (kBesideMetal_mm / postop.spacing_mm().array()).ceil().cast<int>();
  const auto is_by_metal = [&](int i, int j, int k) {
    for (int dk = -beside.z(); dk <= beside.z(); ++dk) {
      for (int dj = -beside.y(); dj <= beside.y(); ++dj) {
        for (int di = -beside.x(); di <= beside.x(); ++di) {
          const Eigen::Vector3i at(i + di, j + dj, k + dk);
          if ((at.array() < 0).any() || (at.array() >= postop.size.array()).any()) continue;
          if (postop.at(at.x(), at.y(), at.z()) > kMetal_hu) return true;
        }
      }
    }
    return false;
  };
  bool has_metal = false;
  for (int k = first.z(); k <= last.z() && !has_metal; ++k)
    for (int j = first.y(); j <= last.y() && !has_metal; ++j)
      for (int i = first.x(); i <= last.x() && !has_metal; ++i) has_metal = postop.at(i, j, k) > kMetal_hu;
  std::vector<WallVoxel> voxels;
  for (int k = first.z(); k <= last.z(); ++k) {
    for (int j = first.y(); j <= last.y(); ++j) {
      for (int i = first.x(); i <= last.x(); ++i) {
        const Vector3d p = plan_from_postop * (postop.lps_from_index * Vector3d(i, j, k));
        const double along = (p - bore.entry_mm).dot(bore.direction);
        if (along < -2 || along > length_mm + 2 ||
            (p - bore.entry_mm - along * bore.direction).norm() > reach_mm ||
            grid.depth_at(p) < kLeastDepth_mm)
          continue;
        const float hu = postop.at(i, j, k);
        voxels.push_back({p, hu, hu > kMetal_hu, has_metal && is_by_metal(i, j, k)});
      }
    }
  }
  return voxels;
}

TunnelFit fit_tunnel(const std::vector<WallVoxel>& voxels, const Bore& bore, double from_mm, double to_mm,
                     Wall wall) {
  return Fit(voxels, bore, from_mm, to_mm, wall).run();
}

}  // namespace arthronaut::postop
