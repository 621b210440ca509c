// Which of two planned tunnels an operation guides by: the chosen one, the only one, or none; never one of
// two.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "app/navigate/beginning_words.h"
#include "app/navigate/navigate_setup.h"
#include "app/navigate/theatre_bones.h"
#include "planning/phantom/phantom_case.h"

namespace arthronaut::navigate {
namespace {

using bones::BoneKind;

const tunnels::TunnelKey kAm{BoneKind::Femur, norms::Bundle::Anteromedial};
const tunnels::TunnelKey kPl{BoneKind::Femur, norms::Bundle::Posterolateral};

class TunnelChoice : public ::testing::Test {
 protected:
  TunnelChoice() { bones_.open(&model_, "", ""); }
  void plan_bundles() {
    const tunnels::Tunnel& am = whole_;
    tunnels::Tunnel pl = am;
    pl.entry_mm += 9 * pl.direction.unitOrthogonal();
    model_.set_tunnel(kAm, am);
    model_.set_tunnel(kPl, pl);
  }
  // As an operation that begins now would have it.
  [[nodiscard]] std::optional<tunnels::TunnelKey> planned() const {
    const auto plan = bones_.plan_of(BoneKind::Femur);
    return plan ? std::optional(plan->tunnel.key()) : std::nullopt;
  }

  // Of the operation, as soon as it has heard of all that it was told.
  [[nodiscard]] std::optional<tunnels::TunnelKey> in_force() {
    const theatre::LiveOperation& operation = bones_.operation(BoneKind::Femur);
    operation.finish();
    const auto& plan = operation.latest()->operation->plan;
    return plan ? std::optional(plan->tunnel.key()) : std::nullopt;
  }

  open_case::PlanModel model_{phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "test")};
  const tunnels::Tunnel whole_ = *model_.tunnel(BoneKind::Femur);
  TheatreBones bones_{[] {}, {}};
};

}  // namespace

TEST_F(TunnelChoice, ASingleTunnelNeedsNone) {
  EXPECT_FALSE(bones_.must_choose(BoneKind::Femur));
  EXPECT_EQ(planned(), tunnels::TunnelKey(BoneKind::Femur));
}

TEST_F(TunnelChoice, Hazard38NothingGuidesByOneOfTwoThatNobodyChose) {
  plan_bundles();
  EXPECT_TRUE(bones_.must_choose(BoneKind::Femur));
  EXPECT_FALSE(bones_.guided(BoneKind::Femur));
  EXPECT_FALSE(planned());
  EXPECT_FALSE(bones_.must_choose(BoneKind::Tibia)) << "of the other bone nothing is asked";
  bones_.choose(kPl);
  EXPECT_EQ(planned(), kPl);
  bones_.choose(kAm);
  EXPECT_EQ(planned(), kAm);
  // Another case has its own.
  bones_.open(&model_, "", "");
  EXPECT_FALSE(planned());
}

// A second tunnel that is planned while the first is drilled changes nothing of what guides; once the source
// has ended, somebody has to say which.
TEST_F(TunnelChoice, Hazard38ASecondTunnelTakesNothingFromTheFirst) {
  model_.set_tunnel(kAm, *model_.tunnel(BoneKind::Femur));
  theatre::LiveOperation& operation = bones_.used(BoneKind::Femur);
  operation.start(simulated_setup(model_, kAm, "", SimulatedPart::Scratch));
  while (!operation.latest()->operation->has_source && operation.latest()->message.empty())
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  ASSERT_EQ(operation.latest()->message, "");
  plan_bundles();
  bones_.offer_plans();
  EXPECT_EQ(planned(), kAm);
  EXPECT_EQ(&bones_.operation(BoneKind::Femur), &operation);
  operation.end_source();
  operation.finish();
  EXPECT_EQ(in_force(), kAm) << "nothing was offered by the tunnel that came";
  EXPECT_TRUE(bones_.must_choose(BoneKind::Femur));
  bones_.offer_plans();
  operation.finish();
  EXPECT_FALSE(in_force());
}

// Looked at while it was the only one, a tunnel was chosen by nobody.
TEST_F(TunnelChoice, Hazard38LookingIsNotChoosing) {
  plan_bundles();
  model_.set_tunnel(kPl, std::nullopt);
  EXPECT_EQ(in_force(), kAm);
  plan_bundles();
  bones_.offer_plans();
  EXPECT_TRUE(bones_.must_choose(BoneKind::Femur));
  EXPECT_FALSE(in_force());
}

// The chosen tunnel goes and comes back: what guided meanwhile, being the only one, was chosen by nobody.
TEST_F(TunnelChoice, Hazard38AChosenTunnelThatComesBackIsTheChosenOne) {
  plan_bundles();
  bones_.choose(kAm);
  EXPECT_EQ(in_force(), kAm);
  model_.set_tunnel(kAm, std::nullopt);
  bones_.offer_plans();
  EXPECT_EQ(in_force(), kPl);
  plan_bundles();
  bones_.offer_plans();
  EXPECT_EQ(in_force(), kAm);
}

// What is registered is judged at the entry of the chosen tunnel, though the bone was looked at before.
TEST_F(TunnelChoice, TheRegistrationAimsAtTheChosenTunnel) {
  plan_bundles();
  (void)bones_.operation(BoneKind::Femur);
  for (const tunnels::TunnelKey& key : {kAm, kPl}) {
    bones_.choose(key);
    bones_.offer_plans();
    const operation::RegistrationWorkOptions work =
        operation::work_options(bones_.operation(BoneKind::Femur).setup());
    EXPECT_EQ(work.online.target_in_bone_mm, model_.tunnel(key)->entry_mm);
    EXPECT_EQ(work.fit.target_in_bone_mm, model_.tunnel(key)->entry_mm);
    EXPECT_EQ(work.online.direction_in_bone, model_.tunnel(key)->direction);
  }
}

// The other one was offered; going back to the one in force and taking over, before anything was heard of
// either, must leave the one that the screen names now.
TEST_F(TunnelChoice, Hazard38TakingOverNeverTakesTheTunnelOfBefore) {
  plan_bundles();
  bones_.choose(kAm);
  theatre::LiveOperation& operation = bones_.used(BoneKind::Femur);
  operation.start(simulated_setup(model_, kAm, "", SimulatedPart::Scratch));
  while (!operation.latest()->operation->has_source && operation.latest()->message.empty())
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  ASSERT_EQ(operation.latest()->message, "");
  bones_.choose(kPl);
  bones_.offer_plans();
  bones_.choose(kAm);
  operation.apply(operation::TakePlanOver{});
  operation.end_source();
  operation.finish();
  EXPECT_EQ(operation.latest()->operation->plan->tunnel.key(), kAm);
}

// What is confirmed before a live source guides says which tunnel it is.
TEST_F(TunnelChoice, Hazard38TheTimeOutNamesTheTunnel) {
  plan_bundles();
  bones_.choose(kPl);
  operation::OperationState state;
  state.source = std::make_shared<const operation::SourceSetup>();
  state.plan = bones_.plan_of(BoneKind::Femur);
  const auto lines = time_out_lines(state, "", {});
  EXPECT_TRUE(std::ranges::any_of(
      lines, [](const CardLine& line) { return line.text.find("tunnel femur PL, ") == 0; }));
}

}  // namespace arthronaut::navigate
