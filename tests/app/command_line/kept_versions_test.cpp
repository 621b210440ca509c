// What a plan was before: kept by plan, listed, named, taken again.
#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "planning/cases/plan_versions.h"
#include "planning/files/atomic_file.h"
#include "tests/app/command_line/plan_command.h"

namespace arthronaut {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

// A default takes the place of a plan that may be an evening's work, and no undo follows a command: it is
// kept, once, and said; what is new takes nothing's place.
TEST_F(PlanCommand, KeepsWhatADefaultTakesThePlaceOf) {
  const tunnels::Tunnel by_hand = knee_.plan.tunnels.at(bones::BoneKind::Femur);
  const auto first = run({"plan", "--bone", "femur", "--default"});
  EXPECT_THAT(first.output, HasSubstr("kept as version 1, --take 1 brings it back"));
  EXPECT_THAT(first.output, HasSubstr("femur: turned by "));
  EXPECT_THAT(first.output, HasSubstr("default    at the native footprint ["));
  EXPECT_THAT(run({"plan", "--bone", "femur", "--default"}).output, Not(HasSubstr("kept as version")));
  EXPECT_EQ(run({"plan", "--take", "1"}).exit_code, 0);
  const auto taken = cases::load_case(folder_ / "knee.arthro").plan.tunnels.at(bones::BoneKind::Femur);
  EXPECT_LT((taken.entry_mm - by_hand.entry_mm).norm(), 1e-6);
  const auto again = run({"plan", "--bone", "femur", "--default", "--json"});
  EXPECT_EQ(nlohmann::json::parse(again.output).at("kept_version"), 1) << "it is a version already";
  EXPECT_EQ(cases::load_plan_versions(folder_ / "knee.arthro").size(), 2U)
      << "the default, too, when 1 was taken";
}

// Of a version and of markups the bone that is named is taken, and the other one's tunnel stays.
TEST_F(PlanCommand, TakesTheBoneThatIsNamedAlone) {
  using bones::BoneKind;
  const auto plan = [&] { return cases::load_case(folder_ / "knee.arthro").plan; };
  const cases::Plan first = plan();
  EXPECT_EQ(run({"plan", "--keep", "--export", folder_ / "out"}).exit_code, 0);
  for (const char* bone : {"femur", "tibia"})
    EXPECT_LE(run({"plan", "--bone", bone, "--default"}).exit_code, 4);
  const cases::Plan second = plan();
  const auto off_mm = [](const cases::Plan& a, const cases::Plan& b, BoneKind bone) {
    return (a.tunnels.at(bone).entry_mm - b.tunnels.at(bone).entry_mm).norm() +
           (a.tunnels.at(bone).direction - b.tunnels.at(bone).direction).norm();
  };
  for (const BoneKind bone : {BoneKind::Femur, BoneKind::Tibia}) ASSERT_GT(off_mm(first, second, bone), 0.01);
  EXPECT_LE(run({"plan", "--bone", "femur", "--take", "1"}).exit_code, 4);
  EXPECT_LT(off_mm(plan(), first, BoneKind::Femur), 1e-6);
  EXPECT_LT(off_mm(plan(), second, BoneKind::Tibia), 1e-6);
  EXPECT_LE(run({"plan", "--bone", "tibia", "--from-markups", folder_ / "out/plan.mrk.json"}).exit_code, 4);
  EXPECT_LT(off_mm(plan(), first, BoneKind::Tibia), 1e-3);
  EXPECT_EQ(run({"plan", "--take", "1", "--type", "am"}).exit_code, 2);
}

// So is what any other command takes the place of: a tunnel placed by numbers, taken from markups, removed, a
// version taken again.
TEST_F(PlanCommand, KeepsWhatAnyCommandTakesThePlaceOf) {
  const std::vector<std::string> placed{"plan",        "--bone",          "femur",         "--at-footprint",
                                        "--direction", "-0.83,-0.3,0.41", "--diameter-mm", "8"};
  EXPECT_THAT(run(placed).output, HasSubstr("kept as version 1, --take 1 brings it back"));
  EXPECT_THAT(run({"plan", "--take", "1"}).output, HasSubstr("kept as version 2, --take 2 brings it back"));
  EXPECT_EQ(run({"plan", "--export", folder_ / "out"}).exit_code, 0);
  EXPECT_THAT(run({"plan", "--bone", "femur", "--remove"}).output, HasSubstr("kept as version 1"))
      << "which is the same";
  EXPECT_EQ(run(placed).exit_code, 0);
  EXPECT_EQ(run({"plan", "--take", "2"}).exit_code, 0);
  EXPECT_THAT(run({"plan", "--from-markups", folder_ / "out/plan.mrk.json"}).output,
              Not(HasSubstr("kept as version 3")));
  const auto versions = cases::load_plan_versions(folder_ / "knee.arthro");
  ASSERT_EQ(versions.size(), 2U);
  EXPECT_NEAR(versions[1].plan.tunnels.at(bones::BoneKind::Femur).diameter_mm, 8, 1e-9);
}

// What a newer program says against a bone cannot be read: the plan that is there stays, and no version of it
// is kept for nothing.
TEST_F(PlanCommand, WhatCannotBeReadLeavesThePlan) {
  std::ofstream(folder_ / "knee.arthro/bone_doubts.json")
      << R"({"format": "arthronaut.bone_doubts", "version": 99})";
  const std::string plan = files::read_text(folder_ / "knee.arthro/plan.json");
  const auto result = run({"plan", "--bone", "femur", "--default"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.errors, HasSubstr("bone_doubts.json"));
  EXPECT_EQ(files::read_text(folder_ / "knee.arthro/plan.json"), plan);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "knee.arthro/plan_versions"));
}

// Kept, changed, compared, taken again.
TEST_F(PlanCommand, VersionsAreKeptComparedAndTaken) {
  EXPECT_THAT(run({"plan", "--versions"}).output, HasSubstr("No version is kept"));
  EXPECT_EQ(run({"plan", "--keep"}).exit_code, 0);
  EXPECT_EQ(run({"plan", "--bone", "tibia", "--default"}).exit_code, 0);
  const auto listed = run({"plan", "--versions"});
  EXPECT_THAT(listed.output, HasSubstr("femur: the same"));
  EXPECT_THAT(listed.output, HasSubstr("tibia: turned by "));
  EXPECT_EQ(
      run({"plan", "--name-version", "1", "--name", "first", "--note", "before the resident"}).exit_code, 0);
  EXPECT_THAT(run({"plan", "--versions"}).output,
              AllOf(HasSubstr("Version 1, \"first\", kept "), HasSubstr("of a right knee"),
                    HasSubstr("\"before the resident\"")));
  EXPECT_EQ(run({"plan", "--name-version", "7", "--name", "x"}).exit_code, 3);
  EXPECT_EQ(run({"plan", "--name", "x"}).exit_code, 2) << "of no version";
  const auto unknown = run({"plan", "--take", "7"});
  EXPECT_EQ(unknown.exit_code, 3);
  EXPECT_THAT(unknown.errors, HasSubstr("no version 7"));
  EXPECT_EQ(run({"plan", "--take", "1"}).exit_code, 0);
  const auto taken = cases::load_case(folder_ / "knee.arthro").plan.tunnels.at(bones::BoneKind::Tibia);
  EXPECT_LT((taken.entry_mm - knee_.plan.tunnels.at(bones::BoneKind::Tibia).entry_mm).norm(), 1e-6);
}

}  // namespace
}  // namespace arthronaut
