// What the report leaves out of a session, and says so: of another surface of the bone, of a broken file.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "navigation/operation/achieved_tunnel.h"
#include "tests/app/report/reported_case.h"

namespace arthronaut::report {
namespace {

// With a registration that found a pose, on a bone of that surface.
void record(const std::filesystem::path& session_folder, const std::string& mesh_sha256) {
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

}  // namespace
}  // namespace arthronaut::report
