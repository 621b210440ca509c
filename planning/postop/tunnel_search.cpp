#include "planning/postop/tunnel_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace arthronaut::postop {

namespace {

using Eigen::Vector3d;

constexpr int kSectors = 8, kSegments = 3, kStations = 4;
constexpr double kStationStep_mm = 2.25, kFirstStation_mm = 1.0;
// A hard cortex counts for no more than this, or one side of a bore in it would outweigh the rest.
constexpr double kMostContrast_hu = 250;
constexpr double kLeastDepth_mm = 0.4;
constexpr std::size_t kRefined = 40, kReturned = 8;

// Where the line enters the bone, nearest to its own origin.
std::optional<Vector3d> entry_on(const BoneGrid& grid, const Vector3d& origin, const Vector3d& direction) {
  constexpr double kReach_mm = 22, kStep_mm = 0.5;
  std::optional<Vector3d> entry;
  double nearest = kReach_mm;
  bool was_inside = true;  // nothing is known of what lies before
  for (double t = -kReach_mm; t <= kReach_mm; t += kStep_mm) {
    const Vector3d p = origin + t * direction;
    const std::ptrdiff_t cell = grid.cell_at(grid.in_cells(p));
    const bool is_inside = cell >= 0 && grid.depth_mm[static_cast<std::size_t>(cell)] > 0;
    if (is_inside && !was_inside && std::abs(t) < nearest) {
      nearest = std::abs(t);
      entry = p;
    }
    was_inside = is_inside;
  }
  return entry;
}

// Sines and cosines of the sectors' middles.
const std::array<Eigen::Vector2d, kSectors>& sectors() {
  static const auto table = [] {
    std::array<Eigen::Vector2d, kSectors> made;
    for (int s = 0; s < kSectors; ++s)
      made[static_cast<std::size_t>(s)] = {std::cos(2 * M_PI * s / kSectors),
                                           std::sin(2 * M_PI * s / kSectors)};
    return made;
  }();
  return table;
}

double evidence_of(const BoneGrid& grid, const Bore& bore) {
  const Vector3d u = bore.direction.unitOrthogonal(), v = bore.direction.cross(u),
                 entry = grid.in_cells(bore.entry_mm), along = bore.direction / BoneGrid::kStep_mm;
  std::array<Vector3d, kSectors> out;
  for (std::size_t s = 0; s < kSectors; ++s)
    out[s] = (sectors()[s].x() * u + sectors()[s].y() * v) / BoneGrid::kStep_mm;
  double evidence = 0;
  for (int segment = 0; segment < kSegments; ++segment) {
    std::array<double, kSectors> contrast{};
    std::array<int, kSectors> count{};
    double inner_sum = 0;
    int inner_count = 0;
    for (int station = 0; station < kStations; ++station) {
      const double t = kFirstStation_mm + kStationStep_mm * (segment * kStations + station);
      const Vector3d middle = entry + t * along;
      for (std::size_t s = 0; s < kSectors; ++s) {
        const auto deep_cell = [&](double off_mm) {
          const std::ptrdiff_t cell = grid.cell_at(middle + off_mm * out[s]);
          return cell >= 0 && grid.depth_mm[static_cast<std::size_t>(cell)] < kLeastDepth_mm ? -1 : cell;
        };
        const std::ptrdiff_t rim = deep_cell(bore.radius_mm + 0.8);
        if (rim < 0) continue;
        const std::ptrdiff_t beyond = deep_cell(bore.radius_mm + 1.6);
        if (beyond < 0) continue;
        const std::ptrdiff_t core = grid.cell_at(middle + 0.35 * bore.radius_mm * out[s]),
                             side = grid.cell_at(middle + 0.75 * bore.radius_mm * out[s]);
        if (core < 0 || side < 0) continue;
        const double outer = 0.5 * (grid.grey[static_cast<std::size_t>(rim)] +
                                    grid.grey[static_cast<std::size_t>(beyond)]),
                     inner = 0.5 * (grid.grey[static_cast<std::size_t>(core)] +
                                    grid.grey[static_cast<std::size_t>(side)]);
        contrast[s] += std::clamp(outer - inner, -kMostContrast_hu, kMostContrast_hu);
        ++count[s];
        inner_sum += inner;
        ++inner_count;
      }
    }
    std::array<double, kSectors> seen{};
    std::size_t seen_count = 0;
    for (std::size_t s = 0; s < kSectors; ++s) {
      seen[s] = count[s] > 0 ? contrast[s] / count[s] : 1e9;
      seen_count += count[s] > 0 ? 1 : 0;
    }
    if (seen_count < kSectors / 2) continue;
    // All around: the weaker half of the sectors decides. Darker than the bone; or brighter, as a graft in
    // fatty marrow, but not as bone.
    std::sort(seen.begin(), seen.end());
    const std::size_t half = seen_count / 2;
    double darker = 0, brighter = 0;
    for (std::size_t s = 0; s < half; ++s) {
      darker += seen[s] / static_cast<double>(half);
      brighter -= seen[seen_count - 1 - s] / static_cast<double>(half);
    }
    const bool is_soft = inner_sum < kMostSoft_hu * inner_count;
    evidence += std::max({darker, is_soft ? brighter : darker, -20.0});
  }
  return evidence;
}

// Better ones nearby, by ever smaller steps.
void climb(const BoneGrid& grid, Bore& bore) {
  for (double step = 1; step > 0.2; step *= 0.6) {
    for (bool is_better = true; is_better;) {
      is_better = false;
      const Vector3d u = bore.direction.unitOrthogonal(), v = bore.direction.cross(u);
      for (int way = 0; way < 10; ++way) {
        const double by = way % 2 ? -step : step;
        Bore tried = bore;
        if (way < 2) tried.radius_mm = std::clamp(bore.radius_mm + 0.7 * by, 1.8, 8.0);
        if (way >= 2 && way < 6) tried.entry_mm += by * (way < 4 ? u : v);
        // About the middle of what is looked at, so that place and tilt do not hinder each other.
        if (way >= 6) {
          const Vector3d tilt = 0.07 * by * (way < 8 ? u : v);
          tried.direction = (bore.direction + tilt).normalized();
          tried.entry_mm -= 12 * tilt;
        }
        const auto entry = entry_on(grid, tried.entry_mm, tried.direction);
        if (!entry) continue;
        tried.entry_mm = *entry;
        tried.evidence = evidence_of(grid, tried);
        if (tried.evidence <= bore.evidence + 1) continue;
        bore = tried;
        is_better = true;
        break;
      }
    }
  }
}

struct Alike {
  double entry_mm, direction_rad;
};

void keep_distinct(std::vector<Bore>& bores, std::size_t most, const Alike& alike) {
  const auto is_same = [&](const Bore& a, const Bore& b) {
    return (a.entry_mm - b.entry_mm).norm() < alike.entry_mm &&
           geometry::angle_between_rad(a.direction, b.direction) < alike.direction_rad;
  };
  std::stable_sort(bores.begin(), bores.end(),
                   [](const Bore& a, const Bore& b) { return a.evidence > b.evidence; });
  std::vector<Bore> kept;
  for (const Bore& bore : bores) {
    if (std::any_of(kept.begin(), kept.end(), [&](const Bore& other) { return is_same(bore, other); }))
      continue;
    kept.push_back(bore);
    if (kept.size() == most) break;
  }
  bores = std::move(kept);
}

}  // namespace

