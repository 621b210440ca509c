// What the report leaves out of a session, and says so: of another surface of the bone, of a broken file.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "navigation/operation/achieved_tunnel.h"
#include "navigation/recording/session_overview.h"
#include "tests/app/report/reported_case.h"
#include "tests/navigation/recording/recorded_frames.h"

namespace arthronaut::report {
namespace {

// With a registration that found a pose, on a bone of that surface.
void record(const std::filesystem::path& session_folder, const std::string& mesh_sha256, int frames = 0) {
  pipeline::PipelineOptions options;
  options.calibration = {.image_size_px = {1920, 1080}, .focal_px = 600, .boundary = {{960, 540}, 520}};
  options.tools = tools::standard_tools();
  recording::SessionHeader header;
  header.id = session_folder.filename().string();
  header.mesh_sha256 = mesh_sha256;
  registration::RegistrationSummary registration;
  registration.has_pose = true;
  recording::SessionRecorder recorder(session_folder, header, options);
  recorder.set_registration(registration);
  for (int i = 0; i < frames; ++i) recorder.append(test::frame_result(i));
  recorder.finish();
}

// The case's bone was replaced since: where in the new one it was drilled nobody knows.
TEST_F(Report, TellsNoPlaceInABoneThatTheSessionWasNotOf) {
  const auto session_folder = cases::create_session_folder(knee_folder());
  record(session_folder, "of another surface");
  const auto planned = knee_.plan.tunnels.at(bones::BoneKind::Femur);
  operation::write_achieved_file(
      session_folder / "achieved.json",
      {.planned = planned, .measured = planned, .depth_mm = 30, .pose_count = 42, .truth = {}});
  write(pdf());
  const std::string text = pdf_text();
  expect_contains(text, "THE CASE HAS ANOTHER SURFACE OF THE FEMUR");
  EXPECT_EQ(text.find("As navigation measured it: entry "), std::string::npos);
  const auto json_file = pdf().parent_path() / "report.json";
  write(json_file);
  const auto json = nlohmann::json::parse(files::read_text(json_file));
  EXPECT_EQ(json.at("session").at("is_of_another_surface"), true);
  EXPECT_FALSE(json.at("achieved").at(0).contains("wall_mm"));
}

// A registration's file that is broken takes nothing else away, also where its session is asked for by name.
TEST_F(Report, ABrokenRegistrationTakesNothingElseAway) {
  const auto session_folder = cases::create_session_folder(knee_folder());
  record(session_folder, "");
  std::ofstream(session_folder / "registration.json") << "{";
  ReportOptions options;
  options.session = session_folder.filename().string();
  write(pdf(), options);
  const std::string text = pdf_text();
  expect_contains(text, "NOT READABLE: the registration: ");
  expect_contains(text, "registration.json");
  expect_contains(text, "In theatre");
}

// A page of the record, and with it events and frames: what was measured lies in a file of its own.
void damage(const std::filesystem::path& session_folder, int first_page = 2) {
  std::fstream file(session_folder / "session.sqlite", std::ios::in | std::ios::out | std::ios::binary);
  constexpr int kPage = 4096;
  for (int page = first_page;; ++page) {  // the first but one; the first holds the tables' names
    file.seekg(0, std::ios::end);
    if (page * kPage >= file.tellg()) return;
    file.seekp(page * kPage);
    file.write(std::string(kPage, '\x5a').data(), kPage);
  }
}

// What is whole of a damaged record is told, and what is missing; nothing is made of what is not there.
TEST_F(Report, ADamagedRecordIsToldAsFarAsItIsWhole) {
  const auto session_folder = cases::create_session_folder(knee_folder());
  record(session_folder, "");
  const auto planned = knee_.plan.tunnels.at(bones::BoneKind::Femur);
  operation::write_achieved_file(
      session_folder / "achieved.json",
      {.planned = planned, .measured = planned, .depth_mm = 30, .pose_count = 42, .truth = {}});
  damage(session_folder);
  const auto json_file = pdf().parent_path() / "report.json";
  const std::vector<std::string> doubts = write(json_file);
  const auto json = nlohmann::json::parse(files::read_text(json_file));
  EXPECT_EQ(json.at("achieved").size(), 1U);
  EXPECT_TRUE(json.at("unreadable_sessions").empty());
  ASSERT_EQ(json.at("damaged_sessions").size(), 1U);
  EXPECT_EQ(json.at("damaged_sessions").at(0).at("id"), session_folder.filename().string());
  EXPECT_TRUE(json.at("session").at("was_finished").is_null());
  EXPECT_TRUE(json.at("session").at("registration").is_null());
  for (const char* const row : {"Verification", "Time-out", "Alarms, void registrations"})
    EXPECT_EQ(json.at("session").at("safety").at(row), "NOT KNOWN: the record is damaged") << row;
  ASSERT_FALSE(doubts.empty());
  expect_contains(doubts.front(), "is damaged and only in it as far as it is whole: ");
  write(pdf());
  expect_contains(pdf_text(), "DAMAGED, and in this report only as far as it is whole: ");
}

// One that is not the session that is told of may have said that a tunnel was drilled: that is not silent.
TEST_F(Report, ADamagedSessionBesideTheOneThatIsToldOfIsNamed) {
  const auto earlier = cases::create_session_folder(knee_folder());
  record(earlier, "");
  damage(earlier);
  const auto newer = cases::create_session_folder(knee_folder());
  record(newer, "");
  const auto planned = knee_.plan.tunnels.at(bones::BoneKind::Femur);
  operation::write_achieved_file(
      newer / "achieved.json",
      {.planned = planned, .measured = planned, .depth_mm = 30, .pose_count = 42, .truth = {}});
  const auto json_file = pdf().parent_path() / "report.json";
  const std::vector<std::string> doubts = write(json_file);
  ASSERT_EQ(doubts.size(), 1U);
  expect_contains(doubts.front(), earlier.filename().string() + " cannot be read and is not in it");
}

// Also where all that was done in it is whole, and its frames are not: nothing of them would be told.
TEST_F(Report, DamagedFramesOfAnotherSessionAreNamed) {
  const auto earlier = cases::create_session_folder(knee_folder());
  record(earlier, "", 2000);
  constexpr int kBehindAllTables = 60;  // what is done in a session without events lies in its first pages
  damage(earlier, kBehindAllTables);
  ASSERT_TRUE(recording::read_overview(earlier).problems.empty());
  const auto newer = cases::create_session_folder(knee_folder());
  record(newer, "");
  const auto json_file = pdf().parent_path() / "report.json";
  const std::vector<std::string> doubts = write(json_file);
  const auto json = nlohmann::json::parse(files::read_text(json_file));
  ASSERT_FALSE(json.at("damaged_sessions").empty());
  EXPECT_EQ(json.at("damaged_sessions").at(0).at("id"), earlier.filename().string());
  ASSERT_FALSE(doubts.empty());
  expect_contains(doubts.front(), earlier.filename().string() + " is damaged");
}

// Where there is no other one it is told of without a tunnel, too.
TEST_F(Report, ADamagedSessionIsBetterThanNone) {
  const auto session_folder = cases::create_session_folder(knee_folder());
  record(session_folder, "");
  damage(session_folder);
  const auto json_file = pdf().parent_path() / "report.json";
  write(json_file);
  const auto json = nlohmann::json::parse(files::read_text(json_file));
  EXPECT_TRUE(json.at("unreadable_sessions").empty());
  EXPECT_EQ(json.at("damaged_sessions").size(), 1U);
  EXPECT_EQ(json.at("session").at("bone"), "femur");
}

// A newer version's record may hold anything: it is named, with the reason, and nothing is told of it.
TEST_F(Report, ASessionOfANewerVersionIsNamed) {
  const auto session_folder = cases::create_session_folder(knee_folder());
  record(session_folder, "");
  auto header = nlohmann::json::parse(files::read_text(session_folder / "session.json"));
  header["version"] = 99;
  std::ofstream(session_folder / "session.json") << header;
  const std::vector<std::string> doubts = write(pdf());
  ASSERT_FALSE(doubts.empty());
  expect_contains(doubts.front(), "version: is 99, newer than this program reads");
  expect_contains(pdf_text(), "NOT READABLE, and not in this report: the session ");
}

}  // namespace
}  // namespace arthronaut::report
