#include "app/report/report.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "navigation/operation/achieved_tunnel.h"
#include "navigation/recording/session.h"
#include "navigation/tools/tool_set.h"
#include "planning/cases/case.h"
#include "planning/cases/identity.h"
#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"
#include "planning/phantom/phantom_case.h"
#include "planning/plan_review/plan_review.h"
#include "tests/temporary_folder.h"

namespace arthronaut::report {

namespace {

// A case of the phantom, its meshes coarse: pictures are looked at elsewhere.
class Report : public ::testing::Test {
 protected:
  void SetUp() override {
    knee_ = phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 3.0}), "Knee of Ærø");
    cases::save_case(knee_folder(), knee_);
  }
  std::filesystem::path knee_folder() const { return folder_ / "Knee.arthro"; }
  std::filesystem::path pdf() const { return folder_ / "report.pdf"; }

  std::string pdf_info() const { return output_of("pdfinfo " + pdf().string()); }
  std::string pdf_text() const { return output_of("pdftotext -layout " + pdf().string() + " - 2>/dev/null"); }

  // The report of a session of this kind of source with a registration, and with these events after it.
  std::string text_of_session(const std::string& source_kind,
                              const std::vector<std::pair<std::string_view, std::string>>& events) const {
    const auto session_folder = cases::create_session_folder(knee_folder());
    pipeline::PipelineOptions options;
    options.calibration = {.image_size_px = {1920, 1080}, .focal_px = 600, .boundary = {{960, 540}, 520}};
    options.tools = tools::standard_tools();
    recording::SessionHeader header;
    header.id = session_folder.filename().string();
    header.source_kind = source_kind;
    registration::RegistrationSummary registration;
    registration.has_pose = registration.reliable = true;
    registration.reasons.clear();
    recording::SessionRecorder recorder(session_folder, header, options);
    recorder.set_registration(registration);
    for (const auto& [kind, text] : events) recorder.add_event({0, std::string(kind), text, -1});
    recorder.finish();
    write_report(knee_folder(), pdf());
    return pdf_text();
  }

  cases::Case knee_;

 private:
  std::string output_of(const std::string& command) const {
    const auto file = folder_ / "output.txt";
    EXPECT_EQ(std::system((command + " > " + file.string()).c_str()), 0) << command;
    return files::read_text(file);
  }
  const test::TemporaryFolder folder_;
};

int page_count(const std::string& info) {
  const auto at = info.find("Pages:");
  return at == std::string::npos ? 0 : std::atoi(info.c_str() + at + 6);
}

void expect_contains(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "\"" << part << "\" is not in:\n" << text;
}

}  // namespace

// A case that has only been planned: the plan's numbers, versions and what the software is not.
TEST_F(Report, OfAPlanAloneSaysThatNothingWasNavigated) {
  write_report(knee_folder(), pdf());
  EXPECT_GE(page_count(pdf_info()), 2);
  const std::string text = pdf_text();
  expect_contains(text, "Knee of Ærø");
  expect_contains(text, "not a medical device");
  expect_contains(text, "No session with a registration");
  expect_contains(text, "femur");
  expect_contains(text, "OpenCV");
}

// The sheet has every check of both tunnels, in words, and the percentages of the entries.
TEST_F(Report, HasThePlanOnOneSheet) {
  write_report(knee_folder(), pdf());
  const std::string text = pdf_text();
  expect_contains(text, "The plan on one sheet");
  expect_contains(text, "True lateral view");
  expect_contains(text, "Entry at ");
  const plan_review::CaseReview review(cases::load_case(knee_folder()));
  for (const auto kind : {bones::BoneKind::Femur, bones::BoneKind::Tibia}) {
    expect_contains(text, "Checks of the " + std::string(bones::to_text(kind)));
    for (const auto& check : review.checks(kind)) expect_contains(text, check.name + ":");
  }
}