std::vector<Bore> search_bores(const BoneGrid& grid, const tunnels::Tunnel& plan) {
  const Vector3d u = plan.direction.unitOrthogonal(), v = plan.direction.cross(u);
  constexpr double kStep_mm = 1.5, kStep_deg = 6;
  const int places = static_cast<int>(kSearched_mm / kStep_mm),
            tilts = static_cast<int>(kSearched_deg / kStep_deg);
  std::vector<Bore> bores;
  for (int a = -tilts; a <= tilts; ++a) {
    for (int b = -tilts; b <= tilts; ++b) {
      const double tilt = geometry::rad_from_deg(kStep_deg * std::hypot(a, b));
      if (tilt > geometry::rad_from_deg(kSearched_deg)) continue;
      const Vector3d aside = a * u + b * v;
      const Vector3d direction =
          tilt > 0 ? Vector3d(std::cos(tilt) * plan.direction + std::sin(tilt) * aside.normalized())
                   : plan.direction;
      for (int i = -places; i <= places; ++i) {
        for (int j = -places; j <= places; ++j) {
          if (std::hypot(i, j) * kStep_mm > kSearched_mm) continue;
          const auto entry = entry_on(grid, plan.entry_mm + kStep_mm * (i * u + j * v), direction);
          if (!entry) continue;
          for (const double radius_mm : {2.4, 3.2, 4.0, 4.8, 5.8}) {
            Bore bore{*entry, direction, radius_mm};
            bore.evidence = evidence_of(grid, bore);
            if (bore.evidence > 20) bores.push_back(bore);
          }
        }
      }
    }
  }
  keep_distinct(bores, kRefined, {2.5, 0.14});
  for (Bore& bore : bores) climb(grid, bore);
  keep_distinct(bores, kReturned, {4, 0.3});
  return bores;
}

}  // namespace arthronaut::postop
