#include "planning/plan_export/plan_export.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>

#include "planning/bones/mesh_file.h"
#include "planning/bones/mesh_repair.h"
#include "planning/cases/plan_file.h"
#include "planning/files/atomic_file.h"
#include "planning/files/csv_table.h"
#include "planning/files/sha256.h"
#include "planning/geometry/error.h"
#include "planning/geometry/rigid_transform.h"
#include "planning/phantom/phantom_case.h"
#include "planning/phantom/phantom_knee.h"
#include "planning/plan_export/drilled_bone.h"
#include "planning/plan_export/markups_file.h"
#include "tests/message_of.h"
#include "tests/planning/geometry/shapes.h"
#include "tests/planning/plan_export/exported_case.h"
#include "tests/temporary_folder.h"

namespace arthronaut::plan_export {
namespace {

using bones::BoneKind;
using Eigen::Vector3d;

TEST(PlanExport, WritesWhatIsReadBackTheSame) {
  const test::TemporaryFolder folder;
  const auto knee = test::knee_case();
  const auto summary = export_plan(knee, folder.path() / "out");
  EXPECT_TRUE(summary.doubts.empty()) << summary.doubts[0];
  ASSERT_EQ(summary.files.size(), 8u);
  for (const auto& file : summary.files) EXPECT_TRUE(std::filesystem::exists(file)) << file;
  const auto table = files::CsvTable::read(summary.files[1], {"bone", "entry_x_mm", "length_mm", "wall_mm"});
  EXPECT_EQ(table.row_count(), 2u);
  const auto markups = read_markups(summary.files[2]);
  for (const auto& [key, tunnel] : knee.plan.tunnels) {
    const BoneKind kind = key.bone;
    EXPECT_LT((markups.tunnels.at(kind).entry_mm - tunnel.entry_mm).norm(), 1e-9);
    EXPECT_LT((markups.tunnels.at(kind).direction - tunnel.direction).norm(), 1e-6);
    EXPECT_NEAR(markups.tunnels.at(kind).diameter_mm, tunnel.diameter_mm, 1e-3);
  }
  // Less bone than before, by about the tunnel.
  const auto femur = bones::read_mesh(folder.path() / "out" / "femur_drilled.stl");
  const auto as_ply = bones::read_mesh(folder.path() / "out" / "femur_drilled.ply");
  EXPECT_EQ(as_ply.triangles.size(), femur.triangles.size());
  EXPECT_NEAR(geometry::signed_volume_mm3(as_ply), geometry::signed_volume_mm3(femur), 0.1);
  EXPECT_TRUE(bones::mend_mesh(as_ply).report.is_closed);
  const auto& tunnel = knee.plan.tunnels.at(BoneKind::Femur);
  const double length =
      tunnels::measure(tunnel, geometry::Surface(knee.bones.at(BoneKind::Femur).mesh)).length_mm;
  const double removed =
      geometry::signed_volume_mm3(knee.bones.at(BoneKind::Femur).mesh) - geometry::signed_volume_mm3(femur);
  EXPECT_NEAR(removed / (geometry::kPi * std::pow(tunnel.diameter_mm / 2, 2) * length), 1,
              0.15);  // mouths slant
}

// Whichever file goes on alone: which knee, and which plan. The plan's hash is that of the case's plan.json.
TEST(PlanExport, EveryFileSaysOfWhichSideAndPlan) {
  const test::TemporaryFolder folder;
  const auto knee = test::knee_case();
  cases::save_plan(folder.path(), knee.plan);
  const std::string hash = files::sha256_of_file(folder / "plan.json");
  const std::string side(bones::to_text(knee.side));
  const auto summary = export_plan(knee, folder.path() / "out");
  ASSERT_EQ(summary.files.size(), 8u);
  for (const auto& file : summary.files) {
    const std::string text = files::read_text(file);
    EXPECT_THAT(text, testing::HasSubstr(hash.substr(0, 12))) << file;
    EXPECT_THAT(text, testing::HasSubstr(side)) << file;
  }
  const auto plan = nlohmann::json::parse(files::read_text(summary.files[0]));
  EXPECT_EQ(plan.at("plan_sha256"), hash);
  EXPECT_EQ(plan.at("side"), side);
  EXPECT_EQ(cases::plan_from(files::read_text(summary.files[0]), summary.files[0]).tunnels.size(), 2U);
  // A moved entry is another plan, another side another knee.
  auto moved = knee;
  moved.plan.tunnels.at(BoneKind::Femur).entry_mm.x() += 0.01;
  EXPECT_NE(cases::plan_in_words(moved), cases::plan_in_words(knee));
  moved = knee;
  moved.side = knee.side == bones::Side::Left ? bones::Side::Right : bones::Side::Left;
  EXPECT_NE(cases::plan_in_words(moved), cases::plan_in_words(knee));
}

// The folder that somebody named stays the folder that it was, with all that he laid there.
TEST(PlanExport, ExportsAgainIntoTheSameFolder) {
  namespace fs = std::filesystem;
  const test::TemporaryFolder folder;
  auto knee = test::knee_case();
  const fs::path out = folder / "out";
  (void)export_plan(knee, out);
  const auto number_of = [](const fs::path& file) {
    struct stat found {};
    EXPECT_EQ(::stat(file.c_str(), &found), 0);
    return found.st_ino;
  };
  const auto before = number_of(out);
  const auto mode = fs::status(out).permissions();
  std::ofstream(out / "mine.txt") << "kept";
  knee.plan.tunnels.at(BoneKind::Femur).diameter_mm = 8;
  (void)export_plan(knee, out);
  EXPECT_EQ(number_of(out), before);
  EXPECT_EQ(fs::status(out).permissions(), mode);
  EXPECT_EQ(files::read_text(out / "mine.txt"), "kept");
  EXPECT_THAT(files::read_text(out / "plan.csv"), testing::HasSubstr(",8.000,"));
  EXPECT_EQ(std::distance(fs::directory_iterator(out), {}), 9) << "eight files and mine";
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1) << "nothing lies about";
}

// A folder that is exported to again holds no bone drilled by the plan before.
TEST(PlanExport, LeavesNoBoneDrilledByAnEarlierPlan) {
  const test::TemporaryFolder folder;
  auto knee = test::knee_case();
  (void)export_plan(knee, folder.path());
  knee.plan.remove(BoneKind::Tibia);
  knee.plan.tunnels.at(BoneKind::Femur).entry_mm.x() += 300;
  const auto summary = export_plan(knee, folder.path());
  EXPECT_EQ(summary.files.size(), 4U);
  EXPECT_FALSE(summary.doubts.empty());
  for (const char* name :
       {"femur_drilled.stl", "tibia_drilled.stl", "femur_drilled.ply", "tibia_drilled.ply"})
    EXPECT_FALSE(std::filesystem::exists(folder / name)) << name;
}

// A disk that gets full over the drilled bones, which are by far the largest: the plan before and its bones
// stay together, and of a folder that was not there nothing is left.
TEST(PlanExport, LeavesWhatWasThereWhereTheDiskIsFull) {
  const test::TemporaryFolder folder;
  auto knee = test::knee_case();
  (void)export_plan(knee, folder / "out");
  const auto plan = files::read_text(folder / "out/plan.json");
  const auto bone = files::read_text(folder / "out/femur_drilled.stl");
  knee.plan.tunnels.at(BoneKind::Femur).diameter_mm += 1;
  ::signal(SIGXFSZ, SIG_IGN);  // the write fails instead
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const rlimit full{100'000, before.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &full);
  EXPECT_THAT(test::message_of<IoError>([&] { (void)export_plan(knee, folder / "out"); }),
              testing::StartsWith((folder / "out/femur_drilled.stl").string() + ": cannot write"));
  EXPECT_THROW((void)export_plan(knee, folder / "new"), IoError);
  ::setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_EQ(files::read_text(folder / "out/plan.json"), plan);
  EXPECT_EQ(files::read_text(folder / "out/femur_drilled.stl"), bone);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder / "out"), {}), 8);
  EXPECT_FALSE(std::filesystem::exists(folder / "new"));
}

