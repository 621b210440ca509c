#include "planning/cases/case.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "planning/bones/mesh_file.h"
#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"
#include "tests/message_of.h"
#include "tests/planning/geometry/shapes.h"
#include "tests/temporary_folder.h"

namespace arthronaut::cases {
namespace {

using bones::BoneKind;
using test::message_of;
using ::testing::HasSubstr;

Case example() {
  return {.name = "Knie Müller \"links\"",
          .side = bones::Side::Left,
          .created_utc = "2026-01-31T12:00:00Z",
          .bones = {{BoneKind::Femur,
                     {.kind = BoneKind::Femur, .mesh = test::box({40, 30, 50}), .source = "femur.stl"}},
                    {BoneKind::Tibia,
                     {.kind = BoneKind::Tibia, .mesh = test::ellipsoid({35, 25, 60}, 2), .source = "CT"}}},
          .landmarks = {{BoneKind::Femur, {{"native_footprint", {40, 0.1, -1.0 / 3}}}}},
          .plan = {.tunnels = {{BoneKind::Femur,
                                {.bone = BoneKind::Femur,
                                 .entry_mm = {40, 1e-3, 0.1},
                                 .direction = {-0.6, 0, 0.8},
                                 .diameter_mm = 8.5}}}}};
}

class CaseFolder : public ::testing::Test {
 protected:
  void SetUp() override { save_case(folder_, example()); }
  void overwrite(const std::string& name, const std::string& text) {
    files::write_atomically(folder_ / name, text);
  }
  void replace(const std::string& name, const std::string& what, const std::string& with) {
    std::string text = files::read_text(folder_ / name);
    const auto at = text.find(what);
    ASSERT_NE(at, std::string::npos) << what << " in " << text;
    overwrite(name, text.replace(at, what.size(), with));
  }
  [[nodiscard]] std::string refusal() const {
    return message_of<InvalidInput>([&] { (void)load_case(folder_); });
  }

