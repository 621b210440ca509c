#include "planning/postop/wall_levels.h"

#include <cmath>

namespace arthronaut::postop {

namespace {

// Of what a level is taken from, its own share.
constexpr double kLeastOwn = 0.5;
// Each side is taken out of the other in turn; what is left falls by a tenth or less each time.
constexpr int kRounds = 3;
// Neighbouring voxels share their noise, in a level so much.
constexpr double kCorrelated = 4;
// Differences that are no chance.
constexpr double kSeenSigmas = 3, kSeen_hu = 15;

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

std::vector<SeenWall> seen_walls(const std::vector<WallLevels>& steps, std::size_t stretches, bool by_rim) {
  constexpr std::size_t kSectors = WallLevels::kSectors;
  struct Sides {
    Level within;
    std::vector<Level> beside = std::vector<Level>(kSectors), beyond = std::vector<Level>(kSectors);
  };
  std::vector<Sides> sides(stretches);
  for (std::size_t step = 0; step < steps.size(); ++step) {
    Sides& of = sides[std::min(stretches - 1, (2 * step + 1) * stretches / (2 * steps.size()))];
    of.within.add(steps[step].inside());
    for (std::size_t sector = 0; sector < kSectors; ++sector) {
      const Level& outside = steps[step].outside(sector);
      of.beside[sector].add(by_rim ? steps[step].rim(sector) : outside);
      of.beyond[sector].add(outside);
    }
  }
  std::vector<SeenWall> walls;
  for (const Sides& of : sides) {
    double seen = 0, darker = 0, all = 0, in = 0, out = 0;
    const Level& a = of.within;
    for (std::size_t sector = 0; sector < kSectors; ++sector) {
      const Level& b = of.beside[sector];
      if (b.count < 4) continue;
      const double weight = b.count;
      all += weight;
      if (a.count < 8) continue;
      const double contrast = std::abs(b.mean() - a.mean()),
                   sigma = std::sqrt(kCorrelated * (a.variance() / a.count + b.variance() / b.count));
      if (contrast < std::max(kSeen_hu, kSeenSigmas * sigma)) continue;
      seen += weight;
      darker += b.mean() > a.mean() ? weight : -weight;
      in += weight * a.mean();
      out += weight * of.beyond[sector].mean();
    }
    walls.push_back({.share = all > 0 ? std::abs(darker) / all : 0,
                     .inside_hu = seen > 0 ? in / seen : 0,
                     .outside_hu = seen > 0 ? out / seen : 0});
  }
  return walls;
}

}  // namespace arthronaut::postop