// What another program wrote or moved in that folder is not lost to an export.
TEST(PlanExport, WritesOverNothingOfAnotherProgram) {
  const test::TemporaryFolder folder;
  auto knee = test::knee_case();
  const auto refusal = [&] {
    return test::message_of<InvalidInput>([&] { (void)export_plan(knee, folder.path()); });
  };
  (void)export_plan(knee, folder.path());
  // Its own export may be replaced, also by another plan.
  knee.plan.tunnels.at(BoneKind::Femur).diameter_mm += 1;
  EXPECT_NO_THROW((void)export_plan(knee, folder.path()));
  // The femoral entry was dragged in 3D Slicer and saved in the same place.
  auto moved = knee;
  moved.plan.tunnels.at(BoneKind::Femur).entry_mm.x() += 2;
  const std::string of_slicer = markups_of(moved);
  files::write_atomically(folder / "plan.mrk.json", of_slicer);
  EXPECT_THAT(refusal(), testing::HasSubstr("plan.mrk.json: was changed since it was exported"));
  EXPECT_EQ(files::read_text(folder / "plan.mrk.json"), of_slicer);
  // Also where nothing is left that tells the hashes.
  std::filesystem::remove(folder / "SHA256SUMS");
  EXPECT_THAT(refusal(), testing::HasSubstr("plan.mrk.json: was changed by another program"));
  std::filesystem::remove(folder / "plan.mrk.json");
  EXPECT_NO_THROW((void)export_plan(knee, folder.path()));
  // A landmark was moved there, the tunnels were not.
  auto other_landmarks = knee;
  other_landmarks.landmarks.at(BoneKind::Femur).at("notch_apex").x() += 5;
  const std::string with_landmark = markups_of(other_landmarks);
  files::write_atomically(folder / "plan.mrk.json", with_landmark);
  EXPECT_THAT(refusal(), testing::HasSubstr("plan.mrk.json: was changed since it was exported"));
  EXPECT_EQ(files::read_text(folder / "plan.mrk.json"), with_landmark);
  std::filesystem::remove(folder / "plan.mrk.json");
  EXPECT_NO_THROW((void)export_plan(knee, folder.path())) << "what was moved away is none";
  std::filesystem::remove(folder / "SHA256SUMS");
  files::write_atomically(folder / "plan.csv", "date,drug\n");
  EXPECT_THAT(refusal(), testing::HasSubstr("plan.csv: is another program's"));
  std::filesystem::remove(folder / "plan.csv");
  files::write_atomically(folder / "plan.json", "{}");
  EXPECT_THAT(refusal(), testing::HasSubstr("plan.json"));
  EXPECT_EQ(files::read_text(folder / "plan.json"), "{}");
}

