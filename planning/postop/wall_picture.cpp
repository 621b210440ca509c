#include "planning/postop/wall_picture.h"

#include <algorithm>
#include <cmath>

#include "planning/geometry/quantile.h"

namespace arthronaut::postop {

namespace {

constexpr std::size_t kSectors = WallLevels::kSectors;
constexpr double kBin_mm = 2;  // of the levels
// From the wall inwards, and from it or from the rim about it outwards; farther out it is still seen what the
// bone is like.
constexpr double kInward_mm = 1.8, kOutward_mm = 1.2, kBesideWallFrom_mm = 0.6, kBoneTo_mm = 2.5;
// Of the profile that tells whether there is a rim: as far inwards, for what was taken for the wall may be
// the rim's outer side.
constexpr double kProfileTo_mm = 3, kPoint_mm = 0.2;
// A station with more metal than this inside the bore or beside its wall is passed over as a whole: what is
// left of its wall is seen one-sidedly, and through the metal's blur.
constexpr double kMetalOfBin = 0.02, kBesideWall_mm = 1.5;
// From the wall inwards, of the shade across the inside: nothing of the wall's blur is there.
constexpr double kShadeFrom_mm = 1.2;
constexpr double kLeastNoise_hu = 6;
constexpr double kHuber = 2.5;
constexpr double kNoRim_hu = -1e4;  // less dense than anything: what is beyond the wall begins at it

}  // namespace

void InsideShade::add(std::size_t bin, const Eigen::Vector2d& across_mm, double hu) {
  Sums& sums = sums_[bin];
  ++sums.count;
  sums.hu += hu;
  sums.place += across_mm;
  sums.with_hu += hu * across_mm;
  sums.with_place += across_mm * across_mm.transpose();
}

void InsideShade::settle() {
  constexpr std::size_t kBeside = 1, kLeast = 100;  // steps to either side; voxels
  for (std::size_t bin = 0; bin < sums_.size(); ++bin) {
    double count = 0;
    Eigen::Matrix2d normal = Eigen::Matrix2d::Identity();
    Eigen::Vector2d right = Eigen::Vector2d::Zero();
    // The steps' own means differ.
    for (std::size_t i = bin - std::min(bin, kBeside); i < std::min(sums_.size(), bin + kBeside + 1); ++i) {
      const Sums& sums = sums_[i];
      if (sums.count == 0) continue;
      count += sums.count;
      normal += sums.with_place - sums.place * sums.place.transpose() / sums.count;
      right += sums.with_hu - sums.hu / sums.count * sums.place;
    }
    if (count >= kLeast) rise_[bin] = normal.ldlt().solve(right);
  }
}

WallPicture::WallPicture(const std::vector<WallVoxel>& voxels, const BoreShape& bore, Wall wall)
    : voxels_(voxels),
      near_(voxels),
      bore_(bore),
      wall_(wall),
      bins_(bore.frame.parts_of(kBin_mm)),
      outside_(bore.frame.parts_of(WallOutside::kStep_mm)) {}

bool WallPicture::counts(const WallVoxel& voxel, const PlacedByBore& placed) const {
  if (wall_ == Wall::Screw) return true;
  return !voxel.is_metal && !voxel.is_by_metal && metal_of_bin_[placed.bin].mean() < kMetalOfBin;
}

std::optional<PlacedByBore> WallPicture::place(const Eigen::Vector3d& p) const {
  return bore_.frame.place(p, bore_.stretches(), bins_);
}

// Means well inside and well outside the wall and the bone beyond it, what they make of each voxel through
// this blur, and the noise about that.
void WallPicture::take(double blur) {
  place_all();
  levels_.assign(bins_, {});
  const bool has_metal =
      wall_ == Wall::Clear && std::ranges::any_of(metal_of_bin_, [](const Level& of) { return of.sum > 0; });
  shade_.begin(has_metal ? bins_ : 0);
  metal_.assign(bore_.stretches(), {});
  fitted_.clear();
  for (const auto& [placed, voxel] : placed_) {
    const double off = placed.off - bore_.radius_mm[placed.stretch];
    if (off < -0.4) metal_[placed.stretch].add(voxel->is_metal ? 1 : 0);
    const double beyond = off - bore_.profile.rim_mm;
    if (!counts(*voxel, placed) || beyond > kOutward_mm || off < -kInward_mm - 1) continue;
    WallLevels& levels = levels_[placed.bin];
    const WallGrey grey = grey_at(placed, bore_.profile.blur_mm);
    if (off < -kBesideWallFrom_mm) levels.add_inside(voxel->hu, grey);
    if (has_metal && off < -kShadeFrom_mm)
      shade_.add(placed.bin, placed.off * Eigen::Vector2d(placed.across_u, placed.across_v), voxel->hu);
    if (off <= -kInward_mm) continue;
    const std::size_t sector = placed.sector(kSectors);
    if (beyond > kBesideWallFrom_mm) levels.add_outside(sector, voxel->hu, grey);
    if (off > 0 && beyond < 0) levels.add_rim(sector, voxel->hu);
    fitted_.push_back({placed,
                       sector,
                       cell_of(placed),
                       voxel,
                       blur == bore_.profile.blur_mm ? grey : grey_at(placed, blur),
                       {}});
  }
  shade_.settle();
  for (WallLevels& levels : levels_) levels.part(bore_.profile.has_rim() ? bore_.profile.rim_hu : kNoRim_hu);
  std::erase_if(fitted_, [&](const FittedVoxel& fitted) {
    const WallLevels& levels = levels_[fitted.placed.bin];
    return !levels.has_inside() || !levels.has_outside(fitted.sector);
  });
  take_bone(blur);
  std::vector<double> off_model;
  off_model.reserve(fitted_.size());
  for (const FittedVoxel& fitted : fitted_)
    off_model.push_back(std::abs(fitted.voxel->hu - fitted.model.value));
  noise_hu_ = std::max(kLeastNoise_hu, 1.4826 * geometry::median(std::move(off_model), 1e3));
}

void WallPicture::place_all() {
  metal_of_bin_.assign(bins_, {});
  placed_.clear();
  const double reach_mm = *std::ranges::max_element(bore_.radius_mm) + bore_.profile.rim_mm + kBoneTo_mm;
  for (const WallVoxel& voxel : near_.about(bore_.frame, reach_mm)) {
    const auto placed = place(voxel.p_mm);
    if (!placed || placed->off > reach_mm) continue;
    placed_.push_back({*placed, &voxel});
    if (placed->off < bore_.radius_mm[placed->stretch] + kBesideWall_mm)
      metal_of_bin_[placed->bin].add(voxel.is_metal ? 1 : 0);
  }
}

// The bone outside, from beyond the blur; then by what each cell is off it, as explains its wall best.
void WallPicture::take_bone(double blur) {
  outside_.clear();
  for (const auto& [placed, voxel] : placed_) {
    const double beyond = placed.off - bore_.radius_mm[placed.stretch] - bore_.profile.rim_mm;
    if (beyond < kBesideWallFrom_mm || beyond > kBoneTo_mm || !counts(*voxel, placed) ||
        !levels_[placed.bin].has_inside())
      continue;
    const double inside = grey_at(placed, bore_.profile.blur_mm).inside;
    outside_.add(cell_of(placed), voxel->depth_mm, (voxel->hu - inside * inside_hu(placed)) / (1 - inside));
  }
  outside_.settle(noise_hu_);
  for (FittedVoxel& fitted : fitted_) fitted.model = model_of(fitted, blur);
  constexpr int kRounds = 2;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<OwnOfCell> own = own_of_cells(0);
    for (const FittedVoxel& fitted : fitted_) {
      const double residual = fitted.voxel->hu - fitted.model.value,
                   weight = weight_of(residual, fitted.model.variance);
      own[fitted.cell].normal += weight * fitted.model.bone * fitted.model.bone.transpose();
      own[fitted.cell].right += weight * residual * fitted.model.bone;
    }
    for (std::size_t cell = 0; cell < own.size(); ++cell) outside_.move(cell, own[cell].best());
    for (FittedVoxel& fitted : fitted_) fitted.model = model_of(fitted, blur);
  }
}

