#include "app/case/plan_history.h"

#include <gtest/gtest.h>

#include "planning/phantom/phantom_case.h"
#include "tests/temporary_folder.h"

namespace arthronaut::open_case {
namespace {

using bones::BoneKind;

class PlanHistoryTest : public ::testing::Test {
 protected:
  PlanHistoryTest() : model_(knee()) {
    cases::save_case(folder_, model_.knee());
    history_.open(&model_, folder_);
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
  EXPECT_FALSE(history_.status().save_failed);
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
  EXPECT_TRUE(history_.status().save_failed);
  EXPECT_NEAR(model_.tunnel(BoneKind::Femur)->diameter_mm, start_mm_ + 1, 1e-12);
}

}  // namespace
}  // namespace arthronaut::open_case
