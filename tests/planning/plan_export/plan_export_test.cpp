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
#include "tests/temporary_folder.h"

namespace arthronaut::plan_export {
namespace {

using bones::BoneKind;
using Eigen::Vector3d;

cases::Case knee_case() {
  const auto knee = phantom::make_phantom_knee({.edge_length_mm = 2});
  cases::Case contents;
  contents.name = "Knee";
  contents.side = knee.side;
  contents.bones = {{BoneKind::Femur, knee.femur}, {BoneKind::Tibia, knee.tibia}};
  contents.landmarks = {{BoneKind::Femur, knee.femur_landmarks}, {BoneKind::Tibia, knee.tibia_landmarks}};
  contents.plan.tunnels = {{BoneKind::Femur, knee.femoral_tunnel}, {BoneKind::Tibia, knee.tibial_tunnel}};
  cases::name_meshes(contents);
  return contents;
}

// A hole of 8 mm through a slab of 20 mm takes away pi 4^2 20 mm^3; the drill has the circle's area.
TEST(DrilledBone, TakesACylinderOutOfASlab) {
  const auto slab = test::box({30, 30, 10});
  const tunnels::Tunnel tunnel{BoneKind::Femur, {0.3, -0.2, 10}, -Vector3d::UnitZ(), 8};
  const auto drilled = drill(slab, tunnel);
  ASSERT_TRUE(drilled.is_usable()) << drilled.reason;
  const double removed = geometry::signed_volume_mm3(slab) - geometry::signed_volume_mm3(drilled.mesh);
  EXPECT_NEAR(removed, geometry::kPi * 16 * 20, 0.01);
  EXPECT_TRUE(bones::mend_mesh(drilled.mesh).report.is_closed);
  EXPECT_EQ(drill(slab, {BoneKind::Femur, {0, 0, 60}, Vector3d::UnitZ(), 8}).outcome,
            DrilledBone::Outcome::MissesTheBone);
  auto open = slab;
  open.triangles.pop_back();
  EXPECT_EQ(drill(open, tunnel).outcome, DrilledBone::Outcome::BrokenSurface);
}

// Of 275,000 triangles each edge in the box about a side as long as the tunnel was tried against it: 14 s of
// 16 that an export took.
TEST(DrilledBone, ATunnelsWallIsInShortPieces) {
  const auto femur = knee_case().bones.at(BoneKind::Femur).mesh;
  const auto tunnel = knee_case().plan.tunnels.at(BoneKind::Femur);
  const auto drilled = drill(femur, tunnel);
  ASSERT_TRUE(drilled.is_usable()) << drilled.reason;
  EXPECT_TRUE(bones::mend_mesh(drilled.mesh).report.is_closed);
  const auto is_on_wall = [&](const Vector3d& p) {
    return std::abs((p - tunnel.entry_mm).cross(tunnel.direction).norm() - tunnel.diameter_mm / 2) < 0.01;
  };
  double longest_mm = 0;
  for (const auto& triangle : drilled.mesh.triangles) {
    std::array<Vector3d, 3> p;
    for (std::size_t k = 0; k < 3; ++k)
      p[k] = drilled.mesh.vertices_mm[static_cast<std::size_t>(triangle[k])];
    if (!std::ranges::all_of(p, is_on_wall)) continue;
    for (std::size_t k = 0; k < 3; ++k) longest_mm = std::max(longest_mm, (p[k] - p[(k + 1) % 3]).norm());
  }
  EXPECT_GT(longest_mm, 1);
  EXPECT_LT(longest_mm, 3.1);
}

TEST(PlanExport, WritesWhatIsReadBackTheSame) {
  const test::TemporaryFolder folder;
  const auto knee = knee_case();
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
  const auto knee = knee_case();
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
  auto knee = knee_case();
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
  auto knee = knee_case();
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
  auto knee = knee_case();
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
  auto knee = knee_case();
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
  auto knee = knee_case();
  knee.plan.tunnels.clear();
  EXPECT_THROW((void)export_plan(knee, folder.path() / "out"), InvalidInput);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "out"));
}