// One bone is a case too: neither page asks for a picture of the other.
TEST_F(Report, OfOneBoneAlone) {
  for (const auto kind : {bones::BoneKind::Femur, bones::BoneKind::Tibia}) {
    auto one = knee_;
    std::erase_if(one.bones, [&](const auto& bone) { return bone.first != kind; });
    std::erase_if(one.plan.tunnels, [&](const auto& tunnel) { return tunnel.first != kind; });
    const auto folder = knee_folder().parent_path() / (std::string(bones::to_text(kind)) + ".arthro");
    cases::save_case(folder, one);
    write_report(folder, pdf());
    EXPECT_GE(page_count(pdf_info()), 2);
    expect_contains(pdf_text(), std::string(bones::to_text(kind)));
  }
}

// A session with a registration and a drilled tunnel: the comparison is the one that the geometry says.
TEST_F(Report, ComparesPlannedAndAchieved) {
  const auto session_folder = cases::create_session_folder(knee_folder());
  pipeline::PipelineOptions options;
  options.calibration = {.image_size_px = {1920, 1080}, .focal_px = 600, .boundary = {{960, 540}, 520}};
  options.tools = tools::standard_tools();
  recording::SessionHeader header;
  header.id = session_folder.filename().string();
  header.refractive_index = 1.333;
  registration::RegistrationSummary registration;
  registration.has_pose = true;
  registration.reasons = {"too few points", "one flat patch"};
  registration.assumptions = {"the cartilage was left out"};
  registration.point_count = 812;
  registration.rms_mm = 0.31;
  {
    recording::SessionRecorder recorder(session_folder, header, options);
    recorder.set_registration(registration);
    recorder.finish();
  }
  const auto planned = knee_.plan.tunnels.at(bones::BoneKind::Femur);
  auto measured = planned, truth = planned;
  const Eigen::Vector3d side = planned.direction.unitOrthogonal();
  measured.entry_mm += 1.25 * side;  // across the axis: entry and axis are off by the same
  truth.entry_mm += 2.0 * side;
  operation::write_achieved_file(
      session_folder / "achieved.json",
      {.planned = planned, .measured = measured, .depth_mm = 30, .pose_count = 42, .truth = truth});
  write_report(knee_folder(), pdf());
  EXPECT_GE(page_count(pdf_info()), 3);
  const std::string text = pdf_text();
  expect_contains(text, "NOT RELIABLE");
  expect_contains(text, "too few points");
  expect_contains(text, "assumed: the cartilage was left out");
  expect_contains(text, "812");
  expect_contains(text, "1.25 mm");  // plan to measured
  expect_contains(text, "2.00 mm");  // plan to truth
  expect_contains(text, "0.75 mm");  // measured to truth
  expect_contains(text, "water");
}

// Each start of a source is a session of its own: what was drilled in the one before is not left out.
TEST_F(Report, NamesTheTunnelOfTheOtherBundleThatWasDrilledInASessionBefore) {
  tunnels::Tunnel am = knee_.plan.tunnels.at(bones::BoneKind::Femur), pl = am;
  am.bundle = norms::Bundle::Anteromedial;
  pl.bundle = norms::Bundle::Posterolateral;
  pl.entry_mm += 8 * am.direction.unitOrthogonal();
  knee_.plan.put(am, "");
  knee_.plan.put(pl, "");
  cases::save_case(knee_folder(), knee_);
  std::string first;
  const auto record = [&](const tunnels::Tunnel& planned, const std::string& source_kind) {
    const auto folder = cases::create_session_folder(knee_folder());
    if (first.empty()) first = folder.filename().string();
    recording::SessionHeader header;
    header.id = folder.filename().string();
    header.source_kind = source_kind;
    pipeline::PipelineOptions options;
    options.calibration = {.image_size_px = {1920, 1080}, .focal_px = 600, .boundary = {{960, 540}, 520}};
    options.tools = tools::standard_tools();
    recording::SessionRecorder(folder, header, options).finish();
    auto measured = planned;
    measured.entry_mm += (planned.bundle == am.bundle ? 1.25 : 0.75) * planned.direction.unitOrthogonal();
    operation::write_achieved_file(
        folder / operation::achieved_file_name(planned.key()),
        {.planned = planned, .measured = measured, .depth_mm = 30, .pose_count = 42, .truth = {}});
  };
  record(am, "live");
  record(pl, "live");
  write_report(knee_folder(), pdf());
  const std::string text = pdf_text();
  expect_contains(text, "Planned against achieved: femur PL");
  expect_contains(text, "0.75 mm");
  expect_contains(text, "Planned against achieved: femur AM");
  expect_contains(text, "1.25 mm");
  expect_contains(text, "Drilled in the session " + first);
  // A rehearsal's is nobody's knee: after it the live ones are not its own.
  record(pl, "simulation");
  write_report(knee_folder(), pdf());
  EXPECT_EQ(pdf_text().find("Planned against achieved: femur AM"), std::string::npos);
}

