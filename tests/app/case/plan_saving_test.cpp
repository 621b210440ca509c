// What becomes of a plan that could not be saved.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include "app/case/plan_history.h"
#include "planning/phantom/phantom_case.h"
#include "tests/temporary_folder.h"

namespace arthronaut::open_case {
namespace {

// A disk that has room again, or a share that is back: what could not be saved is saved without another
// change, which might never come.
TEST(PlanSaving, WhatCouldNotBeSavedIsTriedAgain) {
  const test::TemporaryFolder temporary;
  const std::filesystem::path &folder = temporary.path(), away = folder.string() + ".away";
  cases::save_case(folder, phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "test"));
  PlanModel model(cases::load_case(folder));
  PlanHistory history;
  history.open(&model, folder);
  tunnels::Tunnel wider = *model.tunnel(bones::BoneKind::Femur);
  wider.diameter_mm += 1;

  std::filesystem::rename(folder, away);
  history.apply({bones::BoneKind::Femur, wider, "Change the diameter of the femoral tunnel", false}, 1.0);
  history.settle(2.0);
  ASSERT_EQ(history.status().save, PlanStatus::Save::Failed);
  history.look_at_disk(10.0);
  EXPECT_EQ(history.status().save, PlanStatus::Save::Failed) << "it is still away";
  std::filesystem::rename(away, folder);
  history.look_at_disk(11.0);
  EXPECT_EQ(history.status().save, PlanStatus::Save::Failed) << "not with every frame";
  history.look_at_disk(14.0);
  EXPECT_EQ(history.status().save, PlanStatus::Save::Saved);
  EXPECT_NEAR(cases::load_case(folder).plan.tunnels.at(bones::BoneKind::Femur).diameter_mm, wider.diameter_mm,
              1e-9);
}

// A disk that takes the plan, which is small, and not the landmarks that it was made by: it has neither. With
// room again it has both, and nobody is told of another program.
TEST(PlanSaving, WithoutItsLandmarksThePlanStaysAsItWas) {
  const test::TemporaryFolder temporary;
  const std::filesystem::path& folder = temporary.path();
  cases::Case bare = phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "test");
  bare.landmarks.clear();
  bare.landmark_states.clear();
  cases::save_case(folder, bare);
  PlanModel model(cases::load_case(folder));
  PlanHistory history;
  history.open(&model, folder);
  tunnels::Tunnel wider = *model.tunnel(bones::BoneKind::Femur);
  const double before_mm = wider.diameter_mm;
  wider.diameter_mm += 1;
  const auto saved_mm = [&] {
    return cases::load_case(folder).plan.tunnels.at(bones::BoneKind::Femur).diameter_mm;
  };
  ::signal(SIGXFSZ, SIG_IGN);  // the write fails instead
  rlimit whole{};
  ::getrlimit(RLIMIT_FSIZE, &whole);
  const rlimit full{2000, whole.rlim_max};  // a plan takes half of it, landmarks twice as much
  ::setrlimit(RLIMIT_FSIZE, &full);
  history.apply({bones::BoneKind::Femur, wider, "Change the diameter of the femoral tunnel", false}, 1.0);
  history.settle(2.0);
  ::setrlimit(RLIMIT_FSIZE, &whole);
  EXPECT_EQ(history.status().save, PlanStatus::Save::Failed);
  EXPECT_NEAR(saved_mm(), before_mm, 1e-9);
  history.look_at_disk(10.0);
  EXPECT_FALSE(history.is_in_conflict());
  EXPECT_EQ(history.status().save, PlanStatus::Save::Saved);
  EXPECT_NEAR(saved_mm(), wider.diameter_mm, 1e-9);
}

}  // namespace
}  // namespace arthronaut::open_case