// Two holes of 8 mm, 5 mm apart: together they take away two circles less the lens that they share. As
// polygons of 96 sides of the circles' area they share it to a share of 1e-3.
TEST(DrilledBone, TakesTwoTunnelsOutAlsoWhereTheyRunIntoEachOther) {
  const auto slab = test::box({30, 30, 10});
  const auto at = [](double x_mm, norms::Bundle bundle) {
    return tunnels::Tunnel{BoneKind::Femur, {x_mm, -0.2, 10}, -Vector3d::UnitZ(), 8, bundle};
  };
  const auto removed = [&](double apart_mm) {
    const std::array both{at(0.3, norms::Bundle::Anteromedial),
                          at(0.3 + apart_mm, norms::Bundle::Posterolateral)};
    const auto drilled = drill(slab, both);
    EXPECT_TRUE(drilled.is_usable()) << drilled.reason;
    EXPECT_TRUE(bones::mend_mesh(drilled.mesh).report.is_closed);
    return geometry::signed_volume_mm3(slab) - geometry::signed_volume_mm3(drilled.mesh);
  };
  const double circle = geometry::kPi * 16;
  EXPECT_NEAR(removed(12), 2 * circle * 20, 0.02);
  const double lens = 2 * 16 * std::acos(5.0 / 8) - 2.5 * std::sqrt(4 * 16 - 25.0);
  EXPECT_NEAR(removed(5), (2 * circle - lens) * 20, 1e-3 * lens * 20);
  std::array missing{at(0.3, norms::Bundle::Anteromedial), at(300, norms::Bundle::Posterolateral)};
  EXPECT_EQ(drill(slab, missing).reason, "the tunnel femur PL misses the bone");
}

// Two bundles: both holes, two rows, two lines with names of their own, read back the same.
TEST(PlanExport, TwoBundlesAreWrittenAndReadBack) {
  const test::TemporaryFolder folder;
  auto knee = knee_case();
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

// 3D Slicer may hand back RAS; anything else is refused with the place.
TEST(Markups, ReadRasAndRefuseTheRest) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "plan.mrk.json";
  const auto with = [&](const std::string& system, const std::string& unit, const std::string& second) {
    files::write_atomically(file, R"({"markups":[{"type":"Line","name":"femur tunnel","coordinateSystem":")" +
                                      system + R"(","coordinateUnits":")" + unit +
                                      R"(","controlPoints":[{"position":[1,2,3]},{"position":)" + second +
                                      "}]}]}");
  };
  with("RAS", "mm", "[1,2,33]");
  const auto plan = read_markups(file);
  EXPECT_EQ(plan.tunnels.at(BoneKind::Femur).entry_mm, Vector3d(-1, -2, 3));
  EXPECT_EQ(plan.tunnels.at(BoneKind::Femur).direction, Vector3d(0, 0, 1));
  for (const auto& [system, unit, second] : {std::array<const char*, 3>{"XYZ", "mm", "[1,2,33]"},
                                             {"LPS", "cm", "[1,2,33]"},
                                             {"LPS", "mm", "[1,2]"},
                                             {"LPS", "mm", "[1,2,\"3\"]"},
                                             {"LPS", "mm", "[1,2,3]"}}) {
    with(system, unit, second);
    try {
      (void)read_markups(file);
      ADD_FAILURE() << system << unit << second;
    } catch (const InvalidInput& error) {
      EXPECT_NE(std::string(error.what()).find("plan.mrk.json: markups[0]"), std::string::npos)
          << error.what();
    }
  }
  files::write_atomically(file, "{\"markups\": 3}");
  EXPECT_THROW((void)read_markups(file), InvalidInput);
  EXPECT_THROW((void)read_markups(folder.path() / "none.mrk.json"), IoError);
}

// 3D Slicer keeps the last place of a point that was taken away or is still being placed: no tunnel runs
// there. Landmarks are not read back, so that one without a place stands in no tunnel's way.
TEST(Markups, APointThatIsNotPlacedIsNoEndOfATunnel) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "plan.mrk.json";
  const auto with = [&](const std::string& status) {
    files::write_atomically(
        file,
        R"({"markups":[{"type":"Fiducial","name":"femur landmarks","controlPoints":[{"label":"notch_apex"}]},)"
        R"({"type":"Line","name":"femur tunnel","controlPoints":[{"position":[1,2,3]},)"
        R"({"position":[1,2,33],"positionStatus":")" +
            status + R"("}]}]})");
  };
  with("defined");
  EXPECT_EQ(read_markups(file).tunnels.size(), 1U);
  for (const std::string status : {"undefined", "preview"}) {
    with(status);
    EXPECT_THAT(
        test::message_of<InvalidInput>([&] { (void)read_markups(file); }),
        testing::HasSubstr("markups[1].controlPoints[1]: is not placed: its positionStatus is \"" + status));
  }
}

