#include "app/case/history.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

#include "app/case/plan_steps.h"

namespace arthronaut::open_case {

namespace {

using bones::BoneKind;

tunnels::Tunnel tunnel(double x) {
  return {.bone = BoneKind::Femur,
          .entry_mm = {x, 0, 0},
          .direction = Eigen::Vector3d::UnitX(),
          .diameter_mm = 9};
}

// A plan whose every saved state is kept.
struct Planner {
  std::map<BoneKind, tunnels::Tunnel> plan;
  std::vector<double> saved;  // x of the femoral entry, -1 without a tunnel
  History history{[this] { saved.push_back(x()); }};

  double x() const { return plan.empty() ? -1 : plan.at(BoneKind::Femur).entry_mm.x(); }
  void move_to(double to) { change(tunnel(to), "Move femoral entry"); }
  void change(std::optional<tunnels::Tunnel> to, const std::string& description) {
    const auto set = [this](BoneKind bone, const std::optional<tunnels::Tunnel>& value) {
      plan.erase(bone);
      if (value) plan.emplace(bone, *value);
    };
    const auto before = plan.empty() ? std::nullopt : std::optional(plan.at(BoneKind::Femur));
    history.execute(set_tunnel(set, BoneKind::Femur, before, std::move(to), description));
  }
};

}  // namespace

TEST(History, UndoAndRedoWalkThroughEveryState) {
  Planner planner;
  for (double x : {1.0, 2.0, 3.0}) planner.move_to(x);
  EXPECT_EQ(planner.history.undo_text(), "Move femoral entry");
  planner.history.undo();
  EXPECT_EQ(planner.x(), 2);
  planner.history.undo();
  planner.history.undo();
  EXPECT_EQ(planner.x(), -1);  // no tunnel, as at the start
  EXPECT_FALSE(planner.history.can_undo());
  planner.history.undo();  // nothing happens
  for (double x : {1.0, 2.0, 3.0}) {
    planner.history.redo();
    EXPECT_EQ(planner.x(), x);
  }
  EXPECT_FALSE(planner.history.can_redo());
}

TEST(History, ANewStepForgetsWhatWasUndone) {
  Planner planner;
  planner.move_to(1);
  planner.move_to(2);
  planner.history.undo();
  planner.move_to(5);
  EXPECT_FALSE(planner.history.can_redo());
  planner.history.undo();
  EXPECT_EQ(planner.x(), 1);
}

// A drag of many small moves is one step, and is saved once, at its end.
TEST(History, ADragIsOneStep) {
  Planner planner;
  planner.move_to(1);
  planner.history.begin_drag();
  for (double x = 2; x < 50; ++x) planner.move_to(x);
  EXPECT_FALSE(planner.history.can_undo()) << "not while the mouse is down";
  EXPECT_EQ(planner.saved, std::vector<double>({1}));
  planner.history.end_drag();
  EXPECT_EQ(planner.saved, std::vector<double>({1, 49}));
  planner.history.undo();
  EXPECT_EQ(planner.x(), 1);
  planner.history.redo();
  EXPECT_EQ(planner.x(), 49);
}

// The step before a drag stays a step of its own.
TEST(History, ADragDoesNotSwallowTheStepBeforeIt) {
  Planner planner;
  planner.move_to(1);
  planner.history.begin_drag();
  planner.move_to(2);
  planner.history.end_drag();
  planner.history.undo();
  EXPECT_EQ(planner.x(), 1);
  planner.history.undo();
  EXPECT_EQ(planner.x(), -1);
}

TEST(History, RemovingATunnelCanBeUndone) {
  Planner planner;
  planner.move_to(4);
  planner.change(std::nullopt, "Remove femoral tunnel");
  EXPECT_TRUE(planner.plan.empty());
  planner.history.undo();
  EXPECT_EQ(planner.x(), 4);
}

// Any walk of executing, undoing and redoing: the model equals that of a plain list of states, and so does
// what was saved.
TEST(History, AgreesWithAListOfStatesOnRandomWalks) {
  std::mt19937 random(7);
  Planner planner;
  std::vector<double> states{-1};
  std::size_t at = 0;
  for (int i = 0; i < 5000; ++i) {
    switch (random() % 3) {
      case 0:
        states.resize(++at);
        states.push_back(i);
        planner.move_to(i);
        break;
      case 1:
        if (at > 0) --at;
        planner.history.undo();
        break;
      default:
        if (at + 1 < states.size()) ++at;
        planner.history.redo();
    }
    ASSERT_EQ(planner.x(), states[at]);
    if (!planner.saved.empty()) {
      ASSERT_EQ(planner.saved.back(), states[at]);
    }
  }
}

}  // namespace arthronaut::open_case
