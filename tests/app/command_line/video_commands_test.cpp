// track, navigate and replay on a clip whose poses are known from where its markers were drawn.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "navigation/registration/registration_file.h"
#include "navigation/strokes/poses_file.h"
#include "planning/cases/case.h"
#include "planning/files/atomic_file.h"
#include "planning/files/format.h"
#include "tests/app/command_line/marker_clip.h"
#include "tests/resources/described.h"
#include "tests/temporary_folder.h"

namespace arthronaut {
namespace {

using test::run_program;
using ::testing::HasSubstr;
using ::testing::Not;

class VideoCommands : public ::testing::Test {
 protected:
  VideoCommands() { test::write_marker_clip(folder_); }
  test::TemporaryFolder folder_;
};

// Every marker of every frame, where it was drawn: 84 px for 4 mm at 400 px focal length. Edges between whole
// pixels are found to about 0.1 px: 0.005 mm across the view and 0.03 mm in depth; the limits are three times
// that.
TEST_F(VideoCommands, TrackFindsEveryMarkerWhereItWasDrawn) {
  const auto result =
      run_program({"track", "--camera", folder_ / "camera.json", "--tools", folder_ / "tools.json",
                   "--fixed-lens", "-o", folder_ / "poses.csv", folder_ / "clip.mkv"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("24 of 24 frames"));
  const auto rows = strokes::read_poses_file(folder_ / "poses.csv");
  ASSERT_EQ(rows.size(), 2u * test::kClipFrames);
  for (const strokes::PoseRow& row : rows) {
    EXPECT_NEAR(row.camera_from_marker.translation_mm.z(), test::kClipDepthMm, 0.1) << row.frame;
    if (row.marker_id != 2) continue;
    const double x_mm =
        (test::clip_probe_x_px(static_cast<int>(row.frame)) - 320) / test::kClipFocalPx * test::kClipDepthMm;
    EXPECT_NEAR(row.camera_from_marker.translation_mm.x(), x_mm, 0.02) << row.frame;
    EXPECT_NEAR(row.time_s, static_cast<double>(row.frame) / 60, 1e-6);
    EXPECT_FALSE(row.mark_angle_deg.has_value());
  }
}

// What was seen by a camera whose own file says that it is not to be relied on is not reliable either:
// written, and said, also where nothing else is said.
TEST_F(VideoCommands, WhatIsSeenByADoubtedCameraIsNotReliable) {
  std::string camera = test::clip_camera_json();
  camera.insert(camera.find('{') + 1, R"("reliable": false, "reasons": ["the lens was not turned"],)");
  test::write_file(folder_ / "camera.json", camera);
  for (const char* output : {"poses.csv", "-"}) {
    const auto result = run_program(
        {"track", "--camera", folder_ / "camera.json", "--tools", folder_ / "tools.json", "--fixed-lens",
         "--quiet", "-o", output[0] == '-' ? output : (folder_ / output).string(), folder_ / "clip.mkv"});
    EXPECT_EQ(result.exit_code, 4);
    EXPECT_THAT(result.errors, HasSubstr("the lens was not turned"));
  }
  EXPECT_EQ(strokes::read_poses_file(folder_ / "poses.csv").size(), 2U * test::kClipFrames);
}

// A recording may be of the simulator, and nobody can tell: what its camera means else is said, also to who
// wants errors alone. What live pictures give by it is not reliable.
TEST_F(VideoCommands, Hazard26TheSimulatorsCameraIsSaidAndNotReliableLive) {
  std::string camera = test::clip_camera_json();
  camera.insert(camera.find('{') + 1, R"("scope": "Simulated arthroscope",)");
  test::write_file(folder_ / "camera.json", camera);
  const auto tracked =
      run_program({"track", "--camera", folder_ / "camera.json", "--tools", folder_ / "tools.json",
                   "--fixed-lens", "--quiet", "-o", folder_ / "poses.csv", folder_ / "clip.mkv"});
  EXPECT_EQ(tracked.exit_code, 0) << tracked.errors;
  EXPECT_THAT(tracked.errors, HasSubstr("of the simulated arthroscope"));
  const std::string knee = folder_ / "knee.arthro";
  ASSERT_EQ(run_program({"phantom", "-o", knee}).exit_code, 0);
  const auto navigate = [&](const std::string& video) {
    return run_program({"navigate", knee, "--video", video, "--duration-s", "0.5", "--camera",
                        folder_ / "camera.json", "--tools", folder_ / "tools.json", "--medium", "air",
                        "--fixed-lens"});
  };
  EXPECT_THAT(navigate(folder_ / "clip.mkv").errors, HasSubstr("of the simulated arthroscope"));
  const auto live =
      navigate("gst:videotestsrc is-live=true ! video/x-raw,width=640,height=480,framerate=30/1 ! appsink");
  EXPECT_EQ(live.exit_code, 4) << live.errors;
  EXPECT_THAT(live.errors, HasSubstr("calibrated on the simulator, and live pictures are of another"));
  // A real scope's calibration, once the case has it, is not replaced by the simulator's.
  test::write_file(folder_ / "camera.json", test::clip_camera_json());
  EXPECT_THAT(navigate(folder_ / "clip.mkv").errors, Not(HasSubstr("of the simulated arthroscope")));
  const std::string real = files::read_text(knee + "/camera.json");
  EXPECT_EQ(real, test::clip_camera_json());
  test::write_file(folder_ / "camera.json", camera);
  const auto simulated = navigate(folder_ / "clip.mkv");
  EXPECT_THAT(simulated.output + simulated.errors, HasSubstr("camera.json stays as it is"));
  EXPECT_EQ(files::read_text(knee + "/camera.json"), real);
}

// A dump holds of every frame a picture and what was seen in it; in the first one, where both markers had to
// be searched for, the squares that were looked at lie where the markers were drawn.
TEST_F(VideoCommands, TrackDumpsWhatItSawInEveryFrame) {
  const auto dump = folder_ / "dump";
  const auto result =
      run_program({"track", "--camera", folder_ / "camera.json", "--tools", folder_ / "tools.json",
                   "--fixed-lens", "--dump", dump, "-o", folder_ / "poses.csv", folder_ / "clip.mkv"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  for (int i = 0; i < test::kClipFrames; ++i)
    for (const char* extension : {"png", "json"})
      EXPECT_GT(std::filesystem::file_size(dump / files::format("%06d.%s", i, extension)), 0u) << i;
  std::ifstream stream(dump / "000000.json");
  const auto first = nlohmann::json::parse(stream);
  EXPECT_EQ(test::undescribed(first, "frame_dump"), "");
  EXPECT_EQ(first["markers"].size(), 2u);
  EXPECT_EQ(first["markers"][0]["state"], "tracked");
  double nearest_px = 1e9;
  for (const auto& candidate : first["candidates"]) {
    if (candidate.value("id", -1) != 2) continue;
    double x_px = 0;
    for (const auto& corner : candidate["corners_px"]) x_px += 0.25 * corner[0].get<double>();
    nearest_px = std::min(nearest_px, std::abs(x_px - test::clip_probe_x_px(0)));
  }
  EXPECT_LT(nearest_px, 2);  // as good as a candidate's corners are said to be
}

// "-o -" gives the table and nothing else; --quiet gives nothing at all.
TEST_F(VideoCommands, TrackWritesToStandardOutput) {
  const std::vector<std::string> arguments{
      "track", "--camera", folder_ / "camera.json", "--tools", folder_ / "tools.json", "--fixed-lens",
      "-o",    "-",        folder_ / "clip.mkv"};
  const auto result = run_program(arguments);
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(result.output.starts_with(
      "frame,time_s,marker_id,qw,qx,qy,qz,tx_mm,ty_mm,tz_mm,rms_px,mark_angle_deg,size_mm\n"));
  EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 1 + 2 * test::kClipFrames);
  EXPECT_EQ(result.errors, "");
}

// A clip without the lens mark stands for no pose unless the lens is said not to turn: done, but not
// reliable. Here the principal point lies on the axis, so the mark is not needed; off the axis it is.
TEST_F(VideoCommands, TrackNeedsTheMarkOfALensThatTurns) {
  std::string camera = test::clip_camera_json();
  const std::string on_axis = "\"rotation_center_px\": [320.0, 240.0]";
  camera.replace(camera.find(on_axis), on_axis.size(), "\"rotation_center_px\": [300.0, 230.0]");
  test::write_file(folder_ / "camera.json", camera);
  const auto result =
      run_program({"track", "--camera", folder_ / "camera.json", "--tools", folder_ / "tools.json", "-o",
                   folder_ / "poses.csv", folder_ / "clip.mkv"});
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_THAT(result.errors, HasSubstr("lens mark"));
  EXPECT_TRUE(strokes::read_poses_file(folder_ / "poses.csv").empty());
}

// navigate writes a session into the case also where nothing reliable comes out, says so by exit code 4 and
// the reasons; replay finds the same again, and a record that was changed is found out.
TEST_F(VideoCommands, NavigateRecordsWhatReplayFindsAgain) {
  const std::string knee = folder_ / "knee.arthro";
  ASSERT_EQ(run_program({"phantom", "-o", knee}).exit_code, 0);
  const auto navigated =
      run_program({"navigate", knee, "--video", folder_ / "clip.mkv", "--camera", folder_ / "camera.json",
                   "--tools", folder_ / "tools.json", "--medium", "air", "--fixed-lens"});
  EXPECT_EQ(navigated.exit_code, 4) << navigated.errors;
  EXPECT_THAT(navigated.errors, HasSubstr("not reliable"));
  EXPECT_TRUE(std::filesystem::exists(knee + "/camera.json"));
  ASSERT_FALSE(std::filesystem::is_empty(knee + "/sessions"));
  const std::filesystem::path session = *std::filesystem::directory_iterator(knee + "/sessions");
  EXPECT_EQ(strokes::read_poses_file(session / "poses.csv").size(), 2u * test::kClipFrames);

  const auto same = run_program({"replay", knee, "--session", session.filename()});
  EXPECT_EQ(same.exit_code, 0) << same.output << same.errors;
  EXPECT_THAT(same.output, HasSubstr("24 of 24 frames replayed"));
  EXPECT_THAT(same.output, Not(HasSubstr("cut short")));
  EXPECT_EQ(same.errors, "");
  const auto verified = run_program({"verify", knee, "--session", session.filename()});
  EXPECT_EQ(verified.exit_code, 0) << verified.errors;
  EXPECT_THAT(verified.output, HasSubstr("as recorded"));

  // The bone was made anew since: that is what differs, not the program.
  const std::string other = folder_ / "other.arthro";
  std::filesystem::copy(knee, other, std::filesystem::copy_options::recursive);
  cases::Case moved = cases::load_case(other);
  for (Eigen::Vector3d& vertex : moved.bones.at(bones::BoneKind::Femur).mesh.vertices_mm) vertex.x() += 3;
  cases::save_case(other, moved);
  const auto of_other = run_program({"replay", other});
  EXPECT_EQ(of_other.exit_code, 4) << of_other.errors;
  EXPECT_THAT(
      of_other.output,
      HasSubstr("session: bone: the case's femur is not the mesh that this session was recorded with"));
  EXPECT_THAT(of_other.output, Not(HasSubstr("registration")));

  // Nobody was at its pedal: there is no operation to go on with.
  const auto resumed = run_program({"resume", knee, "--json"});
  EXPECT_EQ(resumed.exit_code, 0) << resumed.errors;
  const auto told = nlohmann::json::parse(resumed.output);
  EXPECT_EQ(test::undescribed(told, "resumable"), "");
  EXPECT_FALSE(told.at("is_found"));
  EXPECT_THAT(told.at("why_none"), HasSubstr("nobody was at its pedal"));
  EXPECT_THAT(run_program({"resume", knee}).output, HasSubstr("Nothing was left in the middle: session"));

  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open((session / "session.sqlite").c_str(), &database), SQLITE_OK);
  sqlite3_exec(database, "UPDATE markers SET tx_mm = tx_mm + 0.5 WHERE frame = 7 AND marker_id = 2", nullptr,
               nullptr, nullptr);
  sqlite3_exec(database, "DELETE FROM ending", nullptr, nullptr, nullptr);
  sqlite3_close(database);
  const auto changed = run_program({"replay", knee, "-o", folder_ / "differences.csv"});
  EXPECT_EQ(changed.exit_code, 4);
  EXPECT_THAT(changed.output, HasSubstr("frame 7: pose of marker 2: 0.5"));
  EXPECT_THAT(changed.errors, HasSubstr("the record is not as it was recorded: session.sqlite: frames 0 to"));
  EXPECT_THAT(changed.output,
              HasSubstr("the recording was cut short: the program ended before the session did"));
  const auto table = run_program({"replay", knee, "-o", "-"});
  EXPECT_EQ(table.exit_code, 4);
  EXPECT_THAT(table.output, ::testing::StartsWith("frame,what,amount,unit,detail\n7,pose of marker 2,"));
  EXPECT_EQ(table.errors, changed.errors);
  const auto broken = run_program({"verify", knee, "--json"});
  EXPECT_EQ(broken.exit_code, 4);
  EXPECT_THAT(broken.errors, HasSubstr("session.sqlite: frames 0 to"));
  const auto checked = nlohmann::json::parse(broken.output);
  EXPECT_EQ(test::undescribed(checked, "verify"), "");
  const auto findings = checked.at("sessions").at(0).at("findings");
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_LE(findings[0].at("from"), 7);
  EXPECT_GT(findings[0].at("to"), 7);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "differences.csv"));
  const auto reported = run_program({"report", knee, "-o", folder_ / "report.json"});
  EXPECT_EQ(reported.exit_code, 4);
  EXPECT_THAT(reported.errors, HasSubstr("is no longer what was recorded: session.sqlite: frames 0 to"));

