// Which moments of a session a report has pictures of.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/report/reported_case.h"

namespace arthronaut::report {
namespace {

// Nine pictures, ten a second, in each of which the bone is seen; `before` is called before each of them, and
// with -1 after the last.
template <typename Before>
void record_pictures_of(const std::filesystem::path& session, const Before& before) {
  pipeline::PipelineOptions options;
  options.calibration = {.image_size_px = {320, 240}, .focal_px = 100, .boundary = {{160, 120}, 110}};
  options.tools = tools::standard_tools();
  recording::SessionHeader header;
  header.id = session.filename().string();
  recording::SessionRecorder recorder(session, header, options);
  for (int i = 0; i < 9; ++i) {
    before(recorder, i);
    auto frame = std::make_shared<camera::Frame>();
    frame->index = i;
    frame->timestamp_ns = i * 100'000'000LL;
    frame->width = 320;
    frame->height = 240;
    frame->bgr.assign(3UL * 320 * 240, static_cast<std::uint8_t>(20 * i));
    recorder.append_picture(frame);
    pipeline::FrameResult result;
    result.frame_index = i;
    result.timestamp_ns = frame->timestamp_ns;
    result.intrinsics_are_known = true;
    markers::MarkerObservation& marker = result.markers.emplace_back();
    marker.id = options.tools.find_world_marker(bones::BoneKind::Femur)->marker_id;
    marker.state = markers::MarkerState::Tracked;
    marker.camera_from_marker.translation_mm = {0, 0, 25};
    recorder.append(result);
  }
  before(recorder, -1);
  recorder.finish();
}

registration::RegistrationSummary registration_at(double x_mm, bool is_reliable = true) {
  registration::RegistrationSummary registration;
  registration.has_pose = true;
  registration.reliable = is_reliable;
  if (is_reliable) registration.reasons.clear();
  registration.marker_from_bone.translation_mm = {x_mm, 0, 0};
  return registration;
}

// At the end all strokes are registered once more, and nobody sees the bone by that.
TEST_F(Report, ShowsTheBoneAsItWasRegisteredWhileItWasSeen) {
  record_pictures_of(cases::create_session_folder(knee_folder()), [](auto& recorder, int frame) {
    if (frame == 3) recorder.set_registration(registration_at(1));
    if (frame == -1) recorder.set_registration(registration_at(1.1));
  });
  write(pdf());
  expect_contains(pdf_text(), "0:00.3: registered");
}

// An alarm writes the registration anew; the marker is taken out at the end. What counts is what was drilled
// by.
TEST_F(Report, ShowsNoAlarmAsTheRegistration) {
  record_pictures_of(cases::create_session_folder(knee_folder()), [](auto& recorder, int frame) {
    if (frame == 1) recorder.set_registration(registration_at(1));
    if (frame == 3) recorder.set_registration(registration_at(2));
    if (frame == 4) {
      recorder.set_registration(registration_at(2, false));
      recorder.add_event(
          {400'000'000, std::string(recording::kAlarmEvent), "the control point has moved", -1});
    }
    if (frame == 5) {
      recorder.set_registration(registration_at(2));
      recorder.add_event({500'000'000, std::string(recording::kAlarmEvent), "", -1});
      recorder.add_event({500'000'000, std::string(recording::kDrilledEvent), "achieved.json", -1});
    }
    if (frame == 7) recorder.set_registration({});
  });
  write(pdf());
  const std::string text = pdf_text();
  expect_contains(text, "0:00.3: registered");
  for (const char* const step :
       {"bone registered, and 1 time more until", "ALARM: the control point has moved", "alarm is over",
        "nothing is registered any more"})
    expect_contains(text, step);
}

}  // namespace
}  // namespace arthronaut::report
