// What a report shows of the session's video.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/app/report/reported_case.h"

namespace arthronaut::report {
namespace {

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
  EXPECT_LE(page_count(pdf_info()), 4) << "a report that is filed";
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
