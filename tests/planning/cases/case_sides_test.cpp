#include "planning/cases/case_sides.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <random>
#include <thread>

#include "planning/cases/case_lock.h"
#include "planning/cases/plan_versions.h"
#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"
#include "tests/message_of.h"
#include "tests/planning/geometry/shapes.h"
#include "tests/temporary_folder.h"

namespace arthronaut::cases {
namespace {

using bones::BoneKind;
using bones::Side;
using ::testing::HasSubstr;

Plan plan_at(double x_mm) {
  return {.tunnels = {{BoneKind::Femur, {.entry_mm = {x_mm, 0, 0}, .diameter_mm = 9}}}};
}

Case right_knee() {
  Case knee;
  knee.name = "A knee";
  knee.bones[BoneKind::Femur] = {
      .kind = BoneKind::Femur, .mesh = test::ellipsoid({40, 30, 50}, 3), .source = "made"};
  knee.landmarks[BoneKind::Femur] = {{"a", {1, 2, 3}}};
  knee.landmark_states[BoneKind::Femur] = {{"a", landmarks::LandmarkState::Confirmed}};
  knee.plan = plan_at(10);
  return knee;
}

SideContents left_contents() {
  return {.landmarks = {{BoneKind::Femur, {{"b", {4, 5, 6}}}}},
          .landmark_states = {{BoneKind::Femur, {{"b", landmarks::LandmarkState::Proposed}}}},
          .plan = plan_at(-10),
          .doubts = {{BoneKind::Femur, {"look"}}}};
}

bool is_planned_at(const Plan& plan, double x_mm) {
  return plan.tunnels.size() == 1 && plan.tunnels.at(BoneKind::Femur).entry_mm.x() == x_mm;
}

// There and back: nothing of the one side is among what the other one has, and nothing is lost.
TEST(CaseSides, WhatIsOfOneSideIsBackWithIt) {
  const test::TemporaryFolder folder;
  const Case before = right_knee();
  save_case(folder.path(), before);
  save_bone_doubts(folder.path(), {{BoneKind::Femur, {"too short"}}});
  EXPECT_FALSE(load_side(folder.path(), before, Side::Left));
  change_side(folder.path(), Side::Left, left_contents());
  const Case left = load_case(folder.path());
  EXPECT_EQ(left.side, Side::Left);
  EXPECT_EQ(left.landmarks, left_contents().landmarks);
  EXPECT_EQ(left.landmark_states, left_contents().landmark_states);
  EXPECT_TRUE(is_planned_at(left.plan, -10));
  EXPECT_EQ(load_bone_doubts(folder.path()), left_contents().doubts);
  const auto kept = load_side(folder.path(), left, Side::Right);
  ASSERT_TRUE(kept);
  change_side(folder.path(), Side::Right, *kept);
  const Case back = load_case(folder.path());
  EXPECT_EQ(back.side, Side::Right);
  EXPECT_EQ(back.landmarks, before.landmarks);
  EXPECT_EQ(back.landmark_states, before.landmark_states);
  EXPECT_TRUE(is_planned_at(back.plan, 10));
  EXPECT_EQ(load_bone_doubts(folder.path()), (BoneDoubts{{BoneKind::Femur, {"too short"}}}));
  EXPECT_THROW(change_side(folder.path(), Side::Right, *kept), InvalidInput);
}

// Landmarks of a surface that is gone would lie beside the bone that came in its place.
TEST(CaseSides, LandmarksOfAnotherMeshAreNotBroughtBack) {
  const test::TemporaryFolder folder;
  save_case(folder.path(), right_knee());
  change_side(folder.path(), Side::Left, {});
  Case other = load_case(folder.path());
  other.bones[BoneKind::Femur].mesh.vertices_mm[0].x() += 1;
  save_case(folder.path(), other);
  const auto kept = load_side(folder.path(), other, Side::Right);
  ASSERT_TRUE(kept);
  EXPECT_TRUE(kept->landmarks.empty());
  other.plan = kept->plan;
  EXPECT_FALSE(plan_fits(other, BoneKind::Femur));
}

// A process that is killed while it changes the side: nobody who reads the case finds the plan or the
// landmarks of one side in a knee of the other, and who takes the case next has the change whole, or none of
// it.
TEST(CaseSides, Hazard52AfterAKillTheCaseIsWhollyOfOneSide) {
  const test::TemporaryFolder temporary;
  const auto folder = temporary / "Knee.arthro";
  std::mt19937 random(20260103);
  std::uniform_int_distribution<int> delay_us(0, 12000);
  int cut_off = 0;
  for (int i = 0; i < 60; ++i) {
    std::filesystem::remove_all(folder);
    save_case(folder, right_knee());
    const pid_t child = ::fork();
    if (child == 0) {
      change_side(folder, Side::Left, left_contents());
      ::_exit(0);
    }
    std::this_thread::sleep_for(std::chrono::microseconds(delay_us(random)));
    ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
    const Case found = load_case(folder);
    const bool is_left = found.side == Side::Left;
    EXPECT_TRUE(found.plan.tunnels.empty() || is_planned_at(found.plan, is_left ? -10 : 10));
    EXPECT_EQ(found.landmarks.at(BoneKind::Femur).contains("b"), is_left);
    const CaseLock lock(folder);
    ASSERT_TRUE(lock.is_held()) << lock.refusal();
    const Case taken = load_case(folder);
    const bool is_left_now = taken.side == Side::Left;
    EXPECT_TRUE(is_planned_at(taken.plan, is_left_now ? -10 : 10));
    EXPECT_EQ(taken.landmarks.at(BoneKind::Femur).contains("b"), is_left_now);
    EXPECT_EQ(load_bone_doubts(folder).empty(), !is_left_now);
    cut_off += static_cast<int>(is_left_now && WIFSIGNALED(status));
  }
  EXPECT_GT(cut_off, 0) << "no change was ever cut off: the delays are of no use";
}

// What was kept before sides were written down is of the side that the case had.
TEST(CaseSides, KeptVersionsAreOfTheSideThatTheCaseHad) {
  const test::TemporaryFolder folder;
  save_case(folder.path(), right_knee());
  (void)keep_plan_version(folder.path(), plan_at(5), std::nullopt);
  change_side(folder.path(), Side::Left, left_contents());
  (void)keep_plan_version(folder.path(), plan_at(-5), Side::Left);
  const auto versions = load_plan_versions(folder.path());
  ASSERT_EQ(versions.size(), 2U);
  EXPECT_EQ(versions[0].side, Side::Right);
  EXPECT_NE(side_refusal(versions[0], Side::Left), "");
  EXPECT_EQ(versions[1].side, Side::Left);
}

// A change that could not be made, as on a full disk, and that waits in the file: whoever went on with the
// side that the case has keeps what was planned since.
TEST(CaseSides, AChangeThatFailedTakesNothingThatWasDoneSince) {
  const test::TemporaryFolder folder;
  save_case(folder.path(), right_knee());
  change_side(folder.path(), Side::Left, left_contents());
  std::string waiting = files::read_text(sides_file(folder.path()));
  const std::string before = "\"sides\":";
  ASSERT_NE(waiting.find(before), std::string::npos);
  waiting.insert(waiting.find(before), "\"changing_to\": \"right\", ");
  files::write_atomically(sides_file(folder.path()), waiting);
  Case since = load_case(folder.path());
  ASSERT_EQ(since.side, Side::Left);
  since.plan.tunnels.begin()->second.entry_mm.x() = -33;
  save_plan(folder.path(), since.plan);
  const CaseLock lock(folder.path());
  ASSERT_TRUE(lock.is_held()) << lock.refusal();
  const Case found = load_case(folder.path());
  EXPECT_EQ(found.side, Side::Left);
  EXPECT_TRUE(is_planned_at(found.plan, -33));
  EXPECT_EQ(files::read_text(sides_file(folder.path())).find("changing_to"), std::string::npos);
}

TEST(CaseSides, AFileThatIsNoneIsRefusedByPlace) {
  const test::TemporaryFolder folder;
  files::write_atomically(
      sides_file(folder.path()),
      R"({"format": "arthronaut.sides", "version": 1, "changing_to": "left", "sides": []})");
  EXPECT_THAT(
      test::message_of<InvalidInput>([&] { (void)load_side(folder.path(), right_knee(), Side::Left); }),
      HasSubstr("sides.json: changing_to"));
}

}  // namespace
}  // namespace arthronaut::cases
