#include "planning/library/accuracy_checks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <ctime>
#include <fstream>

#include "planning/files/format.h"
#include "planning/geometry/error.h"
#include "tests/temporary_folder.h"

namespace arthronaut::library {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Outcome = AccuracyStanding::Outcome;

AccuracyDevice scope(const std::string& name, const std::string& camera_sha256 = "aa") {
  return {name, camera_sha256};
}

AccuracyCheck check_of(const std::string& utc, double distance_mm, const std::string& device = "scope A") {
  return {.checked_utc = utc,
          .device = device,
          .medium = "saline",
          .source = "a clip",
          .camera_sha256 = "aa",
          .true_mm = 10,
          .distance_mm = distance_mm,
          .spread_mm = 0.02,
          .frame_count = 120,
          .reasons = {}};
}

class AccuracyChecksTest : public ::testing::Test {
 protected:
  AccuracyChecksTest() { set_zone("UTC"); }
  ~AccuracyChecksTest() override { set_zone("UTC"); }
  static void set_zone(const char* zone) {
    ::setenv("TZ", zone, 1);
    ::tzset();
  }
  const test::TemporaryFolder folder_;
};

TEST_F(AccuracyChecksTest, AreKeptAndReadInTheOrderOfTime) {
  AccuracyCheck doubted = check_of("2026-11-22T06:00:00Z", 10.2, "scope B");
  doubted.reasons = {"too few frames", "another medium"};
  (void)keep_accuracy_check(folder_.path(), doubted);
  (void)keep_accuracy_check(folder_.path(), check_of("2026-11-21T06:00:00Z", 10.01));
  const auto file = keep_accuracy_check(folder_.path(), check_of("2026-11-23T06:00:00Z", 9.99));
  const AccuracyChecks read = read_accuracy_checks(folder_.path());
  EXPECT_TRUE(read.problems.empty());
  ASSERT_EQ(read.checks.size(), 3u);
  EXPECT_EQ(read.checks[0].distance_mm, 10.01);
  EXPECT_EQ(read.checks[1].reasons, doubted.reasons);
  EXPECT_EQ(read.checks[1].medium, "saline");
  EXPECT_EQ(read.checks[2].frame_count, 120u);
  EXPECT_THAT(devices_of(read), ElementsAre(scope("scope A"), scope("scope B")));
  EXPECT_EQ(accuracy_trend(read.checks, scope("scope A"), "2026-11-23T09:00:00Z").points.size(), 2u);
  struct stat status {};
  ASSERT_EQ(::stat(file.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0600U);
}

// Two checks of the same second are two checks; the same one again is itself.
TEST_F(AccuracyChecksTest, OfOneSecondStandBesideEachOther) {
  (void)keep_accuracy_check(folder_.path(), check_of("2026-11-23T06:00:00Z", 9.99));
  (void)keep_accuracy_check(folder_.path(), check_of("2026-11-23T06:00:00Z", 9.98));
  (void)keep_accuracy_check(folder_.path(), check_of("2026-11-23T06:00:00Z", 9.98));
  EXPECT_EQ(read_accuracy_checks(folder_.path()).checks.size(), 2u);
}

TEST_F(AccuracyChecksTest, ABrokenFileIsToldAndHidesNoOther) {
  const auto file = keep_accuracy_check(folder_.path(), check_of("2026-11-23T06:00:00Z", 9.99));
  std::ofstream(file.parent_path() / "broken.json") << "{";
  std::ofstream(file.parent_path() / "newer.json") << R"({"format": "arthronaut.accuracy", "version": 2})";
  const AccuracyChecks read = read_accuracy_checks(folder_.path());
  EXPECT_EQ(read.checks.size(), 1u);
  ASSERT_EQ(read.problems.size(), 2u);
  EXPECT_THAT(read.problems[0], HasSubstr("broken.json"));
  EXPECT_TRUE(read_accuracy_checks(folder_ / "none").checks.empty());
}

TEST_F(AccuracyChecksTest, OneThatMeasuredNothingIsNotKept) {
  AccuracyCheck nothing = check_of("2026-11-23T06:00:00Z", 9.99);
  nothing.frame_count = 0;
  EXPECT_THROW((void)keep_accuracy_check(folder_.path(), nothing), InvalidInput);
  EXPECT_THROW((void)keep_accuracy_check(folder_.path(), check_of("yesterday", 9.99)), InvalidInput);
  EXPECT_THROW((void)keep_accuracy_check(folder_.path(), check_of("2026-11-23T06:00:00Z", 9.99, "")),
               InvalidInput);
  EXPECT_FALSE(std::filesystem::exists(accuracy_folder(folder_.path())));
}

// A day is the theatre's, not Greenwich's: eight in the evening in New York is the next day by UTC.
TEST_F(AccuracyChecksTest, ADayIsTheMachinesOwn) {
  EXPECT_FALSE(is_same_day("2026-11-23T13:00:00Z", "2026-11-24T01:00:00Z"));
  set_zone("America/New_York");
  EXPECT_TRUE(is_same_day("2026-11-23T13:00:00Z", "2026-11-24T01:00:00Z"));
  EXPECT_FALSE(is_same_day("2026-11-23T04:00:00Z", "2026-11-23T13:00:00Z"));
}

TEST_F(AccuracyChecksTest, AreMissedWhenTheLastIsOfAnotherDay) {
  EXPECT_EQ(accuracy_standing({}, scope("scope A"), "2026-11-23T09:00:00Z").outcome, Outcome::NeverChecked);
  const std::vector<AccuracyCheck> checks{check_of("2026-11-22T06:00:00Z", 10.01),
                                          check_of("2026-11-23T06:00:00Z", 10.01, "scope B")};
  const AccuracyStanding standing = accuracy_standing(checks, scope("scope A"), "2026-11-23T09:00:00Z");
  EXPECT_EQ(standing.outcome, Outcome::MissingToday);
  EXPECT_THAT(standing.text, HasSubstr("scope A: accuracy not checked today; last on 2026-11-22, 10.010 mm"));
  EXPECT_TRUE(accuracy_standing(checks, scope("scope B"), "2026-11-23T09:00:00Z").is_fine());
}

// Limits by Montgomery's eq. 6.33 over the days before: moving ranges of 0.02 mm give +- 3 * 0.02 / 1.128 =
// 0.0532 mm about 10.01 mm.
TEST_F(AccuracyChecksTest, AreOutsideByTheirOwnLimitsOrByTheFixedOne) {
  std::vector<AccuracyCheck> checks;
  for (int day = 1; day <= 10; ++day)
    checks.push_back(
        check_of("2026-11-" + std::string(day < 10 ? "0" : "") + std::to_string(day) + "T06:00:00Z",
                 day % 2 == 0 ? 10.02 : 10.0));
  const auto standing_with = [&](double today_mm) {
    auto all = checks;
    all.push_back(check_of("2026-11-23T06:00:00Z", today_mm));
    return accuracy_standing(all, scope("scope A"), "2026-11-23T09:00:00Z");
  };
  const AccuracyStanding fine = standing_with(10.05);
  EXPECT_TRUE(fine.is_fine()) << fine.text;
  ASSERT_TRUE(fine.limits.is_known);
  EXPECT_NEAR(fine.limits.upper, 10.01 + 0.0532, 1e-3);
  EXPECT_NEAR(fine.limits.lower, 10.01 - 0.0532, 1e-3);
  EXPECT_EQ(standing_with(10.07).outcome, Outcome::OutsideLimits);
  EXPECT_THAT(standing_with(10.07).text, HasSubstr("outside of its usual"));
  EXPECT_EQ(standing_with(9.95).outcome, Outcome::OutsideLimits);
  EXPECT_THAT(standing_with(10.11).text, HasSubstr("off by more than 0.100 mm"));
  checks.back().reasons = {"too few frames"};
  EXPECT_EQ(accuracy_standing(checks, scope("scope A"), "2026-11-10T09:00:00Z").outcome,
            Outcome::NotReliable);
  // Without enough days the fixed limit alone holds.
  const std::vector<AccuracyCheck> first{check_of("2026-11-23T06:00:00Z", 10.09)};
  EXPECT_TRUE(accuracy_standing(first, scope("scope A"), "2026-11-23T09:00:00Z").is_fine());
}

// Light goes another way through air: what is usual there is not usual in saline.
TEST_F(AccuracyChecksTest, AreComparedWithThoseInTheSameMediumAlone) {
  std::vector<AccuracyCheck> checks;
  for (int day = 10; day <= 19; ++day) {
    checks.push_back(check_of(files::format("2026-11-%dT06:00:00Z", day), day % 2 == 0 ? 10.02 : 10.0));
    checks.push_back(check_of(files::format("2026-11-%dT07:00:00Z", day), day % 2 == 0 ? 9.96 : 9.94));
    checks.back().medium = "air";
  }
  checks.push_back(check_of("2026-11-23T06:00:00Z", 9.94));
  const std::string now = "2026-11-23T09:00:00Z";
  const AccuracyStanding standing = accuracy_standing(checks, scope("scope A"), now);
  EXPECT_EQ(standing.outcome, Outcome::OutsideLimits) << standing.text;
  EXPECT_NEAR(standing.limits.center, 10.01, 1e-6);
  const AccuracyTrend trend = accuracy_trend(checks, scope("scope A"), now);
  EXPECT_EQ(trend.points.size(), 11U);
  EXPECT_EQ(trend.left_out, 10);
}

// A clock that once ran ahead: what it dated hides nothing that was checked since.
TEST_F(AccuracyChecksTest, OneOfTheFutureIsToldAndHidesNoOther) {
  const std::string now = "2026-11-23T09:00:00Z";
  AccuracyChecks read{{check_of("2026-11-23T06:00:00Z", 10.01), check_of("2027-01-23T06:00:00Z", 10.3)}, {}};
  EXPECT_TRUE(worst_standing(read, now).is_fine()) << worst_standing(read, now).text;
  EXPECT_EQ(accuracy_trend(read.checks, scope("scope A"), now).points.size(), 1U);
  EXPECT_THAT(problems_of(read, now),
              ElementsAre("scope A: 1 check is dated in the future, up to 2027-01-23: not counted; this "
                          "machine's clock is wrong, or was"));
  read.checks.erase(read.checks.begin());
  EXPECT_EQ(worst_standing(read, now).outcome, Outcome::MissingToday);
  EXPECT_THAT(worst_standing(read, now).text, HasSubstr("what there is, is dated in the future"));
  EXPECT_THAT(problems_of(read, "2027-01-23T06:00:00Z"), ElementsAre());
}

// The same pictures once more say nothing new, whatever they are called now.
TEST_F(AccuracyChecksTest, ARecordedClipCountsOnce) {
  AccuracyCheck recorded = check_of("2026-10-23T06:00:00Z", 10.01);
  recorded.clip_sha256 = "c1";
  (void)keep_accuracy_check(folder_.path(), recorded);
  EXPECT_EQ(read_accuracy_checks(folder_.path()).checks.front().clip_sha256, "c1");
  recorded.checked_utc = "2026-11-23T06:00:00Z";
  recorded.source = "clip of today.mkv";
  try {
    (void)keep_accuracy_check(folder_.path(), recorded);
    FAIL() << "kept twice";
  } catch (const InvalidInput& error) {
    EXPECT_THAT(error.what(), HasSubstr("kept already, as of 2026-10-23"));
  }
  EXPECT_EQ(read_accuracy_checks(folder_.path()).checks.size(), 1u);
  recorded.clip_sha256 = "c2";
  (void)keep_accuracy_check(folder_.path(), recorded);
  EXPECT_EQ(read_accuracy_checks(folder_.path()).checks.size(), 2u);
}

TEST_F(AccuracyChecksTest, AClipOfAnUnknownDateIsNotTodays) {
  AccuracyCheck undated = check_of("2026-11-23T06:00:00Z", 10.01);
  undated.clip_sha256 = "c1";
  undated.is_dated = false;
  (void)keep_accuracy_check(folder_.path(), undated);
  std::vector<AccuracyCheck> checks = read_accuracy_checks(folder_.path()).checks;
  AccuracyStanding standing = accuracy_standing(checks, scope("scope A"), "2026-11-23T09:00:00Z");
  EXPECT_EQ(standing.outcome, Outcome::MissingToday);
  EXPECT_THAT(standing.text, HasSubstr("of a recorded clip, when recorded unknown"));
  EXPECT_TRUE(accuracy_trend(checks, scope("scope A"), "2026-11-23T09:00:00Z").points.empty());
  // A live check of today stands beside it.
  checks.push_back(check_of("2026-11-23T05:00:00Z", 10.02));
  standing = accuracy_standing(checks, scope("scope A"), "2026-11-23T09:00:00Z");
  EXPECT_TRUE(standing.is_fine());
  EXPECT_THAT(standing.text, HasSubstr("10.020 mm"));
}

// Two arthroscopes of one model, or two that nobody has named: each has its own camera.json, its own limits
// and its own day.
TEST_F(AccuracyChecksTest, ArthroscopesOfOneNameAreTwo) {
  AccuracyChecks read{{check_of("2026-11-22T06:00:00Z", 10.01), check_of("2026-11-23T06:00:00Z", 10.01)}, {}};
  read.checks[0].camera_sha256 = "bb0123456789";
  EXPECT_THAT(devices_of(read), ElementsAre(scope("scope A"), scope("scope A", "bb0123456789")));
  EXPECT_TRUE(accuracy_standing(read.checks, scope("scope A"), "2026-11-23T09:00:00Z").is_fine());
  const AccuracyStanding other =
      accuracy_standing(read.checks, scope("scope A", "bb0123456789"), "2026-11-23T09:00:00Z");
  EXPECT_EQ(other.outcome, Outcome::MissingToday);
  EXPECT_THAT(other.text, HasSubstr("scope A (camera bb012345): accuracy not checked today"));
}

TEST_F(AccuracyChecksTest, TheWorstOfTheKnownDevicesIsShown) {
  const std::string now = "2026-11-23T09:00:00Z";
  EXPECT_EQ(worst_standing({}, now).outcome, Outcome::NeverChecked);
  AccuracyChecks read{{check_of("2026-11-23T06:00:00Z", 10.01)}, {}};
  EXPECT_TRUE(worst_standing(read, now).is_fine());
  // Of a scope that nobody has checked for 31 days no check is missed.
  read.checks.insert(read.checks.begin(), check_of("2026-10-23T06:00:00Z", 10.01, "scope C"));
  EXPECT_TRUE(worst_standing(read, now).is_fine());
  read.checks.insert(read.checks.begin() + 1, check_of("2026-11-22T06:00:00Z", 10.01, "scope B"));
  EXPECT_THAT(worst_standing(read, now).text, HasSubstr("scope B: accuracy not checked today"));
  // One that is off comes before one that was not checked, and is not hidden by a good one after it.
  read.checks.insert(read.checks.begin() + 2, check_of("2026-11-23T05:00:00Z", 10.2, "scope D"));
  EXPECT_EQ(worst_standing(read, now).outcome, Outcome::OutsideLimits);
  EXPECT_THAT(worst_standing(read, now).text,
              ::testing::AllOf(HasSubstr("scope D"), HasSubstr("1 other arthroscope is not fine")));
  // Tomorrow nothing was checked yet.
  EXPECT_EQ(worst_standing(read, "2026-11-24T09:00:00Z").outcome, Outcome::MissingToday);
}

}  // namespace
}  // namespace arthronaut::library
