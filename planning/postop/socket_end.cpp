#include "planning/postop/socket_end.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "planning/geometry/quantile.h"
#include "planning/postop/bone_grid.h"

namespace arthronaut::postop {

namespace {

using Eigen::Vector3d;

constexpr double kLeastStep_hu = 30;
constexpr int kTurns = 16;
constexpr double kSpacing_mm = 0.5, kFirst_mm = 2.5, kLeast_mm = 6;
// Stations that a step is told by, to either side: 5 mm.
constexpr std::ptrdiff_t kBeside = 10;
// Of the rings at which a station is looked at, each as wide in area.
constexpr int kRings = 3;
constexpr double kLeastBlur_mm = 0.1;

double station_mm(std::ptrdiff_t station) { return kFirst_mm + kSpacing_mm * static_cast<double>(station); }

double median_of(const std::vector<double>& grey, std::ptrdiff_t from, std::ptrdiff_t to) {
  return geometry::median(
      {grey.begin() + std::max<std::ptrdiff_t>(0, from), grey.begin() + std::min(std::ssize(grey), to)});
}

}  // namespace

// The mean of the ring, station by station; of a station in metal that before it.
std::vector<double> AlongBore::greys(const Vector3d& from, const TellingRing& ring) const {
  const double length = passage_.length_mm();
  const Vector3d d = (passage_.exit_mm - passage_.entry_mm).normalized(), u = d.unitOrthogonal(),
                 v = d.cross(u);
  const double low = ring.from_mm * ring.from_mm, high = ring.to_mm * ring.to_mm;
  std::vector<double> grey;
  for (std::ptrdiff_t station = 0; station_mm(station) < length - 0.5; ++station) {
    double sum = 0;
    int count = 0;
    for (int n = 0; n < kRings; ++n) {
      const double off = std::sqrt(low + (n + 0.5) / kRings * (high - low));
      for (int turn = 0; turn < kTurns; ++turn) {
        const double angle = 2 * M_PI * turn / kTurns;
        const double hu = postop_.at(postop_from_plan_ * (from + station_mm(station) * d +
                                                          off * (std::cos(angle) * u + std::sin(angle) * v)));
        if (!std::isfinite(hu) || hu > kMetal_hu) continue;
        sum += hu;
        ++count;
      }
    }
    grey.push_back(count >= kTurns ? sum / count : grey.empty() ? 0 : grey.back());
  }
  return grey;
}

std::optional<double> AlongBore::step_in(std::vector<double> grey) const {
  constexpr auto kFirst = static_cast<std::ptrdiff_t>((kLeast_mm - kFirst_mm) / kSpacing_mm);
  if (std::ssize(grey) <= kFirst) return std::nullopt;
  // What is denser than the bone about the bore counts no more than that: else the far cortex would outdo the
  // marrow before it.
  const double densest = median_of(grey, 0, kFirst) + 1.2 * std::max(contrast_hu_, kLeastStep_hu);
  for (double& hu : grey) hu = std::min(hu, densest);
  std::vector<double> jumps;
  for (std::size_t i = 1; i < grey.size(); ++i) jumps.push_back(std::abs(grey[i] - grey[i - 1]));
  const double noise = geometry::median(std::move(jumps), 0);
  const double least = std::max({kLeastStep_hu, 5 * noise, 0.5 * contrast_hu_});
  // Between what lies before and what follows.
  const auto rise_at = [&](std::ptrdiff_t i) {
    return median_of(grey, i, i + kBeside) - median_of(grey, i - kBeside, i);
  };
  std::ptrdiff_t at = kFirst;
  const std::ptrdiff_t last = std::ssize(grey) - 4;
  while (at <= last && rise_at(at) < least) ++at;
  if (at > last) return std::nullopt;
  while (at + 1 <= last && rise_at(at + 1) > rise_at(at)) ++at;
  // Half-way up.
  const double level = 0.5 * (median_of(grey, at - kBeside, at) + median_of(grey, at, at + kBeside));
  for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(1, at - kBeside);
       i < std::min(std::ssize(grey), at + kBeside); ++i) {
    const double a = grey[static_cast<std::size_t>(i) - 1], b = grey[static_cast<std::size_t>(i)];
    if (a < level && b >= level) return station_mm(i - 1) + kSpacing_mm * (level - a) / (b - a);
  }
  return station_mm(at);
}