// Of a case with one bone alone the other's tunnel is passed over; one that lies beside its bone is of
// another knee.
TEST(Markups, GiveTheTunnelsOfTheBonesThatAreThere) {
  const test::TemporaryFolder folder;
  auto knee = knee_case();
  const geometry::Surface femur(knee.bones.at(BoneKind::Femur).mesh);
  const auto of_femur = [&](BoneKind kind) { return kind == BoneKind::Femur ? &femur : nullptr; };
  const auto file = folder / "plan.mrk.json";
  files::write_atomically(file, markups_of(knee));
  const auto tunnels = read_tunnels(file, {}, of_femur).tunnels;
  ASSERT_EQ(tunnels.size(), 1U);
  EXPECT_LT((tunnels.at(BoneKind::Femur).entry_mm - knee.plan.tunnels.at(BoneKind::Femur).entry_mm).norm(),
            1e-6);
  EXPECT_THAT(
      test::message_of<InvalidInput>([&] { (void)read_tunnels(file, {}, [](BoneKind) { return nullptr; }); }),
      testing::HasSubstr("hold no line"));
  const geometry::Surface elsewhere(test::box({1, 1, 1}));
  EXPECT_THAT(test::message_of<InvalidInput>(
                  [&] { (void)read_tunnels(file, {}, [&](BoneKind) { return &elsewhere; }); }),
              testing::HasSubstr("another knee"));
}

// Another program may empty the description: a tunnel is then as wide as it was planned, one that is new as
// is usual of its bundle, and either is said. A width that no plan may have is refused before it is in one.
TEST(Markups, ADiameterThatIsNotSaidIsThePlansOwn) {
  const test::TemporaryFolder folder;
  auto knee = knee_case();
  const geometry::Surface femur(knee.bones.at(BoneKind::Femur).mesh);
  const auto of_femur = [&](BoneKind kind) { return kind == BoneKind::Femur ? &femur : nullptr; };
  tunnels::Tunnel am = knee.plan.tunnels.at(BoneKind::Femur);
  am.bundle = norms::Bundle::Anteromedial;
  am.diameter_mm = 6.5;
  knee.plan.put(am, knee.plan.mesh_sha256.at(BoneKind::Femur));
  const std::string said = markups_of(knee);
  const auto with_description = [&](const std::string& description) {
    std::string text = said;
    constexpr std::string_view kSaid = "diameter_mm=6.500";
    text.replace(text.find(kSaid), kSaid.size(), description);
    files::write_atomically(folder / "plan.mrk.json", text);
  };
  with_description("seen by a colleague");
  const auto kept = read_tunnels(folder / "plan.mrk.json", knee.plan, of_femur);
  EXPECT_EQ(kept.tunnels.at(am.key()).diameter_mm, 6.5);
  EXPECT_EQ(kept.note, "femur AM tunnel has no diameter_mm there: 6.5 mm, as it was planned");
  const auto usual = read_tunnels(folder / "plan.mrk.json", {}, of_femur);
  EXPECT_EQ(usual.tunnels.at(am.key()).diameter_mm, 7.0);
  EXPECT_THAT(usual.note, testing::HasSubstr("7.0 mm, as is usual"));
  for (const char* width : {"diameter_mm=20", "diameter_mm=2.9", "diameter_mm=nan", "diameter_mm="}) {
    with_description(width);
    EXPECT_THAT(test::message_of<InvalidInput>(
                    [&] { (void)read_tunnels(folder / "plan.mrk.json", knee.plan, of_femur); }),
                testing::HasSubstr("must be 3 to 15"))
        << width;
  }
}

}  // namespace
}  // namespace arthronaut::plan_export
