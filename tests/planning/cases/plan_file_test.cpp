// The plan on disk: of which mesh it is, and which version of it.
#include "planning/cases/plan_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <random>

#include "planning/bones/mesh_file.h"
#include "planning/bones/mesh_hash.h"
#include "planning/files/atomic_file.h"
#include "planning/files/json_document.h"
#include "planning/geometry/error.h"
#include "tests/message_of.h"
#include "tests/planning/geometry/shapes.h"
#include "tests/temporary_folder.h"

namespace arthronaut::cases {
namespace {

using bones::BoneKind;
using Outcome = PlanFit::Outcome;
using ::testing::HasSubstr;

Plan plan_with_diameter(double diameter_mm) {
  return {.tunnels = {{BoneKind::Femur,
                       {.bone = BoneKind::Femur, .entry_mm = {40, 0, 0}, .diameter_mm = diameter_mm}}}};
}

class PlanFile : public ::testing::Test {
 protected:
  void SetUp() override {
    save_case(folder_, {.name = "Knee",
                        .created_utc = "",
                        .bones = {{BoneKind::Femur, {.mesh = test::box({40, 30, 50}), .source = "made"}}},
                        .landmarks = {},
                        .plan = plan_with_diameter(9)});
  }
  test::TemporaryFolder temporary_;
  std::filesystem::path folder_ = temporary_ / "Knee.arthro";
};

// Hazard 21: the plan names its mesh, and another mesh in its place is noticed.
TEST_F(PlanFile, Hazard21PlanOnAnotherMeshIsNotValid) {
  const Case before = load_case(folder_);
  EXPECT_EQ(before.plan.mesh_sha256.at(BoneKind::Femur),
            bones::mesh_sha256(before.bones.at(BoneKind::Femur).mesh));
  EXPECT_EQ(plan_fit(before, BoneKind::Femur).outcome, Outcome::Fits);
  EXPECT_TRUE(plan_fits(before, BoneKind::Femur));

  auto other = test::box({40, 30, 50});
  other.vertices_mm[0].x() += 1e-9;
  bones::write_mesh_ply(mesh_file(folder_, BoneKind::Femur), other);
  const Case after = load_case(folder_);
  EXPECT_EQ(plan_fit(after, BoneKind::Femur).outcome, Outcome::OtherMesh);
  EXPECT_FALSE(plan_fits(after, BoneKind::Femur));
  EXPECT_THAT(plan_fit(after, BoneKind::Femur).reason, HasSubstr("another surface of the femur"));
  // Saving such a case does not make its plan valid.
  save_case(folder_, after);
  EXPECT_FALSE(plan_fits(load_case(folder_), BoneKind::Femur));
}

// Cases of before the hash open as they did, and get the hash when they are saved.
TEST_F(PlanFile, Hazard21AnOlderPlanGetsItsHashOnTheNextSave) {
  save_plan(folder_, plan_with_diameter(8));
  const Case older = load_case(folder_);
  EXPECT_EQ(plan_fit(older, BoneKind::Femur).outcome, Outcome::Unknown);
  EXPECT_TRUE(plan_fits(older, BoneKind::Femur));
  save_case(folder_, older);
  EXPECT_EQ(plan_fit(load_case(folder_), BoneKind::Femur).outcome, Outcome::Fits);
}

TEST_F(PlanFile, WithoutATunnelOrABoneThereIsNothingToFit) {
  Case knee = load_case(folder_);
  EXPECT_EQ(plan_fit(knee, BoneKind::Tibia).outcome, Outcome::NoPlan);
  knee.bones.clear();
  EXPECT_EQ(plan_fit(knee, BoneKind::Femur).outcome, Outcome::NoBone);
  EXPECT_FALSE(plan_fits(knee, BoneKind::Femur));
}

// Hazard 15: two processes on one plan. The second does not write over what the first one saved.
TEST_F(PlanFile, Hazard15APlanThatAnotherProcessChangedIsNotWrittenOver) {
  const Case opened = load_case(folder_);
  const pid_t child = ::fork();
  if (child == 0) {
    save_plan(folder_, plan_with_diameter(7));
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_THAT(test::message_of<InvalidInput>(
                  [&] { (void)save_plan_over(folder_, plan_with_diameter(10), opened.plan_version); }),
              HasSubstr("changed by another program"));
  EXPECT_EQ(load_case(folder_).plan.tunnels.at(BoneKind::Femur).diameter_mm, 7);
}

// Save upon save, each over the one before; a plan that was deleted is a change as well.
TEST_F(PlanFile, SavesOverItsOwnVersions) {
  std::string version = load_case(folder_).plan_version;
  for (const double diameter_mm : {9.5, 10.0, 9.5})
    version = save_plan_over(folder_, plan_with_diameter(diameter_mm), version);
  EXPECT_EQ(version, plan_version(folder_));
  EXPECT_EQ(load_case(folder_).plan.tunnels.at(BoneKind::Femur).diameter_mm, 9.5);
  std::filesystem::remove(folder_ / "plan.json");
  EXPECT_EQ(plan_version(folder_), "");
  EXPECT_THROW((void)save_plan_over(folder_, {}, version), InvalidInput);
  EXPECT_NO_THROW((void)save_plan_over(folder_, plan_with_diameter(8), ""));
}

// A plan keeps its name through a reading: what is exported and reported under it is found again.
TEST_F(PlanFile, ADirectionIsReadBackToTheBit) {
  std::mt19937 random(7);
  std::normal_distribution<double> any(0, 1);
  for (int i = 0; i < 1000; ++i) {
    Plan plan = plan_with_diameter(9);
    Eigen::Vector3d along;
    for (int axis = 0; axis < 3; ++axis) along[axis] = any(random);
    plan.tunnels.at(BoneKind::Femur).direction = along.normalized();
    EXPECT_EQ(plan_sha256(plan_from(files::as_text(to_json(plan)), "plan.json")), plan_sha256(plan));
  }
}

// Other programs' directions need not be of length 1.
TEST_F(PlanFile, ADirectionOfAnotherLengthIsNormalised) {
  Plan plan = plan_with_diameter(9);
  plan.tunnels.at(BoneKind::Femur).direction = {0, 3, 4};
  const Plan back = plan_from(files::as_text(to_json(plan)), "plan.json");
  EXPECT_NEAR((back.tunnels.at(BoneKind::Femur).direction - Eigen::Vector3d(0, 0.6, 0.8)).norm(), 0, 1e-12);
}

tunnels::Tunnel tunnel_of(norms::Bundle bundle, double x_mm) {
  return {.bone = BoneKind::Femur, .entry_mm = {x_mm, 0, 0}, .diameter_mm = 6, .bundle = bundle};
}

// What cases of one tunnel a bone are, they stay: to the byte, for the programs of before.
TEST_F(PlanFile, ASingleTunnelIsWrittenAsItAlwaysWas) {
  save_plan(folder_, plan_with_diameter(9.5));
  EXPECT_EQ(files::read_text(folder_ / "plan.json"), R"({
  "format": "arthronaut.plan",
  "version": 1,
  "tunnels": [
    {
      "bone": "femur",
      "entry_mm": [
        40.0,
        0.0,
        0.0
      ],
      "direction": [
        0.0,
        0.0,
        1.0
      ],
      "diameter_mm": 9.5
    }
  ]
}
)");
}

TEST_F(PlanFile, TwoBundlesComeBackAndOlderProgramsRefuseThem) {
  Plan plan;
  plan.put(tunnel_of(norms::Bundle::Posterolateral, 30), std::string(64, 'b'));
  plan.put(tunnel_of(norms::Bundle::Anteromedial, 40), std::string(64, 'a'));
  save_plan(folder_, plan);
  EXPECT_THAT(files::read_text(folder_ / "plan.json"), HasSubstr("\"version\": 2"));
  const Plan back = load_case(folder_).plan;
  ASSERT_EQ(back.of(BoneKind::Femur).size(), 2U);
  EXPECT_EQ(back.tunnels.at({BoneKind::Femur, norms::Bundle::Anteromedial}).entry_mm.x(), 40);
  EXPECT_EQ(back.tunnels.at({BoneKind::Femur, norms::Bundle::Posterolateral}).bundle,
            norms::Bundle::Posterolateral);
  EXPECT_EQ(back.mesh_sha256, plan.mesh_sha256);
  EXPECT_FALSE(back.tunnels.contains(BoneKind::Femur)) << "the bone alone is never one of two";
  EXPECT_EQ(plan_fit(load_case(folder_), BoneKind::Femur).outcome, Outcome::NoPlan);
}

// A single tunnel and those of bundles take each other's place, and the bundles stand beside each other.
TEST_F(PlanFile, ABoneHasASingleTunnelOrThoseOfBundles) {
  Plan plan = plan_with_diameter(9);
  plan.put(tunnel_of(norms::Bundle::Anteromedial, 40), "a");
  EXPECT_EQ(plan.of(BoneKind::Femur),
            (std::vector<tunnels::TunnelKey>{{BoneKind::Femur, norms::Bundle::Anteromedial}}));
  plan.put(tunnel_of(norms::Bundle::Posterolateral, 30), "b");
  EXPECT_EQ(plan.of(BoneKind::Femur).size(), 2U);
  plan.put(tunnel_of(norms::Bundle::Whole, 35), "c");
  EXPECT_EQ(plan.of(BoneKind::Femur), std::vector<tunnels::TunnelKey>{BoneKind::Femur});
  EXPECT_EQ(plan.mesh_sha256.size(), 1U);
}

TEST_F(PlanFile, RefusesBundlesThatContradictEachOther) {
  const auto with = [&](const std::string& first, const std::string& second) {
    const auto tunnel = [](const std::string& bundle) {
      return R"({"bone":"femur","entry_mm":[1,2,3],"direction":[0,0,1],"diameter_mm":6)" +
             (bundle.empty() ? "" : ",\"bundle\":\"" + bundle + "\"") + "}";
    };
    return test::message_of<InvalidInput>([&] {
      (void)plan_from(R"({"format":"arthronaut.plan","version":2,"tunnels":[)" + tunnel(first) + "," +
                          tunnel(second) + "]}",
                      "plan.json");
    });
  };
  EXPECT_THAT(with("", ""), HasSubstr("has two tunnels"));
  EXPECT_THAT(with("am", "am"), HasSubstr("has two tunnels of the same bundle"));
  EXPECT_THAT(with("am", ""), HasSubstr("beside a single tunnel"));
  EXPECT_THAT(with("", "pl"), HasSubstr("beside a single tunnel"));
  EXPECT_THAT(with("am", "posterior"), HasSubstr("must be single, am or pl"));
}

// No key, command or markups file gives a tunnel of 100 mm, or of a hair: a file with one is broken.
TEST_F(PlanFile, RefusesADiameterThatNoTunnelHas) {
  const auto with = [&](const char* diameter_mm) {
    return test::message_of<InvalidInput>([&] {
      (void)plan_from(
          R"({"format":"arthronaut.plan","version":1,"tunnels":[{"bone":"femur","entry_mm":[1,2,3],)"
          R"("direction":[0,0,1],"diameter_mm":)" +
              std::string(diameter_mm) + "}]}",
          "plan.json");
    });
  };
  EXPECT_THAT(with("100"), HasSubstr("tunnels[0].diameter_mm: is 100, must be 3 to 15"));
  EXPECT_THAT(with("0.001"), HasSubstr("must be 3 to 15"));
  EXPECT_THAT(with("0"), HasSubstr("diameter_mm"));
  EXPECT_THAT(with("NaN"), HasSubstr("plan.json"));
}

}  // namespace
}  // namespace arthronaut::cases