std::vector<OwnOfCell> WallPicture::own_of_cells(Eigen::Index numbers) const {
  std::vector<OwnOfCell> own;
  own.reserve(outside_.cells());
  for (std::size_t cell = 0; cell < outside_.cells(); ++cell) own.emplace_back(numbers, outside_, cell);
  return own;
}

std::size_t WallPicture::cell_of(const PlacedByBore& placed) const {
  constexpr std::size_t kParts = WallOutside::kSectors;
  const std::size_t steps = outside_.cells() / kParts;
  const double share = (placed.along + bore_.frame.half_mm()) / (2 * bore_.frame.half_mm());
  return std::min(steps - 1, static_cast<std::size_t>(share * static_cast<double>(steps))) * kParts +
         placed.sector(kParts);
}

double WallPicture::weight_of(double residual, double variance) const {
  const double sigma = std::sqrt(noise_hu_ * noise_hu_ + variance);
  return std::min(1.0, kHuber * sigma / std::max(1e-9, std::abs(residual))) / (sigma * sigma);
}

double WallPicture::inside_hu(const PlacedByBore& placed) const {
  const double off = std::min(placed.off, bore_.radius_mm[placed.stretch]);
  return levels_[placed.bin].inside_hu() +
         shade_.at(placed.bin, off * Eigen::Vector2d(placed.across_u, placed.across_v));
}

