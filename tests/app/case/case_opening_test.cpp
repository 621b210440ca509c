#include "app/case/case_opening.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <memory>
#include <set>
#include <thread>

#include "planning/cases/bone_doubts.h"
#include "planning/files/atomic_file.h"
#include "planning/phantom/phantom_case.h"
#include "tests/temporary_folder.h"

namespace arthronaut::open_case {
namespace {

// As the window asks once a frame; returns how often it was told that the case has just become open.
int take_until_done(CaseOpening& opening) {
  int count = 0;
  while (opening.is_busy()) {
    count += opening.take() ? 1 : 0;
    std::this_thread::yield();
  }
  return count + (opening.take() ? 1 : 0);
}

// A case is taken over once, and what ends the opening wakes the window.
TEST(CaseOpening, GivesTheCaseOnce) {
  const test::TemporaryFolder folder;
  phantom::PhantomOptions coarse;
  coarse.edge_length_mm = 4;
  cases::save_case(folder.path(), phantom::case_of(phantom::make_phantom_knee(coarse), "test"));
  std::atomic<int> ends = 0;
  CaseOpening opening(folder.path(), [&ends] { ++ends; });
  EXPECT_EQ(take_until_done(opening), 1);
  EXPECT_EQ(ends, 1);
  ASSERT_NE(opening.model(), nullptr);
  EXPECT_EQ(opening.model()->knee().name, "test");
  EXPECT_EQ(opening.folder(), folder.path());
  EXPECT_EQ(opening.failure(), "");
}

// The model knows from the start where the images end within a bone; doubts that nobody can read keep no case
// from being opened.
TEST(CaseOpening, Hazard46KnowsWhereTheImagesEnd) {
  using Verdict = tunnels::PlanCheck::Verdict;
  const test::TemporaryFolder folder;
  const cases::Case knee = phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "test");
  cases::save_case(folder.path(), knee);
  const tunnels::Tunnel& tunnel = knee.plan.tunnels.at(bones::BoneKind::Femur);
  cases::save_bone_doubts(
      folder.path(),
      {{bones::BoneKind::Femur,
        {bones::ImageCut{
            .at_mm = tunnel.entry_mm + 10 * tunnel.direction, .out = tunnel.direction, .area_mm2 = 500}}}});
  const auto length = [&] {
    CaseOpening opening(folder.path(), [] {});
    EXPECT_EQ(take_until_done(opening), 1) << opening.failure();
    return opening.model()->checks(bones::BoneKind::Femur).front();
  };
  EXPECT_EQ(length().name, "Length");
  EXPECT_EQ(length().verdict, Verdict::NotChecked);
  files::write_atomically(cases::bone_doubts_file(folder.path()), "{");
  EXPECT_EQ(length().verdict, Verdict::Fine);
  CaseOpening unread(folder.path(), [] {});
  EXPECT_EQ(take_until_done(unread), 1) << unread.failure();
  const auto& checks = unread.model()->checks(bones::BoneKind::Femur);
  const auto seen = std::ranges::find(checks, "Seen bone", &tunnels::PlanCheck::name);
  ASSERT_NE(seen, checks.end()) << "that nobody knows where they end";
  EXPECT_EQ(seen->verdict, Verdict::NotChecked);
}

// One that cannot be opened says why, and the window is woken all the same.
TEST(CaseOpening, SaysWhyACaseCannotBeOpened) {
  const test::TemporaryFolder folder;
  std::atomic<int> ends = 0;
  CaseOpening opening(folder.path() / "absent.arthro", [&ends] { ++ends; });
  EXPECT_EQ(take_until_done(opening), 0);
  EXPECT_EQ(ends, 1);
  EXPECT_EQ(opening.model(), nullptr);
  EXPECT_NE(opening.failure().find("absent.arthro"), std::string::npos) << opening.failure();
}

// A large case takes seconds: how far it is never goes back, and ends where the case is open.
TEST(CaseOpening, TellsHowFarItIs) {
  const test::TemporaryFolder folder;
  cases::Case knee = phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 3}), "test");
  knee.landmarks.clear();  // they are proposed, which takes longest
  cases::save_case(folder.path(), knee);
  CaseOpening opening(folder.path(), [] {});
  std::set<double> told;
  double before = 0;
  while (!opening.take() && opening.is_busy()) {
    EXPECT_GE(opening.done_fraction(), before);
    told.insert(before = opening.done_fraction());
    std::this_thread::yield();
  }
  ASSERT_NE(opening.model(), nullptr) << opening.failure();
  EXPECT_EQ(opening.done_fraction(), 1);
  EXPECT_GE(told.size(), 3U);
}

