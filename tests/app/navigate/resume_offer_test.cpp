#include "app/navigate/resume_offer.h"

#include <gtest/gtest.h>

#include <chrono>
#include <optional>
#include <thread>

#include "navigation/recording/recording_lock.h"
#include "planning/phantom/phantom_case.h"
#include "tests/navigation/theatre/resumable_fixture.h"

namespace arthronaut::navigate {
namespace {

class ResumeOfferTest : public recording::ResumableTest {
 protected:
  // An operation whose program was killed: a copy of a record that nobody finishes. Returns its folder.
  std::filesystem::path cut_off_operation() {
    operation::OperationSetup setup = test::phantom_setup();
    setup.mesh_sha256 = model_.mesh_sha256(bones::BoneKind::Femur);
    test::PhantomOperation run(setup);
    continues_.clear();
    operate(run, test::scripted_source(sources::SourceKind::Simulation));
    // The record is committed twice a second.
    EXPECT_TRUE(becomes([&] { return found(setup.mesh_sha256).has_value(); }, 60));
    const std::filesystem::path from = cases::session_folders(folder_.path()).back();
    const std::filesystem::path killed = killed_.path() / "sessions" / from.filename();
    std::filesystem::create_directories(killed.parent_path());
    std::filesystem::copy(from, killed, std::filesystem::copy_options::recursive);
    end(run);
    return killed;
  }
  // Whether it is so before as much time has gone.
  template <typename IsSo>
  bool becomes(const IsSo& is_so, double within_s) {
    const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(within_s);
    while (std::chrono::steady_clock::now() < until) {
      if (is_so()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return false;
  }
  [[nodiscard]] std::optional<bones::BoneKind> cut_off() {
    return offer_.cut_off(std::chrono::system_clock::now());
  }
  bool has_looked() {
    return becomes([&] { return !offer_.is_looking(); }, 120);
  }

  const open_case::PlanModel model_{
      phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "test")};
  const test::TemporaryFolder killed_;  // the case
  ResumeOffer offer_{[] {}};
};

// Hazard 12: a program that was killed still holds its record for as long as the machine takes to free its
// memory, longer than anybody waits for it. What it left is offered the moment it is gone.
TEST_F(ResumeOfferTest, Hazard12WhatAKilledProgramStillHeldIsOfferedOnceItLetsGo) {
  const std::filesystem::path session = cut_off_operation();
  std::optional<recording::RecordingLock> killed(session);
  offer_.open(model_, killed_.path(), false, "");
  ASSERT_TRUE(has_looked());
  EXPECT_FALSE(cut_off()) << "it may be going on";
  killed.reset();
  EXPECT_TRUE(becomes([&] { return cut_off() == bones::BoneKind::Femur; }, 60));
}

// What was answered meanwhile stays answered.
TEST_F(ResumeOfferTest, WhatWasDeclinedWhileItWasHeldIsNotOfferedAgain) {
  const std::filesystem::path session = cut_off_operation();
  std::optional<recording::RecordingLock> killed(session);
  offer_.open(model_, killed_.path(), false, "");
  ASSERT_TRUE(has_looked());
  ASSERT_NE(offer_.of(bones::BoneKind::Femur), nullptr);
  offer_.decline(bones::BoneKind::Femur);
  killed.reset();
  EXPECT_FALSE(becomes([&] { return cut_off() || offer_.of(bones::BoneKind::Femur) != nullptr; }, 4));
}

// One that goes on elsewhere is offered by nobody who asks for the front, and a session that is begun after
// it is not what was left.
TEST_F(ResumeOfferTest, ASessionThatIsBegunSinceIsNotWhatWasLeft) {
  std::optional<recording::RecordingLock> elsewhere(cut_off_operation());
  offer_.open(model_, killed_.path(), false, "");
  ASSERT_TRUE(has_looked());
  const recording::RecordingLock next(cut_off_operation());
  elsewhere.reset();
  EXPECT_TRUE(becomes([&] { return offer_.of(bones::BoneKind::Femur) == nullptr; }, 60));
  EXPECT_FALSE(cut_off());
}

}  // namespace
}  // namespace arthronaut::navigate
