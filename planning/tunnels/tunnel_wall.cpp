#include "planning/tunnels/tunnel_wall.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "planning/geometry/rigid_transform.h"
#include "planning/tunnels/half_plane.h"

namespace arthronaut::tunnels {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kLeastTurnCosine = 0.70710678118654752;  // 45 deg: of the mouth's own face
constexpr double kLeastFacing = 0.25881904510252074;      // sin 15 deg: of a face that a drill goes through
constexpr int kHalfPlanes = 240, kHalvings = 4, kHalvingsOfThick = 1, kMostHalfPlanes = 1200;
constexpr double kThick_mm = 8;
// What goes on from one of the first half planes to the next changes by less, but for faces that are nearly
// straight along them.
constexpr double kLeap_mm = 0.5;
constexpr double kOneBreach_mm = 1;  // pieces nearer to each other are one

class WallSearch {
 public:
  WallSearch(const AxisView& view, const WallQuery& query)
      : view_(view),
        query_(query),
        half_plane_(query.length_mm, 0.5 * query.diameter_mm, -rim_reach_mm(query.diameter_mm),
                    query.length_mm + rim_reach_mm(query.diameter_mm)) {
    sort_by_angle();
  }
  [[nodiscard]] TunnelWall run();
  [[nodiscard]] std::vector<DepthRange> breaches();  // after run()

 private:
  struct Facet {
    const AxisTriangle* triangle;
    std::array<double, 3> entry_same, exit_same;  // at the corners: see LipEnds
  };
  struct Trial {
    double angle_rad;
    Thinnest thinnest;
    std::vector<DepthRange> outside;
    DepthRange between_lips;
  };
  void sort_by_angle();
  [[nodiscard]] Trial try_at(double angle_rad);
  void try_where_it_leaps();
  void cut(const Facet& facet, const Vector2d& along, const Vector2d& across);

  const AxisView& view_;
  const WallQuery& query_;
  HalfPlane half_plane_;
  std::vector<Facet> facets_;
  std::vector<Trial> trials_;
  std::vector<std::vector<std::int32_t>> by_angle_{static_cast<std::size_t>(kHalfPlanes)};
};

void WallSearch::sort_by_angle() {
  const auto in_view = [&](const Vector3d& v) {
    return Vector3d(v.dot(view_.direction_to_bone(Vector3d::UnitX())),
                    v.dot(view_.direction_to_bone(Vector3d::UnitY())), v.dot(query_.direction));
  };
  const Vector3d entry = in_view(query_.entry.normal), exit = in_view(query_.exit.normal);
  const auto add = [&](double angle, std::int32_t facet) {
    const int bucket = static_cast<int>(std::floor(angle / (2 * geometry::kPi) * kHalfPlanes));
    by_angle_[static_cast<std::size_t>((bucket % kHalfPlanes + kHalfPlanes) % kHalfPlanes)].push_back(facet);
  };
  constexpr double kBucket = 2 * geometry::kPi / kHalfPlanes;
  for (const AxisTriangle& triangle : view_.triangles()) {
    const auto index = static_cast<std::int32_t>(facets_.size());
    Facet facet{&triangle, {}, {}};
    for (std::size_t k = 0; k < 3; ++k) {
      facet.entry_same[k] = triangle.smooth_normals[k].dot(entry) - kLeastTurnCosine;
      facet.exit_same[k] = triangle.smooth_normals[k].dot(exit) - kLeastTurnCosine;
    }
    facets_.push_back(facet);
    if (triangle.nearest_mm <= 0) {
      for (auto& bucket : by_angle_) bucket.push_back(index);
      continue;
    }
    // A triangle beside the axis spans less than half a turn.
    const auto angle_of = [](const Vector3d& c) { return std::atan2(c.y(), c.x()); };
    const double start = angle_of(triangle.corners_mm[0]);
    double low = 0, high = 0;
    for (std::size_t k = 1; k < 3; ++k) {
      double turn = angle_of(triangle.corners_mm[k]) - start;
      if (turn > geometry::kPi) turn -= 2 * geometry::kPi;
      if (turn < -geometry::kPi) turn += 2 * geometry::kPi;
      low = std::min(low, turn);
      high = std::max(high, turn);
    }
    const double first = std::floor((start + low) / kBucket) * kBucket;
    for (double angle = first + 0.5 * kBucket; angle < start + high + kBucket; angle += kBucket)
      add(angle, index);
  }
}

void WallSearch::cut(const Facet& facet, const Vector2d& along, const Vector2d& across) {
  const auto& corners = facet.triangle->corners_mm;
  std::array<double, 3> side{};
  for (std::size_t k = 0; k < 3; ++k) side[k] = across.dot(corners[k].head<2>());
  // station, distance from the axis, of the entry's face, of the exit's, facing
  using End = Eigen::Matrix<double, 5, 1>;
  std::array<End, 2> ends;
  std::size_t count = 0;
  for (std::size_t k = 0; k < 3 && count < 2; ++k) {
    const std::size_t next = (k + 1) % 3;
    if ((side[k] >= 0) == (side[next] >= 0)) continue;
    const double t = side[k] / (side[k] - side[next]);
    const auto mix = [&](double a, double b) { return a + t * (b - a); };
    ends[count++] << mix(corners[k].z(), corners[next].z()),
        mix(along.dot(corners[k].head<2>()), along.dot(corners[next].head<2>())),
        mix(facet.entry_same[k], facet.entry_same[next]), mix(facet.exit_same[k], facet.exit_same[next]),
        mix(facet.triangle->smooth_normals[k].z(), facet.triangle->smooth_normals[next].z());
  }
  if (count < 2) return;
  if (ends[0][0] > ends[1][0]) std::swap(ends[0], ends[1]);
  if (ends[0][1] < 0 && ends[1][1] < 0) return;
  for (std::size_t k = 0; k < 2; ++k) {  // the half on this side of the axis
    if (ends[k][1] >= 0) continue;
    const End& other = ends[1 - k];
    ends[k] = (ends[k] + (0 - ends[k][1]) / (other[1] - ends[k][1]) * (other - ends[k])).eval();
    ends[k][1] = 0;
  }
  Cut cut{ends[0][0], ends[1][0], ends[0][1], ends[1][1]};
  cut.comes_out = along.dot(facet.triangle->normal.head<2>()) > 0;
  for (std::size_t k = 0; k < 2; ++k) {
    cut.entry_lip.same[k] = ends[k][2];
    cut.exit_lip.same[k] = ends[k][3];
    cut.entry_lip.facing[k] = -ends[k][4] - kLeastFacing;
    cut.exit_lip.facing[k] = ends[k][4] - kLeastFacing;
  }
  cut.of = facet.triangle;
  half_plane_.add(cut);
}

// Of the triangle's point that is nearest to the axis; the fallback where the axis goes through it.
double nearest_angle(const AxisTriangle& triangle, double fallback_rad) {
  if (triangle.nearest_mm <= 0) return fallback_rad;
  Vector2d best = triangle.corners_mm[0].head<2>();
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector2d from = triangle.corners_mm[k].head<2>(),
                   along = triangle.corners_mm[(k + 1) % 3].head<2>() - from;
    const double squared = along.squaredNorm();
    const double t = squared > 0 ? std::clamp(-from.dot(along) / squared, 0.0, 1.0) : 0.0;
    const Vector2d at = from + t * along;
    if (at.squaredNorm() < best.squaredNorm()) best = at;
  }
  return std::atan2(best.y(), best.x());
}

