#include "planning/library/trends.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace arthronaut::library {

namespace {

constexpr double kSigmas = 3, kRangeOfTwo = 1.128;

std::optional<double> value_of(const SessionFacts& session, Trend trend) {
  switch (trend) {
    case Trend::EntryOffset:
      return session.entry_offset_mm;
    case Trend::Angle:
      return session.angle_deg;
    case Trend::AchievedOffset:
    case Trend::AchievedAngle:
      return std::nullopt;
    case Trend::PredictedError:
      // Of registrations that were found there: one that was brought along is the session's before.
      return session.registering_min ? session.predicted_error_mm : std::nullopt;
    case Trend::Registering:
      return session.registering_min;
    case Trend::Verifying:
      return session.verifying_min;
    case Trend::Drilling:
      return session.drilling_min;
  }
  return std::nullopt;
}

// What is rehearsed or looked at after an operation is not what was compared.
const SessionFacts* compared_session_of(const CaseRecord& record, bones::BoneKind bone) {
  const SessionFacts* best = nullptr;
  const auto rank = [](const SessionFacts& session) {
    return session.is_simulated() ? 0 : session.is_drilled() ? 2 : 1;
  };
  for (const SessionFacts& session : record.sessions)
    if (session.bone == bone && !session.started_utc.empty() &&
        (best == nullptr || rank(session) >= rank(*best)))
      best = &session;
  return best;
}

void add_comparisons(const CaseRecord& record, Trend trend, const TrendOptions& options,
                     std::vector<TrendPoint>& points) {
  for (const PostoperativeFacts& facts : record.postoperative) {
    const bool is_offset = trend == Trend::AchievedOffset;
    const auto value = is_offset ? facts.entry_offset_mm : facts.angle_deg;
    const bool is_known = facts.is_known(is_offset ? tunnels::Quantity::Entry : tunnels::Quantity::Direction);
    if (!value || is_known == options.of_unknown || (options.bone && facts.tunnel.bone != options.bone))
      continue;
    const SessionFacts* session = compared_session_of(record, facts.tunnel.bone);
    // A bone that was never navigated is of what its case is: one that was only rehearsed is nobody's.
    const bool is_simulated = session != nullptr ? session->is_simulated() : record.is_simulated();
    if (is_simulated && !options.with_simulated) continue;
    if (session == nullptr)
      points.push_back(
          {record.created_utc, *value, record.name, "", record.folder, facts.tunnel.bone, is_simulated});
    else
      points.push_back({session->started_utc, *value, record.name, session->id, record.folder,
                        facts.tunnel.bone, is_simulated});
  }
}

}  // namespace

std::string_view to_text(Trend trend) {
  switch (trend) {
    case Trend::EntryOffset:
      return "Offset of the entry";
    case Trend::Angle:
      return "Angle to the planned axis";
    case Trend::AchievedOffset:
      return "Offset of the entry, by CT";
    case Trend::AchievedAngle:
      return "Angle to the planned axis, by CT";
    case Trend::PredictedError:
      return "Predicted error of the registration";
    case Trend::Registering:
      return "Registering";
    case Trend::Verifying:
      return "Verifying";
    case Trend::Drilling:
      return "Drilling";
  }
  return "";
}

std::string_view unit_of(Trend trend) {
  switch (trend) {
    case Trend::EntryOffset:
    case Trend::AchievedOffset:
    case Trend::PredictedError:
      return "mm";
    case Trend::Angle:
    case Trend::AchievedAngle:
      return "deg";
    case Trend::Registering:
    case Trend::Verifying:
    case Trend::Drilling:
      return "min";
  }
  return "";
}

std::vector<TrendPoint> trend_of(std::span<const CaseRecord> records, Trend trend,
                                 const TrendOptions& options) {
  std::vector<TrendPoint> points;
  for (const CaseRecord& record : records) {
    if (is_of_comparisons(trend)) {
      add_comparisons(record, trend, options, points);
      continue;
    }
    for (const SessionFacts& session : record.sessions) {
      // Without a header nobody knows when it was, or whether of a simulation.
      if (session.started_utc.empty() || (session.is_simulated() && !options.with_simulated)) continue;
      if (options.bone && session.bone != options.bone) continue;
      const auto value = value_of(session, trend);
      if (value)
        points.push_back({session.started_utc, *value, record.name, session.id, record.folder, session.bone,
                          session.is_simulated()});
    }
  }
  std::sort(points.begin(), points.end(), [](const TrendPoint& a, const TrendPoint& b) {
    return std::tie(a.when_utc, a.session, a.case_folder) < std::tie(b.when_utc, b.session, b.case_folder);
  });
  return points;
}

ControlLimits control_limits(std::span<const double> values) {
  ControlLimits limits;
  if (values.size() < kLeastForLimits) return limits;
  double ranges = 0;
  for (std::size_t i = 1; i < values.size(); ++i) ranges += std::abs(values[i] - values[i - 1]);
  const double half = kSigmas * ranges / static_cast<double>(values.size() - 1) / kRangeOfTwo;
  limits.is_known = true;
  // About the first one: of values that are all the same the mean is that value to the last bit.
  const double first = values.front();
  for (const double value : values) limits.center += (value - first) / static_cast<double>(values.size());
  limits.center += first;
  limits.lower = std::max(limits.center - half, 0.0);
  limits.upper = limits.center + half;
  return limits;
}

ControlLimits limits_of(std::span<const TrendPoint> points) {
  const bool has_real =
      std::ranges::any_of(points, [](const TrendPoint& point) { return !point.is_simulated; });
  std::vector<double> values;
  for (const TrendPoint& point : points)
    if (point.is_simulated != has_real) values.push_back(point.value);
  return control_limits(values);
}

bool is_one_series(const TrendPoint& a, const TrendPoint& b) {
  return a.is_simulated == b.is_simulated && a.bone == b.bone;
}

}  // namespace arthronaut::library
