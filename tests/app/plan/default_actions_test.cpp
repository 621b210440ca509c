// The default plan as keys ask for it: made while the screen goes on, and taken of nothing else than it is
// of.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "app/plan/plan_view.h"
#include "app/scene/offscreen_context.h"
#include "planning/cases/bone_doubts.h"
#include "planning/files/atomic_file.h"
#include "planning/phantom/phantom_case.h"
#include "planning/phantom/phantom_knee.h"
#include "planning/plan_export/markups_file.h"
#include "tests/temporary_folder.h"

namespace arthronaut::plan {
namespace {

using bones::BoneKind;

class DefaultActions : public ::testing::Test {
 protected:
  void SetUp() override {
    unsetenv("DISPLAY");
    context_.emplace();
    view_.emplace([this] { context_->make_current(); }, [] {}, [] {},
                  [](bones::Side) { return std::vector<std::string>{}; });
    view_->add_actions(actions_);
    cases::save_case(folder_.path(), model_.knee());
    view_->case_opened({&model_, folder_.path(), ""});
  }
  const widgets::Action& action(const std::string& id) const {
    return *std::ranges::find(actions_.all(), id, [](const widgets::Action& one) { return one.id; });
  }
  // Until another default could be asked for: whatever ran has ended and was taken, or was not.
  void settle() {
    do {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      view_->tick(1000);
    } while (!action("plan.default").can_run());
  }
  double femoral_mm() const { return model_.tunnel(BoneKind::Femur)->diameter_mm; }

