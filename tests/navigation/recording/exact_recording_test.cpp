// What a record of pictures must give back: the luma that was tracked, bit for bit, and so the same poses.
#include <gtest/gtest.h>

#include <random>

#include "navigation/pipeline/navigation_pipeline.h"
#include "navigation/recording/picture_writer.h"
#include "navigation/recording/session.h"
#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"
#include "tests/navigation/recording/recorded_frames.h"
#include "tests/navigation/simulator/phantom_options.h"
#include "tests/temporary_folder.h"

namespace arthronaut {
namespace {

class ExactRecording : public ::testing::Test {
 protected:
  const test::TemporaryFolder folder_;
};

std::vector<std::uint8_t> luma_of(const camera::Frame& frame) {
  std::vector<std::uint8_t> luma;
  camera::gray_from(frame, luma);
  return luma;
}

camera::FramePtr random_picture(std::int64_t index, int width, int height) {
  auto frame = std::make_shared<camera::Frame>();
  frame->index = index;
  frame->timestamp_ns = index * 1'000'000'000 / 60;
  frame->width = width;
  frame->height = height;
  frame->bgr.resize(static_cast<std::size_t>(3 * width * height));
  std::mt19937 random(static_cast<unsigned>(index));
  for (std::uint8_t& value : frame->bgr) value = static_cast<std::uint8_t>(random());
  return frame;
}

// Random pictures, the hardest that there are, of even and odd sizes: every byte of luma comes back.
TEST_F(ExactRecording, GivesBackTheLumaOfRandomPictures) {
  for (const auto& [width, height] : {std::pair{160, 120}, {322, 182}, {161, 121}, {64, 33}}) {
    const auto file = folder_ / "video.mkv";
    recording::PictureWriter writer(folder_.path(), {});
    for (int i = 0; i < 12; ++i) writer.write(random_picture(i, width, height));
    writer.finish();
    const auto video = sources::open_video_with_exact_luma(file);
    for (int i = 0; i < 12; ++i) {
      const camera::FramePtr frame = video->next();
      ASSERT_NE(frame, nullptr) << i;
      EXPECT_EQ(frame->luma, luma_of(*random_picture(i, width, height))) << width << ' ' << i;
    }
    EXPECT_EQ(video->next(), nullptr);
  }
}

// A picture that has a luma of its own is recorded with that one.
TEST_F(ExactRecording, PrefersThePicturesOwnLuma) {
  auto picture = std::make_shared<camera::Frame>(*random_picture(0, 160, 120));
  picture->luma.assign(160 * 120, 77);
  picture->luma[5] = 255;
  recording::PictureWriter writer(folder_.path(), {});
  writer.write(picture);
  writer.finish();
  EXPECT_EQ(luma_of(*sources::open_video_with_exact_luma(folder_ / "video.mkv")->next()), picture->luma);
}

// A simulated operation, tracked and recorded, then tracked again from the record: every number of every
// frame is the same to the last bit.
TEST_F(ExactRecording, IsTrackedAgainToTheSamePosesBitForBit) {
  simulator::SimulationOptions simulation = simulator::phantom_options();
  simulation.frame_count = 8;
  pipeline::PipelineOptions options;
  options.calibration = simulation.camera;
  options.refractive_index = simulation.refractive_index;
  options.tools = simulation.tools;
  std::vector<pipeline::FrameResult> then;
  {
    simulator::SimulatedOperation operation(simulation, simulator::Phase::Scratch);
    recording::SessionRecorder recorder(folder_.path(), test::session_header(), options);
    pipeline::NavigationPipeline navigation(options);
    pipeline::FrameResult result;
    while (const camera::FramePtr frame = operation.next()) {
      navigation.process(*frame, result);
      recorder.append_picture(frame);
      recorder.append(result);
      then.push_back(result);
    }
    recorder.finish();
  }
  const recording::RecordedSession session(folder_.path());
  EXPECT_TRUE(session.header().video_has_exact_luma);
  const auto video = recording::open_recorded_video(session);
  EXPECT_EQ(video->info().kind, sources::SourceKind::Recording);
  pipeline::NavigationPipeline navigation(options);
  pipeline::FrameResult now;
  int poses = 0;
  for (const pipeline::FrameResult& was : then) {
    const camera::FramePtr frame = video->next();
    ASSERT_NE(frame, nullptr);
    navigation.process(*frame, now);
    EXPECT_EQ(now.frame_index, was.frame_index);
    EXPECT_EQ(now.timestamp_ns, was.timestamp_ns);
    EXPECT_EQ(now.lens.mark_angle_deg, was.lens.mark_angle_deg);
    EXPECT_EQ(now.lens.circle.center_px, was.lens.circle.center_px);
    EXPECT_EQ(now.intrinsics_are_known, was.intrinsics_are_known);
    ASSERT_EQ(now.markers.size(), was.markers.size());
    for (std::size_t i = 0; i < now.markers.size(); ++i) {
      EXPECT_EQ(now.markers[i].state, was.markers[i].state);
      if (!was.stands_for(was.markers[i])) continue;
      ++poses;
      EXPECT_EQ(now.markers[i].camera_from_marker.rotation.coeffs(),
                was.markers[i].camera_from_marker.rotation.coeffs());
      EXPECT_EQ(now.markers[i].camera_from_marker.translation_mm,
                was.markers[i].camera_from_marker.translation_mm);
      EXPECT_EQ(now.markers[i].covariance, was.markers[i].covariance);
    }
    EXPECT_EQ(now.tip_is_valid, was.tip_is_valid);
    EXPECT_EQ(now.tip_in_world_mm, was.tip_in_world_mm);
  }
  EXPECT_GE(poses, 8);
}

// Three markers on each tool and two on each bone's screw, ids 10 and 20 above those they have. Their first
// marker stays their frame.
tools::ToolSet with_several_markers(tools::ToolSet tools) {
  // Up the handle, turned a little to one side: seen when the first one is seen obliquely. The third is
  // smaller and on the other side.
  const auto turned = [](double about_y_deg) {
    return Eigen::Quaterniond(
        Eigen::AngleAxisd(geometry::rad_from_deg(about_y_deg), Eigen::Vector3d::UnitY()));
  };
  for (tools::Tool& tool : tools.tools) {
    const int id = tool.marker_id;
    tool.markers = {{id, tool.size_mm, {}},
                    {id + 10, tool.size_mm, {turned(25), {5.6, 2.0, -1.4}}},
                    {id + 20, 0.75 * tool.size_mm, {turned(-25), {-5.2, 1.0, -1.2}}}};
  }
  for (tools::WorldMarker& world : tools.world_markers)
    world.markers = {
        {world.marker_id, world.size_mm, {}},
        {world.marker_id + 10, 0.75 * world.size_mm, {turned(0), {0, 1.9 * world.size_mm, 0.8}}}};
  return tools;
}

// The same with several markers on the probe and on the screw: their bodies lie where they truly are, and
// both the pictures and the record itself give the bodies' poses back to the last bit.
TEST_F(ExactRecording, KeepsBodiesOfSeveralMarkersBitForBit) {
  simulator::SimulationOptions simulation = simulator::phantom_options();
  simulation.frame_count = 8;
  simulation.tools = with_several_markers(simulation.tools);
  pipeline::PipelineOptions options;
  options.calibration = simulation.camera;
  options.refractive_index = simulation.refractive_index;
  options.tools = simulation.tools;
  std::vector<pipeline::FrameResult> then;
  int bodies = 0, of_several = 0;
  {
    simulator::SimulatedOperation operation(simulation, simulator::Phase::Scratch);
    recording::SessionRecorder recorder(folder_.path(), test::session_header(), options);
    pipeline::NavigationPipeline navigation(options);
    pipeline::FrameResult result;
    while (const camera::FramePtr frame = operation.next()) {
      navigation.process(*frame, result);
      recorder.append_picture(frame);
      recorder.append(result);
      then.push_back(result);
      for (const markers::BodyObservation& body : result.bodies) {
        if (!body.is_tracked() || !result.intrinsics_are_known) continue;
        ++bodies;
        of_several += body.used_count() > 1 ? 1 : 0;
        EXPECT_EQ(body.odd_marker, markers::BodyObservation::kNone);
        for (const auto& truth : operation.truth().markers) {
          if (truth.id != body.id) continue;
          const auto error = geometry::log(truth.camera_from_marker.inverse() * body.camera_from_body);
          EXPECT_LT(error.head<3>().norm(), 0.1) << body.id;
          EXPECT_LT(geometry::deg_from_rad(error.tail<3>().norm()), 1.0) << body.id;
        }
      }
    }
    recorder.finish();
  }
  EXPECT_GE(bodies, 8);
  EXPECT_GE(of_several, 4);
  const recording::RecordedSession session(folder_.path());
  EXPECT_TRUE(tools::are_same(session.pipeline_options().tools.find_tool("probe")->markers,
                              options.tools.find_tool("probe")->markers));
  const auto video = recording::open_recorded_video(session);
  pipeline::NavigationPipeline navigation(options);
  pipeline::FrameResult now;
  for (std::size_t i = 0; i < then.size(); ++i) {
    const camera::FramePtr frame = video->next();
    ASSERT_NE(frame, nullptr);
    navigation.process(*frame, now);
    ASSERT_EQ(now.bodies.size(), then[i].bodies.size());
    std::size_t recorded = 0;
    for (std::size_t b = 0; b < now.bodies.size(); ++b) {
      const markers::BodyObservation& was = then[i].bodies[b];
      EXPECT_EQ(now.bodies[b].state, was.state);
      if (!was.is_tracked() || !then[i].intrinsics_are_known) continue;
      EXPECT_EQ(now.bodies[b].used, was.used);
      EXPECT_EQ(now.bodies[b].camera_from_body.translation_mm, was.camera_from_body.translation_mm);
      EXPECT_EQ(now.bodies[b].camera_from_body.rotation.coeffs(), was.camera_from_body.rotation.coeffs());
      EXPECT_EQ(now.bodies[b].covariance, was.covariance);
      for (const recording::RecordedBody& kept : session.frames()[i].bodies) {
        if (kept.id != was.id) continue;
        ++recorded;
        EXPECT_EQ(kept.camera_from_body.translation_mm, was.camera_from_body.translation_mm);
        EXPECT_EQ(kept.camera_from_body.rotation.coeffs(), was.camera_from_body.rotation.coeffs());
      }
    }
    EXPECT_EQ(recorded, session.frames()[i].bodies.size());
    EXPECT_EQ(now.tip_in_world_mm, then[i].tip_in_world_mm);
  }
}

// Sessions of before have no such word in their header: their luma is not claimed to be exact.
TEST_F(ExactRecording, IsNotClaimedOfOlderSessions) {
  recording::SessionRecorder(folder_.path(), test::session_header(), test::scripted_options()).finish();
  std::string header = files::read_text(folder_ / "session.json");
  const std::size_t begin = header.find("\"video_has_exact_luma\"");
  ASSERT_NE(begin, std::string::npos);
  header.erase(begin, header.find('\n', begin) - begin);
  files::write_atomically(folder_ / "session.json", header);
  EXPECT_FALSE(recording::RecordedSession(folder_.path()).header().video_has_exact_luma);
}

}  // namespace
}  // namespace arthronaut
