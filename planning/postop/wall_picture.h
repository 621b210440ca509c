// What the voxels about a bore's wall show, were the bore as it is taken to be: levels inside, the bone
// outside, what both make of each voxel's grey, and how that changes with the bore. Inner header of postop.
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "planning/postop/bore_frame.h"
#include "planning/postop/near_voxels.h"
#include "planning/postop/tunnel_fit.h"
#include "planning/postop/wall_levels.h"
#include "planning/postop/wall_outside.h"

namespace arthronaut::postop {

// A bore as it is taken to be.
struct BoreShape {
  BoreFrame frame;
  std::vector<double> radius_mm;  // by stretches
  WallProfile profile = {};

  [[nodiscard]] std::size_t stretches() const { return radius_mm.size(); }
  // A round wall looks as a flat one does that lies nearer to the axis: at a circle's edge less than half of
  // what the blur brings there comes from within.
  [[nodiscard]] double seems_nearer_mm(double radius) const {
    return profile.blur_mm * profile.blur_mm / (2 * radius);
  }
};

struct FittedVoxel {
  // What is made of its grey.
  struct Model {
    double value = 0, slope = 0;                     // slope: by the distance from the axis
    double by_blur = 0;                              // without a rim
    Eigen::Vector2d bone = Eigen::Vector2d::Zero();  // by what the bone of its cell is off: level, depth
    double variance = 0;                             // of what neither tells
  };

  PlacedByBore placed;
  std::size_t sector, cell;  // of the levels, of the bone outside
  const WallVoxel* voxel;
  WallGrey grey;
  Model model;
};

// How the grey inside a bore rises from side to side, where metal in it throws shadows and streaks over what
// is beside it. Taken for an even grey it draws the axis: in a made CT by 0.45 degrees, and by 0.12 with it.
class InsideShade {
 public:
  // Of so many steps along the bore; none: the grey is taken for even.
  void begin(std::size_t bins) { sums_.assign(bins, {}), rise_.assign(bins, Eigen::Vector2d::Zero()); }
  void add(std::size_t bin, const Eigen::Vector2d& across_mm, double hu);
  // Each step by those next to it, too.
  void settle();
  // How far the grey there is off the step's mean, HU.
  [[nodiscard]] double at(std::size_t bin, const Eigen::Vector2d& across_mm) const {
    return rise_.empty() ? 0 : rise_[bin].dot(across_mm);
  }

 private:
  struct Sums {
    double count = 0, hu = 0;
    Eigen::Vector2d place = Eigen::Vector2d::Zero(), with_hu = Eigen::Vector2d::Zero();
    Eigen::Matrix2d with_place = Eigen::Matrix2d::Zero();
  };
  std::vector<Sums> sums_;
  std::vector<Eigen::Vector2d> rise_;  // HU/mm
};

class WallPicture {
 public:
  // Voxels and bore must outlive it.
  WallPicture(const std::vector<WallVoxel>& voxels, const BoreShape& bore, Wall wall);

  // Anew for the bore as it is now, seen through this blur.
  void take(double blur);

  [[nodiscard]] const std::vector<FittedVoxel>& fitted() const { return fitted_; }
  [[nodiscard]] const std::vector<WallLevels>& levels() const { return levels_; }  // by steps of 2 mm
  [[nodiscard]] double metal_share(std::size_t stretch) const { return metal_[stretch].mean(); }
  [[nodiscard]] double noise_hu() const { return noise_hu_; }
  // Of a point of the mean profile, for one voxel: of bone with grain, too.
  [[nodiscard]] double profile_noise_hu() const {
    return std::hypot(noise_hu_, std::sqrt(outside_.variance(0)));
  }

  // One over the variance of a voxel, less for what differs much.
  [[nodiscard]] double weight_of(double residual, double variance) const;
  // What each cell says of itself, for a fit of so many numbers; nothing yet.
  [[nodiscard]] std::vector<OwnOfCell> own_of_cells(Eigen::Index numbers) const;
  // The eighth of a stretch in which most of a cell lies.
  [[nodiscard]] std::size_t eighth_of(std::size_t cell) const;
  // The mean grey by the distance from the wall, of the cells with marrow beyond it, of voxels that lie so
  // deep under the bone's surface.
  [[nodiscard]] std::vector<WallPoint> mean_profile(double least_depth_mm) const;

 private:
  struct PlacedVoxel {
    PlacedByBore placed;
    const WallVoxel* voxel;
  };

  [[nodiscard]] bool counts(const WallVoxel& voxel, const PlacedByBore& placed) const;
  [[nodiscard]] std::optional<PlacedByBore> place(const Eigen::Vector3d& p) const;
  [[nodiscard]] std::size_t cell_of(const PlacedByBore& placed) const;
  [[nodiscard]] WallGrey grey_at(const PlacedByBore& placed, double blur) const;
  // The grey inside where that voxel lies; where it lies outside, at the wall.
  [[nodiscard]] double inside_hu(const PlacedByBore& placed) const;
  [[nodiscard]] FittedVoxel::Model model_of(const FittedVoxel& fitted, double blur) const;
  void place_all();
  void take_bone(double blur);

  const std::vector<WallVoxel>& voxels_;
  NearVoxels near_;
  const BoreShape& bore_;
  Wall wall_;
  std::size_t bins_;
  std::vector<WallLevels> levels_;  // by bins
  std::vector<Level> metal_, metal_of_bin_;
  std::vector<PlacedVoxel> placed_;
  std::vector<FittedVoxel> fitted_;
  WallOutside outside_;
  InsideShade shade_;
  double noise_hu_ = 25;
};

}  // namespace arthronaut::postop