// What is not wanted any more is neither a case nor a failure, ends soon, and holds no lock.
TEST(CaseOpening, OneThatIsCancelledIsNoCaseAndNoFailure) {
  const test::TemporaryFolder folder;
  cases::Case knee = phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 2}), "test");
  knee.landmarks.clear();
  cases::save_case(folder.path(), knee);
  {
    CaseOpening opening(folder.path(), [] {});
    while (opening.done_fraction() == 0) std::this_thread::yield();
    opening.cancel();
    EXPECT_EQ(take_until_done(opening), 0);
    EXPECT_LT(opening.done_fraction(), 1);
    EXPECT_EQ(opening.model(), nullptr);
    EXPECT_EQ(opening.failure(), "");
  }
  CaseOpening again(folder.path(), [] {});
  EXPECT_EQ(take_until_done(again), 1);
  EXPECT_FALSE(again.is_read_only());
}

// One case lends its lock to the next opening: cancelled, that gives it back.
TEST(CaseOpening, Hazard15ACancelledOpeningGivesTheLockBack) {
  const test::TemporaryFolder folder;
  cases::save_case(folder.path(),
                   phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "test"));
  CaseOpening first(folder.path(), [] {});
  ASSERT_EQ(take_until_done(first), 1);
  CaseOpening again(first, [] {});
  again.cancel();
  EXPECT_EQ(take_until_done(again), 0);
  first.keep_lock(again);
  EXPECT_FALSE(first.is_read_only());
  CaseOpening other(folder.path(), [] {});
  EXPECT_EQ(take_until_done(other), 1);
  EXPECT_TRUE(other.is_read_only());
}

// That a case was left behind by a program that died is news, and no state of the case.
TEST(CaseOpening, SaysForAMinuteThatTheCaseWasTakenOver) {
  const test::TemporaryFolder folder;
  cases::save_case(folder.path(),
                   phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "test"));
  if (const pid_t other = ::fork(); other == 0) {
    const cases::CaseLock lock(folder.path());
    ::_exit(0);  // the lock is not let go
  } else {
    ::waitpid(other, nullptr, 0);
  }
  CaseOpening opening(folder.path(), [] {});
  ASSERT_EQ(take_until_done(opening), 1);
  const auto now = CaseOpening::Clock::now();
  EXPECT_NE(opening.notice(now).find("Taken over"), std::string::npos);
  EXPECT_NE(opening.notice(now + std::chrono::seconds(50)), "");
  EXPECT_EQ(opening.notice(now + std::chrono::seconds(61)), "");
}

// Hazard 15: a case that is read-only stays so when it is opened again, and one that could not be opened
// again is still held.
TEST(CaseOpening, Hazard15OpeningAgainGivesNoRightToWrite) {
  const test::TemporaryFolder folder;
  cases::save_case(folder.path(),
                   phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "test"));
  CaseOpening first(folder.path(), [] {});
  CaseOpening second(folder.path(), [] {});
  ASSERT_EQ(take_until_done(first), 1);
  ASSERT_EQ(take_until_done(second), 1);
  CaseOpening& reader = first.is_read_only() ? first : second;
  CaseOpening& writer = first.is_read_only() ? second : first;
  CaseOpening read_again(reader, [] {});
  EXPECT_EQ(take_until_done(read_again), 1);
  EXPECT_TRUE(read_again.is_read_only());

  const auto aside = folder.path() / "aside.json";
  std::filesystem::rename(folder.path() / "case.json", aside);
  CaseOpening in_vain(writer, [] {});
  EXPECT_EQ(take_until_done(in_vain), 0);
  writer.keep_lock(in_vain);
  std::filesystem::rename(aside, folder.path() / "case.json");
  CaseOpening third(folder.path(), [] {});
  EXPECT_EQ(take_until_done(third), 1);
  EXPECT_TRUE(third.is_read_only());
}

