// Bad input, each with its message and exit code; and nothing half-written is left behind.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "navigation/registration/registration_file.h"
#include "planning/cases/case.h"
#include "planning/files/atomic_file.h"
#include "tests/app/command_line/marker_clip.h"
#include "tests/temporary_folder.h"

namespace arthronaut {
namespace {

using test::run_program;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

class BadInput : public ::testing::Test {
 protected:
  BadInput() { test::write_marker_clip(folder_); }

  [[nodiscard]] std::vector<std::string> track(const std::string& output) const {
    return {"track", "--camera", folder_ / "camera.json", "--tools", folder_ / "tools.json", "--fixed-lens",
            "-o",    output,     folder_ / "clip.mkv"};
  }
  void spoil(const std::string& name, const std::string& what, const std::string& with) const {
    std::string text = files::read_text(folder_ / name);
    text.replace(text.find(what), what.size(), with);
    test::write_file(folder_ / name, text);
  }

  test::TemporaryFolder folder_;
};

// File and field are named.
TEST_F(BadInput, CameraWithAMissingField) {
  spoil("camera.json", "\"focal_px\"", "\"focal\"");
  const auto result = run_program(track(folder_ / "poses.csv"));
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.errors, AllOf(HasSubstr("camera.json"), HasSubstr("focal_px")));
  EXPECT_THAT(folder_.names(), ElementsAre("camera.json", "clip.mkv", "tools.json"));
}

TEST_F(BadInput, CameraOfANewerVersion) {
  spoil("camera.json", "\"version\": 1", "\"version\": 2");
  const auto result = run_program(track(folder_ / "poses.csv"));
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.errors, AllOf(HasSubstr("camera.json"), HasSubstr("version")));
}

TEST_F(BadInput, CameraOfAnotherPictureSize) {
  spoil("camera.json", "[640, 480]", "[1920, 1080]");
  const auto result = run_program(track(folder_ / "poses.csv"));
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.errors,
              AllOf(HasSubstr("clip.mkv: frame 0"), HasSubstr("640 x 480"), HasSubstr("1920 x 1080")));
  EXPECT_THAT(folder_.names(), ElementsAre("camera.json", "clip.mkv", "tools.json"));
}

// Which marker, and who had it first.
TEST_F(BadInput, ToolsWithAMarkerTwice) {
  spoil("tools.json", "\"marker_id\": 2", "\"marker_id\": 0");
  const auto result = run_program(track(folder_ / "poses.csv"));
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.errors, AllOf(HasSubstr("tools.json"), HasSubstr("marker 0"), HasSubstr("already")));
}

// The frame where the video breaks off is named; the poses before it are not passed off as the whole.
TEST_F(BadInput, VideoThatEndsHalfWayThroughAFrame) {
  std::filesystem::resize_file(folder_ / "clip.mkv",
                               std::filesystem::file_size(folder_ / "clip.mkv") * 6 / 10);
  const auto result = run_program(track(folder_ / "poses.csv"));
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.errors, AllOf(HasSubstr("clip.mkv"), HasSubstr("frame")));
  EXPECT_THAT(folder_.names(), ElementsAre("camera.json", "clip.mkv", "tools.json"));
}

TEST_F(BadInput, VideoThatIsNotThereOrNoVideo) {
  std::filesystem::remove(folder_ / "clip.mkv");
  EXPECT_EQ(run_program(track("-")).exit_code, 3);
  test::write_file(folder_ / "clip.mkv", "no video");
  const auto result = run_program(track("-"));
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.errors,
              HasSubstr("clip.mkv: is not a video that can be read: its data are of no known format"));
  EXPECT_EQ(result.output, "");
}

