#include "app/library/plan_verdict.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/case/plan_model.h"
#include "app/library/case_thumbnail.h"
#include "planning/geometry/rigid_transform.h"
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
  const plan_review::TunnelVerdict good = judge_plan(knee, {});
  EXPECT_THAT(good.wrong, testing::IsEmpty());
  keep_plan_verdict(folder.path(), good);
  ASSERT_TRUE(plan_verdict(folder.path()));
  EXPECT_THAT(plan_verdict(folder.path())->wrong, testing::IsEmpty());

  // Out of the bone's side: along the wall instead of into it.
  tunnels::Tunnel& femoral = knee.plan.tunnels.at({bones::BoneKind::Femur});
  femoral.direction = femoral.direction.cross(Eigen::Vector3d::UnitZ()).normalized();
  const plan_review::TunnelVerdict bad = judge_plan(knee, {});
  ASSERT_THAT(bad.wrong, testing::Not(testing::IsEmpty()));
  EXPECT_THAT(bad.wrong.front(), testing::StartsWith("femur: "));
  keep_plan_verdict(folder.path(), bad);
  EXPECT_EQ(plan_verdict(folder.path())->wrong, bad.wrong);
  EXPECT_EQ(plan_verdict(folder.path())->look, bad.look);

  // Another plan since: what was found is of the one before.
  cases::save_case(folder.path(), knee);
  std::filesystem::last_write_time(
      folder / "plan.json", std::filesystem::last_write_time(folder / "plan.json") + std::chrono::seconds(2));
  EXPECT_FALSE(plan_verdict(folder.path()));
}

// The knee as it may lie in a scanner: turned about the leg's axis, without a landmark.
cases::Case turned_without_landmarks() {
  cases::Case knee = phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 3}), "Knee");
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(geometry::rad_from_deg(-50), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  for (auto& [kind, bone] : knee.bones)
    for (Eigen::Vector3d& vertex : bone.mesh.vertices_mm) vertex = turn * vertex;
  for (auto& [key, tunnel] : knee.plan.tunnels) {
    tunnel.entry_mm = turn * tunnel.entry_mm;
    tunnel.direction = turn * tunnel.direction;
  }
  knee.plan.mesh_sha256.clear();
  knee.landmarks.clear();
  knee.landmark_states.clear();
  return knee;
}

// The list of cases and Plan go by the same landmarks: by those that are proposed where the case has none.
TEST(PlanVerdict, IsThatOfPlanWhereTheCaseHasNoLandmarks) {
  const cases::Case good = turned_without_landmarks();
  EXPECT_THAT(judge_plan(good, {}).wrong, testing::IsEmpty());
  cases::Case flipped = good;  // out of the medial side and the tibia's back
  for (auto& [key, tunnel] : flipped.plan.tunnels) {
    tunnel.direction.x() = -tunnel.direction.x();
    tunnel.direction.y() = -tunnel.direction.y();
  }
  for (const cases::Case& knee : {good, flipped}) {
    const open_case::PlanModel plan(knee);
    std::vector<std::string> wrong;
    for (const auto& [key, tunnel] : knee.plan.tunnels)
      for (const std::string& words : tunnels::wrong_in_words(plan.checks(key)))
        wrong.push_back(tunnels::name_of(key) + ": " + words);
    EXPECT_EQ(judge_plan(knee, {}).wrong, wrong);
  }
  EXPECT_THAT(judge_plan(flipped, {}).wrong, testing::Not(testing::IsEmpty()));
}

// What was planned on another surface of the bone is wrong in Plan, whatever else the checks say.
TEST(PlanVerdict, SaysThatAPlanIsOfAnotherSurface) {
  cases::Case knee = phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 3}), "Knee");
  knee.plan.mesh_sha256[{bones::BoneKind::Tibia}] = std::string(64, 'a');
  EXPECT_THAT(judge_plan(knee, {}).wrong, testing::ElementsAre(testing::StartsWith("tibia: Bone: ")));
}

// Nothing that is to be looked at goes by as a plan that is fine: landmarks that nobody confirmed, the side.
TEST(PlanVerdict, IsNotFineWhileAnythingIsToBeLookedAt) {
  library::CaseRecord record;
  record.bones = record.planned = {bones::BoneKind::Femur, bones::BoneKind::Tibia};
  EXPECT_EQ(plan_in_words(record, nullptr), "femur and tibia planned; not checked yet");
  const auto unconfirmed = judge_plan(turned_without_landmarks(), {});
  EXPECT_FALSE(unconfirmed.is_fine());
  EXPECT_THAT(plan_in_words(record, &unconfirmed), testing::HasSubstr("femur and tibia planned; look: "));
  const cases::BoneDoubts doubts{{bones::BoneKind::Tibia, {cases::SideDoubt{.told = bones::Side::Left}}}};
  const auto other_side = judge_plan(turned_without_landmarks(), doubts);
  EXPECT_THAT(plan_in_words(record, &other_side),
              testing::HasSubstr("femur and tibia planned; wrong: Side: the fibula lies on the left"));
  record.planned.clear();
  const auto bones_alone = judge_plan(cases::Case(), doubts);
  EXPECT_THAT(plan_in_words(record, &bones_alone),
              testing::HasSubstr("no tunnel planned; wrong: Side: the fibula lies on the left"));
  EXPECT_EQ(plan_in_words(record, nullptr), "no tunnel planned");
  record.planned = record.bones;
  const plan_review::TunnelVerdict fine;
  EXPECT_EQ(plan_in_words(record, &fine), "femur and tibia planned");
}

// A case without landmarks is seen from the front in the list as well, whichever way the axes of its file
// lie.
TEST(CaseThumbnail, KnowsTheFrontOfBonesThatLieTurned) {
  const test::TemporaryFolder folder;
  cases::save_case(folder.path(), turned_without_landmarks());
  const cases::Case drawn = load_for_thumbnail(folder.path()).knee;
  const auto axes = landmarks::anatomical_axes(bones::BoneKind::Femur, drawn.side,
                                               drawn.landmarks.at(bones::BoneKind::Femur),
                                               drawn.bones.at(bones::BoneKind::Femur).mesh);
  const Eigen::Vector3d front =
      Eigen::AngleAxisd(geometry::rad_from_deg(-50), Eigen::Vector3d::UnitZ()) * -Eigen::Vector3d::UnitY();
  EXPECT_GT(axes.anterior.dot(front), 0.98);
}

}  // namespace
}  // namespace arthronaut::workstation_library
