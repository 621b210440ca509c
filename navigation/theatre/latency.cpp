#include "navigation/theatre/latency.h"

#include <algorithm>
#include <cmath>

namespace arthronaut::theatre {

namespace {

constexpr double kStep_ms = 0.125, kGrowth = 1.1;

}  // namespace

std::string_view to_text(Stage stage) {
  constexpr std::array<std::string_view, kStageCount> kNames = {"capture",  "decode",      "queue",
                                                                "tracking", "operation",   "publish",
                                                                "display",  "to guidance", "to screen"};
  return kNames[static_cast<std::size_t>(stage)];
}

std::size_t LatencyMeter::step_of(double ms) {
  constexpr double kEven_ms = kStep_ms * kEvenSteps;
  const double step =
      ms < kEven_ms ? ms / kStep_ms : kEvenSteps + std::log(ms / kEven_ms) / std::log(kGrowth);
  return static_cast<std::size_t>(std::min(step, static_cast<double>(kSteps - 1)));
}

// The last step has none: there the worst is all that is known.
double LatencyMeter::end_of_ms(std::size_t step) {
  if (step < kEvenSteps) return static_cast<double>(step + 1) * kStep_ms;
  if (step == kSteps - 1) return HUGE_VAL;
  return kStep_ms * kEvenSteps * std::pow(kGrowth, static_cast<double>(step + 1 - kEvenSteps));
}

void LatencyMeter::add(Stage stage, double ms) {
  if (!(ms >= 0)) return;
  Counts& counts = stages_[static_cast<std::size_t>(stage)];
  ++counts.at[step_of(ms)];
  ++counts.all;
  counts.worst_ms = std::max(counts.worst_ms, ms);
}

void LatencyMeter::add(const FrameLatency& frame) {
  add(Stage::Capture, frame.capture_ms);
  add(Stage::Decode, frame.decode_ms);
  add(Stage::Queue, frame.queue_ms);
  add(Stage::Tracking, frame.tracking_ms);
  add(Stage::Operation, frame.operation_ms);
  add(Stage::ToGuidance, frame.guidance_ms);
}

LatencyReport LatencyMeter::report() const {
  LatencyReport report;
  for (std::size_t stage = 0; stage < kStageCount; ++stage) {
    const Counts& counts = stages_[stage];
    StageLatency& of_stage = report[stage];
    of_stage.count = counts.all;
    of_stage.worst_ms = counts.worst_ms;
    const auto below = [&](double share) {
      const auto wanted = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(counts.all)));
      std::uint64_t seen = 0;
      for (std::size_t step = 0; step < kSteps; ++step)
        if ((seen += counts.at[step]) >= wanted) return std::min(counts.worst_ms, end_of_ms(step));
      return counts.worst_ms;
    };
    if (counts.all == 0) continue;
    of_stage.median_ms = below(0.5);
    of_stage.p99_ms = below(0.99);
  }
  return report;
}

}  // namespace arthronaut::theatre