TEST(PlanExport, RefusesAnEmptyPlan) {
  const test::TemporaryFolder folder;
  auto knee = test::knee_case();
  knee.plan.tunnels.clear();
  EXPECT_THROW((void)export_plan(knee, folder.path() / "out"), InvalidInput);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "out"));
}

// Two bundles: both holes, two rows, two lines with names of their own, read back the same.
TEST(PlanExport, TwoBundlesAreWrittenAndReadBack) {
  const test::TemporaryFolder folder;
  auto knee = test::knee_case();
  tunnels::Tunnel tunnel = knee.plan.tunnels.at(BoneKind::Femur);
  tunnel.diameter_mm = 6;
  tunnel.bundle = norms::Bundle::Anteromedial;
  knee.plan.put(tunnel, knee.plan.mesh_sha256.at(BoneKind::Femur));
  tunnel.bundle = norms::Bundle::Posterolateral;
  tunnel.entry_mm += 8 * tunnel.direction.unitOrthogonal();
  knee.plan.put(tunnel, knee.plan.mesh_sha256.begin()->second);
  const auto summary = export_plan(knee, folder.path() / "out");
  EXPECT_TRUE(summary.doubts.empty()) << summary.doubts[0];
  const auto markups = read_markups(folder.path() / "out" / "plan.mrk.json");
  ASSERT_EQ(markups.tunnels.size(), 3U);
  for (const auto& [key, planned] : knee.plan.tunnels) {
    EXPECT_LT((markups.tunnels.at(key).entry_mm - planned.entry_mm).norm(), 1e-9);
    EXPECT_EQ(markups.tunnels.at(key).bundle, key.bundle);
  }
  const std::string csv = files::read_text(folder.path() / "out" / "plan.csv");
  for (const char* end : {",am,right,", ",pl,right,", ",single,right,", ",bundle,side,plan_sha256\n"})
    EXPECT_NE(csv.find(end), std::string::npos) << csv;
  const auto femur = bones::read_mesh(folder.path() / "out" / "femur_drilled.stl");
  const double removed =
      geometry::signed_volume_mm3(knee.bones.at(BoneKind::Femur).mesh) - geometry::signed_volume_mm3(femur);
  double expected = 0;
  const geometry::Surface surface(knee.bones.at(BoneKind::Femur).mesh);
  for (const auto& key : knee.plan.of(BoneKind::Femur))
    expected += geometry::kPi * 9 * tunnels::measure(knee.plan.tunnels.at(key), surface).length_mm;
  EXPECT_NEAR(removed / expected, 1, 0.15);  // mouths slant
  // A single line beside one of a bundle contradicts it.
  std::string text = files::read_text(folder.path() / "out" / "plan.mrk.json");
  text.replace(text.find("femur PL tunnel"), 15, "femur tunnel");
  files::write_atomically(folder.path() / "wrong.mrk.json", text);
  EXPECT_THROW((void)read_markups(folder.path() / "wrong.mrk.json"), InvalidInput);
}

}  // namespace
}  // namespace arthronaut::plan_export