// Hazard 2: nobody takes the figures of a simulation for a patient's.
TEST_F(Report, Hazard2NamesTheKindOfSource) {
  expect_contains(text_of_session("simulation", {}), "simulation: nobody's knee");
  expect_contains(text_of_session("recording", {}), "recording: a video that was made before");
  const std::string live = text_of_session("live", {});
  expect_contains(live, "live: a camera, as it came");
  expect_contains(live, "not confirmed in this session");
  expect_contains(live, "not verified");
  expect_contains(live, "none in this session");  // of a nominal guide
  expect_contains(text_of_session("live", {{recording::kGuideCheckedEvent, "its tip lies 0.4 mm off"}}),
                  "its tip lies 0.4 mm off");
}

// What was asked before the guide was followed, and what spoke against it, is in the report.
TEST_F(Report, SaysHowItWasVerifiedConfirmedAndDoubted) {
  const std::string good = text_of_session("live", {{"time-out confirmed", "right femur"},
                                                    {recording::kVerifiedEvent, ""},
                                                    {recording::kAlarmEvent, "The control point has moved"},
                                                    {recording::kAlarmEvent, ""}});
  expect_contains(good, "verified by touches");
  expect_contains(good, "The control point has moved; over");
  EXPECT_EQ(good.find("not confirmed in this session"), std::string::npos);
  const std::string skipped = text_of_session("simulation", {{"verification skipped", "guidance began"}});
  expect_contains(skipped, "SKIPPED; guidance began without it");
  expect_contains(skipped, "not asked: no live source");
}

// Hazard 19: nobody is named unless that was asked for.
TEST_F(Report, Hazard19NamesThePatientOnlyWhenAsked) {
  cases::save_identity(knee_folder(), {"Muster^Anna", "4711", "19900131"});
  write_report(knee_folder(), pdf());
  for (const char* word : {"Muster", "4711", "1990"})
    EXPECT_EQ((pdf_text() + pdf_info()).find(word), std::string::npos) << word;
  write_report(knee_folder(), pdf(), {.with_identity = true});
  expect_contains(pdf_text(), "Muster, Anna");
  expect_contains(pdf_text(), "1990-01-31");
}

// In memory it is the same document as in a file; without its date it is the same at any time.
TEST_F(Report, CanBeTheSameBytesEachTime) {
  const std::string report = make_report(knee_folder(), {.says_when_made = false});
  EXPECT_EQ(report.substr(0, 5), "%PDF-");
  EXPECT_EQ(report, make_report(knee_folder(), {.says_when_made = false}));
  write_report(knee_folder(), pdf(), {.says_when_made = false});
  EXPECT_EQ(report, files::read_text(pdf()));
  EXPECT_EQ(pdf_text().find("Report made"), std::string::npos);
  write_report(knee_folder(), pdf());
  expect_contains(pdf_text(), "Report made");
}

// Hazard 21: a plan of another mesh is no valid plan, and the report says so.
TEST_F(Report, Hazard21SaysThatThePlanIsOfAnotherMesh) {
  write_report(knee_folder(), pdf());
  EXPECT_EQ(pdf_text().find("NOT VALID"), std::string::npos);
  cases::Plan plan = cases::load_case(knee_folder()).plan;
  plan.mesh_sha256[bones::BoneKind::Femur] = std::string(64, '0');
  cases::save_plan(knee_folder(), plan);
  write_report(knee_folder(), pdf());
  expect_contains(pdf_text(), "NOT VALID");
}

TEST_F(Report, LeavesNothingBehindWhenItFails) {
  EXPECT_THROW(write_report(knee_folder() / "nothing", pdf()), IoError);
  EXPECT_THROW(write_report(knee_folder(), "/nowhere/report.pdf"), IoError);
  EXPECT_FALSE(std::filesystem::exists(pdf()));
}

}  // namespace arthronaut::report
