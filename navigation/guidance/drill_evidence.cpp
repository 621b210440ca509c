#include "navigation/guidance/drill_evidence.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "planning/geometry/error.h"
#include "planning/geometry/quantile.h"

namespace arthronaut::guidance {

namespace {

constexpr std::size_t kCapacity = 2048;  // over a minute at 30 poses a second
// What a pose can stand for at most: where it stood while no picture came, nobody saw.
constexpr std::int64_t kLongest_ns = 100'000'000;

template <typename Poses, typename Value>
double median_of(const Poses& poses, const Value& value) {
  std::vector<double> values;
  values.reserve(poses.size());
  for (const auto& pose : poses) values.push_back(value(pose));
  return geometry::median(std::move(values), 0);
}

template <typename Poses, typename Vector>
Eigen::Vector3d median_vector(const Poses& poses, const Vector& vector) {
  Eigen::Vector3d result;
  for (int axis = 0; axis < 3; ++axis)
    result[axis] = median_of(poses, [&](const auto& pose) { return vector(pose)[axis]; });
  return result;
}

}  // namespace

std::string_view to_text(EvidenceOutcome outcome) {
  switch (outcome) {
    case EvidenceOutcome::NoGuidance:
      return "there was no guidance meanwhile";
    case EvidenceOutcome::NeverTouched:
      return "the guide never stood on the bone";
    case EvidenceOutcome::BesideEntry:
      return "the guide did not stand at the planned entry";
    case EvidenceOutcome::TooShort:
      return "guide or drill stood at the planned entry too shortly";
    case EvidenceOutcome::Seen:
      return "seen";
    case EvidenceOutcome::NoPicture:
      return "no picture showed anything when it was said";
  }
  return "unknown";
}

DrillEvidence::Store::Store() { poses_.reserve(kCapacity); }

void DrillEvidence::Store::add(Pose pose) {
  passed_over_ns_ += pose.stands_for_ns;
  if (++passed_over_ < stride_) return;
  passed_over_ = 0;
  pose.stands_for_ns = std::exchange(passed_over_ns_, 0);
  if (poses_.size() == kCapacity) {
    for (std::size_t i = 0; i < kCapacity / 2; ++i) {
      const std::int64_t before_ns = poses_[2 * i].stands_for_ns;
      poses_[i] = poses_[2 * i + 1];
      poses_[i].stands_for_ns += before_ns;
    }
    poses_.resize(kCapacity / 2);
    stride_ *= 2;
  }
  poses_.push_back(pose);
}

void DrillEvidence::Store::clear() {
  poses_.clear();
  stride_ = 1;
  passed_over_ = 0;
  passed_over_ns_ = 0;
}

DrillEvidence::DrillEvidence(const tunnels::Tunnel& planned, const DrillEvidenceLimits& limits)
    : planned_(planned), limits_(limits) {
  const auto require = [](bool holds, const char* what) {
    if (!holds) throw InvalidInput(std::string("drill evidence: ") + what);
  };
  require(limits.most_depth_mm > limits.least_depth_mm, "most_depth_mm must be above least_depth_mm");
  require(limits.most_lateral_mm > 0, "most_lateral_mm must be above 0");
  require(limits.window_mm > 0, "window_mm must be above 0");
  require(limits.least_s > 0, "least_s must be above 0");
}

void DrillEvidence::clear() {
  forget_guide();
  drill_.clear();
}

void DrillEvidence::forget_guide() {
  guide_.clear();
  valid_count_ = deep_enough_count_ = 0;
  nearest_mm_ = 0;
}

void DrillEvidence::add(const GuidanceNumbers& numbers) {
  const std::int64_t before_ns =
      std::exchange(newest_ns_, numbers.timestamp_ns).value_or(numbers.timestamp_ns);
  const std::int64_t stands_for_ns =
      std::clamp(numbers.timestamp_ns - before_ns, std::int64_t{0}, kLongest_ns);
  if (numbers.drill) {
    const DrillDepth& drill = *numbers.drill;
    if (drill.depth_mm >= limits_.least_drilled_mm && drill.lateral_mm <= limits_.most_lateral_mm)
      drill_.add({drill.tip_mm, drill.direction, drill.depth_mm, drill.sigma_offset_mm, drill.sigma_angle_deg,
                  numbers.timestamp_ns, stands_for_ns});
  }
  if (!numbers.is_valid()) return;
  nearest_mm_ = valid_count_ == 0 ? numbers.tip_to_entry_mm : std::min(nearest_mm_, numbers.tip_to_entry_mm);
  ++valid_count_;
  if (numbers.depth_mm < limits_.least_depth_mm || numbers.depth_mm > limits_.most_depth_mm) return;
  ++deep_enough_count_;
  const Eigen::Vector3d along = planned_.direction.normalized();
  const Eigen::Vector3d from_entry = numbers.guide_point_mm - planned_.entry_mm;
  if ((from_entry - from_entry.dot(along) * along).norm() > limits_.most_lateral_mm) return;
  guide_.add({numbers.guide_point_mm, numbers.guide_direction, numbers.depth_mm, numbers.sigma_offset_mm,
              numbers.sigma_angle_deg, numbers.timestamp_ns, stands_for_ns});
}

void DrillEvidence::summarise(const std::vector<Pose>& poses, DrillEvidenceSummary& summary) const {
  std::vector<double> depths;
  depths.reserve(poses.size());
  for (const Pose& pose : poses) depths.push_back(pose.depth_mm);
  const double deepest_mm = geometry::quantile(std::move(depths), 0.9, 0);
  std::vector<Pose> counted;
  counted.reserve(poses.size());
  std::copy_if(poses.begin(), poses.end(), std::back_inserter(counted),
               [&](const Pose& pose) { return std::abs(pose.depth_mm - deepest_mm) <= limits_.window_mm; });
  summary.pose_count = static_cast<int>(counted.size());
  std::int64_t counted_ns = 0;
  for (const Pose& pose : counted) counted_ns += pose.stands_for_ns;
  if (static_cast<double>(counted_ns) < limits_.least_s * 1e9) return;
  summary.outcome = EvidenceOutcome::Seen;
  summary.direction = median_vector(counted, [](const Pose& pose) { return pose.direction; }).normalized();
  summary.entry_mm = median_vector(
      counted, [&](const Pose& pose) { return crossing_of(pose.point_mm, pose.direction, planned_); });
  summary.depth_mm = median_of(counted, [](const Pose& pose) { return pose.depth_mm; });
  summary.sigma_offset_mm = median_of(counted, [](const Pose& pose) { return pose.sigma_offset_mm; });
  summary.sigma_angle_deg = median_of(counted, [](const Pose& pose) { return pose.sigma_angle_deg; });
  double squares_mm = 0;
  for (const Pose& pose : counted)
    squares_mm += (crossing_of(pose.point_mm, pose.direction, planned_) - summary.entry_mm).squaredNorm();
  summary.spread_mm = std::sqrt(squares_mm / static_cast<double>(counted.size()));
  summary.timestamp_ns = counted.back().timestamp_ns;
}

DrillEvidenceSummary DrillEvidence::summary() const {
  DrillEvidenceSummary summary;
  summary.nearest_mm = nearest_mm_;
  // A drill's own marker says more than the guide that it runs through.
  if (!drill_.poses().empty()) {
    DrillEvidenceSummary of_drill = summary;
    of_drill.outcome = EvidenceOutcome::TooShort;
    of_drill.is_of_drill = true;
    summarise(drill_.poses(), of_drill);
    if (of_drill.is_usable() || valid_count_ == 0) return of_drill;
  }
  if (valid_count_ == 0) return summary;
  if (deep_enough_count_ == 0) {
    summary.outcome = EvidenceOutcome::NeverTouched;
    return summary;
  }
  if (guide_.poses().empty()) {
    summary.outcome = EvidenceOutcome::BesideEntry;
    return summary;
  }
  summary.outcome = EvidenceOutcome::TooShort;
  summarise(guide_.poses(), summary);
  return summary;
}

}  // namespace arthronaut::guidance