WallSearch::Trial WallSearch::try_at(double angle_rad) {
  const Vector2d along(std::cos(angle_rad), std::sin(angle_rad)), across(-along.y(), along.x());
  const int bucket = static_cast<int>(std::floor(angle_rad / (2 * geometry::kPi) * kHalfPlanes));
  half_plane_.clear();
  for (const std::int32_t index :
       by_angle_[static_cast<std::size_t>((bucket % kHalfPlanes + kHalfPlanes) % kHalfPlanes)])
    cut(facets_[static_cast<std::size_t>(index)], along, across);
  const Thinnest thinnest = half_plane_.thinnest();
  return {angle_rad, thinnest, half_plane_.outside(), half_plane_.between_lips()};
}

// What is a lip in one half plane may be wall in the next, and behind the edge of a groove the next face may
// lie far off: the thickness then leaps, and the thinnest place stands just where it does so, however thick
// the bone is in the half planes on either side.
void WallSearch::try_where_it_leaps() {
  const auto leap_mm = [](const Trial& a, const Trial& b) {
    const double thicker = std::max(a.thinnest.radius_mm, b.thinnest.radius_mm),
                 thinner = std::min(a.thinnest.radius_mm, b.thinnest.radius_mm);
    return std::max({std::abs(a.between_lips.from_mm - b.between_lips.from_mm),
                     std::abs(a.between_lips.to_mm - b.between_lips.to_mm),
                     std::isfinite(thinner) ? thicker - thinner : 0.0});
  };
  std::vector<Trial> between;
  for (std::size_t k = 0; k < trials_.size(); ++k) {
    Trial low = trials_[k], high = trials_[(k + 1) % trials_.size()];
    if (high.angle_rad < low.angle_rad) high.angle_rad += 2 * geometry::kPi;
    for (int halving = 0; halving < kHalvings && leap_mm(low, high) > kLeap_mm; ++halving) {
      const Trial middle = try_at((low.angle_rad + high.angle_rad) / 2);
      between.push_back(middle);
      (leap_mm(low, middle) > leap_mm(middle, high) ? high : low) = middle;
    }
  }
  trials_.insert(trials_.end(), between.begin(), between.end());
}

