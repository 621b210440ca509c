#include "navigation/experiments/predicted_error.h"

#include <gtest/gtest.h>

#include <cmath>

#include "planning/geometry/error.h"

namespace arthronaut::experiments {
namespace {

void expect_honest(const ErrorRatios& ratios, const char* which) {
  // For an error of two coordinates that are predicted exactly the median is 0.83, for one 0.67.
  EXPECT_GT(ratios.offset, 0.5) << which;
  EXPECT_LT(ratios.offset, 1.6) << which;
  EXPECT_GT(ratios.angle, 0.5) << which;
  EXPECT_LT(ratios.angle, 1.6) << which;
}

// Two hundred operations, half with badly pivoted tools, half with a poor camera: what stands on the screen
// is what is wrong; for all of them and for each kind of set-up, where a prediction without tools and camera
// says far too little. The median of a kind's 50 is known to a seventh; of 25 it scatters by 0.48 to 0.62.
TEST(PredictedError, Hazard6IsTheErrorThereIs) {
  const PredictedErrorResult result = run_predicted_error({.operation_count = 200});
  ASSERT_EQ(result.operations.size(), 200u);
  expect_honest(result.all(), "all");
  using Kind = experiments::Setup;  // gtest has a Setup of its own
  for (const Kind setup : {Kind::Careful, Kind::PoorTools, Kind::PoorCamera, Kind::PoorBoth}) {
    EXPECT_EQ(result.of(setup).count, 50);
    expect_honest(result.of(setup), to_text(setup));
  }
  EXPECT_GT(result.all().tip, 0.5);
  EXPECT_LT(result.all().tip, 1.6);
  // An error of more than twice the prediction has a share of 2 % where all is Gaussian and known.
  EXPECT_LE(result.all().offset_above_two, 0.10);
  EXPECT_LE(result.all().angle_above_two, 0.10);
  EXPECT_GT(result.of(Setup::PoorTools).plain_offset, 1.6);
}

// The same seed gives the same figures.
TEST(PredictedError, IsDeterministic) {
  PredictedErrorOptions options;
  options.operation_count = 2;
  options.seed = 5;
  const auto first = run_predicted_error(options), second = run_predicted_error(options);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(first.operations[i].offset_mm, second.operations[i].offset_mm);
    EXPECT_EQ(first.operations[i].predicted_angle_deg, second.operations[i].predicted_angle_deg);
  }
  options.operation_count = 0;
  EXPECT_THROW((void)run_predicted_error(options), InvalidInput);
}

}  // namespace
}  // namespace arthronaut::experiments