  const test::TemporaryFolder folder_;
  open_case::PlanModel model_{phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "default")};
  std::optional<scene::OffscreenContext> context_;
  widgets::Actions actions_;
  std::optional<PlanView> view_;
};

TEST_F(DefaultActions, ThePlanIsAsItWasUntilItIsMade) {
  const Eigen::Vector3d before = model_.tunnel(BoneKind::Femur)->entry_mm;
  action("plan.default").run();
  EXPECT_TRUE(view_->is_busy());
  EXPECT_FALSE(action("plan.default").can_run()) << "one at a time";
  EXPECT_FALSE(action("plan.bundles").can_run());
  EXPECT_EQ(model_.tunnel(BoneKind::Femur)->entry_mm, before);
  settle();
  EXPECT_NE(model_.tunnel(BoneKind::Femur)->entry_mm, before);
  EXPECT_EQ(model_.tunnel(BoneKind::Femur)->entry_mm, model_.default_tunnel(BoneKind::Femur).tunnel.entry_mm);
  action("plan.undo").run();
  EXPECT_EQ(model_.tunnel(BoneKind::Femur)->entry_mm, before) << "one step";
}

// A grid that reaches too far back puts the norm's place at the back wall. Nobody is moved unasked; asked,
// the entry moves as far as is needed, in one step, and what was moved by hand since is not touched.
TEST_F(DefaultActions, EntersWhereItPassesWhenAsked) {
  cases::Case knee = model_.knee();
  landmarks::Landmarks& marks = knee.landmarks.at(BoneKind::Femur);
  const auto proposed =
      landmarks::propose(knee.bones.at(BoneKind::Femur).mesh, BoneKind::Femur, {.side = knee.side}).landmarks;
  for (const char* extent : {"lateral_condyle_deep", "lateral_condyle_shallow", "lateral_condyle_low"})
    marks[extent] = proposed.at(extent);
  marks.erase("native_footprint");
  marks["lateral_condyle_deep"] += 16 * Eigen::Vector3d::UnitY();
  open_case::PlanModel model(knee);
  cases::save_case(folder_.path(), knee);
  view_->case_opened({&model, folder_.path(), ""});
  EXPECT_FALSE(action("plan.within_spread").can_run()) << "no default was made";
  action("plan.default").run();
  settle();
  const auto made = model.default_tunnel(BoneKind::Femur);
  ASSERT_TRUE(made.other_entry) << made.place;
  EXPECT_EQ(model.tunnel(BoneKind::Femur)->entry_mm, made.tunnel.entry_mm);
  ASSERT_TRUE(action("plan.within_spread").can_run());
  action("plan.within_spread").run();
  EXPECT_EQ(model.tunnel(BoneKind::Femur)->entry_mm, made.other_entry->entry_mm);
  EXPECT_FALSE(action("plan.within_spread").can_run());
  action("plan.undo").run();
  EXPECT_EQ(model.tunnel(BoneKind::Femur)->entry_mm, made.tunnel.entry_mm) << "one step";
  view_.reset();
}

// What is of the other knee is no proposal: which knee it is is asked first.
TEST_F(DefaultActions, WhileTheSideIsInDoubtItIsAskedFirst) {
  const Eigen::Vector3d before = model_.tunnel(BoneKind::Femur)->entry_mm;
  cases::save_bone_doubts(folder_.path(), {{BoneKind::Tibia, {cases::SideDoubt{.told = bones::Side::Left}}}});
  view_->case_opened({&model_, folder_.path(), ""});
  action("plan.default").run();
  EXPECT_TRUE(action("plan.default").can_run()) << "none is being made";
  EXPECT_EQ(model_.tunnel(BoneKind::Femur)->entry_mm, before);
  ASSERT_TRUE(action("plan.left_knee").can_run()) << "the question stands";
  cases::save_bone_doubts(folder_.path(), {});
  view_->case_opened({&model_, folder_.path(), ""});
  action("plan.default").run();
  EXPECT_FALSE(action("plan.default").can_run()) << "one is being made";
  settle();
}

// An undo of what was done on the other bone turns to that bone.
TEST_F(DefaultActions, UndoTurnsToTheBoneOfItsStep) {
  const auto tibial_mm = [&] { return model_.tunnel(BoneKind::Tibia)->diameter_mm; };
  const double femur_before = femoral_mm(), tibia_before = tibial_mm();
  action("plan.wider").run();
  action("plan.bone").run();
  action("plan.undo").run();
  EXPECT_EQ(femoral_mm(), femur_before);
  action("plan.wider").run();
  EXPECT_GT(femoral_mm(), femur_before) << "the femur is the one that is worked on again";
  EXPECT_EQ(tibial_mm(), tibia_before);
}

// Esc, another mode, and a hand that was quicker: nothing of it comes into the plan.
TEST_F(DefaultActions, WhatIsLeftOrOvertakenIsNotTaken) {
  action("plan.wider").run();
  view_->tick(1000);
  const double planned_mm = femoral_mm();
  const auto plan = model_.knee().plan;
  const auto is_untouched = [&] {
    return std::ranges::all_of(cases::compare_plans(model_.knee().plan, plan), [](const auto& difference) {
      return difference.kind == cases::TunnelDifference::Kind::Same;
    });
  };
  action("plan.default").run();
  ASSERT_TRUE(action("plan.stop_placing").can_run());
  action("plan.stop_placing").run();
  settle();
  EXPECT_TRUE(is_untouched());
  action("plan.bundles").run();
  view_->leave();
  settle();
  EXPECT_TRUE(is_untouched());
  action("plan.default").run();
  action("plan.wider").run();
  settle();
  EXPECT_EQ(femoral_mm(), planned_mm + 0.5);
  EXPECT_EQ(model_.tunnel(BoneKind::Femur)->entry_mm, plan.tunnels.at(BoneKind::Femur).entry_mm);
}

// The case that it was made of is closed, then the window: neither waits for the case, nor reads it.
TEST_F(DefaultActions, AnotherCaseKnowsNothingOfIt) {
  action("plan.default").run();
  auto other = std::make_unique<open_case::PlanModel>(model_.knee());
  const Eigen::Vector3d entry_mm = other->tunnel(BoneKind::Femur)->entry_mm;
  view_->case_opened({other.get(), folder_.path(), ""});
  settle();
  EXPECT_EQ(other->tunnel(BoneKind::Femur)->entry_mm, entry_mm);
  action("plan.default").run();
  view_.reset();
}

// Esc stops an export, which takes half a minute of a fine bone; what is in front is left first.
TEST_F(DefaultActions, EscStopsAnExport) {
  action("plan.export").run();
  ASSERT_TRUE(view_->has_running_work());
  action("plan.place").run();
  action("plan.stop_placing").run();
  EXPECT_FALSE(action("plan.place").is_on());
  action("plan.stop_placing").run();
  while (view_->has_running_work()) view_->tick(1000);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "export"));
}

// Markups as 3D Slicer gives them back: what was moved there becomes the plan, as one step; what is of
// another knee changes nothing.
TEST_F(DefaultActions, MarkupsThatWereMovedBecomeThePlan) {
  cases::Case moved = model_.knee();
  const Eigen::Vector3d before = moved.plan.tunnels.at(BoneKind::Femur).entry_mm;
  tunnels::Tunnel& femoral = moved.plan.tunnels.at(BoneKind::Femur);
  femoral.entry_mm =
      model_.surface(BoneKind::Femur).closest_point(before + Eigen::Vector3d(0, 0, 2)).point_mm;
  const auto file = folder_ / "moved.mrk.json";
  files::write_atomically(file, plan_export::markups_of(moved));
  view_->take_markups(file);
  EXPECT_LT((model_.tunnel(BoneKind::Femur)->entry_mm - femoral.entry_mm).norm(), 1e-3);
  const auto other = folder_ / "other.mrk.json";
  std::ofstream(other) << plan_export::markups_of(model_.knee()).replace(0, 1, "[");
  view_->take_markups(other);
  EXPECT_LT((model_.tunnel(BoneKind::Femur)->entry_mm - before).norm(), 3) << "broken: nothing is taken";
  action("plan.undo").run();
  EXPECT_EQ(model_.tunnel(BoneKind::Femur)->entry_mm, before);
}

}  // namespace
}  // namespace arthronaut::plan
