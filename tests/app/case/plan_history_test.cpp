#include "app/case/plan_history.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <random>
#include <thread>

#include "tests/app/case/plan_history_fixture.h"

namespace arthronaut::open_case {
namespace {

using bones::BoneKind;

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

// A hand that pauses in a drag, and a machine that is too slow to follow it, end no step: letting go does.
TEST_F(PlanHistoryTest, ADragIsOneStepHoweverLongItPauses) {
  history_.apply(wider(0.5, false), 1.0);
  history_.settle(10.0, true);
  EXPECT_TRUE(history_.is_moving());
  history_.apply(wider(0.5, true), 10.1);
  history_.settle(20.0);
  EXPECT_FALSE(history_.is_moving());
  EXPECT_EQ(history_.step_count(), 1U);
}

// What a step is of: an undo that shows nothing on the bone that is looked at says where it was.
TEST_F(PlanHistoryTest, AStepKnowsItsBone) {
  history_.apply(wider(0.5, false), 1.0);
  history_.settle_now();
  landmarks::LandmarkStates states = model_.landmark_states(BoneKind::Tibia);
  for (const auto& [name, at] : model_.landmarks(BoneKind::Tibia))
    states[name] = landmarks::LandmarkState::Proposed;
  history_.apply_landmarks(BoneKind::Tibia, model_.landmarks(BoneKind::Tibia), states, "Confirm", false, 2.0);
  history_.settle_now();
  EXPECT_EQ(history_.bones_of(0), std::set{BoneKind::Femur});
  EXPECT_EQ(history_.bones_of(1), std::set{BoneKind::Tibia});
}

// A surgeon looks at another knee and comes back: what he did here can still be taken back. Not where the
// case was changed elsewhere meanwhile: a step back from another state would be an invention.
TEST_F(PlanHistoryTest, TheStepsAreThereAgainAfterAnotherCase) {
  history_.apply(wider(1, false), 1.0);
  history_.settle(2.0);
  history_.apply(wider(1, false), 3.0);
  history_.settle(4.0);
  history_.undo();
  const test::TemporaryFolder elsewhere;
  cases::save_case(elsewhere.path(), knee());
  PlanModel other(cases::load_case(elsewhere.path()));
  history_.open(&other, elsewhere.path());
  EXPECT_FALSE(history_.can_undo());
  EXPECT_FALSE(history_.can_redo());
  EXPECT_EQ(history_.status().text, "saved") << "nothing was done there that could be lost";
  PlanModel again(cases::load_case(folder_));
  history_.open(&again, folder_);
  ASSERT_TRUE(history_.can_undo());
  EXPECT_EQ(history_.status().undo_what, "Change the diameter of the femoral tunnel");
  history_.redo();
  EXPECT_NEAR(again.tunnel(BoneKind::Femur)->diameter_mm, start_mm_ + 2, 1e-9);
  history_.go_to(0);
  EXPECT_NEAR(again.tunnel(BoneKind::Femur)->diameter_mm, start_mm_, 1e-9);
  EXPECT_NEAR(saved_diameter_mm(), start_mm_, 1e-9);
  history_.redo();

  history_.open(&other, elsewhere.path());
  cases::Case changed = cases::load_case(folder_);
  changed.plan.tunnels.at(BoneKind::Femur).diameter_mm = 11.5;
  cases::save_case(folder_, changed);
  PlanModel changed_model(cases::load_case(folder_));
  history_.open(&changed_model, folder_);
  EXPECT_FALSE(history_.can_undo());
  EXPECT_FALSE(history_.can_redo());
}

// The program is ended and started again: the list of steps is there, with what was undone, and all of it can
// be taken back. What another program did since is none of the steps: then nothing can, and that is said.
TEST_F(PlanHistoryTest, TheStepsOutliveTheProgram) {
  history_.apply(wider(1, false), 1.0);
  history_.settle(2.0);
  history_.apply_measurements({{{{1, 2, 3}, {4, 5, 6}}}}, "Measure a distance");
  history_.apply(wider(0.5, false), 3.0);
  history_.settle(4.0);
  history_.undo();
  {
    PlanModel again(cases::load_case(folder_));
    again.set_measurements(cases::load_measurements(folder_));
    PlanHistory started_again;
    started_again.open(&again, folder_);
    ASSERT_EQ(started_again.step_count(), 3U);
    EXPECT_EQ(started_again.position(), 2U);
    EXPECT_EQ(started_again.step_name(1), "Measure a distance");
    EXPECT_EQ(started_again.status().undo_what, "Measure a distance");
    started_again.redo();
    EXPECT_NEAR(again.tunnel(BoneKind::Femur)->diameter_mm, start_mm_ + 1.5, 1e-9);
    started_again.go_to(0);
    EXPECT_NEAR(saved_diameter_mm(), start_mm_, 1e-9);
    EXPECT_TRUE(cases::load_measurements(folder_).empty());
  }
  cases::Case changed = cases::load_case(folder_);
  changed.plan.tunnels.at(BoneKind::Femur).diameter_mm = 7.25;
  cases::save_case(folder_, changed);
  PlanModel other(changed);
  PlanHistory after_another;
  after_another.open(&other, folder_);
  EXPECT_EQ(after_another.step_count(), 0U);
  EXPECT_NE(after_another.status().text.find("changed elsewhere since"), std::string::npos);
}

// A broken file costs the steps, not the case.
TEST_F(PlanHistoryTest, StepsThatCannotBeReadAreSaid) {
  history_.apply(wider(1, false), 1.0);
  history_.settle(2.0);
  std::ofstream(cases::step_history_file(folder_)) << "{ broken";
  PlanModel again(cases::load_case(folder_));
  PlanHistory started_again;
  started_again.open(&again, folder_);
  EXPECT_FALSE(started_again.can_undo());
  EXPECT_NE(started_again.status().text.find("cannot be taken back"), std::string::npos);
}

// Killed at any moment of planning: the plan on the disk is one of the steps, and those before it can be
// taken back to the first.
TEST_F(PlanHistoryTest, TheStepsOutliveAKill) {
  std::mt19937 random(20260104);
  std::uniform_int_distribution<int> delay_us(0, 60000);
  int taken_back = 0;
  for (int i = 0; i < 8; ++i) {
    int ready[2];
    ASSERT_EQ(::pipe(ready), 0);
    const pid_t child = ::fork();
    if (child == 0) {
      PlanModel model(cases::load_case(folder_));
      PlanHistory history;
      history.open(&model, folder_);
      (void)!::write(ready[1], "r", 1);
      for (int step = 1;; ++step) {
        tunnels::Tunnel tunnel = *model.tunnel(BoneKind::Femur);
        tunnel.diameter_mm += 1e-4;
        history.apply({BoneKind::Femur, tunnel, "Widen", false}, step);
        history.settle_now();
        (void)!::write(ready[1], "s", 1);
      }
    }
    // It is open, and has saved a step, however busy the machine is.
    for (int told = 0; told < 2; ++told) {
      char one = 0;
      ASSERT_EQ(::read(ready[0], &one, 1), 1);
    }
    for (const int end : ready) ::close(end);
    std::this_thread::sleep_for(std::chrono::microseconds(delay_us(random)));
    ::kill(child, SIGKILL);
    ASSERT_EQ(::waitpid(child, nullptr, 0), child);
    PlanModel again(cases::load_case(folder_));
    PlanHistory started_again;
    started_again.open(&again, folder_);
    const double found_mm = saved_diameter_mm();
    EXPECT_EQ(started_again.can_undo(), found_mm > start_mm_ + 5e-5) << i;
    if (!started_again.can_undo()) continue;
    started_again.undo();
    EXPECT_NEAR(saved_diameter_mm(), found_mm - 1e-4, 1e-9);
    started_again.redo();
    EXPECT_NEAR(saved_diameter_mm(), found_mm, 1e-9);
    ++taken_back;
  }
  EXPECT_GT(taken_back, 4) << "the child hardly ever came to save";
}

// Normalising a direction again on reading would change its last digit: the steps would be another case's.
TEST_F(PlanHistoryTest, TheStepsAreThereAgainWhateverTheDirection) {
  tunnels::Tunnel tunnel = *model_.tunnel(BoneKind::Femur);
  tunnel.direction = Eigen::Vector3d(-0.83, -0.32, 0.41).normalized();
  history_.apply({BoneKind::Femur, tunnel, "Aim the femoral tunnel", false}, 1.0);
  history_.settle_now();
  history_.open(nullptr, {});
  PlanModel again(cases::load_case(folder_));
  EXPECT_EQ(again.tunnel(BoneKind::Femur)->direction, tunnel.direction);
  history_.open(&again, folder_);
  EXPECT_TRUE(history_.can_undo());
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

// Work on what is on the disk, as a report, starts with what is seen, or does not start.
TEST_F(PlanHistoryTest, TheModelIsSavedWhereWorkOnTheDiskStarts) {
  history_.apply(wider(1, true), 1.0);
  EXPECT_NEAR(saved_diameter_mm(), start_mm_, 1e-9);
  EXPECT_EQ(model_.save_now(), "");
  EXPECT_NEAR(saved_diameter_mm(), start_mm_ + 1, 1e-9);
  cases::Case changed = cases::load_case(folder_);
  changed.plan.tunnels.at(BoneKind::Femur).diameter_mm = 7.25;
  cases::save_case(folder_, changed);
  EXPECT_NE(model_.save_now(), "") << "another program saved another plan";
  EXPECT_NEAR(saved_diameter_mm(), 7.25, 1e-9);
}

// Whoever reads the case has the landmarks that the screen planned by, as proposed; a look at a case writes
// nothing.
TEST_F(PlanHistoryTest, ProposedLandmarksAreSavedWithTheFirstChange) {
  cases::Case bare = knee();
  bare.landmarks.clear();
  bare.landmark_states.clear();
  cases::save_case(folder_, bare);
  PlanModel model(cases::load_case(folder_));
  history_.open(&model, folder_);
  history_.settle_now();
  EXPECT_TRUE(cases::load_case(folder_).landmarks[BoneKind::Femur].empty());
  tunnels::Tunnel tunnel = *model.tunnel(BoneKind::Femur);
  tunnel.diameter_mm += 1;
  history_.apply({BoneKind::Femur, tunnel, "Change the diameter", false}, 1.0);
  history_.settle(2.0);
  cases::Case saved = cases::load_case(folder_);
  for (const BoneKind kind : {BoneKind::Femur, BoneKind::Tibia}) {
    ASSERT_EQ(saved.landmarks[kind].size(), model.landmarks(kind).size());
    for (const auto& [name, at] : model.landmarks(kind)) {
      EXPECT_NEAR((saved.landmarks[kind].at(name) - at).norm(), 0, 1e-6) << name;
      EXPECT_EQ(landmarks::state_of(saved.landmark_states[kind], name), landmarks::LandmarkState::Proposed);
    }
  }
  EXPECT_NEAR(saved_diameter_mm(), start_mm_ + 1, 1e-9);
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

// An edit that leaves the tunnel as it is makes no step: undo would seem to do nothing.
TEST_F(PlanHistoryTest, AnEditThatChangesNothingIsNoStep) {
  history_.apply(wider(0, false), 1.0);
  history_.apply_plan(model_.knee().plan, "Take version 1");  // kept just now, and clicked on
  history_.settle_now();
  EXPECT_FALSE(history_.can_undo());
  EXPECT_EQ(history_.status().save, PlanStatus::Save::Saved);
}

// The list of steps is walked to any place, and model and disk are what they were there.
TEST_F(PlanHistoryTest, TheListOfStepsIsWalkedToAnyPlace) {
  for (int i = 0; i < 3; ++i) {
    history_.apply(wider(1, false), 2.0 * i);
    history_.settle_now();
  }
  ASSERT_EQ(history_.step_count(), 3U);
  EXPECT_EQ(history_.step_name(0), "Change the diameter of the femoral tunnel");
  for (const std::size_t place : {0U, 2U, 1U, 3U}) {
    history_.go_to(place);
    EXPECT_EQ(history_.position(), place);
    EXPECT_NEAR(saved_diameter_mm(), start_mm_ + static_cast<double>(place), 1e-9);
  }
}

// What was measured is a step like any other, on disk after each.
TEST_F(PlanHistoryTest, MeasurementsAreUndoneAndSaved) {
  const cases::Measurement distance{{{0, 0, 0}, {3, 4, 0}}};
  history_.apply_measurements({distance}, "Measure a distance");
  EXPECT_EQ(cases::load_measurements(folder_), std::vector{distance});
  history_.apply(wider(1, false), 1.0);
  history_.settle_now();
  history_.undo();
  EXPECT_EQ(model_.measurements().size(), 1U);
  history_.undo();
  EXPECT_TRUE(model_.measurements().empty());
  EXPECT_TRUE(cases::load_measurements(folder_).empty());
  history_.redo();
  EXPECT_EQ(cases::load_measurements(folder_), std::vector{distance});
}

// Landmarks are moved, confirmed and undone like the plan, and what follows from them follows; a case file
// that holds them is never written over a plan that another program has saved.
TEST_F(PlanHistoryTest, LandmarksAreUndoneAndSaved) {
  landmarks::Landmarks marks = model_.landmarks(BoneKind::Femur);
  landmarks::LandmarkStates states = model_.landmark_states(BoneKind::Femur);
  const Eigen::Vector3d before = marks.at("blumensaat_anterior");
  marks["blumensaat_anterior"] = before + Eigen::Vector3d(0, -2, 0);
  states["blumensaat_anterior"] = landmarks::LandmarkState::Confirmed;
  history_.apply_landmarks(BoneKind::Femur, marks, states, "Drag a landmark of the femur", true, 1.0);
  marks["blumensaat_anterior"] = before + Eigen::Vector3d(0, -3, 0);
  history_.apply_landmarks(BoneKind::Femur, marks, states, "Drag a landmark of the femur", true, 1.1);
  history_.settle_now();
  EXPECT_EQ(history_.step_count(), 1U);
  EXPECT_EQ(cases::load_case(folder_).landmarks.at(BoneKind::Femur).at("blumensaat_anterior"),
            marks.at("blumensaat_anterior"));
  history_.undo();
  EXPECT_EQ(model_.landmarks(BoneKind::Femur).at("blumensaat_anterior"), before);
  EXPECT_EQ(cases::load_case(folder_).landmarks.at(BoneKind::Femur).at("blumensaat_anterior"), before);
  cases::Plan elsewhere = model_.knee().plan;
  elsewhere.tunnels.at(BoneKind::Femur).diameter_mm = 7.25;
  cases::save_plan(folder_, elsewhere);
  history_.redo();
  EXPECT_TRUE(history_.is_in_conflict());
  EXPECT_EQ(saved_diameter_mm(), 7.25);
}

// A default plan is one step, of however many tunnels.
TEST_F(PlanHistoryTest, SeveralTunnelsAreOneStep) {
  const cases::Plan before = model_.knee().plan;
  std::map<tunnels::TunnelKey, tunnels::Tunnel> tunnels = before.tunnels;
  for (auto& [bone, tunnel] : tunnels) tunnel.diameter_mm = 7;
  history_.apply_tunnels(tunnels, "Make the default plan");
  history_.apply_tunnels(tunnels, "Make the default plan");
  EXPECT_EQ(history_.step_count(), 1U) << "the second changes nothing";
  EXPECT_EQ(saved_diameter_mm(), 7);
  history_.undo();
  EXPECT_EQ(saved_diameter_mm(), start_mm_);
  EXPECT_EQ(model_.tunnel(BoneKind::Tibia)->diameter_mm, before.tunnels.at(BoneKind::Tibia).diameter_mm);
}

// Two bundles in place of a single tunnel: one step, and undo brings the single one back as it was.
TEST_F(PlanHistoryTest, TwoBundlesAreOneStep) {
  const cases::Plan before = model_.knee().plan;
  tunnels::Tunnel am = before.tunnels.at(BoneKind::Femur), pl = am;
  pl.entry_mm += 9 * pl.direction.unitOrthogonal();
  const tunnels::TunnelKey of_am{BoneKind::Femur, norms::Bundle::Anteromedial},
      of_pl{BoneKind::Femur, norms::Bundle::Posterolateral};
  history_.apply_tunnels({{of_am, am}, {of_pl, pl}}, "Plan two bundles in the femur");
  EXPECT_EQ(model_.knee().plan.of(BoneKind::Femur).size(), 2U);
  EXPECT_EQ(cases::load_case(folder_).plan.of(BoneKind::Femur).size(), 2U);
  EXPECT_EQ(model_.tunnel(of_pl)->bundle, norms::Bundle::Posterolateral);
  EXPECT_TRUE(model_.plan_fit(of_pl).is_valid());
  EXPECT_FALSE(model_.tunnel(BoneKind::Femur)) << "the bone alone is none of the two";
  // One of them moves, the other stays.
  am.diameter_mm = 6;
  history_.apply({of_am, am, "Change the diameter", false}, 1.0);
  EXPECT_EQ(model_.tunnel(of_am)->diameter_mm, 6);
  EXPECT_EQ(model_.tunnel(of_pl)->diameter_mm, pl.diameter_mm);
  history_.undo();
  history_.undo();
  EXPECT_EQ(model_.knee().plan.mesh_sha256, before.mesh_sha256);
  EXPECT_EQ(model_.tunnel(BoneKind::Femur)->entry_mm, before.tunnels.at(BoneKind::Femur).entry_mm);
}

}  // namespace
}  // namespace arthronaut::open_case
