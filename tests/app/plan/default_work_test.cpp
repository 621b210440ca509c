#include "app/plan/default_work.h"

#include <gtest/gtest.h>

#include <thread>

#include "planning/phantom/phantom_case.h"
#include "planning/phantom/phantom_knee.h"

namespace arthronaut::plan {
namespace {

using bones::BoneKind;

class DefaultWorkTest : public ::testing::Test {
 protected:
  // Once its thread has ended.
  std::optional<std::vector<MadeTunnel>> taken() {
    std::optional<std::vector<MadeTunnel>> made;
    while (work_.is_busy()) {
      std::this_thread::yield();
      if (auto news = work_.take()) made = std::move(news);
    }
    return made;
  }
  std::optional<open_case::PlanModel> model_{
      phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "default")};
  DefaultWork work_{[] {}};
};

// The same as without a thread, though the case is closed meanwhile.
TEST_F(DefaultWorkTest, MakesThemOfTheCaseAsItWas) {
  const auto femoral = model_->default_tunnel(BoneKind::Femur).tunnel;
  work_.start(*model_, {BoneKind::Femur, BoneKind::Tibia});
  EXPECT_TRUE(work_.is_running());
  model_.reset();
  const auto made = taken();
  ASSERT_TRUE(made);
  ASSERT_EQ(made->size(), 2U);
  EXPECT_EQ(made->at(0).key, tunnels::TunnelKey(BoneKind::Femur));
  EXPECT_EQ(made->at(0).made.tunnel.entry_mm, femoral.entry_mm);
  EXPECT_EQ(made->at(0).made.tunnel.direction, femoral.direction);
  EXPECT_TRUE(made->at(1).made.is_usable());
  EXPECT_EQ(work_.progress(), "2 of 2 tunnels");
  EXPECT_FALSE(work_.is_running());
  EXPECT_FALSE(work_.take()) << "said once";
}

TEST_F(DefaultWorkTest, WhatIsCancelledIsNotTaken) {
  work_.start(*model_, {BoneKind::Tibia});
  work_.cancel();
  EXPECT_FALSE(work_.is_running());
  EXPECT_FALSE(taken());
  work_.start(*model_, {BoneKind::Tibia});
  EXPECT_TRUE(taken());
}

// Of another plan or other landmarks it must not be taken; what was measured in slices changes nothing of it.
TEST_F(DefaultWorkTest, KnowsWhetherItIsOfWhatIsPlanned) {
  work_.start(*model_, {BoneKind::Tibia});
  model_->set_measurements({{{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX()}}});
  EXPECT_TRUE(work_.is_of(*model_));
  const auto before = *model_->tunnel(BoneKind::Femur);
  auto wider = before;
  wider.diameter_mm += 0.5;
  model_->set_tunnel(BoneKind::Femur, wider);
  EXPECT_FALSE(work_.is_of(*model_));
  model_->set_tunnel(BoneKind::Femur, before);
  EXPECT_TRUE(work_.is_of(*model_));
  auto states = model_->landmark_states(BoneKind::Tibia);
  states[model_->landmarks(BoneKind::Tibia).begin()->first] = landmarks::LandmarkState::Proposed;
  model_->set_landmarks(BoneKind::Tibia, model_->landmarks(BoneKind::Tibia), states);
  EXPECT_FALSE(work_.is_of(*model_));
}

}  // namespace
}  // namespace arthronaut::plan