  // 2^32 + 2 is no marker 2.
  ASSERT_EQ(sqlite3_open((session / "session.sqlite").c_str(), &database), SQLITE_OK);
  sqlite3_exec(database, "UPDATE markers SET marker_id = 4294967298 WHERE frame = 7 AND marker_id = 2",
               nullptr, nullptr, nullptr);
  sqlite3_close(database);
  const auto beyond = run_program({"replay", knee});
  EXPECT_EQ(beyond.exit_code, 3);
  EXPECT_THAT(beyond.errors, HasSubstr("session.sqlite: marker_id: 4294967298 is out of range"));

  // Of an older session, or of none, only when that is said.
  test::write_file(session / "session.sqlite", "spoilt");
  const auto without = run_program({"report", knee, "-o", folder_ / "report.json"});
  EXPECT_EQ(without.exit_code, 4);
  EXPECT_THAT(without.errors, AllOf(HasSubstr("the session " + session.filename().string() +
                                              " is damaged and only in it as far as it is whole"),
                                    HasSubstr("session.sqlite: file is not a database"),
                                    HasSubstr("the registration cannot be read and is not in it")));
}

// A video that breaks off leaves no session in the case, and not its camera either.
TEST_F(VideoCommands, NavigateLeavesNothingBehindWhenItFails) {
  const std::string knee = folder_ / "knee.arthro";
  ASSERT_EQ(run_program({"phantom", "-o", knee}).exit_code, 0);
  std::filesystem::resize_file(folder_ / "clip.mkv", std::filesystem::file_size(folder_ / "clip.mkv") / 2);
  const auto result =
      run_program({"navigate", knee, "--video", folder_ / "clip.mkv", "--camera", folder_ / "camera.json",
                   "--tools", folder_ / "tools.json", "--fixed-lens"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.errors, HasSubstr("clip.mkv"));
  EXPECT_FALSE(std::filesystem::exists(knee + "/camera.json"));
  EXPECT_TRUE(!std::filesystem::exists(knee + "/sessions") || std::filesystem::is_empty(knee + "/sessions"));
}

// How a live source usually ends: the session is closed whole, and nothing of it is half written.
TEST_F(VideoCommands, NavigateKeepsWhatALiveSourceGaveUntilCtrlC) {
  const std::string knee = folder_ / "knee.arthro";
  ASSERT_EQ(run_program({"phantom", "-o", knee}).exit_code, 0);
  const auto session = [&]() -> std::filesystem::path {
    if (!std::filesystem::exists(knee + "/sessions") || std::filesystem::is_empty(knee + "/sessions"))
      return {};
    return *std::filesystem::directory_iterator(knee + "/sessions");
  };
  const std::string given = files::read_text(folder_ / "camera.json");
  const auto result = run_program(
      {"navigate", knee, "--video",
       "gst:videotestsrc is-live=true ! video/x-raw,width=640,height=480,framerate=30/1 ! appsink",
       "--camera", folder_ / "camera.json", "--tools", folder_ / "tools.json", "--fixed-lens", "--no-copy"},
      {.interrupts_when = [&] {
        const auto folder = session();
        const bool runs = !folder.empty() && std::filesystem::exists(folder / "session.sqlite");
        if (runs) test::write_file(folder_ / "camera.json", "somebody calibrates meanwhile");
        return runs;
      }});
  EXPECT_EQ(files::read_text(knee + "/camera.json"), given);
  EXPECT_EQ(result.exit_code, 4) << result.errors;  // no marker was seen
  EXPECT_THAT(result.output, HasSubstr("the source ended: stopped by hand"));
  EXPECT_TRUE(std::filesystem::exists(session() / "poses.csv"));
  for (const auto& file : std::filesystem::directory_iterator(session()))
    EXPECT_NE(file.path().extension(), ".part") << file.path();
  const auto verified = run_program({"verify", knee, "--session", session().filename()});
  EXPECT_EQ(verified.exit_code, 0) << verified.errors;
}

// Between two sessions nobody sees the marker, and here nobody can touch the bone: live pictures are guided
// by an earlier session's registration where it is named, and only there. A recording is no patient.
TEST_F(VideoCommands, Hazard25LiveNoEarlierRegistrationGuidesUnnamed) {
  const std::string knee = folder_ / "knee.arthro";
  ASSERT_EQ(run_program({"phantom", "-o", knee}).exit_code, 0);
  const auto navigate = [&](const std::string& video, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"navigate",     knee,
                                       "--video",      video,
                                       "--camera",     folder_ / "camera.json",
                                       "--tools",      folder_ / "tools.json",
                                       "--medium",     "air",
                                       "--fixed-lens", "--duration-s",
                                       "0.3",          "--no-copy"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto result = run_program(arguments);
    EXPECT_THAT(result.exit_code, ::testing::AnyOf(0, 4)) << result.errors;
    const auto sessions = cases::session_folders(knee);
    EXPECT_FALSE(sessions.empty());
    return std::pair(result.output + result.errors,
                     sessions.empty() ? std::filesystem::path() : sessions.back());
  };
  const auto stands_in = [](const std::filesystem::path& session) {
    if (!std::filesystem::exists(session / "registration.json")) return false;
    return registration::read_registration_record(session / "registration.json").registration.has_pose;
  };
  const std::string live =
      "gst:videotestsrc is-live=true ! video/x-raw,width=640,height=480,framerate=30/1 ! appsink";
  registration::RegistrationSummary found;
  found.has_pose = found.reliable = true;
  found.reasons.clear();
  found.covariance.diagonal().head<3>().setConstant(0.01);
  found.marker_from_bone.translation_mm =
      -cases::load_case(knee).bones.at(bones::BoneKind::Femur).mesh.vertices_mm.front();
  registration::Provenance of;
  of.source = sources::SourceKind::Live;
  of.world_marker_id = 0;
  const auto [first_said, first] = navigate(live);
  const std::string file = first / "registration.json";
  registration::write_registration_file(file, found, &of);

  const auto [said, session] = navigate(live);
  EXPECT_THAT(said, HasSubstr("registration: that of session " + first.filename().string() +
                              " is not used: nobody has seen the world marker since"));
  EXPECT_FALSE(stands_in(session));
  const auto [named, by_name] = navigate(live, {"--registration", file});
  EXPECT_THAT(named, HasSubstr("has not moved since it was found is your word"));
  EXPECT_TRUE(stands_in(by_name));

  of.source = sources::SourceKind::Recording;
  for (const std::filesystem::path& folder : {session, by_name})
    registration::write_registration_file(folder / "registration.json", found, &of);
  const auto [shown, recording] = navigate(folder_ / "clip.mkv");
  EXPECT_THAT(shown, HasSubstr("registration: of session " + by_name.filename().string()));
  EXPECT_TRUE(stands_in(recording));

  // Reliable by its own word alone: neither named nor out of the case does it guide.
  found.marker_from_bone.translation_mm.x() += 650;
  registration::write_registration_file(file, found);
  const std::string far_named = navigate(folder_ / "clip.mkv", {"--registration", file}).first;
  EXPECT_THAT(far_named, HasSubstr("not said of which camera and marker it is"));
  EXPECT_THAT(far_named, HasSubstr("mm away from the marker that sits on it"));
  EXPECT_THAT(far_named, Not(HasSubstr(", reliable")));
  for (const std::filesystem::path& folder : cases::session_folders(knee))
    registration::write_registration_file(folder / "registration.json", found, &of);
  EXPECT_THAT(navigate(folder_ / "clip.mkv").first,
              ::testing::AllOf(HasSubstr(" is not used: "), HasSubstr("it puts the femur")));
}

}  // namespace
}  // namespace arthronaut
