// What a report for strangers says of neither: who the patient is, which session it was, and when.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>

#include "navigation/operation/achieved_tunnel.h"
#include "navigation/recording/session_database.h"
#include "navigation/recording/session_files.h"
#include "navigation/recording/session_marks.h"
#include "tests/app/report/reported_case.h"

namespace arthronaut::report {
namespace {

// A case in a folder of the patient's name, with a session whose video could not be copied.
class ReportForStrangers : public Report {
 protected:
  void SetUp() override {
    Report::SetUp();
    const auto folder = cases::create_session_folder(knee_folder());
    pipeline::PipelineOptions options;
    options.calibration = {.image_size_px = {1920, 1080}, .focal_px = 600, .boundary = {{960, 540}, 520}};
    options.tools = tools::standard_tools();
    recording::SessionHeader header;
    header.id = folder.filename().string();
    header.started_utc = "2026-01-31T12:00:00Z";
    recording::SessionRecorder recorder(folder, header, options);
    recorder.set_registration({});
    recorder.append({});
    recorder.append_latency({.tracking_ms = 3});
    recorder.add_event(
        {0, std::string(recording::kVideoStoppedEvent), "/media/Mueller_Jane.mkv: no such video"});
    recorder.finish();
    std::filesystem::rename(knee_folder(), patients_folder());
    session_ = cases::session_folders(patients_folder()).back();
  }
  std::filesystem::path patients_folder() const { return pdf().parent_path() / "Mueller_Jane.arthro"; }

  // In every form of it nothing names the patient's folder, the session or its day.
  void expect_names_nobody() const {
    const std::string session = session_.filename().string(), day = session.substr(5, 8);
    ASSERT_TRUE(std::all_of(day.begin(), day.end(), [](unsigned char c) { return std::isdigit(c) != 0; }));
    const auto expect_not_in = [&](const std::string& text) {
      for (const std::string& told :
           {std::string("Mueller"), std::string("Jane"), session, day, std::string("2026-01-31")})
        EXPECT_EQ(text.find(told), std::string::npos) << told << " is in:\n" << text;
    };
    const ReportOptions options{.is_deidentified = true, .picture_px_per_mm = 1};
    const auto json = pdf().parent_path() / "report.json";
    for (const std::string& said : write_report(patients_folder(), json, options)) expect_not_in(said);
    expect_not_in(files::read_text(json));
    write_report(patients_folder(), pdf(), options);
    expect_not_in(pdf_text());
  }
  std::string told() const {
    write_report(patients_folder(), pdf(), {.picture_px_per_mm = 1});
    return pdf_text();
  }

  std::filesystem::path session_;
};

// Hazard 19: what cannot be read is told by the file within the session, not by where that lies.
TEST_F(ReportForStrangers, Hazard19ARecordThatCannotBeReadNamesNobody) {
  // What a damaged page does: all that the report reads of the record is there, and not all that was hashed.
  recording::SessionDatabase::open(recording::database_file(session_)).execute("DROP TABLE latency");
  EXPECT_THAT(told(), testing::AllOf(testing::HasSubstr("are not readable: session.sqlite:"),
                                     testing::Not(testing::HasSubstr("Mueller_Jane.arthro"))));
  expect_names_nobody();
  expect_contains(pdf_text(), "are not readable");
  expect_contains(pdf_text(), "CUT SHORT: why is not told");
}

// Nor does what another session says of itself: the femur was drilled in it, the tibia in the one after it.
TEST_F(ReportForStrangers, Hazard19AnotherSessionsSafetyNamesNobody) {
  const auto tibia = cases::create_session_folder(patients_folder());
  recording::SessionHeader header;
  header.id = tibia.filename().string();
  header.bone = bones::BoneKind::Tibia;
  pipeline::PipelineOptions options;
  options.bone = header.bone;
  options.calibration = {.image_size_px = {1920, 1080}, .focal_px = 600, .boundary = {{960, 540}, 520}};
  options.tools = tools::standard_tools();
  recording::SessionRecorder(tibia, header, options).finish();
  for (const auto& [folder, bone] :
       {std::pair{session_, bones::BoneKind::Femur}, std::pair{tibia, bones::BoneKind::Tibia}}) {
    const tunnels::Tunnel& planned = knee_.plan.tunnels.at(bone);
    operation::write_achieved_file(
        folder / operation::achieved_file_name(planned.key()),
        {.planned = planned, .measured = planned, .depth_mm = 30, .pose_count = 42, .truth = {}});
  }
  expect_contains(told(), "CUT SHORT: the video stopped: /media/Mueller_Jane.mkv");
  expect_names_nobody();
  expect_contains(pdf_text(), "The session of the femur");
  expect_contains(pdf_text(), "CUT SHORT: why is not told");
}

TEST_F(ReportForStrangers, Hazard19ABrokenFileOfMarksNamesNobody) {
  files::write_atomically(recording::marks_file(session_), "{");
  expect_contains(told(), "NOT READABLE: sessions/" + session_.filename().string());
  expect_names_nobody();
  expect_contains(pdf_text(), "NOT READABLE: why is not told");
}

TEST_F(ReportForStrangers, Hazard19ABrokenComparisonNamesNobody) {
  files::write_atomically(patients_folder() / "achieved.json", "{");
  expect_names_nobody();
  expect_contains(pdf_text(), "NOT READABLE: why is not told");
}

}  // namespace
}  // namespace arthronaut::report