FittedVoxel::Model WallPicture::model_of(const FittedVoxel& fitted, double blur) const {
  const auto& [placed, sector, cell, voxel, grey, was] = fitted;
  const WallLevels& levels = levels_[placed.bin];
  const WallOutside::Grey bone = outside_.at(cell, voxel->depth_mm);
  const double a = inside_hu(placed),
               rise = bone.steep * voxel->deeper.cast<double>().dot(bore_.frame.outwards(placed));
  // In bone that is denser than the rim there is none.
  const bool by_rim = bore_.profile.has_rim() && bore_.profile.rim_hu > bone.hu;
  const double share = by_rim ? grey.beyond : 1 - grey.inside,
               share_slope = by_rim ? grey.beyond_slope : -grey.inside_slope,
               rim = by_rim ? bore_.profile.rim_hu : 0,
               beyond = placed.off - bore_.radius_mm[placed.stretch] +
                        bore_.seems_nearer_mm(bore_.radius_mm[placed.stretch]) -
                        (by_rim ? bore_.profile.rim_mm : 0);
  // Of grey that rises outwards the blur brings more across its edge from where it is brighter: by the
  // blur's square times both slopes.
  // By more blur the wall seems nearer, too.
  const double past = beyond / blur, nearer = blur / bore_.radius_mm[placed.stretch] - past;
  return {a * grey.inside + rim * grey.rim + bone.hu * share + blur * blur * rise * share_slope,
          a * grey.inside_slope + (by_rim ? rim * grey.rim_slope : 0) + bone.hu * share_slope -
              beyond * rise * share_slope,
          share_slope * ((bone.hu - a) * nearer + blur * rise * (1 - past * nearer)),
          share * Eigen::Vector2d(1, bone.steep),
          std::max(grey.inside * 0.5 * std::max(0.0, levels.inside().variance() - noise_hu_ * noise_hu_),
                   share * outside_.variance(bone.steep))};
}

WallGrey WallPicture::grey_at(const PlacedByBore& placed, double blur) const {
  const double radius = bore_.radius_mm[placed.stretch];
  return wall_grey(placed.off - radius + bore_.seems_nearer_mm(radius), bore_.profile.rim_mm, blur);
}
// The mean grey by the distance from the wall, of the cells with marrow beyond it. Each of them puts about
// as much into every point, so the levels are means of theirs, and wall and rim are theirs.
std::vector<WallPoint> WallPicture::mean_profile(double least_depth_mm) const {
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
    if (voxel.depth_mm < least_depth_mm) continue;
    const auto placed = place(voxel.p_mm);
    if (!placed || !counts(voxel, *placed)) continue;
    const Level& out = levels_[placed->bin].outside(placed->sector(kSectors));
    if (!levels_[placed->bin].has_inside() || out.count < full || std::abs(out.mean() - grey) > far_off)
      continue;
    const double at = (placed->off - bore_.radius_mm[placed->stretch] + kProfileTo_mm) / kPoint_mm;
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

// In which most of a cell lies.
std::size_t WallPicture::eighth_of(std::size_t cell) const {
  constexpr std::size_t kParts = WallOutside::kSectors;
  const std::size_t steps = outside_.cells() / kParts,
                    stretch = (2 * (cell / kParts) + 1) * bore_.stretches() / (2 * steps);
  return stretch * kSectors + cell % kParts * kSectors / kParts;
}

}  // namespace arthronaut::postop
