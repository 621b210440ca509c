// How one number of the sessions goes over time, with control limits: what is within them is this theatre's
// usual spread, what is outside has a cause to look for.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "planning/library/case_record.h"

namespace arthronaut::library {

enum class Trend {
  EntryOffset,     // mm, of the drilled tunnel from the planned one
  Angle,           // degrees, likewise
  AchievedOffset,  // mm, of the tunnel that a CT after the operation shows
  AchievedAngle,   // degrees, likewise
  PredictedError,  // mm, of a registration that was found in the session: its confidence
  Registering,     // minutes a step, see SessionFacts
  Verifying,
  Drilling,
};
inline constexpr int kTrendCount = 8;
[[nodiscard]] std::string_view to_text(Trend trend);  // "Entry offset", ...
[[nodiscard]] std::string_view unit_of(Trend trend);  // "mm", "deg", "min"

struct TrendPoint {
  std::string when_utc;
  double value = 0;
  std::string case_name, session;
  std::filesystem::path case_folder;
  std::optional<bones::BoneKind> bone = {};  // empty: of none (a check of accuracy), or not known
  bool is_simulated = false;
};

struct TrendOptions {
  bool with_simulated = false;  // a simulation is no operation: it would make the spread look small
  std::optional<bones::BoneKind> bone = {};  // empty: either
  bool of_unknown = false;  // of comparisons those whose number is not relied on, in place of the others
};
// What was measured after the operation, in a CT; the others are of sessions.
[[nodiscard]] constexpr bool is_of_comparisons(Trend trend) {
  return trend == Trend::AchievedOffset || trend == Trend::AchievedAngle;
}
// In the order of time. Sessions that do not say the number, or whose header cannot be read, are left
// out, as are comparisons in which that number is not relied on, whatever else is. A comparison is of its
// bone's newest session that drilled and is no simulation; without one, of the newest that is none; else of
// the newest one. That says when it was and whether of a simulation; without any it is of the day on which
// the case was made.
[[nodiscard]] std::vector<TrendPoint> trend_of(std::span<const CaseRecord> records, Trend trend,
                                               const TrendOptions& options = {});

// Fewer values say nothing of their spread.
inline constexpr std::size_t kLeastForLimits = 8;

struct ControlLimits {
  bool is_known = false;  // false: fewer than kLeastForLimits values; the rest is then 0
  double center = 0, lower = 0, upper = 0;
};
// Of an individuals chart: center = mean, limits = center -+ 3 MR / 1.128, where MR is the mean of the moving
// ranges |x(i) - x(i-1)| and 1.128 = d2 of two values (D. C. Montgomery, Introduction to Statistical Quality
// Control, 7th ed., eq. 6.33). What is charted here is never below 0, and neither is the lower limit. In the
// order of time, since the moving range is of neighbours.
[[nodiscard]] ControlLimits control_limits(std::span<const double> values);

// Those of the operations among the points; where there are none, those of the simulations. Of both together
// they would be of neither.
[[nodiscard]] ControlLimits limits_of(std::span<const TrendPoint> points);
// Whether both points are of one series: what changes from one to the other is not that the one was
// simulated, or of the other bone.
[[nodiscard]] bool is_one_series(const TrendPoint& a, const TrendPoint& b);

}  // namespace arthronaut::library
