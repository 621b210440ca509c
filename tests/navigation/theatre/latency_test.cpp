#include "navigation/theatre/latency.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace arthronaut::theatre {
namespace {

// Median and 99 % of what was counted, to the width of a step; what is not known is not counted.
TEST(LatencyMeter, TellsMedianAndNinetyNinePercent) {
  std::mt19937 random(3);
  std::lognormal_distribution<double> ms(2, 0.6);
  std::vector<double> all;
  LatencyMeter meter;
  for (int i = 0; i < 5000; ++i) {
    all.push_back(ms(random));
    meter.add(Stage::Tracking, all.back());
    meter.add(Stage::Decode, -1);
  }
  std::sort(all.begin(), all.end());
  const LatencyReport report = meter.report();
  const StageLatency& tracking = of(report, Stage::Tracking);
  EXPECT_EQ(tracking.count, 5000U);
  EXPECT_NEAR(tracking.median_ms, all[2499], 0.13);
  EXPECT_NEAR(tracking.p99_ms, all[4949], 0.13);
  EXPECT_EQ(tracking.worst_ms, all.back());
  EXPECT_EQ(of(report, Stage::Decode).count, 0U);
}

// What takes longer than the scale is not lost, and no percentile is above the worst.
TEST(LatencyMeter, KeepsWhatIsBeyondItsScale) {
  LatencyMeter meter;
  meter.add(Stage::ToScreen, 3000);
  const StageLatency only = of(meter.report(), Stage::ToScreen);
  EXPECT_EQ(only.worst_ms, 3000);
  EXPECT_GE(only.p99_ms, 499);
  meter.clear();
  meter.add(Stage::ToScreen, 0.01);
  EXPECT_EQ(of(meter.report(), Stage::ToScreen).median_ms, 0.01);
}

// Seconds are told as seconds: to a tenth of themselves, and never as less than they are.
TEST(LatencyMeter, Hazard3TellsSecondsAsSeconds) {
  LatencyMeter meter;
  for (int i = 0; i < 98; ++i) meter.add(Stage::ToGuidance, 3000);
  meter.add(Stage::ToGuidance, 8000);
  meter.add(Stage::ToGuidance, 60'000);
  const StageLatency all = of(meter.report(), Stage::ToGuidance);
  EXPECT_GE(all.median_ms, 3000);
  EXPECT_LE(all.median_ms, 3300);
  EXPECT_GE(all.p99_ms, 8000);
  EXPECT_LE(all.p99_ms, 8800);
  EXPECT_EQ(all.worst_ms, 60'000);
  meter.add(Stage::ToGuidance, 1e12);
  EXPECT_EQ(of(meter.report(), Stage::ToGuidance).worst_ms, 1e12);
}

}  // namespace
}  // namespace arthronaut::theatre
