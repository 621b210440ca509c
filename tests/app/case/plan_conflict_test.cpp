// Two programs change one plan.
#include <gtest/gtest.h>

#include <fstream>

#include "planning/cases/plan_file.h"
#include "tests/app/case/plan_history_fixture.h"

namespace arthronaut::open_case {
namespace {

using bones::BoneKind;

class PlanConflict : public PlanHistoryTest {
 protected:
  void save_elsewhere(double diameter_mm) {
    cases::Plan elsewhere = model_.knee().plan;
    elsewhere.tunnels.at(BoneKind::Femur).diameter_mm = diameter_mm;
    cases::save_plan(folder_, elsewhere);
  }
};

// Hazard 15: a plan that another program changed meanwhile is not written over, and that is said; whatever is
// done after that stays in memory until the surgeon has chosen.
TEST_F(PlanConflict, Hazard15APlanChangedElsewhereIsNotWrittenOver) {
  save_elsewhere(7.25);
  history_.apply(wider(1, false), 1.0);
  history_.settle_now();
  EXPECT_TRUE(history_.is_in_conflict());
  EXPECT_NE(history_.status().text.find("another program has saved another plan"), std::string::npos);
  history_.apply(wider(1, false), 2.0);
  history_.settle_now();
  history_.undo();
  EXPECT_TRUE(history_.is_in_conflict());
  EXPECT_EQ(saved_diameter_mm(), 7.25);
  EXPECT_NEAR(model_.tunnel(BoneKind::Femur)->diameter_mm, start_mm_ + 1, 1e-12);
}

// What could not be read again is not written, and is not another program's doing.
TEST_F(PlanConflict, APlanThatCannotBeWrittenIsNoConflict) {
  history_.apply(wider(100, false), 1.0);
  history_.settle_now();
  EXPECT_FALSE(history_.is_in_conflict());
  EXPECT_NE(history_.status().text.find("not saved: "), std::string::npos) << history_.status().text;
  EXPECT_NE(history_.status().text.find("must be 3 to 15"), std::string::npos) << history_.status().text;
  EXPECT_EQ(saved_diameter_mm(), start_mm_);
  history_.undo();
  EXPECT_EQ(history_.status().save, PlanStatus::Save::Saved);
}

// Hazard 15: it is noticed within a second, before anybody edits.
TEST_F(PlanConflict, Hazard15AChangeElsewhereIsNoticedWithoutAnEdit) {
  history_.look_at_disk(10.0);
  EXPECT_FALSE(history_.is_in_conflict());
  save_elsewhere(7.25);
  history_.look_at_disk(10.5);
  EXPECT_FALSE(history_.is_in_conflict()) << "the disk is looked at once a second";
  history_.look_at_disk(11.1);
  EXPECT_TRUE(history_.is_in_conflict());
}

// What the two are to be chosen by is said, of the newest that is on disk.
TEST_F(PlanConflict, HowTheOtherPlanDiffersIsSaid) {
  EXPECT_EQ(history_.theirs_in_words(), "");
  save_elsewhere(start_mm_ - 1.5);
  history_.look_at_disk(10.0);
  EXPECT_EQ(history_.theirs_in_words(), "femur: 1.5 mm narrower");
  save_elsewhere(start_mm_ + 0.5);
  history_.look_at_disk(11.5);
  EXPECT_EQ(history_.theirs_in_words(), "femur: 0.5 mm wider");
  history_.take_theirs();
  EXPECT_EQ(history_.theirs_in_words(), "");
}

// Hazard 15: theirs can be taken, and undo brings ours back; ours can be kept, and is then on disk.
TEST_F(PlanConflict, Hazard15TheSurgeonChoosesBetweenTheTwo) {
  save_elsewhere(7.25);
  history_.look_at_disk(10.0);
  history_.take_theirs();
  EXPECT_FALSE(history_.is_in_conflict());
  EXPECT_EQ(model_.tunnel(BoneKind::Femur)->diameter_mm, 7.25);
  history_.undo();
  EXPECT_EQ(model_.tunnel(BoneKind::Femur)->diameter_mm, start_mm_);
  EXPECT_EQ(saved_diameter_mm(), start_mm_);
  save_elsewhere(6.5);
  history_.look_at_disk(20.0);
  ASSERT_TRUE(history_.is_in_conflict());
  history_.keep_ours();
  EXPECT_EQ(history_.status().save, PlanStatus::Save::Saved);
  EXPECT_EQ(saved_diameter_mm(), start_mm_);
}

// Hazard 15: what another program left broken is said, and nothing is lost.
TEST_F(PlanConflict, Hazard15ABrokenPlanOfAnotherProgramIsSaid) {
  std::ofstream(folder_ / "plan.json") << "{ \"format\": \"arthronaut.pl";
  history_.look_at_disk(10.0);
  history_.take_theirs();
  EXPECT_TRUE(history_.is_in_conflict());
  EXPECT_NE(history_.status().text.find("plan.json"), std::string::npos) << history_.status().text;
  EXPECT_EQ(model_.tunnel(BoneKind::Femur)->diameter_mm, start_mm_);
  history_.keep_ours();
  EXPECT_EQ(saved_diameter_mm(), start_mm_);
}

// Hazard 15: what could not be saved while two plans stood against each other is saved with the choice.
TEST_F(PlanConflict, Hazard15WhatWasMeasuredMeanwhileIsKeptWithTheirs) {
  save_elsewhere(7.25);
  history_.look_at_disk(10.0);
  const cases::Measurement distance{{{0, 0, 0}, {3, 4, 0}}};
  history_.apply_measurements({distance}, "Measure a distance");
  ASSERT_TRUE(cases::load_measurements(folder_).empty());
  history_.take_theirs();
  EXPECT_EQ(history_.status().save, PlanStatus::Save::Saved);
  EXPECT_EQ(cases::load_measurements(folder_), std::vector{distance});
  EXPECT_EQ(saved_diameter_mm(), 7.25);
}

// A plan.json that cannot be looked at for a while ends nothing: not the frame, not the conflict.
TEST_F(PlanConflict, APlanThatCannotBeReadForAMomentEndsNothing) {
  const auto plan = folder_ / "plan.json", aside = folder_ / "aside.json";
  std::filesystem::rename(plan, aside);
  std::filesystem::create_symlink("plan.json", plan);  // leads to itself
  EXPECT_NO_THROW(history_.look_at_disk(10.0));
  EXPECT_FALSE(history_.is_in_conflict());
  std::filesystem::rename(aside, plan);
  save_elsewhere(7.25);
  history_.look_at_disk(12.0);
  ASSERT_TRUE(history_.is_in_conflict());
  std::filesystem::rename(plan, aside);
  std::filesystem::create_symlink("plan.json", plan);
  EXPECT_NO_THROW(history_.keep_ours());
  EXPECT_TRUE(history_.is_in_conflict());
  EXPECT_NE(history_.status().text.find("plan.json"), std::string::npos) << history_.status().text;
  std::filesystem::rename(aside, plan);
  history_.keep_ours();
  EXPECT_EQ(saved_diameter_mm(), start_mm_);
}

}  // namespace
}  // namespace arthronaut::open_case