  test::TemporaryFolder temporary_;
  std::filesystem::path folder_ = temporary_ / "Knee.arthro";
};

// A region of cartilage is part of the case only where it was declared, bone by bone; saving the case leaves
// it alone.
TEST_F(CaseFolder, KeepsTheCartilageOfABone) {
  EXPECT_FALSE(load_cartilage(folder_, BoneKind::Femur).has_value());
  const geometry::TriangleMesh patch = test::box({8, 3, 5});  // smaller than any bone
  save_cartilage(folder_, BoneKind::Femur, patch);
  save_case(folder_, example());
  ASSERT_TRUE(load_cartilage(folder_, BoneKind::Femur).has_value());
  EXPECT_EQ(load_cartilage(folder_, BoneKind::Femur)->vertices_mm, patch.vertices_mm);
  EXPECT_FALSE(load_cartilage(folder_, BoneKind::Tibia).has_value());
}

// Every bit of a case comes back: coordinates, marks, words with umlauts and quotes.
TEST_F(CaseFolder, ComesBackAsItWasSaved) {
  const Case saved = example(), loaded = load_case(folder_);
  EXPECT_EQ(loaded.name, saved.name);
  EXPECT_EQ(loaded.side, saved.side);
  EXPECT_EQ(loaded.created_utc, saved.created_utc);
  ASSERT_EQ(loaded.bones.size(), 2U);
  for (const auto& [kind, bone] : saved.bones) {
    EXPECT_EQ(loaded.bones.at(kind).mesh.vertices_mm, bone.mesh.vertices_mm);
    EXPECT_EQ(loaded.bones.at(kind).mesh.triangles, bone.mesh.triangles);
    EXPECT_EQ(loaded.bones.at(kind).source, bone.source);
  }
  EXPECT_EQ(loaded.landmarks, saved.landmarks);
  const auto& tunnel = loaded.plan.tunnels.at(BoneKind::Femur);
  EXPECT_EQ(tunnel.entry_mm, saved.plan.tunnels.at(BoneKind::Femur).entry_mm);
  EXPECT_LT((tunnel.direction - Eigen::Vector3d(-0.6, 0, 0.8)).norm(), 1e-15);
  EXPECT_EQ(tunnel.diameter_mm, 8.5);
}

// Saving the plan touches nothing else, and saving a case again does not write the meshes again.
TEST_F(CaseFolder, WritesOnlyWhatChanged) {
  const auto written = [&](const char* name) { return std::filesystem::last_write_time(folder_ / name); };
  const auto mesh = written("femur.ply"), description = written("case.json");
  Case changed = example();
  changed.plan.tunnels.clear();
  save_plan(folder_, changed.plan);
  EXPECT_EQ(written("case.json"), description);
  EXPECT_TRUE(load_case(folder_).plan.tunnels.empty());
  save_case(folder_, changed);
  EXPECT_EQ(written("femur.ply"), mesh);
  changed.bones.at(BoneKind::Femur).mesh.vertices_mm[0].x() += 0.5;
  save_case(folder_, changed);
  EXPECT_NE(load_case(folder_).bones.at(BoneKind::Femur).mesh.vertices_mm[0].x(), -40);
}

// Every refusal names the file, the place and the reason.
// Of which study the bones are is no reason to keep a surgeon from them.
TEST_F(CaseFolder, OpensWhateverIsWrongWithItsStudy) {
  overwrite("study.json", "{ broken");
  const Case opened = load_case(folder_);
  EXPECT_EQ(opened.bones.size(), 2U);
  EXPECT_FALSE(opened.is_of_two_frames);
}

TEST_F(CaseFolder, RefusesANewerVersion) {
  replace("case.json", "\"version\": 1", "\"version\": 2");
  EXPECT_THAT(refusal(), ::testing::AllOf(HasSubstr("case.json"), HasSubstr("version"), HasSubstr("2")));
}
TEST_F(CaseFolder, RefusesANewerPlan) {
  replace("plan.json", "\"version\": 1", "\"version\": 7");
  EXPECT_THAT(refusal(), ::testing::AllOf(HasSubstr("plan.json"), HasSubstr("version")));
}
TEST_F(CaseFolder, RefusesAnotherFormat) {
  replace("plan.json", "arthronaut.plan", "arthronaut.camera");
  EXPECT_THAT(refusal(), ::testing::AllOf(HasSubstr("plan.json"), HasSubstr("format")));
}
TEST_F(CaseFolder, RefusesHalfAFile) {
  const std::string text = files::read_text(folder_ / "plan.json");
  for (const std::size_t length : {std::size_t{0}, text.size() / 3, text.size() - 3}) {
    overwrite("plan.json", text.substr(0, length));
    EXPECT_THAT(refusal(), HasSubstr("plan.json"));
  }
}
TEST_F(CaseFolder, RefusesNumbersThatAreNone) {
  replace("plan.json", "8.5", "1e999");
  EXPECT_THAT(refusal(), HasSubstr("plan.json"));
}
TEST_F(CaseFolder, RefusesAZeroDirection) {
  replace("plan.json", "-0.6", "0.0");
  replace("plan.json", "0.8", "0.0");
  EXPECT_THAT(refusal(), ::testing::AllOf(HasSubstr("plan.json"), HasSubstr("direction"), HasSubstr("zero")));
}
TEST_F(CaseFolder, RefusesAThirdSide) {
  replace("case.json", "\"left\"", "\"middle\"");
  EXPECT_THAT(refusal(), ::testing::AllOf(HasSubstr("case.json"), HasSubstr("side")));
}
TEST_F(CaseFolder, RefusesABrokenMesh) {
  std::filesystem::resize_file(folder_ / "tibia.ply", 400);
  EXPECT_THAT(refusal(), HasSubstr("tibia.ply"));
}

// A folder that is no case, or has lost a mesh, is said to be so.
TEST_F(CaseFolder, NamesWhatIsMissing) {
  EXPECT_THAT(message_of<IoError>([&] { (void)load_case(temporary_ / "nothing"); }),
              HasSubstr("not a case folder"));
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)load_case(temporary_.path()); }),
              HasSubstr("no case.json"));
  std::filesystem::remove(folder_ / "femur.ply");
  EXPECT_THAT(message_of<IoError>([&] { (void)load_case(folder_); }), HasSubstr("femur.ply"));
}

// A case without a plan is a case: that is how imports begin.
TEST_F(CaseFolder, NeedsNoPlan) {
  std::filesystem::remove(folder_ / "plan.json");
  EXPECT_TRUE(load_case(folder_).plan.tunnels.empty());
}

// Sessions begun within one second still have folders of their own, and sort in the order of their making.
TEST_F(CaseFolder, GivesEverySessionItsFolder) {
  EXPECT_TRUE(session_folders(folder_).empty());
  std::vector<std::filesystem::path> made;
  for (int i = 0; i < 12; ++i) made.push_back(create_session_folder(folder_));
  EXPECT_EQ(session_folders(folder_), made);
}

// What the operating system refuses reaches the caller as such.
TEST_F(CaseFolder, ReportsWhereItCannotWrite) {
  files::write_atomically(temporary_ / "file", std::string_view("not a folder"));
  EXPECT_THROW(save_case(temporary_ / "file", example()), IoError);
  EXPECT_THROW(save_plan(temporary_ / "absent", {}), IoError);
}

}  // namespace
}  // namespace arthronaut::cases
