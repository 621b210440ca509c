// What the list of sessions says of one.
#include "app/review/session_list.h"

#include <gtest/gtest.h>

namespace arthronaut::review {
namespace {

TEST(SessionList, SaysWhenItWas) {
  EXPECT_EQ(session_title("0007-20261121-122356"), "7:  2026-11-21  12:23:56");
  EXPECT_EQ(session_title("20261121-122356"), "2026-11-21  12:23:56");
  EXPECT_EQ(session_title("before the flood"), "before the flood");
}

library::SessionFacts drilled() {
  library::SessionFacts facts;
  facts.bone = bones::BoneKind::Femur;
  facts.source_kind = "live";
  facts.was_finished = facts.was_verified = true;
  facts.registration_is_reliable = true;
  facts.length_min = 5.2;
  facts.entry_offset_mm = 1.24;
  facts.angle_deg = 0.8;
  return facts;
}

// Source, bone, how long and how far; a tick only for what came to its end without a doubt.
TEST(SessionList, SaysWhatItWas) {
  const SessionLine line = session_line(drilled());
  EXPECT_EQ(line.words, "live, femur, 5.2 min; drilled, 1.2 mm and 0.8\u00B0 from the plan");
  EXPECT_EQ(line.severity, widgets::Severity::Good);
  library::SessionFacts facts;
  facts.bone = bones::BoneKind::Tibia;
  facts.was_finished = true;
  EXPECT_EQ(session_line(facts).words, "tibia; not registered");
  EXPECT_EQ(session_line(facts).severity, widgets::Severity::Quiet);
  facts.is_exercise = true;
  EXPECT_EQ(session_line(facts).words, "exercise, tibia; not registered");
}

// What was recorded as of the other knee says so: the case's side was changed since.
TEST(SessionList, SaysOfWhichSideItWasRecorded) {
  library::SessionFacts facts = drilled();
  facts.side = bones::Side::Left;
  EXPECT_EQ(session_line(facts, bones::Side::Left).severity, widgets::Severity::Good);
  const SessionLine line = session_line(facts, bones::Side::Right);
  EXPECT_TRUE(line.words.ends_with("; recorded as of a left knee, the case is a right one")) << line.words;
  EXPECT_EQ(line.severity, widgets::Severity::Caution);
}

// What is being recorded is neither ticked nor doubted for having no end yet.
// In the list, and not below it alone: what is no longer what was recorded, and which of it.
TEST(SessionList, SaysWhatIsNotAsRecorded) {
  recording::SessionCheck check;
  check.outcome = recording::SessionCheck::Outcome::Broken;
  check.findings = {{"video.mkv", 100, 200, "not what was recorded"}};
  const SessionLine line = with_check(session_line(drilled()), check);
  EXPECT_EQ(line.words, "NOT AS RECORDED: video.mkv: bytes 100 to 199 are not what was recorded; " +
                            session_line(drilled()).words);
  EXPECT_EQ(line.severity, widgets::Severity::Bad);
  check.outcome = recording::SessionCheck::Outcome::Unbroken;
  check.findings.clear();
  EXPECT_EQ(with_check(session_line(drilled()), check).words, session_line(drilled()).words);
}

TEST(SessionList, SaysWhatIsBeingRecorded) {
  library::SessionFacts facts;
  facts.bone = bones::BoneKind::Femur;
  facts.is_being_recorded = true;
  EXPECT_EQ(session_line(facts).words, "femur; not registered, being recorded");
  EXPECT_EQ(session_line(facts).severity, widgets::Severity::Quiet);
  EXPECT_TRUE(session_line(facts).is_being_recorded);
}

// Each doubt is said, and none of them has a tick.
TEST(SessionList, SaysWhatIsDoubtfulOfIt) {
  library::SessionFacts facts = drilled();
  facts.was_verified = facts.was_finished = false;
  facts.alarm_count = 2;
  EXPECT_EQ(
      session_line(facts).words,
      "live, femur, 5.2 min; drilled, 1.2 mm and 0.8\u00B0 from the plan; not verified; 2 alarms; cut off");
  EXPECT_EQ(session_line(facts).severity, widgets::Severity::Caution);
  facts.entry_offset_mm.reset();
  facts.alarm_count = 0;
  facts.registration_is_reliable = false;
  EXPECT_EQ(session_line(facts).words, "live, femur, 5.2 min; registration not reliable, cut off");
  EXPECT_EQ(session_line(facts).severity, widgets::Severity::Caution);
  facts.problem = "session.sqlite: is damaged";
  EXPECT_EQ(session_line(facts).words, "live, femur, 5.2 min; cannot be read: session.sqlite: is damaged");
  EXPECT_EQ(session_line(facts).severity, widgets::Severity::Bad);
  facts = drilled();
  facts.registration_is_reliable = false;
  facts.problem = "session.sqlite: is damaged";
  // First, as a row has room for the beginning of its words alone.
  EXPECT_EQ(session_line(facts).words,
            "cannot be read whole: session.sqlite: is damaged; live, femur, 5.2 min; drilled, 1.2 mm and "
            "0.8\u00B0 from the plan; registration not reliable");
}

}  // namespace
}  // namespace arthronaut::review
