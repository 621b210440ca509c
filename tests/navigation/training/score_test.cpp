#include "navigation/training/score.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace arthronaut::training {
namespace {

const Exercise& drilling() { return *find_exercise("drill-femur"); }

// Everything within what gives all points.
ExerciseFacts flawless() {
  ExerciseFacts facts;
  facts.is_done = true;
  facts.time_s = 120;
  facts.frames = 3600;
  facts.entry_offset_mm = 0.4;
  facts.angle_deg = 0.9;
  facts.depth_error_mm = -0.3;
  facts.off_bone_mm = 0;
  facts.tunnel_error_mm = 0.5;
  facts.tip_error_mm = 0.05;
  facts.camera_error_px = 0.1;
  facts.coverage = {0.95, 0.93, 0.97};
  facts.verifying_touches_missing = 0;
  facts.touches = 4;
  facts.drawn_mm = 180;
  facts.drawn_in_air_mm = 2;
  facts.unseen_s = 3;
  return facts;
}

const ScorePart& part_of(const Score& score, Measure measure) {
  const auto found = std::find_if(score.parts.begin(), score.parts.end(),
                                  [&](const ScorePart& part) { return part.measure == measure; });
  if (found == score.parts.end()) throw std::out_of_range("no such part");
  return *found;
}

// Without a fault all points are earned in every exercise, and there is nothing to do better.
TEST(Score, FlawlessEarnsEverything) {
  for (const Exercise& exercise : exercises()) {
    ExerciseFacts facts = flawless();
    facts.time_s = 20;  // the shortest exercise gives all its points for 30 s
    facts.unseen_s = 0.5;
    const Score score = score_of(exercise, Level::Easy, facts);
    EXPECT_EQ(score.points, 100) << exercise.id;
    EXPECT_TRUE(score.better.empty()) << exercise.id;
    for (const ScorePart& part : score.parts) {
      EXPECT_TRUE(part.advice.empty()) << exercise.id << " " << to_text(part.measure);
      EXPECT_FALSE(part.reason.empty()) << exercise.id << " " << to_text(part.measure);
    }
  }
}

// Half-way between the two limits half the points, at the second one and beyond it none.
TEST(Score, PointsFallEvenlyBetweenTheLimits) {
  const Exercise& exercise = drilling();
  const auto mark = std::find_if(exercise.marks.begin(), exercise.marks.end(),
                                 [](const Mark& m) { return m.measure == Measure::EntryOffset; });
  ExerciseFacts facts = flawless();
  const auto points_at = [&](double offset_mm) {
    facts.entry_offset_mm = offset_mm;
    return part_of(score_of(exercise, Level::Easy, facts), Measure::EntryOffset).points;
  };
  EXPECT_DOUBLE_EQ(points_at(mark->good), mark->points);
  EXPECT_DOUBLE_EQ(points_at((mark->good + mark->limit) / 2), mark->points / 2);
  EXPECT_DOUBLE_EQ(points_at(mark->limit), 0);
  EXPECT_DOUBLE_EQ(points_at(10 * mark->limit), 0);
}

// Each mistake costs where it belongs, and nowhere else.
TEST(Score, EachMistakeCostsItsOwnPart) {
  using Change = void (*)(ExerciseFacts&);
  const std::vector<std::pair<Measure, Change>> mistakes{
      {Measure::Time, [](ExerciseFacts& f) { f.time_s = 500; }},
      {Measure::Angle, [](ExerciseFacts& f) { f.angle_deg = 5; }},
      {Measure::DepthError, [](ExerciseFacts& f) { f.depth_error_mm = 4; }},
      {Measure::DepthError, [](ExerciseFacts& f) { f.depth_error_mm = -4; }},
      {Measure::TunnelError, [](ExerciseFacts& f) { f.tunnel_error_mm = 2.9; }},
      {Measure::Verification, [](ExerciseFacts& f) { f.verifying_touches_missing = 3; }},
      {Measure::WastedTouches, [](ExerciseFacts& f) { f.wasted_touches = 3; }},
      {Measure::DrawnInAir, [](ExerciseFacts& f) { f.drawn_in_air_mm = 60; }},
      {Measure::AlarmsIgnored, [](ExerciseFacts& f) { f.alarms = f.alarms_ignored = 1; }},
      {Measure::ActedOnBadData, [](ExerciseFacts& f) { f.bad_data_mm = 8; }},
  };
  for (const auto& [measure, change] : mistakes) {
    ExerciseFacts facts = flawless();
    change(facts);
    const Score score = score_of(drilling(), Level::Hard, facts);
    EXPECT_LT(score.points, 100) << to_text(measure);
    ASSERT_EQ(score.better.size(), 1u) << to_text(measure);
    EXPECT_EQ(score.better.front(), part_of(score, measure).advice);
    for (const ScorePart& part : score.parts)
      EXPECT_EQ(part.points == part.most_points, part.measure != measure) << to_text(part.measure);
  }
}

// A tunnel that was never drilled is worth nothing, and the reason says so instead of a number.
TEST(Score, WhatNeverHappenedIsWorthNothing) {
  ExerciseFacts facts = flawless();
  facts.entry_offset_mm.reset();
  facts.angle_deg.reset();
  facts.depth_error_mm.reset();
  const Score score = score_of(drilling(), Level::Easy, facts);
  for (const Measure measure : {Measure::EntryOffset, Measure::Angle, Measure::DepthError}) {
    EXPECT_EQ(part_of(score, measure).points, 0);
    EXPECT_FALSE(part_of(score, measure).value.has_value());
  }
  facts.entry_offset_mm = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(part_of(score_of(drilling(), Level::Easy, facts), Measure::EntryOffset).points, 0);
}

// An alarm that was dismissed, and a tunnel that was drilled while nothing guides, are not made up for by the
// rest: the whole score is held, and the part that holds it says so and is named first.
TEST(Score, WhatNoSurgeonMayDoHoldsTheWholeScore) {
  using Change = void (*)(ExerciseFacts&);
  const std::vector<std::pair<Measure, Change>> dangers{
      {Measure::AlarmsIgnored, [](ExerciseFacts& f) { f.alarms = f.alarms_ignored = 1; }},
      {Measure::ActedOnBadData, [](ExerciseFacts& f) { f.bad_data_mm = 35; }}};
  for (const auto& [measure, change] : dangers) {
    ExerciseFacts facts = flawless();
    facts.depth_error_mm = 9;  // 10 points, more than the danger's own
    change(facts);
    const Score score = score_of(drilling(), Level::Hard, facts);
    EXPECT_EQ(score.points, 40) << to_text(measure);
    const ScorePart& part = part_of(score, measure);
    EXPECT_EQ(part.caps_at, 40);
    EXPECT_NE(part.reason.find("holds the whole score at 40"), std::string::npos) << part.reason;
    ASSERT_FALSE(score.better.empty());
    EXPECT_EQ(score.better.front(), part.advice);
  }
  ExerciseFacts reaction = flawless();
  reaction.bad_data_mm = 0.5;  // a hand needs a moment to let go
  EXPECT_GT(score_of(drilling(), Level::Hard, reaction).points, 95);
}

// The first step of aiming is to stand on the bone: who holds the guide in the air before the right place has
// not done it.
TEST(Score, AimingStandsOnTheBone) {
  ExerciseFacts facts = flawless();
  facts.time_s = 20;
  facts.unseen_s = 0.5;
  facts.off_bone_mm = 6;
  const Score score = score_of(*find_exercise("aim"), Level::Easy, facts);
  EXPECT_EQ(score.points, 85);
  EXPECT_EQ(part_of(score, Measure::OffBone).points, 0);
  EXPECT_NE(part_of(score, Measure::OffBone).reason.find("6.0 mm off the bone"), std::string::npos);
  ASSERT_EQ(score.better.size(), 1u);
  EXPECT_NE(score.better.front().find("on the bone"), std::string::npos);
}

// Strokes in the air are why no bone is found: they are named before what is lost by it.
TEST(Score, StrokesInTheAirAreNamedFirstWhereNoBoneIsFound) {
  ExerciseFacts facts = flawless();
  facts.drawn_in_air_mm = 0.81 * facts.drawn_mm;
  facts.tunnel_error_mm.reset();
  facts.verifying_touches_missing = 3;
  facts.time_s = 400;
  const Score score = score_of(*find_exercise("register"), Level::Easy, facts);
  ASSERT_FALSE(score.better.empty());
  EXPECT_EQ(score.better.front(), part_of(score, Measure::DrawnInAir).advice);
  EXPECT_NE(score.better.front().find("in the air"), std::string::npos);
}

// No sentence leaves open who did what, nor names a limit where there is nothing to do better.
TEST(Score, SaysWhatWasDoneInPlainWords) {
  for (const Exercise& exercise : exercises())
    for (const ScorePart& part : score_of(exercise, Level::Easy, flawless()).parts) {
      if (part.points == part.most_points) {
        EXPECT_EQ(part.reason.find("all points at"), std::string::npos) << part.reason;
      }
      EXPECT_EQ(part.reason.find("were done"), std::string::npos) << part.reason;
      EXPECT_EQ(part.advice.find("the ring"), std::string::npos) << part.advice;
    }
  ExerciseFacts none;
  none.is_done = true;
  const Score nothing = score_of(drilling(), Level::Easy, none);
  EXPECT_EQ(part_of(nothing, Measure::EntryOffset).reason, "No tunnel was drilled.");
  EXPECT_NE(part_of(nothing, Measure::EntryOffset).advice.find("Drill the tunnel"), std::string::npos);
}

// What would have earned all points stands behind what was done, and a nought reads as one.
TEST(Score, SaysWhatWouldHaveEarnedAllPoints) {
  ExerciseFacts facts = flawless();
  facts.entry_offset_mm = 2.0;
  facts.touches = 5;
  facts.wasted_touches = 2;
  const Score score = score_of(drilling(), Level::Easy, facts);
  EXPECT_EQ(part_of(score, Measure::WastedTouches).reason,
            "Touches: 5, of which told nothing: 2 (all points at 0, no points from 4 on).");
  const std::string offset = part_of(score, Measure::EntryOffset).reason;
  EXPECT_NE(offset.find(" mm or less, no points from "), std::string::npos) << offset;
}

// Half an exercise makes few mistakes: it counts nothing, and that is the first thing to do better.
TEST(Score, HalfAnExerciseCountsNothing) {
  ExerciseFacts facts = flawless();
  facts.is_done = false;
  const Score score = score_of(drilling(), Level::Easy, facts);
  EXPECT_EQ(score.points, 0);
  ASSERT_FALSE(score.better.empty());
  EXPECT_NE(score.better.front().find("done"), std::string::npos);
}

// Numbers that were gone and numbers that were wrong are different mistakes: the advice says which.
TEST(Score, AdviceTellsGoneNumbersFromWrongOnes) {
  ExerciseFacts gone = flawless(), wrong = flawless();
  gone.bad_data_mm = wrong.bad_data_mm = 10;
  wrong.worst_bad_error_mm = 2.8;
  const std::string for_gone =
      part_of(score_of(drilling(), Level::Hard, gone), Measure::ActedOnBadData).advice;
  const std::string for_wrong =
      part_of(score_of(drilling(), Level::Hard, wrong), Measure::ActedOnBadData).advice;
  EXPECT_NE(for_gone.find("gone"), std::string::npos);
  EXPECT_NE(for_wrong.find("control point"), std::string::npos);
}

// What costs most is said first, three things at most.
// Where nothing is drilled, nothing is told of millimetres that were, nor of the drill.
TEST(Score, AimingBlindlyIsToldAsSuch) {
  ExerciseFacts facts = flawless();
  facts.bad_data_mm = 2.4;
  const ScorePart part =
      part_of(score_of(*find_exercise("aim"), Level::Easy, facts), Measure::ActedOnBadData);
  EXPECT_EQ(part.points, 0);
  EXPECT_EQ(part.reason.find("mm"), std::string::npos) << part.reason;
  EXPECT_EQ(part.advice.find("drill"), std::string::npos) << part.advice;
}

TEST(Score, AdviceComesByWhatItCosts) {
  ExerciseFacts facts = flawless();
  facts.entry_offset_mm = 4;  // 20 points
  facts.angle_deg = 6;        // 15
  facts.time_s = 600;         // 10
  facts.wasted_touches = 4;   // 5
  const Score score = score_of(drilling(), Level::Easy, facts);
  ASSERT_EQ(score.better.size(), 3u);
  EXPECT_EQ(score.better[0], part_of(score, Measure::EntryOffset).advice);
  EXPECT_EQ(score.better[1], part_of(score, Measure::Angle).advice);
  EXPECT_EQ(score.better[2], part_of(score, Measure::Time).advice);
}

// A camera is worth what it is off in truth; the view's share without corners is the mean of the pictures'.
TEST(Score, OfACameraIsItsTrueError) {
  ExerciseFacts facts = flawless();
  facts.time_s = 40;
  facts.camera_error_px = 0.625;
  facts.coverage = {0.9, 0.6};
  facts.refused_pictures = 1;
  const Score score = score_of(*find_exercise("calibrate"), Level::Easy, facts);
  EXPECT_NEAR(part_of(score, Measure::CameraError).points, 25, 1e-9);  // half way from 0.25 to 1
  EXPECT_NEAR(*part_of(score, Measure::Uncovered).value, 25, 1e-9);
  EXPECT_NEAR(part_of(score, Measure::Refused).points, 0.75 * 15, 1e-9);
  EXPECT_NE(part_of(score, Measure::CameraError).reason.find("0.62 px"), std::string::npos)
      << part_of(score, Measure::CameraError).reason;
}

// One that the program refuses guides nobody, and who takes no picture has none refused.
TEST(Score, WithoutACameraSaysWhy) {
  ExerciseFacts facts = flawless();
  facts.camera_error_px.reset();
  facts.camera_trouble = "the lens was not turned";
  facts.coverage.clear();
  const Score score = score_of(*find_exercise("calibrate"), Level::Easy, facts);
  EXPECT_NE(part_of(score, Measure::CameraError).reason.find("the lens was not turned"), std::string::npos);
  for (const Measure none : {Measure::CameraError, Measure::Uncovered, Measure::Refused})
    EXPECT_EQ(part_of(score, none).points, 0);
}

// Who says "done" at once has been quick and made no mistake: no exercise gives a point for it.
TEST(Score, DoneAtOnceEarnsNothing) {
  for (const Exercise& exercise : exercises()) {
    ExerciseFacts facts;
    facts.is_done = true;
    facts.time_s = 1;
    facts.frames = 30;
    // The guide was in the hand, somewhere.
    if (exercise.goal == Goal::Aim) facts.entry_offset_mm = facts.angle_deg = 40;
    const Score score = score_of(exercise, Level::Easy, facts);
    EXPECT_EQ(score.points, 0) << exercise.id;
    ASSERT_FALSE(score.better.empty()) << exercise.id;
    for (const ScorePart& part : score.parts)
      if (part.measure == Measure::Time || part.measure == Measure::Refused) {
        EXPECT_EQ(part.advice, "") << exercise.id << ": it was quick, and refused nothing";
      }
  }
}

// What was reached on the way counts by itself, also where the tunnel was not drilled.
TEST(Score, AVerifiedRegistrationCountsWithoutATunnel) {
  ExerciseFacts facts = flawless();
  facts.entry_offset_mm.reset();
  facts.angle_deg.reset();
  facts.depth_error_mm.reset();
  const Score score = score_of(drilling(), Level::Easy, facts);
  EXPECT_EQ(score.points, part_of(score, Measure::TunnelError).most_points +
                              part_of(score, Measure::Verification).most_points);
  EXPECT_NE(part_of(score, Measure::Time).reason.find("as the goal was not reached"), std::string::npos);
}

// Two cases of one name hold sessions of one name: the score is of the case that it was made in, whatever it
// is called by now. One of an older version knows the name alone.
TEST(Score, IsOfItsSessionInItsCase) {
  Score score;
  score.knee = "Knee";
  score.session = "0001-20260131-120000";
  score.case_created_utc = "2026-01-30T08:00:00Z";
  EXPECT_TRUE(is_of_session(score, score.session, "Knee", score.case_created_utc));
  EXPECT_TRUE(is_of_session(score, score.session, "Renamed", score.case_created_utc));
  EXPECT_FALSE(is_of_session(score, score.session, "Knee", "2026-01-30T09:00:00Z"));
  EXPECT_FALSE(is_of_session(score, "0002-20260131-120000", "Knee", score.case_created_utc));
  score.case_created_utc.clear();
  EXPECT_TRUE(is_of_session(score, score.session, "Knee", "2026-01-30T09:00:00Z"));
  EXPECT_FALSE(is_of_session(score, score.session, "Other", "2026-01-30T09:00:00Z"));
  score.session.clear();
  EXPECT_FALSE(is_of_session(score, "", "Knee", ""));
}

}  // namespace
}  // namespace arthronaut::training
