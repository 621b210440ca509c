#include "planning/library/trends.h"

#include <gtest/gtest.h>

namespace arthronaut::library {
namespace {

using bones::BoneKind;

SessionFacts session(const std::string& when, double offset_mm, const std::string& kind = "live") {
  SessionFacts facts;
  facts.id = when;
  facts.started_utc = when;
  facts.source_kind = kind;
  facts.bone = BoneKind::Femur;
  facts.entry_offset_mm = offset_mm;
  return facts;
}

PostoperativeFacts found(BoneKind bone, double offset_mm, std::optional<double> angle_deg, bool is_reliable) {
  PostoperativeFacts facts;
  facts.tunnel = bone;
  facts.entry_offset_mm = offset_mm;
  facts.angle_deg = angle_deg;
  facts.is_reliable = is_reliable;
  return facts;
}

// Across cases, in the order of time; simulated sessions and the other bone only when they are asked for.
TEST(TrendTest, GoesThroughTheSessionsInTime) {
  std::vector<CaseRecord> records(2);
  records[0].name = "A";
  records[0].sessions = {session("2026-01-01", 1), session("2026-01-03", 3)};
  records[1].name = "B";
  records[1].sessions = {session("2026-01-02", 2), session("2026-01-04", 4, "simulation"), SessionFacts{}};
  records[1].sessions[0].bone = BoneKind::Tibia;
  const auto values = [&](const TrendOptions& options) {
    std::vector<double> all;
    for (const TrendPoint& point : trend_of(records, Trend::EntryOffset, options)) all.push_back(point.value);
    return all;
  };
  EXPECT_EQ(values({}), (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(values({.with_simulated = true}), (std::vector<double>{1, 2, 3, 4}));
  EXPECT_EQ(values({.bone = BoneKind::Tibia}), (std::vector<double>{2}));
  EXPECT_EQ(trend_of(records, Trend::EntryOffset)[1].case_name, "B");
  EXPECT_EQ(trend_of(records, Trend::EntryOffset)[0].bone, BoneKind::Femur);
  EXPECT_EQ(trend_of(records, Trend::EntryOffset)[1].bone, BoneKind::Tibia);
  EXPECT_TRUE(trend_of(records, Trend::Drilling).empty());
}

// What was simulated is drawn beside the operations, and widens or narrows no limits of theirs.
TEST(TrendTest, LimitsAreOfTheOperationsAlone) {
  std::vector<TrendPoint> real, mixed, simulated;
  for (int i = 0; i < 10; ++i) {
    const TrendPoint point{
        "2026-01-0" + std::to_string(i), 2 + 0.1 * (i % 3), "A", "", {}, BoneKind::Femur, false};
    TrendPoint rehearsed = point;
    rehearsed.value = 9 - i;
    rehearsed.is_simulated = true;
    real.push_back(point);
    mixed.insert(mixed.end(), {point, rehearsed});
    simulated.push_back(rehearsed);
  }
  EXPECT_TRUE(limits_of(real).is_known);
  EXPECT_EQ(limits_of(mixed).center, limits_of(real).center);
  EXPECT_EQ(limits_of(mixed).upper, limits_of(real).upper);
  EXPECT_NEAR(limits_of(simulated).center, 4.5, 1e-12);
  EXPECT_FALSE(is_one_series(mixed[0], mixed[1]));
  EXPECT_TRUE(is_one_series(mixed[0], mixed[2]));
}

// Of a session whose header a newer program wrote nobody knows whether it was a simulation's.
TEST(TrendTest, LeavesOutWhatMayBeASimulation) {
  std::vector<CaseRecord> records(1);
  records[0].sessions = {session("2026-01-01", 1), session("", 0.1, "")};
  records[0].sessions[1].problem = "session.json: version: is 99";
  EXPECT_EQ(trend_of(records, Trend::EntryOffset).size(), 1U);
  EXPECT_EQ(trend_of(records, Trend::EntryOffset, {.with_simulated = true}).size(), 1U);
}

// What a CT shows is of the bone's newest session: it says when it was, and that it was no operation.
TEST(TrendTest, GoesThroughTheComparisonsWithACt) {
  std::vector<CaseRecord> records(3);
  records[0].name = "A";
  records[0].sessions = {session("2026-01-03", 1), session("2026-01-05", 1)};
  records[0].postoperative = {found(BoneKind::Femur, 2.5, 4, true), found(BoneKind::Tibia, 9, 9, false)};
  records[1].name = "B";
  records[1].created_utc = "2026-01-04";
  records[1].postoperative = {found(BoneKind::Tibia, 1.5, std::nullopt, true)};
  records[2].name = "C";
  records[2].sessions = {session("2026-01-01", 1, "simulation")};
  records[2].postoperative = {found(BoneKind::Femur, 0.5, 1, true)};
  const auto points = trend_of(records, Trend::AchievedOffset);
  ASSERT_EQ(points.size(), 2U);
  EXPECT_EQ(points[0].case_name, "B");
  EXPECT_EQ(points[0].when_utc, "2026-01-04");
  EXPECT_EQ(points[1].value, 2.5);
  EXPECT_EQ(points[1].when_utc, "2026-01-05");
  EXPECT_EQ(trend_of(records, Trend::AchievedOffset, {.with_simulated = true}).size(), 3U);
  EXPECT_EQ(trend_of(records, Trend::AchievedOffset, {.bone = BoneKind::Femur}).size(), 1U);
  ASSERT_EQ(trend_of(records, Trend::AchievedAngle).size(), 1U);
  EXPECT_EQ(trend_of(records, Trend::AchievedAngle)[0].value, 4);
}

// A CT in which only the diameter is not known says the entry's offset; one in which the direction is not
// says no angle, and is counted as left out.
TEST(TrendTest, TakesEachNumberThatIsKnownByItself) {
  using enum tunnels::Quantity;
  std::vector<CaseRecord> records(2);
  records[0].postoperative = {found(BoneKind::Femur, 2.5, 4, false)};
  records[0].postoperative[0].known = {Entry, Direction};
  records[1].postoperative = {found(BoneKind::Femur, 1.5, 3, false)};
  records[1].postoperative[0].known = {Entry};
  EXPECT_EQ(trend_of(records, Trend::AchievedOffset).size(), 2U);
  ASSERT_EQ(trend_of(records, Trend::AchievedAngle).size(), 1U);
  EXPECT_EQ(trend_of(records, Trend::AchievedAngle)[0].value, 4);
  EXPECT_EQ(trend_of(records, Trend::AchievedOffset, {.of_unknown = true}).size(), 0U);
  ASSERT_EQ(trend_of(records, Trend::AchievedAngle, {.of_unknown = true}).size(), 1U);
  EXPECT_EQ(trend_of(records, Trend::AchievedAngle, {.of_unknown = true})[0].value, 3);
}

// What is rehearsed or looked at after an operation hid its comparison, or dated it wrongly.
TEST(TrendTest, AComparisonIsOfTheOperation) {
  std::vector<CaseRecord> records(1);
  SessionFacts looked_at = session("2026-02-03", 0);
  looked_at.entry_offset_mm.reset();
  records[0].sessions = {session("2026-01-03", 1), looked_at, session("2026-03-03", 1, "simulation")};
  records[0].postoperative = {found(BoneKind::Femur, 2.5, 4, true)};
  auto points = trend_of(records, Trend::AchievedOffset);
  ASSERT_EQ(points.size(), 1U);
  EXPECT_EQ(points[0].when_utc, "2026-01-03");
  records[0].sessions.erase(records[0].sessions.begin());
  points = trend_of(records, Trend::AchievedOffset);
  ASSERT_EQ(points.size(), 1U);
  EXPECT_EQ(points[0].when_utc, "2026-02-03") << "where none is drilled";
}

// A tibia beside a femur that was only simulated counted as a real one.
TEST(TrendTest, ABoneThatWasNotNavigatedIsOfWhatItsCaseIs) {
  std::vector<CaseRecord> records(1);
  records[0].created_utc = "2026-01-02";
  records[0].sessions = {session("2026-01-03", 1, "simulation")};
  records[0].postoperative = {found(BoneKind::Femur, 2.5, 4, true), found(BoneKind::Tibia, 1.5, 2, true)};
  EXPECT_TRUE(trend_of(records, Trend::AchievedOffset).empty());
  EXPECT_EQ(trend_of(records, Trend::AchievedOffset, {.with_simulated = true}).size(), 2U);
  records[0].sessions.push_back(session("2026-01-04", 1));
  EXPECT_EQ(trend_of(records, Trend::AchievedOffset).size(), 2U);
}

// By hand: moving ranges 1, 2, 1, 0, 2, 1, 0 have the mean 1, so the limits are 3 / 1.128 = 2.6596 about 4.5.
TEST(ControlLimitsTest, AreThoseOfAnIndividualsChart) {
  const std::vector<double> values{4, 5, 3, 4, 4, 6, 5, 5};
  const ControlLimits limits = control_limits(values);
  ASSERT_TRUE(limits.is_known);
  EXPECT_DOUBLE_EQ(limits.center, 4.5);
  EXPECT_NEAR(limits.upper, 4.5 + 2.659574, 1e-6);
  EXPECT_NEAR(limits.lower, 4.5 - 2.659574, 1e-6);
}

TEST(ControlLimitsTest, AreUnknownOfFewAndNeverBelowNought) {
  EXPECT_FALSE(control_limits(std::vector<double>{1, 2, 3, 4, 5, 6, 7}).is_known);
  EXPECT_FALSE(control_limits({}).is_known);
  EXPECT_EQ(control_limits(std::vector<double>{0, 2, 0, 2, 0, 2, 0, 2}).lower, 0);
  const ControlLimits same = control_limits(std::vector<double>(8, 1.5));
  EXPECT_EQ(same.lower, 1.5);
  EXPECT_EQ(same.upper, 1.5);
}

// None of them is outside: the last bit of their mean put all of a constant series out of its limits.
TEST(ControlLimitsTest, OfEqualValuesAreThatValue) {
  const ControlLimits limits = control_limits(std::vector<double>(125, 0.1));
  EXPECT_EQ(limits.lower, 0.1);
  EXPECT_EQ(limits.upper, 0.1);
}

}  // namespace
}  // namespace arthronaut::library
