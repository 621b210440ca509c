#include "app/plan/isometry_work.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "planning/phantom/phantom_case.h"
#include "planning/phantom/phantom_knee.h"

namespace arthronaut::plan {
namespace {

using bones::BoneKind;
using ::testing::HasSubstr;

class Isometry : public ::testing::Test {
 protected:
  void SetUp() override { await_shape(); }
  // What the shape says of the landmarks comes later than the case; a minute is a hundred times what it
  // takes.
  void await_shape() const {
    const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (!model_.proposal(BoneKind::Femur) && std::chrono::steady_clock::now() < until)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  [[nodiscard]] IsometryAsked asked(const cases::BoneDoubts& doubts = {}) const {
    return isometry_asked(model_, BoneKind::Femur, doubts);
  }
  [[nodiscard]] std::shared_ptr<const ShownIsometry> waited_for(IsometryWork& work) const {
    const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (std::chrono::steady_clock::now() < until) {
      if (auto found = work.of(*asked().request)) return found;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return nullptr;
  }

  open_case::PlanModel model_{phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "test")};
};

// The place of the planned entry says what the check says of the plan.
TEST_F(Isometry, SaysOfTheEntryWhatTheCheckSays) {
  const IsometryAsked asked = this->asked();
  ASSERT_TRUE(asked.request) << asked.why_not;
  const auto& checks = model_.checks(BoneKind::Femur);
  const auto check = std::ranges::find(checks, "Length over flexion", &tunnels::PlanCheck::name);
  ASSERT_NE(check, checks.end());
  const auto lines = isometry_in_words(model_, BoneKind::Femur, *asked.request);
  ASSERT_GE(lines.size(), 3U);
  const std::string entry = "This entry: ";
  ASSERT_TRUE(lines[1].starts_with(entry)) << lines[1];
  EXPECT_TRUE(check->text.starts_with(lines[1].substr(entry.size()))) << check->text << "\n" << lines[1];
  EXPECT_THAT(lines[2], HasSubstr("spheres through the posterior condyles, a hinge: no roll-back"));
  const tunnels::TunnelGeometry& in_femur = model_.measured(BoneKind::Femur);
  const auto here = asked.request->at(in_femur.entry_on_surface_mm, in_femur.entry.normal);
  ASSERT_TRUE(here);
  EXPECT_DOUBLE_EQ(here->change_mm, *check->value);
  // Straight out of the condyle it is no wall of the notch.
  EXPECT_FALSE(asked.request->at(in_femur.exit_mm, in_femur.exit.normal));
}

// Whatever the femoral tunnel does the map stays; another tibial entry makes another one.
TEST_F(Isometry, RestsOnTheTibialEntryAndNotOnTheFemoralOne) {
  IsometryWork work({});
  const auto before = waited_for(work);
  ASSERT_NE(before, nullptr);
  ASSERT_GT(before->items.size(), 2U);
  ASSERT_EQ(before->items.size(), before->map.bands.size());
  tunnels::Tunnel femoral = *model_.tunnel(BoneKind::Femur);
  femoral.entry_mm += 0.5 * model_.axes(BoneKind::Femur).anterior;
  model_.set_tunnel(BoneKind::Femur, femoral);
  EXPECT_EQ(work.of(*asked().request), before);
  tunnels::Tunnel tibial = *model_.tunnel(BoneKind::Tibia);
  tibial.entry_mm += 4 * model_.axes(BoneKind::Tibia).anterior;
  model_.set_tunnel(BoneKind::Tibia, tibial);
  ASSERT_TRUE(asked().request) << asked().why_not;
  EXPECT_EQ(work.of(*asked().request), nullptr);
  const auto after = waited_for(work);
  ASSERT_NE(after, nullptr);
  EXPECT_GT(std::abs(after->map.greatest_mm - before->map.greatest_mm), 0.1);
}

TEST_F(Isometry, SaysWhatIsMissing) {
  const tunnels::Tunnel tibial = *model_.tunnel(BoneKind::Tibia);
  model_.set_tunnel(BoneKind::Tibia, std::nullopt);
  EXPECT_FALSE(asked().request);
  EXPECT_THAT(asked().why_not, HasSubstr("the tibial tunnel"));
  tunnels::Tunnel beside = tibial;
  beside.entry_mm += 500 * model_.axes(BoneKind::Tibia).lateral;
  model_.set_tunnel(BoneKind::Tibia, beside);
  EXPECT_FALSE(asked().request);
  EXPECT_THAT(asked().why_not, HasSubstr("the tibial tunnel"));
  model_.set_tunnel(BoneKind::Tibia, tibial);
  EXPECT_TRUE(asked().request);
  model_.set_tunnel(BoneKind::Femur, std::nullopt);
  EXPECT_THAT(asked().why_not, HasSubstr("no femoral tunnel"));
}

// A map on the wrong wall, about a hinge of somewhere else or to an entry that is none is not shown.
TEST_F(Isometry, IsNotShownOfWhatIsInDoubt) {
  const cases::BoneDoubts doubts{
      {BoneKind::Tibia, {cases::SideDoubt{.told = bones::Side::Left, .said = bones::Side::Right}}}};
  EXPECT_THAT(asked(doubts).why_not, HasSubstr("the side is in doubt"));
  EXPECT_FALSE(asked(doubts).request);
  EXPECT_TRUE(asked({{BoneKind::Tibia, {"a sentence"}}}).request);

  landmarks::Landmarks marks = model_.landmarks(BoneKind::Femur);
  marks.at("lateral_condyle_posterior") += 14 * model_.axes(BoneKind::Femur).anterior;
  model_.set_landmarks(BoneKind::Femur, marks, model_.landmark_states(BoneKind::Femur));
  await_shape();
  EXPECT_THAT(asked().why_not, HasSubstr("the femur's hinge is in doubt: Landmarks"));

  model_.set_landmarks(BoneKind::Femur, {}, {});
  await_shape();
  EXPECT_FALSE(asked().request);
  EXPECT_THAT(asked().why_not, HasSubstr("the flexion axis"));
}

}  // namespace
}  // namespace arthronaut::plan
