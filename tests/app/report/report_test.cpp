#include "app/report/report.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <tuple>

#include "navigation/operation/achieved_tunnel.h"
#include "navigation/recording/case_sessions.h"
#include "navigation/recording/session.h"
#include "navigation/recording/session_check.h"
#include "navigation/recording/session_marks.h"
#include "navigation/sources/exercise_source.h"
#include "navigation/tools/tool_set.h"
#include "planning/cases/case.h"
#include "planning/cases/identity.h"
#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"
#include "planning/phantom/phantom_case.h"
#include "planning/plan_review/plan_review.h"
#include "planning/postop/achieved_file.h"
#include "tests/app/report/page_edges.h"
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

// What happened when, what whoever looked at it marked, and by what the record is known. A broken file of
// marks is told and takes nothing else away.
TEST_F(Report, HasStepsMarksAndTheLastHash) {
  (void)text_of_session("live", {{recording::kVerifiedEvent, ""}, {recording::kVoidEvent, "bumped"}});
  const std::filesystem::path session = cases::session_folders(knee_folder()).back();
  recording::write_marks(session, {{3, 65'400'000'000, "marker, in glare"}, {9, 70'000'000'000, ""}});
  write_report(knee_folder(), pdf());
  const std::string text = pdf_text();
  for (const char* const part : {"bone registered", "registration verified", "registration void",
                                 "Marks of who looked", "marker, in glare", "(frame 3)", "(no note)"})
    expect_contains(text, part);
  const std::string hash = recording::chain_head(session);
  ASSERT_EQ(hash.size(), 64u);
  for (const std::size_t at : {0, 16, 32, 48}) expect_contains(text, hash.substr(at, 16));
  files::write_atomically(recording::marks_file(session), "{");
  write_report(knee_folder(), pdf());
  expect_contains(pdf_text(), "NOT READABLE");
  expect_contains(pdf_text(), "bone registered");
}

// Hazard 40: the tunnel of an exercise is nobody's, and an older session is not hidden by it.
TEST_F(Report, Hazard40AnExerciseIsNotReported) {
  (void)text_of_session("simulation", {});
  const std::filesystem::path operation = cases::session_folders(knee_folder()).back();
  (void)text_of_session("simulation", {});
  const std::filesystem::path exercise = cases::session_folders(knee_folder()).back();
  ASSERT_NE(operation, exercise);
  const auto planned = knee_.plan.tunnels.at(bones::BoneKind::Femur);
  operation::write_achieved_file(
      exercise / "achieved.json",
      {.planned = planned, .measured = planned, .depth_mm = 30, .pose_count = 42, .truth = {}});
  auto header = nlohmann::json::parse(files::read_text(exercise / "session.json"));
  header["source"] = sources::kExerciseSource;
  files::write_atomically(exercise / "session.json", header.dump());
  const auto json_file = pdf().parent_path() / "report.json";
  write_report(knee_folder(), json_file, {.says_when_made = false});
  const auto json = nlohmann::json::parse(files::read_text(json_file));
  EXPECT_TRUE(!json.contains("achieved") || json.at("achieved").empty());
  EXPECT_NE(json.dump().find(operation.filename().string()), std::string::npos);
  EXPECT_EQ(json.dump().find(exercise.filename().string()), std::string::npos);
}

