#include "planning/files/json_covariance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "planning/files/json_document.h"
#include "planning/geometry/error.h"
#include "tests/message_of.h"

namespace arthronaut::files {
namespace {

using testing::AllOf;
using testing::HasSubstr;

JsonObject holding(const std::string& values) {
  return parse_json(R"({"format": "arthronaut.test", "version": 1, "c": )" + values + "}", "a.json",
                    "arthronaut.test", 1);
}

std::string refusal(const std::string& values) {
  return test::message_of<InvalidInput>([&] { (void)read_covariance(holding(values), "c", 2); });
}

// Whatever the units, and where one of the numbers is exact; to the last bit.
TEST(JsonCovariance, RoundTripKeepsEveryNumber) {
  Eigen::Matrix3d covariance;
  covariance << 900, 1e-4 / 3, 0, 1e-4 / 3, 1e-10, 0, 0, 0, 0;
  EXPECT_EQ(read_covariance(holding(covariance_to_json(covariance).dump()), "c", 3), covariance);
}

// What is fully correlated is a covariance still, written to three digits: 0.0333 for 1/30, 0.111 for 1/9.
TEST(JsonCovariance, BearsWhatWasRounded) {
  EXPECT_NEAR(read_covariance(holding("[0.111, 0.0333, 0.0333, 0.00999]"), "c", 2)(0, 1), 0.0333, 1e-12);
}

TEST(JsonCovariance, RefusesWhatNothingScattersBy) {
  EXPECT_THAT(refusal("[1, 0, 0]"), AllOf(HasSubstr("a.json: c"), HasSubstr("must hold 4 numbers")));
  EXPECT_THAT(refusal("[1, 0, 0, -1]"), HasSubstr("a variance must not be negative"));
  EXPECT_THAT(refusal("[1, 0.5, 0.4, 1]"), HasSubstr("must be symmetric"));
  EXPECT_THAT(refusal("[1, 2, 2, 1]"), HasSubstr("is no covariance"));
  EXPECT_THAT(refusal("[1e-12, 2e-12, 2e-12, 1e-12]"), HasSubstr("is no covariance"));
  EXPECT_THAT(refusal("[0, 1, 1, 4]"), HasSubstr("is no covariance"));
}

}  // namespace
}  // namespace arthronaut::files
