#include "planning/postop/wall_levels.h"

namespace arthronaut::postop {

namespace {

// Of what a level is taken from, its own share.
constexpr double kLeastOwn = 0.5;
// Each side is taken out of the other in turn; what is left falls by a tenth or less each time.
constexpr int kRounds = 3;

}  // namespace

void WallLevels::part(double least_rim_hu) {
  inside_.hu = inside_.level.mean();
  for (Side& side : outside_) side.hu = side.level.mean();
  for (int round = 0; round < kRounds && has_inside(); ++round) {
    double around = 0, rim = 0;
    int sectors = 0;
    for (std::size_t s = 0; s < kSectors; ++s) {
      Side& side = outside_[s];
      if (!has_outside(s)) continue;
      const double own = side.beyond / side.level.count;
      if (own > kLeastOwn)
        side.hu = side.level.mean() - (side.inside * (inside_.hu - side.level.mean()) +
                                       side.rim * (std::max(least_rim_hu, side.hu) - side.level.mean())) /
                                          side.beyond;
      around += side.hu;
      rim += std::max(least_rim_hu, side.hu);
      ++sectors;
    }
    if (sectors == 0 || inside_.inside < kLeastOwn * inside_.level.count) continue;
    inside_.hu = inside_.level.mean() - (inside_.beyond * (around / sectors - inside_.level.mean()) +
                                         inside_.rim * (rim / sectors - inside_.level.mean())) /
                                            inside_.inside;
  }
}

}  // namespace arthronaut::postop