// Hazard 15: two windows on one case. The second one opens, read-only, and says who has it; when the first is
// gone the next is free to write.
TEST(CaseOpening, Hazard15TheSecondOpensReadOnlyAndSaysWhoHolds) {
  const test::TemporaryFolder folder;
  cases::save_case(folder.path(),
                   phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "test"));
  {
    CaseOpening first(folder.path(), [] {});
    EXPECT_EQ(take_until_done(first), 1);
    EXPECT_FALSE(first.is_read_only());
    CaseOpening second(folder.path(), [] {});
    EXPECT_EQ(take_until_done(second), 1);
    ASSERT_NE(second.model(), nullptr);
    EXPECT_TRUE(second.is_read_only());
    EXPECT_NE(second.read_only_reason().find("is open elsewhere"), std::string::npos);
  }
  CaseOpening third(folder.path(), [] {});
  EXPECT_EQ(take_until_done(third), 1);
  EXPECT_FALSE(third.is_read_only());
}

// Hazard 15: whoever waits with the case on the screen may write once the other program is gone, and has then
// read what that one has left.
TEST(CaseOpening, Hazard15IsTakenOverWhenTheOtherOneIsGone) {
  const test::TemporaryFolder folder;
  cases::save_case(folder.path(),
                   phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "before"));
  auto first = std::make_unique<CaseOpening>(folder.path(), [] {});
  ASSERT_EQ(take_until_done(*first), 1);
  CaseOpening waits(folder.path(), [] {});
  ASSERT_EQ(take_until_done(waits), 1);
  ASSERT_TRUE(waits.is_read_only());
  EXPECT_FALSE(waits.take_when_free()) << "the other one is there";
  EXPECT_TRUE(waits.is_read_only());
  cases::save_case(folder.path(),
                   phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "after"));
  first.reset();
  EXPECT_TRUE(waits.take_when_free());
  EXPECT_FALSE(waits.take_when_free()) << "it has it";
  CaseOpening anew(waits, [] {});
  ASSERT_EQ(take_until_done(anew), 1);
  EXPECT_FALSE(anew.is_read_only());
  EXPECT_EQ(anew.model()->knee().name, "after");
}

// A case that is closed may take a second to go, while its landmarks are still in the making; whoever opens
// it anew meanwhile may write.
TEST(CaseOpening, ACaseThatIsBeingLetGoIsFreeToBeOpened) {
  const test::TemporaryFolder folder;
  cases::save_case(folder.path(),
                   phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "test"));
  CaseOpening closed(folder.path(), [] {});
  ASSERT_EQ(take_until_done(closed), 1);
  closed.release_lock();
  CaseOpening next(folder.path(), [] {});
  ASSERT_EQ(take_until_done(next), 1);
  EXPECT_FALSE(next.is_read_only()) << next.read_only_reason();
}

// Hazard 20: whose knee it is comes with the case.
TEST(CaseOpening, Hazard20GivesWhoseKneeItIs) {
  const test::TemporaryFolder folder;
  cases::save_case(folder.path(),
                   phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "test"));
  cases::save_identity(folder.path(), {"Muster^Anna", "4711", "19900131"});
  CaseOpening opening(folder.path(), [] {});
  EXPECT_EQ(take_until_done(opening), 1);
  ASSERT_TRUE(opening.identity().has_value());
  EXPECT_EQ(opening.identity()->in_words(), "Muster, Anna · 4711 · 1990-01-31");
}

}  // namespace
}  // namespace arthronaut::open_case
