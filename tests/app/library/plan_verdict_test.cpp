#include "app/library/plan_verdict.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planning/phantom/phantom_case.h"
#include "tests/temporary_folder.h"

namespace arthronaut::workstation_library {
namespace {

// What the list says of a plan is what Plan says of it, as the plan is now.
TEST(PlanVerdict, SaysWhatIsWrongInThePlan) {
  const test::TemporaryFolder folder;
  cases::Case knee = phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 3}), "Knee");
  cases::save_case(folder.path(), knee);
  EXPECT_FALSE(plan_verdict(folder.path()));  // nobody has looked
  const PlanVerdict good = judge_plan(knee);
  EXPECT_THAT(good.wrong, testing::IsEmpty());
  keep_plan_verdict(folder.path(), good);
  ASSERT_TRUE(plan_verdict(folder.path()));
  EXPECT_THAT(plan_verdict(folder.path())->wrong, testing::IsEmpty());

  // Out of the bone's side: along the wall instead of into it.
  tunnels::Tunnel& femoral = knee.plan.tunnels.at({bones::BoneKind::Femur});
  femoral.direction = femoral.direction.cross(Eigen::Vector3d::UnitZ()).normalized();
  const PlanVerdict bad = judge_plan(knee);
  ASSERT_THAT(bad.wrong, testing::Not(testing::IsEmpty()));
  EXPECT_THAT(bad.wrong.front(), testing::StartsWith("femur: "));
  keep_plan_verdict(folder.path(), bad);
  EXPECT_EQ(plan_verdict(folder.path())->wrong, bad.wrong);

  // Another plan since: what was found is of the one before.
  cases::save_case(folder.path(), knee);
  std::filesystem::last_write_time(
      folder / "plan.json", std::filesystem::last_write_time(folder / "plan.json") + std::chrono::seconds(2));
  EXPECT_FALSE(plan_verdict(folder.path()));
}

}  // namespace
}  // namespace arthronaut::workstation_library
