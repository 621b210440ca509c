#include "planning/pacs/line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace arthronaut::pacs {
namespace {

using ::testing::HasSubstr;

constexpr double kPatience_s = 3600;

TEST(PacsAllowance, EndsAfterSoManyBytes) {
  Allowance allowance(kPatience_s);
  EXPECT_EQ(allowance.admit(1, true), 0U);  // nothing was allowed yet
  Allowance other(kPatience_s);
  other.allow(100, "it sends too much");
  EXPECT_EQ(other.admit(60, true), 60U);
  other.note(60, true);
  EXPECT_EQ(other.admit(60, true), 40U);
  other.note(40, true);
  EXPECT_EQ(other.complaint(), "");
  other.allow(10, "it sends too much");
  EXPECT_EQ(other.admit(60, true), 10U);
  other.note(10, true);
  EXPECT_EQ(other.admit(1, true), 0U);
  EXPECT_EQ(other.complaint(), "it sends too much");
  EXPECT_TRUE(other.is_for_good());
}

// What we send is not bounded by what we want to hear.
TEST(PacsAllowance, LetsUsSpeak) {
  Allowance allowance(kPatience_s);
  allowance.allow(1, "it sends too much");
  EXPECT_EQ(allowance.admit(1000, false), 1000U);
  allowance.note(1000, false);
  EXPECT_EQ(allowance.admit(1000, true), 1U);
}

// No patience at all: the second byte is late already.
TEST(PacsAllowance, EndsWithAPeerThatTrickles) {
  Allowance allowance(0);
  allowance.allow(1 << 20, "it sends too much");
  EXPECT_EQ(allowance.admit(1, true), 1U);
  std::this_thread::sleep_for(std::chrono::milliseconds(2));
  EXPECT_EQ(allowance.admit(1, true), 0U);
  EXPECT_THAT(allowance.complaint(), HasSubstr("too slowly"));
  EXPECT_FALSE(allowance.is_for_good());
}

}  // namespace
}  // namespace arthronaut::pacs
