// What the report says of a session: what was reached and how it was verified.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "navigation/operation/achieved_tunnel.h"
#include "navigation/recording/session_check.h"
#include "navigation/recording/session_marks.h"
#include "navigation/sources/exercise_source.h"
#include "planning/geometry/error.h"
#include "tests/app/report/reported_case.h"

namespace arthronaut::report {
namespace {

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
    recorder.add_event({0, std::string(recording::kVideoStoppedEvent), "video.mkv: disk full"});
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
  write(pdf());
  EXPECT_GE(page_count(pdf_info()), 3);
  const std::string text = pdf_text();
  expect_contains(text, "NOT RELIABLE");
  expect_contains(text, "too few points");
  expect_contains(text, "assumed: the cartilage was left out");
  expect_contains(text, "812");
  expect_contains(text, "1.25 mm");  // plan to measured
  expect_contains(text, "2.00 mm");  // plan to truth
  expect_contains(text, "0.75 mm");  // measured to truth
  expect_contains(text, "As navigation measured it: entry ");
  expect_contains(text, "high to low");
  expect_contains(text, "least wall");
  expect_contains(text, "water");
  expect_contains(text, "CUT SHORT: the video stopped: video.mkv: disk full");
  EXPECT_EQ(text.find("changed since"), std::string::npos);
  // The first pages show today's plan, which did not guide.
  knee_.plan.tunnels.at(bones::BoneKind::Femur).entry_mm += 3 * side;
  cases::save_case(knee_folder(), knee_);
  write(pdf());
  expect_contains(pdf_text(),
                  "This tunnel was changed since, by 3.0 mm at the entry, 0.0\u00B0: what follows");
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
    header.source_kind = sources::source_kind_from_text(source_kind);
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
  write(pdf());
  const std::string text = pdf_text();
  expect_contains(text, "Planned against achieved: femur PL");
  expect_contains(text, "0.75 mm");
  expect_contains(text, "Planned against achieved: femur AM");
  expect_contains(text, "1.25 mm");
  expect_contains(text, "Drilled in the session " + first);
  // A rehearsal's is nobody's knee: after it the live ones are not its own.
  record(pl, "simulation");
  write(pdf());
  EXPECT_EQ(pdf_text().find("Planned against achieved: femur AM"), std::string::npos);
}

// The femur in one session, the tibia in the next one: the operation's report holds both.
TEST_F(Report, TellsOfBothBonesThoughEachWasDrilledInASessionOfItsOwn) {
  std::vector<std::string> sessions;
  for (const auto& [bone, off_mm] :
       {std::pair{bones::BoneKind::Femur, 1.25}, std::pair{bones::BoneKind::Tibia, 0.75}}) {
    const tunnels::Tunnel planned = knee_.plan.tunnels.at(bone);
    const auto folder = cases::create_session_folder(knee_folder());
    sessions.push_back(folder.filename().string());
    recording::SessionHeader header;
    header.id = sessions.back();
    header.bone = bone;
    header.source_kind = sources::SourceKind::Live;
    pipeline::PipelineOptions options;
    options.bone = bone;
    options.calibration = {.image_size_px = {1920, 1080}, .focal_px = 600, .boundary = {{960, 540}, 520}};
    options.tools = tools::standard_tools();
    recording::SessionRecorder recorder(folder, header, options);
    registration::RegistrationSummary registration;
    registration.has_pose = registration.reliable = true;
    registration.reasons.clear();
    registration.predicted_tre_mm = off_mm / 5;
    recorder.set_registration(registration);
    if (bone == bones::BoneKind::Femur)
      recorder.add_event({0, std::string(recording::kVerifiedEvent), "", -1});
    recorder.finish();
    tunnels::Tunnel measured = planned;
    measured.entry_mm += off_mm * planned.direction.unitOrthogonal();
    operation::write_achieved_file(
        folder / operation::achieved_file_name(planned.key()),
        {.planned = planned, .measured = measured, .depth_mm = 30, .pose_count = 42, .truth = {}});
  }
  write(pdf());
  const std::string text = pdf_text();
  expect_contains(text, "Planned against achieved: tibia");
  expect_contains(text, "0.75 mm");
  expect_contains(text, "Planned against achieved: femur");
  expect_contains(text, "1.25 mm");
  expect_contains(text, "Drilled in the session " + sessions.front());
  // On the first page by what each was drilled, and further on the other session's own safety.
  expect_contains(text,
                  "Tibia: registration reliable, predicted error at the target 0.15 mm. Verification: not");
  expect_contains(
      text, "Femur: registration reliable, predicted error at the target 0.25 mm. Verification: verified");
  expect_contains(text, "The session of the femur");
  const auto json = knee_folder().parent_path() / "report.json";
  write(json);
  const auto others = nlohmann::json::parse(files::read_text(json)).at("other_sessions");
  ASSERT_EQ(others.size(), 1U);
  EXPECT_EQ(others[0].at("bone"), "femur");
  EXPECT_EQ(others[0].at("safety").at("Verification"), "verified by touches");
  const auto told = nlohmann::json::parse(files::read_text(json)).at("achieved");
  ASSERT_EQ(told.size(), 2U);
  EXPECT_EQ(told[0].at("session"), sessions.back());
  EXPECT_EQ(told[1].at("session"), sessions.front());
  // Of the session that is asked for, and what came before it.
  write(json, {.session = sessions.front()});
  EXPECT_EQ(nlohmann::json::parse(files::read_text(json)).at("achieved").size(), 1U);
}

// No number stands for a tunnel that no pose shows: that it was said to be drilled does, and why that is all.
TEST_F(Report, Hazard29NamesTheTunnelThatWasDrilledByWordAlone) {
  EXPECT_EQ(text_of_session("live", {{"tunnel drilled by word", "femur: no picture came when it was said"},
                                     {recording::kDrilledTakenBackEvent, ""}})
                .find("DRILLED BY WORD ALONE"),
            std::string::npos)
      << "said too early";
  const std::string text =
      text_of_session("live", {{"tunnel drilled by word", "femur: no picture came when it was said"}});
  expect_contains(text, "DRILLED BY WORD ALONE: the femur tunnel");
  expect_contains(text, "no picture came when it was said");
  EXPECT_EQ(text.find("Planned against achieved: femur"), std::string::npos);
  const auto json = knee_folder().parent_path() / "report.json";
  write(json);
  const auto report = nlohmann::json::parse(files::read_text(json));
  EXPECT_TRUE(report.at("achieved").empty());
  ASSERT_EQ(report.at("drilled_by_word").size(), 1U);
  EXPECT_EQ(report.at("drilled_by_word")[0].at("tunnel"), "femur");
  // The next source is rehearsed on, which says nothing of this knee; the one after it says: not drilled.
  expect_contains(text_of_session("simulation", {}), "DRILLED BY WORD ALONE: the femur tunnel");
  const std::string taken_back = text_of_session("live", {{recording::kSaidTooEarlyEvent, "femur"}});
  EXPECT_EQ(taken_back.find("DRILLED BY WORD ALONE"), std::string::npos);
}

// Of the sessions of a case the one that is asked for is told, whatever came after it.
TEST_F(Report, TellsTheSessionThatIsAskedFor) {
  (void)text_of_session("live", {});
  (void)text_of_session("simulation", {});
  const auto folders = cases::session_folders(knee_folder());
  const std::string first = folders.front().filename().string(), newest = folders.back().filename().string();
  const auto json = knee_folder().parent_path() / "report.json";
  for (const std::string& session : {first, newest}) {
    write(json, {.session = session});
    expect_contains(files::read_text(json), "\"id\": \"" + session + "\"");
  }
  // By the number that Review shows, too; which there are is said where there is no such one.
  const std::string number = std::to_string(cases::session_number(folders.front()));
  write(json, {.session = number});
  expect_contains(files::read_text(json), "\"id\": \"" + first + "\"");
  try {
    write(json, {.session = "0099"});
    FAIL() << "there is none of that name";
  } catch (const InvalidInput& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("0099"));
    EXPECT_THAT(error.what(), testing::HasSubstr("it holds " + first + ", " + newest));
  }
}