TEST_F(BadInput, EmptyFolderToImport) {
  std::filesystem::create_directory(folder_ / "empty");
  const auto result = run_program({"import", folder_ / "empty", "-o", folder_ / "knee.arthro"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.errors, HasSubstr("empty"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "knee.arthro"));
}

// Nobody is sent to find out which bone a file without a byte is of.
TEST_F(BadInput, MeshWithoutAByte) {
  test::write_file(folder_ / "bone.stl", "");
  const auto result = run_program({"import", folder_ / "bone.stl", "-o", folder_ / "knee.arthro"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.errors, AllOf(HasSubstr("bone.stl: is empty"), Not(HasSubstr("--bone"))));
}

// The volume is there: it only has to be named.
TEST_F(BadInput, FolderOfVolumesThatAreNoDicom) {
  std::filesystem::create_directory(folder_ / "scans");
  for (const char* name : {"knee.nrrd", "knee.nii.gz", "letter.txt"})
    test::write_file(folder_ / "scans" / name, "NRRD0004");
  const auto result = run_program({"import", folder_ / "scans", "-o", folder_ / "knee.arthro"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.errors, AllOf(HasSubstr("scans: holds no DICOM file"), HasSubstr("scans/knee.nrrd"),
                                   HasSubstr("scans/knee.nii.gz"), Not(HasSubstr("letter.txt"))));
}

// Nor is a folder of meshes one knee's: it is said how they are taken.
TEST_F(BadInput, FolderOfMeshesThatAreNoDicom) {
  std::filesystem::create_directory(folder_ / "meshes");
  for (const char* name : {"a.stl", "b.vtk"}) test::write_file(folder_ / "meshes" / name, "solid");
  const auto result = run_program({"import", folder_ / "meshes", "-o", folder_ / "knee.arthro"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.errors, AllOf(HasSubstr("meshes: holds no DICOM file; of the meshes in it name one"),
                                   HasSubstr("--bone femur or --bone tibia and --side"),
                                   HasSubstr("meshes/a.stl"), HasSubstr("meshes/b.vtk")));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "knee.arthro"));
  EXPECT_THAT(run_program({"series", folder_ / "meshes"}).errors,
              AllOf(HasSubstr("meshes: holds no image"), HasSubstr("arthronaut import")));
}

TEST_F(BadInput, MeshThatIsCutOffOrHoldsNoNumber) {
  test::write_file(folder_ / "cut.stl",
                   std::string(80, ' ') + std::string("\x10\0\0\0", 4) + std::string(70, '\0'));
  const auto cut =
      run_program({"import", folder_ / "cut.stl", "--side", "left", "-o", folder_ / "knee.arthro"});
  EXPECT_EQ(cut.exit_code, 3);
  EXPECT_THAT(cut.errors, HasSubstr("cut.stl"));
  test::write_file(
      folder_ / "nan.stl",
      "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 90 nan 0\nvertex 0 90 0\nendloop\n"
      "endfacet\nendsolid a\n");
  const auto nan =
      run_program({"import", folder_ / "nan.stl", "--side", "left", "-o", folder_ / "knee.arthro"});
  EXPECT_EQ(nan.exit_code, 3);
  EXPECT_THAT(nan.errors, HasSubstr("nan.stl"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "knee.arthro"));
}

// A full disk: by the limit on file sizes, and by the device that is always full.
TEST_F(BadInput, DiskThatIsFull) {
  const auto limited = run_program(track(folder_ / "poses.csv"), {.file_size_bytes = 1000});
  EXPECT_EQ(limited.exit_code, 3);
  EXPECT_THAT(limited.errors, HasSubstr("poses.csv"));
  EXPECT_THAT(folder_.names(), ElementsAre("camera.json", "clip.mkv", "tools.json"));
  const auto full = run_program(track("/dev/full"));
  EXPECT_EQ(full.exit_code, 3);
  EXPECT_THAT(full.errors, HasSubstr("No space left"));
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

TEST_F(BadInput, FolderThatIsReadOnly) {
  const auto result = run_program(track(folder_ / "poses.csv"), {.as_nobody = true});
  // Not root: the folder is the tester's own and writable.
  if (::geteuid() != 0) GTEST_SKIP() << "needs root, to give up its rights";
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.errors, AllOf(HasSubstr("poses.csv"), HasSubstr("Permission denied")));
  EXPECT_THAT(folder_.names(), ElementsAre("camera.json", "clip.mkv", "tools.json"));
}

// Of images: the folder that may not be looked into is named, be it one within the study.
TEST_F(BadInput, FolderWithoutRightsIsNamed) {
  if (::geteuid() != 0) GTEST_SKIP() << "needs root, to give up its rights";
  namespace fs = std::filesystem;
  const fs::path closed = folder_ / "study/closed";
  fs::create_directories(closed);
  fs::permissions(folder_.path(), fs::perms{0755});
  fs::permissions(closed, fs::perms{0700});
  for (const fs::path& asked : {closed, folder_ / "study"}) {
    const auto result = run_program({"series", asked}, {.as_nobody = true});
    EXPECT_EQ(result.exit_code, 3) << result.errors;
    EXPECT_THAT(result.errors, AllOf(HasSubstr(closed.string()), HasSubstr("Permission denied"),
                                     testing::Not(HasSubstr("filesystem error"))));
  }
}

TEST_F(BadInput, FolderThatIsNotThere) {
  const auto result = run_program(track(folder_ / "nowhere/poses.csv"));
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.errors, HasSubstr("nowhere"));
}

TEST_F(BadInput, CaseThatIsNone) {
  for (const char* command : {"navigate", "replay", "report", "resume", "verify"}) {
    std::vector<std::string> arguments{command, folder_ / "nothing.arthro"};
    if (arguments[0] == "navigate") arguments.insert(arguments.end(), {"--video", folder_ / "clip.mkv"});
    if (arguments[0] == "report") arguments.insert(arguments.end(), {"-o", folder_ / "report.pdf"});
    const auto result = run_program(arguments);
    EXPECT_EQ(result.exit_code, 3) << command;
    EXPECT_THAT(result.errors, HasSubstr("nothing.arthro: is not a case folder")) << command;
  }
}

// A registration that was given by name and is of something else guides nothing: the file and what differs
// are named, and no session is left behind. One that says nothing of it is taken at the user's word.
TEST_F(BadInput, RegistrationOfSomethingElse) {
  const std::string knee = folder_ / "knee.arthro";
  ASSERT_EQ(run_program({"phantom", "-o", knee}).exit_code, 0);
  const std::vector<std::string> arguments{"navigate",
                                           knee,
                                           "--video",
                                           folder_ / "clip.mkv",
                                           "--camera",
                                           folder_ / "camera.json",
                                           "--tools",
                                           folder_ / "tools.json",
                                           "--medium",
                                           "air",
                                           "--fixed-lens",
                                           "--registration",
                                           folder_ / "registration.json"};
  registration::RegistrationSummary registration;
  registration.has_pose = registration.reliable = true;
  registration.reasons.clear();
  registration.covariance.setIdentity();
  registration::Provenance of;
  of.source = sources::SourceKind::Recording;
  of.world_marker_id = 0;
  of.mesh_sha256 = "another mesh";
  registration::write_registration_file(folder_ / "registration.json", registration, &of);
  const auto other_mesh = run_program(arguments);
  EXPECT_EQ(other_mesh.exit_code, 3);
  EXPECT_THAT(other_mesh.errors, AllOf(HasSubstr("registration.json"), HasSubstr("mesh")));
  of.mesh_sha256.clear();
  of.source = sources::SourceKind::Simulation;
  registration::write_registration_file(folder_ / "registration.json", registration, &of);
  const auto simulated = run_program(arguments);
  EXPECT_EQ(simulated.exit_code, 3);
  EXPECT_THAT(simulated.errors, AllOf(HasSubstr("registration.json"), HasSubstr("simulation")));
  EXPECT_FALSE(std::filesystem::exists(knee + "/sessions") && !std::filesystem::is_empty(knee + "/sessions"));
  geometry::TriangleMesh elsewhere = cases::load_case(knee).bones.at(bones::BoneKind::Femur).mesh;
  registration::write_registration_file(folder_ / "registration.json", registration,
                                        registration::registered_mesh(elsewhere));
  EXPECT_NE(run_program(arguments).exit_code, 3);
  for (Eigen::Vector3d& vertex : elsewhere.vertices_mm) vertex.x() += 600;
  registration::write_registration_file(folder_ / "registration.json", registration,
                                        registration::registered_mesh(elsewhere));
  const auto other_bone = run_program(arguments);
  EXPECT_EQ(other_bone.exit_code, 3);
  EXPECT_THAT(other_bone.errors, AllOf(HasSubstr("registration.json"), HasSubstr("lies elsewhere")));
}

// An outside tracker tells where the tools are now: it goes with live pictures alone, and with none that are
// tracked by themselves; no session is left behind.
TEST_F(BadInput, OutsideTrackerWithARecording) {
  const std::string knee = folder_ / "knee.arthro";
  ASSERT_EQ(run_program({"phantom", "-o", knee}).exit_code, 0);
  const auto navigated = [&](const std::string& video, const std::string& tracker) {
    std::vector<std::string> arguments{"navigate", knee,
                                       "--video",  video,
                                       "--camera", folder_ / "camera.json",
                                       "--tools",  folder_ / "tools.json"};
    if (!tracker.empty()) arguments.insert(arguments.end(), {"--tracker", tracker});
    return run_program(arguments);
  };
  const auto recorded = navigated(folder_ / "clip.mkv", "igtl://127.0.0.1:18944");
  EXPECT_EQ(recorded.exit_code, 3);
  EXPECT_THAT(recorded.errors, HasSubstr("only a live source"));
  const auto no_address = navigated("udp://127.0.0.1:5999", "127.0.0.1:18944");
  EXPECT_EQ(no_address.exit_code, 3);
  EXPECT_THAT(no_address.errors, HasSubstr("igtl://HOST:PORT"));
  spoil("tools.json", "\"version\": 1,",
        "\"version\": 1, \"tracker\": {\"sigma_mm\": 0.2, \"sigma_deg\": 0.1},");
  const auto nowhere = navigated("udp://127.0.0.1:5999", "");
  EXPECT_EQ(nowhere.exit_code, 3);
  EXPECT_THAT(nowhere.errors, AllOf(HasSubstr("tools.json"), HasSubstr("--tracker")));
  const auto tracked = run_program(track(folder_ / "poses.csv"));
  EXPECT_EQ(tracked.exit_code, 3);
  EXPECT_THAT(tracked.errors, AllOf(HasSubstr("tools.json"), HasSubstr("outside tracker")));
  EXPECT_FALSE(std::filesystem::exists(knee + "/sessions") && !std::filesystem::is_empty(knee + "/sessions"));
}

}  // namespace
}  // namespace arthronaut
