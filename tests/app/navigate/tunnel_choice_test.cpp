// Which of two planned tunnels an operation guides by: the chosen one, the only one, or none; never one of
// two.
#include <gtest/gtest.h>

#include <algorithm>

#include "app/navigate/beginning_words.h"
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
    const tunnels::Tunnel am = *model_.tunnel(BoneKind::Femur);
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

  open_case::PlanModel model_{phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "test")};
  TheatreBones bones_{[] {}};
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

// A second tunnel that is planned while the first is drilled changes nothing of what guides.
TEST_F(TunnelChoice, Hazard38ASecondTunnelTakesNothingFromTheFirst) {
  model_.set_tunnel(kAm, *model_.tunnel(BoneKind::Femur));
  const auto& operation = bones_.operation(BoneKind::Femur);
  EXPECT_EQ(operation.latest()->operation->plan->tunnel.key(), kAm);
  tunnels::Tunnel pl = *model_.tunnel(kAm);
  pl.entry_mm += 9 * pl.direction.unitOrthogonal();
  model_.set_tunnel(kPl, pl);
  bones_.offer_plans();
  EXPECT_EQ(planned(), kAm);
  // The chosen one goes: what is left is the only one.
  model_.set_tunnel(kAm, std::nullopt);
  EXPECT_EQ(planned(), kPl);
}

// What is confirmed before a live source guides says which tunnel it is.
TEST_F(TunnelChoice, Hazard38TheTimeOutNamesTheTunnel) {
  plan_bundles();
  bones_.choose(kPl);
  operation::OperationState state;
  state.source = std::make_shared<const operation::SourceSetup>();
  state.plan = bones_.plan_of(BoneKind::Femur);
  const auto lines = time_out_lines(state, "");
  EXPECT_TRUE(std::ranges::any_of(
      lines, [](const CardLine& line) { return line.text.find("tunnel femur PL, ") == 0; }));
}

}  // namespace arthronaut::navigate
