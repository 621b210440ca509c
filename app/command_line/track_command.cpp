#include <cstdio>

#include "app/command_line/command.h"
#include "app/command_line/medium_option.h"
#include "navigation/camera/camera_file.h"
#include "navigation/pipeline/track_video.h"
#include "planning/files/atomic_file.h"

namespace arthronaut::command_line {

namespace {

struct TrackArguments {
  std::string camera, tools, output, video;
  std::optional<double> medium_index;
  bool fixed_lens = false;
};

std::string share(long part, long whole) {
  char text[64];
  std::snprintf(text, sizeof text, "%ld of %ld frames (%.1f %%)", part, whole,
                whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 0.0);
  return text;
}

void say_statistics(const Context& context, const pipeline::ViewStatistics& statistics) {
  for (const pipeline::MarkerStatistics& marker : statistics.markers) {
    std::string line = "marker " + std::to_string(marker.id) + " (" + marker.name + "): " +
                       share(marker.frames_with_pose, statistics.frame_count);
    if (marker.frames_with_pose < statistics.frame_count) {
      line += ", else mostly: " + std::string(markers::to_text(marker.main_loss));
    }
    context.say(line);
  }
  context.say("lens mark: " + share(statistics.frames_with_mark, statistics.frame_count));
  if (statistics.frames_with_unknown_lens > 0) {
    context.say("no pose stands in " + share(statistics.frames_with_unknown_lens, statistics.frame_count) +
                ": the lens angle is not known there (--fixed-lens if this lens does not turn)");
  }
  if (context.verbose) {
    char text[80];
    std::snprintf(text, sizeof text, "processing: %.1f ms a frame, worst %.1f ms", statistics.processing_ms_mean,
                  statistics.processing_ms_worst);
    context.say(text);
  }
}

void track(Context& context, const TrackArguments& arguments) {
  const camera::CalibrationRecord camera = camera::read_camera_file(arguments.camera);
  const tools::ToolSet tools = tools::read_tools_file(arguments.tools);
  const auto source = sources::open_video(arguments.video);

  pipeline::ViewTrackerOptions options;
  options.calibration = camera.calibration;
  options.refractive_index = arguments.medium_index.value_or(camera.calibration.refractive_index);
  options.follow_lens = !arguments.fixed_lens;
  pipeline::TrackedVideo tracked;
  {
    Progress progress("tracking", static_cast<long>(source->info().frame_count));
    tracked = pipeline::track_video(*source, options, tools, [&](long done) { progress.advance_to(done); });
  }
  files::write_atomically(arguments.output, strokes::poses_to_text(tracked.rows));
  if (arguments.output != "-") say_statistics(context, tracked.statistics);
  if (!tracked.reasons.empty()) context.say_unreliable(arguments.output, tracked.reasons);
}

}  // namespace

void add_track_command(CLI::App& app, Context& context) {
  CLI::App* command = add_subcommand(app, context, "track", "Marker poses in every frame of a video",
                                     "arthronaut track --camera camera.json --tools tools.json --medium saline "
                                     "-o poses.csv clip.mkv");
  const auto arguments = std::make_shared<TrackArguments>();
  command->add_option("--camera", arguments->camera, "camera.json of the arthroscope")->required();
  command->add_option("--tools", arguments->tools, "tools.json: the markers and their sizes")->required();
  add_medium_option(*command, arguments->medium_index,
                    "What the scope looks through: air, water, saline or a refractive index; "
                    "default: the medium of the calibration");
  command->add_flag("--fixed-lens", arguments->fixed_lens,
                    "The lens stays at the calibration's reference angle; the lens mark is not needed");
  command->add_option("-o,--output", arguments->output, "poses.csv to write; - is standard output")->required();
  command->add_option("VIDEO", arguments->video, "Video file, or a pattern of still images such as f_%04d.png")
      ->required();
  command->callback([&context, arguments] { track(context, *arguments); });
}

}  // namespace arthronaut::command_line
