// The whole theatre on the path-traced clips, with the real femur and the true camera: scratch, register from
// nothing, guide. Runs through navigate_source, as the command does.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "navigation/camera/camera_file.h"
#include "navigation/camera/medium.h"
#include "navigation/recording/replay.h"
#include "navigation/registration/registration_file.h"
#include "navigation/theatre/navigate_source.h"
#include "planning/bones/mesh_file.h"
#include "planning/files/csv_table.h"
#include "planning/files/json_document.h"
#include "tests/real_data/real_data.h"
#include "tests/temporary_folder.h"

namespace arthronaut {
namespace {

// What the clips were made to be judged by: 2 mm and 2 deg at the planned entry.
constexpr double kTargetErrorMm = 2.0, kOffsetErrorMm = 2.0, kAngleErrorDeg = 2.0;

tunnels::Tunnel true_plan(const std::filesystem::path& clip) {
  const auto json = files::read_json(clip / "gt/tunnel.json", "arthronaut-acceptance.tunnel", 1);
  tunnels::Tunnel plan;
  plan.entry_mm = json.vector3("entry_mm");
  plan.direction = json.vector3("direction").normalized();
  return plan;
}

theatre::NavigateOptions options_of(const std::filesystem::path& clip, const tunnels::Tunnel& plan) {
  theatre::NavigateOptions options;
  options.source.pipeline.calibration = camera::read_camera_file(clip / "camera.json").calibration;
  options.source.pipeline.refractive_index = camera::kSalineIndex;
  options.source.pipeline.tools = tools::read_tools_file(clip / "tools.json");
  options.source.kind = sources::SourceKind::Recording;
  options.operation.plan = {plan, 25};
  return options;
}

double root_mean_square(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

// Scratching finds the bone from nothing; then guidance with that registration agrees with the truth.
TEST(NavigateReal, RegistersByScratchingAndGuidesTheDrill) {
  ARTHRONAUT_REQUIRE_DATA(probe_clip, "arthroscopy/probe_wet");
  ARTHRONAUT_REQUIRE_DATA(guide_clip, "arthroscopy/guide_wet");
  const tunnels::Tunnel plan = true_plan(guide_clip);

  theatre::NavigateOptions scratch = options_of(probe_clip, plan);
  scratch.bone =
      std::make_shared<const registration::SurfaceIndex>(bones::read_mesh_file(probe_clip / "bone.stl").mesh);
  const std::shared_ptr<sources::FrameSource> probe_video = sources::open_video(probe_clip / "clip.mkv");
  const theatre::NavigationSummary scratched = theatre::navigate_source(probe_video, scratch);
  ASSERT_TRUE(scratched.registration.has_value());
  const auto truth = files::read_json(probe_clip / "gt/registration_gt.json", "arthronaut.registration", 1)
                         .rigid_transform("marker_from_bone");
  const double target_error_mm =
      (scratched.registration->marker_from_bone * plan.entry_mm - truth * plan.entry_mm).norm();
  const double rotation_error_deg = geometry::deg_from_rad(geometry::rotation_angle_rad(
      truth.rotation.conjugate() * scratched.registration->marker_from_bone.rotation));
  std::printf(
      "probe_wet: %ld frames, tip in %ld, strokes %.0f mm; registration rms %.3f mm, error at the target "
      "%.3f mm "
      "(predicted %.3f), rotation %.3f deg, %s\n",
      scratched.statistics.frame_count, scratched.frames_with_tip, scratched.drawn_length_mm,
      scratched.registration->rms_mm, target_error_mm, scratched.registration->predicted_tre_mm,
      rotation_error_deg, scratched.registration->reliable ? "reliable" : "not reliable");
  EXPECT_EQ(scratched.statistics.frame_count, 240);
  EXPECT_TRUE(scratched.registration->reliable);
  EXPECT_LT(target_error_mm, kTargetErrorMm);

  theatre::NavigateOptions drill = options_of(guide_clip, plan);
  drill.registration = {*scratched.registration, operation::provenance_of(scratch.operation, scratch.source)};
  const auto gt = files::CsvTable::read(guide_clip / "gt/guide.csv",
                                        {"tip_to_entry_mm", "axis_to_entry_mm", "angle_deg"});
  std::vector<double> tip_errors, offset_errors, angle_errors;
  theatre::NavigationObserver observer;
  observer.on_frame = [&](const camera::FramePtr&, const operation::OperationStatePtr& now) {
    const operation::OperationState& state = *now;
    const pipeline::FrameResult& result = state.frame;
    if (!result.guidance.is_valid()) return;
    const auto row = static_cast<std::size_t>(result.frame_index);
    tip_errors.push_back(result.guidance.tip_to_entry_mm - gt.number(row, "tip_to_entry_mm"));
    offset_errors.push_back(result.guidance.axis_to_entry_mm - gt.number(row, "axis_to_entry_mm"));
    angle_errors.push_back(result.guidance.angle_deg - gt.number(row, "angle_deg"));
    EXPECT_LT(std::abs(offset_errors.back()), kOffsetErrorMm) << "frame " << row;
    EXPECT_LT(std::abs(angle_errors.back()), kAngleErrorDeg) << "frame " << row;
  };
  const std::shared_ptr<sources::FrameSource> guide_video = sources::open_video(guide_clip / "clip.mkv");
  const theatre::NavigationSummary guided = theatre::navigate_source(guide_video, drill, {}, observer);
  EXPECT_EQ(scratched.frames_in_other_medium + guided.frames_in_other_medium, 0);
  ASSERT_GT(guided.guidance_counts.of(guidance::GuidanceState::Valid),
            30);  // of 40: the guide is free in all of them
  const std::size_t last = gt.row_count() - 1;
  std::printf(
      "guide_wet: guidance in %ld of %ld frames; rms error: tip to entry %.3f mm, axis to entry %.3f mm, "
      "angle %.3f deg\n  last frame: tip to entry %.2f mm (true %.2f), axis to entry %.2f mm (true %.2f), "
      "angle %.2f deg (true %.2f)\n",
      guided.guidance_counts.of(guidance::GuidanceState::Valid), guided.statistics.frame_count,
      root_mean_square(tip_errors), root_mean_square(offset_errors), root_mean_square(angle_errors),
      guided.last_guidance.tip_to_entry_mm, gt.number(last, "tip_to_entry_mm"),
      guided.last_guidance.axis_to_entry_mm, gt.number(last, "axis_to_entry_mm"),
      guided.last_guidance.angle_deg, gt.number(last, "angle_deg"));
}

// In the wrong medium nothing is navigated, and that is what is said: not the lens, not a probe that drew
// nothing.
TEST(NavigateReal, Hazard27TheMediumIsTheReason) {
  ARTHRONAUT_REQUIRE_DATA(guide_clip, "arthroscopy/guide_wet");
  ARTHRONAUT_REQUIRE_DATA(probe_clip, "arthroscopy/probe_wet");
  for (const std::filesystem::path& clip : {guide_clip, probe_clip}) {
    const std::string name = clip.filename();
    theatre::NavigateOptions options = options_of(clip, true_plan(guide_clip));
    options.source.pipeline.refractive_index = camera::kAirIndex;
    options.duration_s = 1;
    const std::shared_ptr<sources::FrameSource> video = sources::open_video(clip / "clip.mkv");
    const theatre::NavigationSummary summary = theatre::navigate_source(video, options);
    EXPECT_GT(2 * summary.frames_in_other_medium, summary.statistics.frame_count) << name;
    EXPECT_EQ(summary.guidance_counts.of(guidance::GuidanceState::Valid), 0) << name;
    ASSERT_EQ(summary.reasons.size(), 1U) << name;
    EXPECT_NE(summary.reasons.front().find("not as in air"), std::string::npos) << summary.reasons.front();
    EXPECT_EQ(summary.statistics.frames_with_unknown_lens, 0) << name;
  }
}

// Frames that the recorder encodes itself, as it does for a camera, keep the luma that was tracked: run again
// on the same build, every state is the same to the last bit, offsets along the bone's own axes among it.
TEST(NavigateReal, ReplaysEncodedFramesToTheLastBit) {
  ARTHRONAUT_REQUIRE_DATA(guide_clip, "arthroscopy/guide_wet");
  const test::TemporaryFolder folder;
  theatre::NavigateOptions options = options_of(guide_clip, true_plan(guide_clip));
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.5, Eigen::Vector3d(1, 2, 3).normalized()).matrix();
  options.source.pipeline.axes = {landmarks::AnatomicalAxes::Origin::FromShaft, turn.col(0), turn.col(1),
                                  turn.col(2)};
  options.registration = {registration::read_registration_file(guide_clip / "gt/registration_gt.json"),
                          operation::provenance_of(options.operation, options.source)};
  const std::shared_ptr<sources::FrameSource> video = sources::open_video(guide_clip / "clip.mkv");
  theatre::RecordOptions record;
  record.folder = folder.path();
  record.keep = recording::KeepVideo::Encode;
  (void)theatre::navigate_source(video, options, record);
  const recording::RecordedSession session(folder.path());
  const recording::ReplaySummary replay = recording::replay_session(session, {});
  std::printf(
      "guide_wet, encoded: %.2f MB a frame; worst difference of a pose %.3f mm, %.3f deg, of guidance %.3f "
      "mm, "
      "%.3f deg\n",
      static_cast<double>(std::filesystem::file_size(session.video())) / 1e6 / 40, replay.worst_pose_mm,
      replay.worst_pose_deg, replay.worst_offset_mm, replay.worst_angle_deg);
  EXPECT_EQ(replay.replayed_frames, 40);
  EXPECT_TRUE(replay.is_same_build);
  EXPECT_EQ(replay.states_compared, 40);
  EXPECT_EQ(replay.states_equal, 40);
  EXPECT_TRUE(replay.is_same()) << replay.differences.size() << " differences";
}

}  // namespace
}  // namespace arthronaut
