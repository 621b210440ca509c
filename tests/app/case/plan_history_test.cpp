#include "app/case/plan_history.h"

#include <gtest/gtest.h>

#include <random>

#include "planning/phantom/phantom_case.h"
#include "tests/temporary_folder.h"

namespace arthronaut::open_case {
namespace {

using bones::BoneKind;

class PlanHistoryTest : public ::testing::Test {
 protected:
  PlanHistoryTest() : model_(saved_and_loaded()) { history_.open(&model_, folder_); }
  // As the workstation gets it.
  cases::Case saved_and_loaded() {
    cases::save_case(folder_, knee());
    return cases::load_case(folder_);
  }
  static cases::Case knee() {
    return phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "test");
  }
  [[nodiscard]] PlanEdit wider(double by_mm, bool continues) const {
    tunnels::Tunnel tunnel = *model_.tunnel(BoneKind::Femur);
    tunnel.diameter_mm += by_mm;
    return {BoneKind::Femur, tunnel, "Change the diameter of the femoral tunnel", continues};
  }
  [[nodiscard]] double saved_diameter_mm() const {
    return cases::load_case(folder_).plan.tunnels.at(BoneKind::Femur).diameter_mm;
  }

  const test::TemporaryFolder temporary_;
  const std::filesystem::path& folder_ = temporary_.path();
  PlanModel model_;
  PlanHistory history_;
  const double start_mm_ = model_.tunnel(BoneKind::Femur)->diameter_mm;
};

// Edits that follow each other are one step back; after a rest a new step begins.
TEST_F(PlanHistoryTest, AMovementIsOneStep) {
  history_.apply(wider(0.5, true), 1.0);
  history_.apply(wider(0.5, true), 1.2);
  history_.settle(1.3);
  EXPECT_TRUE(history_.is_moving());
  history_.settle(2.0);
  EXPECT_FALSE(history_.is_moving());
  history_.apply(wider(0.5, true), 3.0);
  history_.undo();
  EXPECT_NEAR(model_.tunnel(BoneKind::Femur)->diameter_mm, start_mm_ + 1.0, 1e-12);
  history_.undo();
  EXPECT_NEAR(model_.tunnel(BoneKind::Femur)->diameter_mm, start_mm_, 1e-12);
  EXPECT_FALSE(history_.can_undo());
  history_.redo();
  history_.redo();
  EXPECT_NEAR(model_.tunnel(BoneKind::Femur)->diameter_mm, start_mm_ + 1.5, 1e-12);
}

// What is on disk is the last state that came to rest, after every step, undo and redo.
TEST_F(PlanHistoryTest, SavesByItself) {
  history_.apply(wider(1, false), 1.0);
  history_.settle(2.0);
  EXPECT_NEAR(saved_diameter_mm(), start_mm_ + 1, 1e-9);
  EXPECT_EQ(history_.status().save, PlanStatus::Save::Saved);
  history_.undo();
  EXPECT_NEAR(saved_diameter_mm(), start_mm_, 1e-9);
}

// A tunnel that was removed comes back whole.
TEST_F(PlanHistoryTest, RemovalCanBeUndone) {
  history_.apply({BoneKind::Femur, std::nullopt, "Remove the femoral tunnel", false}, 1.0);
  EXPECT_FALSE(model_.tunnel(BoneKind::Femur));
  history_.undo();
  ASSERT_TRUE(model_.tunnel(BoneKind::Femur));
  EXPECT_EQ(model_.tunnel(BoneKind::Femur)->diameter_mm, start_mm_);
}

// A folder that is gone is said on the screen; the plan stays as the surgeon made it.
TEST_F(PlanHistoryTest, AFailedSaveIsSaidAndLosesNothing) {
  std::filesystem::remove_all(folder_);
  history_.apply(wider(1, false), 1.0);
  history_.settle(2.0);
  EXPECT_EQ(history_.status().save, PlanStatus::Save::Failed);
  EXPECT_NEAR(model_.tunnel(BoneKind::Femur)->diameter_mm, start_mm_ + 1, 1e-12);
}

// A new step forgets what was undone, and the status names what comes next either way.
TEST_F(PlanHistoryTest, ANewStepForgetsWhatWasUndone) {
  history_.apply(wider(1, false), 1.0);
  history_.apply(wider(1, false), 5.0);
  history_.undo();
  EXPECT_FALSE(history_.status().redo_what.empty());
  history_.apply({BoneKind::Femur, std::nullopt, "Remove the femoral tunnel", false}, 9.0);
  EXPECT_FALSE(history_.can_redo());
  EXPECT_EQ(history_.status().undo_what, "Remove the femoral tunnel");
  history_.undo();
  EXPECT_NEAR(model_.tunnel(BoneKind::Femur)->diameter_mm, start_mm_ + 1, 1e-12);
}

// Any walk of editing, undoing and redoing: model and disk equal a plain list of states.
TEST_F(PlanHistoryTest, AgreesWithAListOfStatesOnRandomWalks) {
  std::mt19937 random(7);
  std::vector<double> states{start_mm_};
  std::size_t at = 0;
  for (int i = 0; i < 200; ++i) {
    switch (random() % 3) {
      case 0:
        states.resize(at + 1);
        states.push_back(states[at++] + 0.001);
        history_.apply(wider(0.001, false), i);
        history_.settle_now();
        break;
      case 1:
        if (at > 0) --at;
        history_.undo();
        break;
      default:
        if (at + 1 < states.size()) ++at;
        history_.redo();
    }
    ASSERT_NEAR(model_.tunnel(BoneKind::Femur)->diameter_mm, states[at], 1e-9);
    ASSERT_NEAR(saved_diameter_mm(), states[at], 1e-9);
    ASSERT_EQ(history_.can_undo(), at > 0);
  }
}

// Hazard 15: a case that another program has open takes no edit, and says why.
TEST_F(PlanHistoryTest, Hazard15AReadOnlyCaseRefusesEditsWithTheReason) {
  history_.open(&model_, folder_, "is open elsewhere: anna on theatre-2");
  history_.apply(wider(1, false), 1.0);
  history_.settle_now();
  EXPECT_EQ(model_.tunnel(BoneKind::Femur)->diameter_mm, start_mm_);
  EXPECT_EQ(saved_diameter_mm(), start_mm_);
  EXPECT_FALSE(history_.can_undo());
  EXPECT_EQ(history_.status().save, PlanStatus::Save::ReadOnly);
  EXPECT_NE(history_.status().text.find("anna on theatre-2"), std::string::npos);
}

// Hazard 15: a plan that another program changed meanwhile is not written over, and that is said.
TEST_F(PlanHistoryTest, Hazard15APlanChangedElsewhereIsNotWrittenOver) {
  cases::Plan elsewhere = model_.knee().plan;
  elsewhere.tunnels.at(BoneKind::Femur).diameter_mm = 7.25;
  cases::save_plan(folder_, elsewhere);
  history_.apply(wider(1, false), 1.0);
  history_.settle_now();
  EXPECT_EQ(history_.status().save, PlanStatus::Save::Failed);
  EXPECT_NE(history_.status().text.find("changed by another program"), std::string::npos);
  EXPECT_EQ(saved_diameter_mm(), 7.25);
  EXPECT_NEAR(model_.tunnel(BoneKind::Femur)->diameter_mm, start_mm_ + 1, 1e-12);
}

}  // namespace
}  // namespace arthronaut::open_case
