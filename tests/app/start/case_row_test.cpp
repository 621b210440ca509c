// What the row of a case says in the list.
#include <gtest/gtest.h>

#include "app/start/case_list.h"

namespace arthronaut::start {
namespace {

// Two cases of one day differ by their patients, before anybody opens one; without one nothing stands for
// him.
TEST(CaseRow, NamesThePatientWhereHeIsKnown) {
  library::CaseRecord record;
  record.folder = "/data/Knee 1.arthro";
  EXPECT_EQ(whose_and_where(record, "", false), "/data/Knee 1.arthro");
  EXPECT_EQ(whose_and_where(record, "Muster, Anna", false), "Muster, Anna  \u2013  /data/Knee 1.arthro");
  record.note = "look again\n#study";
  EXPECT_EQ(whose_and_where(record, "Muster, Anna", true),
            "Found by its patient: Muster, Anna  \u2013  \u201Clook again\u201D");
}

// Bones that were doubted when they were made have a triangle before anything is planned on them; a plan that
// is to be looked at keeps its own when it was drilled, as planned as it may have been.
TEST(CaseRow, WhatIsDoubtedOfBonesOrPlanHasATriangleInEveryState) {
  const plan_review::TunnelVerdict fine, look{.look = {"femur: Bone: the images end within it"}};
  library::CaseRecord record;
  record.folder = "/data/Knee 1.arthro";
  record.bones = {bones::BoneKind::Femur};
  EXPECT_EQ(severity_of(record, &look), widgets::Severity::Caution);
  EXPECT_EQ(state_in_words(record, &look), "Not planned; look: femur: Bone: the images end within it");
  EXPECT_EQ(severity_of(record, &fine), widgets::Severity::Quiet);
  EXPECT_EQ(state_in_words(record, &fine), "Not planned");
  record.planned = record.bones;
  library::SessionFacts drilled;
  drilled.was_finished = drilled.was_verified = true;
  drilled.registration_is_reliable = true;
  drilled.entry_offset_mm = 1.2;
  drilled.angle_deg = 0.8;
  record.sessions = {drilled};
  ASSERT_EQ(severity_of(record, &fine), widgets::Severity::Good) << state_in_words(record, nullptr);
  EXPECT_EQ(severity_of(record, &look), widgets::Severity::Caution);
  EXPECT_TRUE(state_in_words(record, &look).starts_with("Drilled: drilled, 1.2 mm"));
  EXPECT_TRUE(state_in_words(record, &look).ends_with("; plan: look: femur: Bone: the images end within it"))
      << state_in_words(record, &look);
  record.sessions.back().source_kind = "simulation";
  EXPECT_EQ(severity_of(record, &fine), widgets::Severity::Quiet);
  EXPECT_EQ(severity_of(record, &look), widgets::Severity::Caution);
  EXPECT_TRUE(state_in_words(record, &look).starts_with("Drilled, simulated: "))
      << state_in_words(record, &look);
}

}  // namespace
}  // namespace arthronaut::start