// The same numbers for other programs: whatever the table says, the document says.
TEST_F(Report, GivesTheSameNumbersAsJsonAndAsATable) {
  cases::save_identity(knee_folder(), {"Muster^Anna", "4711", "19900131"});
  (void)text_of_session("live", {{recording::kVerifiedEvent, ""}});
  const std::filesystem::path session = cases::session_folders(knee_folder()).back();
  recording::write_marks(session, {{3, 0, "a \"quoted\" note, with a comma"}});
  const auto planned = knee_.plan.tunnels.at(bones::BoneKind::Femur);
  auto measured = planned;
  measured.entry_mm += 1.25 * planned.direction.unitOrthogonal();
  operation::write_achieved_file(
      session / "achieved.json",
      {.planned = planned, .measured = measured, .depth_mm = 30, .pose_count = 42, .truth = {}});
  const auto json_file = pdf().parent_path() / "report.json", csv_file = pdf().parent_path() / "report.csv";
  write_report(knee_folder(), json_file, {.says_when_made = false});
  write_report(knee_folder(), csv_file, {.says_when_made = false});
  const auto json = nlohmann::json::parse(files::read_text(json_file));
  EXPECT_EQ(json.at("format"), "arthronaut.report");
  EXPECT_EQ(json.at("case").at("name"), "Knee of Ærø");
  EXPECT_FALSE(json.contains("patient"));
  EXPECT_NEAR(json.at("achieved").at(0).at("difference").at("entry_mm").get<double>(), 1.25, 1e-9);
  EXPECT_EQ(json.at("session").at("marks").at(0).at("note"), "a \"quoted\" note, with a comma");
  EXPECT_EQ(json.at("session").at("steps").size(), 2u);
  EXPECT_EQ(json.at("session").at("last_hash"), recording::chain_head(session));
  const plan_review::CaseReview review(cases::load_case(knee_folder()));
  EXPECT_EQ(json.at("tunnels").at(0).at("checks").size(), review.checks(bones::BoneKind::Femur).size());

  const std::string csv = files::read_text(csv_file);
  EXPECT_TRUE(csv.starts_with("quantity,value\n"));
  expect_contains(csv, "session/marks/0/note,\"a \"\"quoted\"\" note, with a comma\"\n");
  std::size_t numbers = 0;
  const nlohmann::json flat = json.flatten();
  for (const auto& [path, value] : flat.items()) {
    if (!value.is_number()) continue;
    ++numbers;
    expect_contains(csv, path.substr(1) + "," + value.dump() + "\n");
  }
  EXPECT_GT(numbers, 30u);
  write_report(knee_folder(), json_file, {.with_identity = true});
  expect_contains(files::read_text(json_file), "Muster^Anna");
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

// What a CT after the operation showed, of both bones: a reliable one, and one in doubt with every reason; in
// the PDF and, the same numbers, for other programs.
TEST_F(Report, ComparesWithImagesAfterTheOperation) {
  const auto achieved_file = knee_folder() / "achieved.json";
  std::map<tunnels::TunnelKey, postop::Comparison> comparisons;
  for (const auto kind : {bones::BoneKind::Femur, bones::BoneKind::Tibia}) {
    const tunnels::Tunnel& plan = knee_.plan.tunnels.at(kind);
    postop::Comparison& comparison = comparisons[plan.key()];
    comparison.bone = {.is_found = true,
                       .plan_from_postop = {},
                       .rms_mm = 0.21,
                       .on_edge_share = 0.9,
                       .in_view_share = 1,
                       .reliable = true,
                       .reasons = {}};
    postop::AchievedTunnel& found = comparison.tunnel;
    found.is_found = found.reliable = true;
    found.reasons.clear();
    found.tunnel = plan;
    found.offset_mm = kind == bones::BoneKind::Femur ? 1.37 : 2.46;
    found.tunnel.entry_mm += found.offset_mm * plan.direction.unitOrthogonal();
    found.tunnel.diameter_mm = 8.4;
    found.length_mm = 27.3;
    found.entry_sigma_mm = 0.08;
    found.direction_sigma_rad = geometry::rad_from_deg(0.25);
    found.widths = {{2, 8.4}, {12, 9.6}};
  }
  postop::AchievedTunnel& doubted = comparisons.at(bones::BoneKind::Tibia).tunnel;
  doubted.reliable = false;
  doubted.metal_share = 0.37;
  doubted.reasons = {"metal hides most of the wall"};
  postop::write_achieved_file(achieved_file, comparisons);
  write_report(knee_folder(), pdf());
  std::string text = pdf_text();
  for (const char* const part :
       {"CT after the operation", "1.37 mm", "2.46 mm", "0.08", "8.4 mm; planned", "8.4 to 9.6 mm",
        "27.3 mm, a socket", "0.21 mm", "37 %", "NOT RELIABLE", "tibia: metal hides most of the wall"})
    expect_contains(text, part);
  const auto json_file = pdf().parent_path() / "report.json";
  write_report(knee_folder(), json_file);
  const auto json = nlohmann::json::parse(files::read_text(json_file)).at("postoperative");
  ASSERT_EQ(json.size(), 2U);
  EXPECT_NEAR(json[0].at("offset_mm").get<double>(), 1.37, 1e-9);
  EXPECT_TRUE(json[0].at("reliable").get<bool>());
  EXPECT_FALSE(json[1].at("reliable").get<bool>());
  EXPECT_EQ(json[1].at("reasons").at(0), "metal hides most of the wall");
  const auto csv_file = pdf().parent_path() / "report.csv";
  write_report(knee_folder(), csv_file);
  expect_contains(files::read_text(csv_file), "postoperative/1/achieved/diameter_mm,8.4\n");
  // The plan goes elsewhere: the differences are not those to it.
  tunnels::Tunnel moved = knee_.plan.tunnels.at(bones::BoneKind::Femur);
  moved.entry_mm += 3 * moved.direction.unitOrthogonal();
  knee_.plan.put(moved, "");
  cases::save_case(knee_folder(), knee_);
  write_report(knee_folder(), pdf());
  expect_contains(pdf_text(), "of an earlier plan");
  // Nothing was found: no number is shown.
  comparisons.at(bones::BoneKind::Femur).tunnel = {};
  postop::write_achieved_file(achieved_file, comparisons);
  write_report(knee_folder(), pdf());
  expect_contains(pdf_text(), "no tunnel found");
  EXPECT_EQ(pdf_text().find("1.37 mm"), std::string::npos);
  files::write_atomically(achieved_file, "{");
  write_report(knee_folder(), pdf());
  expect_contains(pdf_text(), "NOT READABLE");
  std::filesystem::remove(achieved_file);
  write_report(knee_folder(), pdf());
  expect_contains(pdf_text(), "No comparison with images after the operation");
}

// The pictures that were recorded at the moments that matter, the same bytes each time; without a video the
// report says so, and the name of a video that is gone is not in it.
TEST_F(Report, ShowsWhatTheSurgeonSaw) {
  expect_contains(text_of_session("live", {}), "The session keeps no video");
  const auto folder = cases::create_session_folder(knee_folder());
  pipeline::PipelineOptions options;
  options.calibration = {.image_size_px = {320, 240}, .focal_px = 100, .boundary = {{160, 120}, 110}};
  options.tools = tools::standard_tools();
  recording::SessionHeader header;
  header.id = folder.filename().string();
  registration::RegistrationSummary registration;
  registration.has_pose = registration.reliable = true;
  registration.reasons.clear();
  {
    recording::SessionRecorder recorder(folder, header, options);
    recorder.set_registration(registration);
    for (int i = 0; i < 5; ++i) {
      auto frame = std::make_shared<camera::Frame>();
      frame->index = i;
      frame->timestamp_ns = i * 100'000'000LL;
      frame->width = 320;
      frame->height = 240;
      frame->bgr.assign(3UL * 320 * 240, static_cast<std::uint8_t>(40 * i));
      recorder.append_picture(frame);
      pipeline::FrameResult result;
      result.frame_index = i;
      result.timestamp_ns = frame->timestamp_ns;
      result.guidance.state = guidance::GuidanceState::Valid;
      result.guidance.axis_to_entry_mm = i == 2 ? 0.7 : 3.0;  // closest in the third
      result.guidance.angle_deg = 1.2;
      recorder.append(result);
    }
    recorder.add_event({400'000'000, std::string(recording::kDrilledEvent), "", -1});
    recorder.finish();
  }
  write_report(knee_folder(), pdf());
  const std::string text = pdf_text();
  expect_contains(text, "Pictures of the session, with the plan");
  expect_contains(text, "0:00.2: aimed closest, 0.7 mm, 1.2\u00B0");
  expect_contains(text, "0:00.4: drilled");
  const std::string bytes = make_report(knee_folder(), {.says_when_made = false});
  EXPECT_EQ(bytes, make_report(knee_folder(), {.says_when_made = false}));
  const auto video = recording::RecordedSession(folder).video();
  ASSERT_TRUE(std::filesystem::exists(video));
  std::filesystem::remove(video);
  write_report(knee_folder(), pdf());
  expect_contains(pdf_text(), "The session's video is not there, or cannot be read");
  EXPECT_EQ(pdf_text().find(video.filename().string()), std::string::npos);
}

// On either paper every page is of that paper, has its foot, and nothing comes near an edge: neither words
// that have no space to be broken at, nor a table that is longer than a page.
TEST_F(Report, FitsA4AndLetter) {
  knee_.name = std::string(160, 'W');
  cases::save_case(knee_folder(), knee_);
  (void)text_of_session("live",
                        {{recording::kVerifiedEvent, ""}, {recording::kVoidEvent, std::string(300, 'x')}});
  recording::SessionMarks marks;
  for (std::int64_t i = 0; i < 90; ++i) marks.push_back({i, i * 1'000'000'000, "mark " + std::to_string(i)});
  recording::write_marks(cases::session_folders(knee_folder()).back(), marks);
  for (const auto& [paper, width_pt, height_pt] :
       {std::tuple(Paper::A4, 595.28, 841.89), std::tuple(Paper::Letter, 612.0, 792.0)}) {
    SCOPED_TRACE(to_text(paper));
    write_report(knee_folder(), pdf(), {.paper = paper});
    const auto pages = test::pages_of(pdf());
    EXPECT_GE(pages.size(), 5U);
    for (const test::Page& page : pages) {
      EXPECT_NEAR(page.width_pt, width_pt, 0.1);
      EXPECT_NEAR(page.height_pt, height_pt, 0.1);
      EXPECT_GT(page.words, 0);
      EXPECT_TRUE(page.words_lie_within(10)) << page.outermost;
      EXPECT_TRUE(page.has_empty_edge);
    }
    const std::string text = pdf_text();
    for (std::size_t page = 1; page <= pages.size(); ++page)
      expect_contains(text, "page " + std::to_string(page) + " \u00B7 research software");
    for (int i = 0; i < 90; ++i) expect_contains(text, "mark " + std::to_string(i) + " ");
  }
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