std::vector<DepthRange> WallSearch::breaches() {
  struct Breach {
    DepthRange range;
    double from_at_rad, to_at_rad;  // the half planes that its ends are of
  };
  std::vector<Breach> found;
  for (const Trial& trial : trials_)
    for (const DepthRange& range : trial.outside) found.push_back({range, trial.angle_rad, trial.angle_rad});
  std::sort(found.begin(), found.end(),
            [](const Breach& a, const Breach& b) { return a.range.from_mm < b.range.from_mm; });
  std::vector<Breach> merged;
  for (const Breach& breach : found) {
    if (merged.empty() || breach.range.from_mm > merged.back().range.to_mm + kOneBreach_mm) {
      merged.push_back(breach);
    } else if (breach.range.to_mm > merged.back().range.to_mm) {
      merged.back().range.to_mm = breach.range.to_mm;
      merged.back().to_at_rad = breach.to_at_rad;
    }
  }
  // A breach may begin a little earlier, or end later, between two half planes.
  std::vector<DepthRange> ranges;
  for (Breach& breach : merged) {
    double step = 2 * geometry::kPi / kHalfPlanes;
    for (int halving = 0; halving < kHalvings; ++halving) {
      step /= 2;
      for (const double angle : {breach.from_at_rad - step, breach.from_at_rad + step,
                                 breach.to_at_rad - step, breach.to_at_rad + step}) {
        for (const DepthRange& range : try_at(angle).outside) {
          if (range.from_mm > breach.range.to_mm || range.to_mm < breach.range.from_mm) continue;
          if (range.from_mm < breach.range.from_mm)
            breach.range.from_mm = range.from_mm, breach.from_at_rad = angle;
          if (range.to_mm > breach.range.to_mm) breach.range.to_mm = range.to_mm, breach.to_at_rad = angle;
        }
      }
    }
    ranges.push_back(breach.range);
  }
  return ranges;
}

TunnelWall WallSearch::run() {
  double step = 2 * geometry::kPi / kHalfPlanes;
  auto& trials = trials_;
  for (int k = 0; k < kHalfPlanes; ++k) trials.push_back(try_at((k + 0.5) * step));
  try_where_it_leaps();
  const auto less = [](const Trial& a, const Trial& b) {
    return a.thinnest.radius_mm < b.thinnest.radius_mm;
  };
  // Around every trial that something thinner may stand beside: a surface at 45 deg to the half planes.
  const auto is_thick = [&](double least) { return least - 0.5 * query_.diameter_mm > kThick_mm; };
  for (int halving = 0; halving < kHalvings; ++halving) {
    const double least = std::min_element(trials.begin(), trials.end(), less)->thinnest.radius_mm;
    if (!std::isfinite(least) || (halving >= kHalvingsOfThick && is_thick(least))) break;
    const double bound = least + step * least;
    step /= 2;
    std::vector<double> angles;
    for (const Trial& trial : trials) {
      if (trial.thinnest.radius_mm > bound) continue;
      angles.push_back(trial.angle_rad - step);
      angles.push_back(trial.angle_rad + step);
    }
    std::sort(angles.begin(), angles.end());
    angles.erase(
        std::unique(angles.begin(), angles.end(), [&](double a, double b) { return b - a < 0.01 * step; }),
        angles.end());
    if (trials.size() + angles.size() > static_cast<std::size_t>(kMostHalfPlanes)) break;
    for (const double angle : angles) trials.push_back(try_at(angle));
  }
  // A triangle may reach nearer to the axis between two half planes: where it does so is tried too.
  std::sort(trials.begin(), trials.end(), less);
  Trial best = trials.front();
  constexpr std::size_t kFollowed = 6;
  for (std::size_t k = 0; k < std::min(kFollowed, trials.size()); ++k) {
    Trial at = trials[k];
    for (int turn = 0; turn < 8 && at.thinnest.of; ++turn) {
      const Trial next = try_at(nearest_angle(*at.thinnest.of, at.angle_rad));
      if (!(next.thinnest.radius_mm < at.thinnest.radius_mm - 1e-6)) break;
      at = next;
    }
    if (less(at, best)) best = at;
  }
  TunnelWall wall;
  if (!std::isfinite(best.thinnest.radius_mm)) return wall;
  wall.is_known = true;
  wall.thickness_mm = best.thinnest.radius_mm - 0.5 * query_.diameter_mm;
  wall.station_mm = best.thinnest.station_mm;
  wall.at_mm = view_.to_bone({best.thinnest.radius_mm * std::cos(best.angle_rad),
                              best.thinnest.radius_mm * std::sin(best.angle_rad), best.thinnest.station_mm});
  return wall;
}

}  // namespace

std::vector<DepthRange> breaches(const AxisView& view, const WallQuery& query) {
  WallSearch search(view, query);
  (void)search.run();
  return search.breaches();
}

double rim_reach_mm(double diameter_mm) {
  return 0.5 * diameter_mm * std::sqrt(1 - kLeastFacing * kLeastFacing) / kLeastFacing;
}

TunnelWall thinnest_wall(const AxisView& view, const WallQuery& query) {
  return WallSearch(view, query).run();
}

}  // namespace arthronaut::tunnels
