#include "planning/cases/plan_versions.h"

#include <gtest/gtest.h>

#include <fstream>

#include "planning/files/atomic_file.h"
#include "planning/files/private_folder.h"
#include "planning/geometry/error.h"
#include "tests/temporary_folder.h"

namespace arthronaut::cases {
namespace {

using bones::BoneKind;
using Kind = TunnelDifference::Kind;

class PlanVersions : public ::testing::Test {
 protected:
  PlanVersions() {
    plan_.tunnels[BoneKind::Femur] = {.bone = BoneKind::Femur,
                                      .entry_mm = {1.5, -2, 3},
                                      .direction = Eigen::Vector3d(-1, 1, 1).normalized(),
                                      .diameter_mm = 9};
    plan_.mesh_sha256[BoneKind::Femur] = std::string(64, 'a');
  }
  const test::TemporaryFolder folder_;
  Plan plan_;
};

// Each is kept as it was, with its time and the mesh that it names; a later one changes no earlier one.
TEST_F(PlanVersions, AreKeptInTheirOrder) {
  EXPECT_TRUE(load_plan_versions(folder_.path()).empty());
  EXPECT_EQ(keep_plan_version(folder_.path(), plan_).number, 1);
  Plan wider = plan_;
  wider.tunnels.at(BoneKind::Femur).diameter_mm = 10;
  const PlanVersion second = keep_plan_version(folder_.path(), wider);
  EXPECT_EQ(second.number, 2);
  const auto versions = load_plan_versions(folder_.path());
  ASSERT_EQ(versions.size(), 2U);
  EXPECT_EQ(versions[1].kept_utc, second.kept_utc);
  EXPECT_EQ(versions[0].plan.mesh_sha256, plan_.mesh_sha256);
  for (const auto& difference : compare_plans(plan_, versions[0].plan))
    EXPECT_EQ(difference.kind, Kind::Same);
  EXPECT_DOUBLE_EQ(versions[1].plan.tunnels.at(BoneKind::Femur).diameter_mm, 10);
}

// A number is never given twice, even where the versions before it are gone.
TEST_F(PlanVersions, ANumberIsNeverGivenTwice) {
  for (int i = 0; i < 11; ++i) (void)keep_plan_version(folder_.path(), plan_);
  std::filesystem::remove(folder_ / "plan_versions" / "3.json");
  EXPECT_EQ(keep_plan_version(folder_.path(), plan_).number, 12);
  EXPECT_EQ(load_plan_versions(folder_.path()).size(), 11U);
  EXPECT_EQ(load_plan_versions(folder_.path()).back().number, 12);
}

// A name and a note come with it, are changed without touching the plan, and stand in no way of it.
TEST_F(PlanVersions, HaveANameANoteAndASide) {
  (void)keep_plan_version(folder_.path(), plan_);
  (void)keep_plan_version(folder_.path(), plan_, bones::Side::Left, {"wider", "for a thick graft"});
  auto versions = load_plan_versions(folder_.path());
  EXPECT_EQ(versions[0].title(), "Version 1");
  EXPECT_EQ(versions[1].title(), "Version 2, \"wider\"");
  EXPECT_EQ(versions[1].words.note, "for a thick graft");
  EXPECT_EQ(side_refusal(versions[1], bones::Side::Left), "");
  EXPECT_EQ(side_refusal(versions[1], bones::Side::Right),
            "Version 2, \"wider\" was planned in a left knee, the case is a right one");
  EXPECT_EQ(side_refusal(versions[0], bones::Side::Right), "") << "nobody knows";
  say_of_version(folder_.path(), 1, {"narrow \u00e4", ""});
  say_of_version(folder_.path(), 2, {});
  const auto said = load_plan_versions(folder_.path());
  EXPECT_EQ(said[0].title(), "Version 1, \"narrow \u00e4\"");
  EXPECT_EQ(said[0].kept_utc, versions[0].kept_utc);
  EXPECT_EQ(said[1].words, VersionWords{});
  EXPECT_EQ(said[1].side, bones::Side::Left);
  for (const auto& difference : compare_plans(plan_, said[1].plan)) EXPECT_EQ(difference.kind, Kind::Same);
  EXPECT_THROW(say_of_version(folder_.path(), 3, {}), InvalidInput);
  EXPECT_THROW(say_of_version(folder_.path(), 1, {std::string(61, 'a'), ""}), InvalidInput);
}

TEST_F(PlanVersions, ArePrivateAsTheCaseIs) {
  (void)keep_plan_version(folder_.path(), plan_);
  EXPECT_TRUE(files::is_private(folder_ / "plan_versions"));
}

TEST_F(PlanVersions, BrokenOnesNameTheirFile) {
  (void)keep_plan_version(folder_.path(), plan_);
  std::ofstream(folder_ / "plan_versions" / "1.json") << "{";
  try {
    (void)load_plan_versions(folder_.path());
    FAIL() << "half a file was read";
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("1.json"), std::string::npos);
  }
  EXPECT_THROW((void)keep_plan_version(folder_.path(), Plan{}), InvalidInput);
}

// By construction: the entry moved by 3 and 4 mm across, the direction turned by 90 degrees.
TEST_F(PlanVersions, AreComparedTunnelByTunnel) {
  Plan other = plan_;
  tunnels::Tunnel& moved = other.tunnels.at(BoneKind::Femur);
  moved.entry_mm += Eigen::Vector3d(3, 4, 0);
  moved.direction = Eigen::Vector3d(1, 1, 0).normalized();
  moved.diameter_mm = 8.5;
  other.tunnels[BoneKind::Tibia] = moved;
  const auto differences = compare_plans(plan_, other);
  ASSERT_EQ(differences.size(), 2U);
  EXPECT_EQ(differences[0].kind, Kind::Moved);
  EXPECT_DOUBLE_EQ(differences[0].entry_mm, 5);
  EXPECT_NEAR(differences[0].angle_deg, 90, 1e-9);
  EXPECT_DOUBLE_EQ(differences[0].diameter_mm, -0.5);
  EXPECT_EQ(differences[0].in_words(), "femur: entry 5.0 mm off, turned by 90.0 deg, 0.5 mm narrower");
  EXPECT_EQ(differences[1].kind, Kind::OnlyThere);
  EXPECT_EQ(compare_plans(other, plan_)[1].kind, Kind::OnlyHere);
}

}  // namespace
}  // namespace arthronaut::cases
