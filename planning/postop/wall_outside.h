// The grey outside a bore's wall as it would be without the bore, told by how deep a place lies under the
// bone's surface: a cortex that slants across the wall is no level, but is as dense at the same depth a
// little further from it. Inner header of postop.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace arthronaut::postop {

// In cells of the wall: steps along the bore, and so many parts of the turn.
class WallOutside {
 public:
  static constexpr std::size_t kSectors = 16;
  static constexpr double kStep_mm = 1;

  // By which a cell is off what is told by depth: its level, and how much deeper it seems to lie, as where
  // its cortex is thicker than about it.
  struct Off {
    double hu = 0, depth_mm = 0;
  };
  struct Grey {
    double hu, steep;  // steep: HU for a mm of depth
  };

  explicit WallOutside(std::size_t steps) : offs_(steps * kSectors), nodes_(offs_.size() * kNodes) {}

  // Forgets all.
  void clear();
  // Of a place clear of the bore and of its blur.
  void add(std::size_t cell, double depth_mm, double hu);
  // What was added becomes the grey by depth about each cell. What that leaves unexplained, beyond the noise,
  // is how far cells may be off it.
  void settle(double noise_hu);

  [[nodiscard]] Grey at(std::size_t cell, double depth_mm) const;
  // Of a place's grey, that is told by no cell either.
  [[nodiscard]] double variance(double steep) const {
    return 0.5 * (level_variance_ + steep * steep * depth_variance_);
  }

  [[nodiscard]] std::size_t cells() const { return offs_.size(); }
  [[nodiscard]] const Off& off(std::size_t cell) const { return offs_[cell]; }
  void move(std::size_t cell, const Off& by);
  // One over the variances of both numbers of a cell, before it is looked at.
  [[nodiscard]] Eigen::Vector2d certainty() const { return {1 / level_variance_, 1 / depth_variance_}; }

 private:
  static constexpr std::size_t kNodes = 18;
  struct Node {
    double sum = 0, weight = 0;
    void add(const Node& other, double share) {
      sum += share * other.sum;
      weight += share * other.weight;
    }
  };
  struct Added {
    std::size_t cell;
    double depth_mm, hu;
  };

  void smooth();
  [[nodiscard]] std::vector<double> mean_by_depth() const;
  void explain_rest(double noise_hu);

  std::vector<Off> offs_;
  std::vector<Node> nodes_;  // of each cell; smoothed, `sum` is a grey
  std::vector<Added> added_;
  double level_variance_ = 1, depth_variance_ = 1;
};

// What a fit's voxels in one cell say of the cell's own two numbers, and of those together with the fit's.
struct OwnOfCell {
  OwnOfCell(Eigen::Index numbers, const WallOutside& outside, std::size_t cell);
  // Least squares with both found anew for every change of the others: takes them out of the fit's equations.
  void take_out_of(Eigen::MatrixXd& normal, Eigen::VectorXd& right) const;
  [[nodiscard]] WallOutside::Off best() const;

  Eigen::MatrixX2d with_others;
  Eigen::Matrix2d normal;
  Eigen::Vector2d right;
};

}  // namespace arthronaut::postop
