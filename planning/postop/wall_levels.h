// The grey on either side of a bore's wall: one level inside for each step along it, one outside for each
// step and each eighth of the turn. Inner header of postop.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "planning/postop/wall_profile.h"

namespace arthronaut::postop {

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

// Of one step along the bore.
class WallLevels {
 public:
  static constexpr std::size_t kSectors = 8;

  // Well within the wall, well beyond it and its rim, and within the rim. `grey`: what shares of the levels
  // are in that place's grey.
  void add_inside(double hu, const WallGrey& grey) { inside_.add(hu, grey); }
  void add_outside(std::size_t sector, double hu, const WallGrey& grey) { outside_[sector].add(hu, grey); }
  void add_rim(std::size_t sector, double hu) { rim_[sector].add(hu); }
  // The blur mixes into what is beside the wall some of what is across it: takes that out of the levels.
  // least_rim_hu: of the rim, which is as dense as what is beyond it at least.
  void part(double least_rim_hu);

  [[nodiscard]] const Level& inside() const { return inside_.level; }
  [[nodiscard]] const Level& outside(std::size_t sector) const { return outside_[sector].level; }
  [[nodiscard]] const Level& rim(std::size_t sector) const { return rim_[sector]; }
  // The level, parted.
  [[nodiscard]] double inside_hu() const { return inside_.hu; }
  // Enough to tell.
  [[nodiscard]] bool has_inside() const { return inside_.level.count >= 8; }
  [[nodiscard]] bool has_outside(std::size_t sector) const { return outside_[sector].level.count >= 4; }

 private:
  struct Side {
    Level level;
    double inside = 0, rim = 0, beyond = 0;  // sums of the shares
    double hu = 0;
    void add(double v, const WallGrey& grey) {
      level.add(v);
      inside += grey.inside;
      rim += grey.rim;
      beyond += grey.beyond;
    }
  };

  Side inside_;
  std::vector<Side> outside_ = std::vector<Side>(kSectors);
  std::vector<Level> rim_ = std::vector<Level>(kSectors);
};

// Of a stretch of the bore.
struct SeenWall {
  // Of its wall: grey differs across it, the same way all around. What differs the other way is taken off.
  double share = 0;
  // Of what is seen, HU; 0 where nothing is.
  double inside_hu = 0, outside_hu = 0;
};

// The steps are parted into so many stretches. by_rim: the wall is seen where its rim is, and `outside_hu` is
// beyond that.
[[nodiscard]] std::vector<SeenWall> seen_walls(const std::vector<WallLevels>& steps, std::size_t stretches,
                                               bool by_rim);

}  // namespace arthronaut::postop