// A session that a disk has spoilt takes no report away: it is named with its reason, and the one before it
// is told of. Its name holds a date, which a report without names does not.
TEST_F(Report, NamesASessionThatCannotBeRead) {
  (void)text_of_session("live", {});
  (void)text_of_session("simulation", {});
  const std::filesystem::path newest = cases::session_folders(knee_folder()).back();
  files::write_atomically(newest / "session.sqlite", "spoilt");
  EXPECT_THAT(write(pdf()),
              testing::ElementsAre(testing::AllOf(testing::HasSubstr(newest.filename().string()),
                                                  testing::HasSubstr("session.sqlite: "))));
  std::string text = pdf_text();
  expect_contains(text, "NOT READABLE, and not in this report: the session " + newest.filename().string());
  expect_contains(text, "live: a camera, as it came");
  const auto json_file = pdf().parent_path() / "report.json";
  write(json_file);
  const auto json = nlohmann::json::parse(files::read_text(json_file));
  EXPECT_EQ(json.at("unreadable_sessions").at(0).at("id"), newest.filename().string());
  EXPECT_EQ(json.at("session").at("source_kind"), "live");
  write(pdf(), {.is_deidentified = true});
  text = pdf_text();
  expect_contains(text, "NOT READABLE, and not in this report: a session of this case");
  EXPECT_EQ(text.find(newest.filename().string()), std::string::npos);
  write(json_file, {.is_deidentified = true});
  const auto for_strangers = nlohmann::json::parse(files::read_text(json_file));
  EXPECT_EQ(for_strangers.at("unreadable_sessions").at(0).at("id"), nullptr);
  EXPECT_EQ(for_strangers.at("session").at("id"), nullptr);
  EXPECT_EQ(for_strangers.at("session").at("started_utc"), nullptr);
  EXPECT_EQ(for_strangers.at("case").at("created_utc"), nullptr);
  EXPECT_EQ(for_strangers.at("case").at("name"), "De-identified case")
      << "whoever named it may have named a patient";
  EXPECT_EQ(text.find(json.at("case").at("name").get<std::string>()), std::string::npos);
  EXPECT_FALSE(for_strangers.contains("made_utc"));
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
  const std::string skipped =
      text_of_session("simulation", {{"verification skipped", "guidance began after two"}});
  expect_contains(skipped, "SKIPPED: guidance began after two");
  expect_contains(skipped, "not asked: no live source");
}