std::optional<double> AlongBore::end_mm(const TellingRing& ring) const {
  return step_in(greys(passage_.entry_mm, ring));
}

// Runs of stations, each less the mean of its line about the end.
std::vector<std::vector<double>> AlongBore::marrow_beside(const TellingRing& ring, double end_mm) const {
  constexpr double kGap_mm = 1.5, kAbout_mm = 12, kCortex_mm = 2.2;
  constexpr int kLines = 8;
  constexpr std::ptrdiff_t kShift = 4;
  const Vector3d d = (passage_.exit_mm - passage_.entry_mm).normalized(), u = d.unitOrthogonal(),
                 v = d.cross(u);
  std::vector<std::vector<double>> runs;
  for (const double off_mm : {radius_mm_ + kGap_mm + ring.to_mm, radius_mm_ + kGap_mm + 2.5 * ring.to_mm}) {
    for (int line = 0; line < kLines; ++line) {
      const double angle = 2 * M_PI * line / kLines;
      const Vector3d from = passage_.entry_mm + off_mm * (std::cos(angle) * u + std::sin(angle) * v);
      const std::vector<double> grey = greys(from, ring);
      std::vector<double> run;
      const auto close = [&] {
        if (std::ssize(run) >= kBeside) {
          double mean = 0;
          for (const double hu : run) mean += hu / static_cast<double>(run.size());
          for (double& hu : run) hu -= mean;
          for (std::ptrdiff_t first = 0; first + kBeside <= std::ssize(run); first += kShift)
            runs.emplace_back(run.begin() + first, run.end());
        }
        run.clear();
      };
      for (std::ptrdiff_t station = 0; station < std::ssize(grey); ++station) {
        const bool is_marrow =
            std::abs(station_mm(station) - end_mm) < kAbout_mm &&
            bone_.signed_distance_mm(from + station_mm(station) * d) < -(ring.to_mm + kCortex_mm);
        if (is_marrow)
          run.push_back(grey[static_cast<std::size_t>(station)]);
        else
          close();
      }
      close();
    }
  }
  return runs;
}

double AlongBore::end_sigma_mm(const TellingRing& ring, double end_mm) const {
  constexpr std::size_t kLeastRuns = 6;
  constexpr double kNotFound_mm = 5;
  const std::vector<double> seen = greys(passage_.entry_mm, ring);
  // The last station before the end, and the first that the blur brings anything across it to.
  const auto end = static_cast<std::ptrdiff_t>(std::ceil((end_mm - kFirst_mm) / kSpacing_mm)) - 1;
  const std::ptrdiff_t from = end - static_cast<std::ptrdiff_t>(std::ceil(2 * blur_mm_ / kSpacing_mm));
  if (from < 1 || end + kBeside > std::ssize(seen)) return std::numeric_limits<double>::infinity();
  const double graft_hu = median_of(seen, end - 2 * kBeside, from);
  // No brighter than the wall tells: of marrow that varies the step that is found is one of the greater ones.
  const double beyond_hu = std::min(median_of(seen, end + 2, end + 2 + kBeside), graft_hu + contrast_hu_);
  const auto runs = marrow_beside(ring, end_mm);
  if (runs.size() < kLeastRuns) return std::numeric_limits<double>::infinity();
  double sum = 0;
  for (const std::vector<double>& run : runs) {
    // Within the blur marrow that is a little darker or brighter moves the place half-way up.
    std::vector<double> tried(seen.begin(), seen.begin() + from);
    for (const double hu : run) {
      if (tried.size() == seen.size()) break;
      const double past = (station_mm(std::ssize(tried)) - end_mm) / std::max(kLeastBlur_mm, blur_mm_);
      tried.push_back(graft_hu + 0.5 * std::erfc(-past * M_SQRT1_2) * (beyond_hu + hu - graft_hu));
    }
    const auto found = step_in(std::move(tried));
    const double off_mm = found ? *found - end_mm : kNotFound_mm;
    sum += off_mm * off_mm;
  }
  return std::sqrt(sum / static_cast<double>(runs.size()));
}

}  // namespace arthronaut::postop
