// What the report says of a session: what was reached, how it was verified, what the surgeon saw.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

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

// A session with five pictures of one grey each, and numbers of which the third picture's are the best.
std::filesystem::path record_pictures(const std::filesystem::path& knee_folder) {
  const auto folder = cases::create_session_folder(knee_folder);
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
    recorder.add_event({400'000'000, std::string(recording::kDrilledEvent), "achieved.json", -1});
    recorder.finish();
  }
  return folder;
}

// The pictures that were recorded at the moments that matter, the same bytes each time. Without the video the
// report says so, and that the session is no longer what was recorded.
TEST_F(Report, ShowsWhatTheSurgeonSaw) {
  expect_contains(text_of_session("live", {}), "The session keeps no video");
  const auto folder = record_pictures(knee_folder());
  write(pdf());
  const std::string text = pdf_text();
  expect_contains(text, "Pictures of the session, with the plan");
  expect_contains(text, "0:00.2: aimed closest, 0.7 mm, 1.2\u00B0");
  expect_contains(text, "0:00.4: drilled");
  expect_contains(text, "5 in 0:00.4");  // frames
  expect_contains(text, "Blue: as planned.");
  EXPECT_EQ(text.find("-0.0"), std::string::npos) << text;
  const std::string bytes = made({});
  EXPECT_EQ(bytes, made({}));
  expect_contains(text, "as recorded: ");
  const auto json_file = pdf().parent_path() / "report.json";
  const auto record_in_json = [&] {
    return nlohmann::json::parse(files::read_text(json_file)).at("session").at("is_as_recorded");
  };
  EXPECT_TRUE(write(json_file).empty());
  EXPECT_EQ(record_in_json(), true);
  const auto video = recording::RecordedSession(folder).video();
  ASSERT_TRUE(std::filesystem::exists(video));
  std::filesystem::remove(video);
  EXPECT_THAT(write(json_file),
              testing::ElementsAre(testing::HasSubstr("is no longer what was recorded: video")));
  EXPECT_EQ(record_in_json(), false);
  write(pdf());
  const std::string without = pdf_text();
  expect_contains(without, "The session's video is not there, or cannot be read");
  expect_contains(without, "NOT AS RECORDED");
}

// For strangers: not who, not when, and nothing that was filmed.
TEST_F(Report, Hazard19ADeidentifiedOneShowsNoPictureAndNoDay) {
  const std::string session = record_pictures(knee_folder()).filename().string();
  const std::string day = cases::load_case(knee_folder()).created_utc.substr(0, 10);
  write(pdf(), {.is_deidentified = false});
  for (const std::string& told : {std::string("Pictures of the session"), session, day})
    expect_contains(pdf_text(), told);
  write(pdf(), {.with_identity = true, .is_deidentified = true});
  for (const std::string& told : {std::string("Pictures of the session"), session, day})
    EXPECT_EQ(pdf_text().find(told), std::string::npos) << told;
}

// Green of the plan in the stills that the report shows.
cv::Mat green_of(const std::filesystem::path& pdf) {
  const auto images = pdf.parent_path() / "images";
  std::filesystem::remove_all(images);
  std::filesystem::create_directory(images);
  EXPECT_EQ(std::system(
                ("pdfimages -png " + pdf.string() + " " + (images / "i").string() + " 2>/dev/null").c_str()),
            0);
  cv::Mat all = cv::Mat::zeros(560, 560, CV_8U);
  for (const auto& entry : std::filesystem::directory_iterator(images)) {
    const cv::Mat image = cv::imread(entry.path().string());
    if (image.size() != all.size()) continue;  // no still
    cv::Mat green;
    cv::inRange(image, cv::Scalar(120, 255, 120), cv::Scalar(120, 255, 120), green);
    all |= green;
  }
  return all;
}

// The eye looks into the planned tunnel from 25 mm before it, and the guide's tip is at its entry, the shaft
// off to the side: no line lies over the guide, as over the live picture, and there is one without it.
TEST_F(Report, DrawsNoPlanOverATool) {
  const tunnels::Tunnel plan = knee_.plan.tunnels.at(bones::BoneKind::Femur);
  pipeline::PipelineOptions options;
  options.calibration = {.image_size_px = {320, 240},
                         .focal_px = 100,
                         .principal_point_px = {160, 120},
                         .boundary = {{160, 120}, 110}};
  options.tools = tools::standard_tools();
  options.follow_lens = false;
  const tools::Tool& guide = *options.tools.find_tool(tools::standard_guide_name(bones::BoneKind::Femur));
  const auto looking = [](const Eigen::Vector3d& direction, const Eigen::Vector3d& in_camera,
                          const Eigen::Vector3d& at_25_mm) {
    const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(direction, in_camera);
    return geometry::RigidTransform{turn, Eigen::Vector3d(0, 0, 25) - turn * at_25_mm};
  };
  const Eigen::Vector3d shaft_in_camera = Eigen::Vector3d(-1, 0, 0.2).normalized();
  const auto camera_from_bone = looking(plan.direction, Eigen::Vector3d::UnitZ(), plan.entry_mm);
  const auto camera_from_guide = looking(guide.axis->direction, shaft_in_camera, guide.axis->point_mm);
  // Whether the plan is drawn where the shaft's axis is seen in the still.
  const auto shaft_is_crossed = [&](bool guide_is_tracked) {
    const auto folder = cases::create_session_folder(knee_folder());
    recording::SessionHeader header;
    header.id = folder.filename().string();
    recording::SessionRecorder recorder(folder, header, options);
    registration::RegistrationSummary registration;  // the bone is where its marker is
    registration.has_pose = registration.reliable = true;
    registration.reasons.clear();
    recorder.set_registration(registration);
    recorder.set_plan(plan, 30);
    auto frame = std::make_shared<camera::Frame>();
    frame->width = 320;
    frame->height = 240;
    frame->bgr.assign(3UL * 320 * 240, 90);
    recorder.append_picture(frame);
    pipeline::FrameResult result;
    result.intrinsics_are_known = true;
    result.guidance.state = guidance::GuidanceState::Valid;
    const auto see = [&](int id, const geometry::RigidTransform& camera_from_marker) {
      markers::MarkerObservation& marker = result.markers.emplace_back();
      marker.id = id;
      marker.state = markers::MarkerState::Tracked;
      marker.camera_from_marker = camera_from_marker;
    };
    see(options.tools.find_world_marker(bones::BoneKind::Femur)->marker_id, camera_from_bone);
    if (guide_is_tracked) see(guide.marker_id, camera_from_guide);
    recorder.append(result);
    recorder.finish();
    write(pdf());
    const cv::Mat green = green_of(pdf());
    EXPECT_GT(cv::countNonZero(green), 500);
    const camera::CameraModel camera(options.calibration, 0, options.refractive_index);
    bool is_crossed = false;
    for (double back_mm = 0; back_mm < 15; back_mm += 0.1) {
      const auto seen = camera.project(Eigen::Vector3d(0, 0, 25) - back_mm * shaft_in_camera);
      if (!seen || !camera.is_inside_view(*seen)) continue;
      const Eigen::Vector2i at = ((*seen - Eigen::Vector2d(50, 10)) * 560 / 220).cast<int>();
      is_crossed = is_crossed || green.at<std::uint8_t>(at.y(), at.x()) != 0;
    }
    return is_crossed;
  };
  EXPECT_TRUE(shaft_is_crossed(false));
  EXPECT_FALSE(shaft_is_crossed(true));
}

}  // namespace
}  // namespace arthronaut::report