// A plan that was changed in the session, and one that was changed since, are told on the first page, which
// shows the plan of now.
TEST_F(Report, Hazard5SaysThatThePlanIsNotTheOneThatGuided) {
  const auto folder = cases::create_session_folder(knee_folder());
  pipeline::PipelineOptions options;
  options.calibration = {.image_size_px = {1920, 1080}, .focal_px = 600, .boundary = {{960, 540}, 520}};
  options.tools = tools::standard_tools();
  recording::SessionHeader header;
  header.id = folder.filename().string();
  header.source_kind = sources::SourceKind::Live;
  const tunnels::Tunnel planned = knee_.plan.tunnels.at(bones::BoneKind::Femur);
  tunnels::Tunnel edited = planned;
  edited.entry_mm += 3 * planned.direction.unitOrthogonal();
  registration::RegistrationSummary registration;
  registration.has_pose = registration.reliable = true;
  registration.reasons.clear();
  {
    recording::SessionRecorder recorder(folder, header, options);
    recorder.set_plan(planned, 41.1);
    recorder.set_registration(registration);
    recorder.append({});
    recorder.finish();
  }
  write(pdf());
  EXPECT_EQ(pdf_text().find("THE PLAN "), std::string::npos);
  knee_.plan.tunnels.at(bones::BoneKind::Femur) = edited;
  cases::save_case(knee_folder(), knee_);
  write(pdf());
  expect_contains(pdf_text(),
                  "THE PLAN IS ANOTHER ONE NOW: the session was planned to the femur, 9.0 mm wide");
  const auto second = cases::create_session_folder(knee_folder());
  header.id = second.filename().string();
  {
    recording::SessionRecorder recorder(second, header, options);
    recorder.set_plan(planned, 41.1);
    recorder.set_registration(registration);
    recorder.append({});
    recorder.set_plan(edited, 25.5);
    recorder.finish();
  }
  write(pdf());
  const std::string text = pdf_text();
  expect_contains(text, "THE PLAN WAS CHANGED IN THE SESSION, at 0:00.0: from femur, 9.0 mm wide");
  EXPECT_EQ(text.find("THE PLAN IS ANOTHER ONE NOW"), std::string::npos);
}

// What happened when, what whoever looked at it marked, and by what the record is known. A broken file of
// marks is told and takes nothing else away.
TEST_F(Report, HasStepsMarksAndTheLastHash) {
  (void)text_of_session("live", {{recording::kVerifiedEvent, ""}, {recording::kVoidEvent, "bumped"}});
  const std::filesystem::path session = cases::session_folders(knee_folder()).back();
  recording::write_marks(session, {{3, 65'400'000'000, "marker, in glare"}, {9, 70'000'000'000, ""}});
  write(pdf());
  const std::string text = pdf_text();
  for (const char* const part : {"bone registered", "registration verified", "REGISTRATION VOID: bumped",
                                 "Marks of who looked", "marker, in glare", "(frame 3)", "(no note)"})
    expect_contains(text, part);
  const std::string hash = recording::chain_head(session);
  ASSERT_EQ(hash.size(), 64u);
  for (const std::size_t at : {0, 16, 32, 48}) expect_contains(text, hash.substr(at, 16));
  files::write_atomically(recording::marks_file(session), "{");
  write(pdf());
  // Without where the case lies: its folder may bear a name.
  expect_contains(pdf_text(), "NOT READABLE: sessions/");
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
  write(json_file);
  const auto json = nlohmann::json::parse(files::read_text(json_file));
  EXPECT_TRUE(!json.contains("achieved") || json.at("achieved").empty());
  EXPECT_NE(json.dump().find(operation.filename().string()), std::string::npos);
  EXPECT_EQ(json.dump().find(exercise.filename().string()), std::string::npos);
}

}  // namespace
}  // namespace arthronaut::report
