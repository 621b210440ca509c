#include <memory>

#include "app/command_line/command.h"
#include "app/command_line/frame_dump.h"
#include "app/command_line/medium_option.h"
#include "app/command_line/option_checks.h"
#include "app/command_line/picture_size.h"
#include "app/command_line/tracking_report.h"
#include "navigation/camera/camera_file.h"
#include "navigation/pipeline/track_video.h"
#include "planning/geometry/error.h"

namespace arthronaut::command_line {

namespace {

struct TrackArguments {
  std::string camera, tools, output, video, dump;
  std::optional<double> medium_index;
  bool fixed_lens = false;
};

void track(Context& context, const TrackArguments& arguments) {
  refuse_before_the_work(
      {.read = {arguments.camera, arguments.tools, arguments.video}, .written = {arguments.output}});
  const camera::CalibrationRecord camera = camera::read_camera_file(arguments.camera);
  std::vector<std::string> reasons = camera_doubts(arguments.camera);
  warn_of_simulated_camera(arguments.camera);
  const tools::ToolSet tools = tools::read_tools_file(arguments.tools);
  if (tools.tracker)
    throw InvalidInput(arguments.tools, "tracker",
                       "the tools are seen by an outside tracker: no marker is looked for in pictures");
  const auto source = sources::open_video(arguments.video);
  refuse_other_size(arguments.video, *source, camera.calibration);

  pipeline::ViewTrackerOptions options;
  options.calibration = camera.calibration;
  options.refractive_index = arguments.medium_index.value_or(camera.calibration.refractive_index);
  options.follow_lens = !arguments.fixed_lens;
  pipeline::TrackedVideo tracked;
  {
    Progress progress("tracking", static_cast<long>(source->info().frame_count));
    std::optional<FrameDump> dump;
    if (!arguments.dump.empty()) dump.emplace(arguments.dump);
    long done = 0;
    tracked = pipeline::track_video(*source, options, tools, [&](const auto& frame, const auto& seen) {
      if (dump) dump->add(frame, seen);
      progress.advance_to(++done);
    });
  }
  strokes::write_poses_file(arguments.output, tracked.rows);
  if (arguments.output != "-") say_statistics(context, tracked.statistics);
  reasons.insert(reasons.end(), tracked.reasons.begin(), tracked.reasons.end());
  if (!reasons.empty())
    context.say_unreliable(arguments.output == "-" ? "what was tracked" : arguments.output, reasons);
}

}  // namespace

void add_track_command(CLI::App& app, Context& context) {
  CLI::App* command =
      add_subcommand(app, context, "track", "Marker poses in every frame of a video",
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
  command->add_option("-o,--output", arguments->output, "poses.csv to write; - is standard output")
      ->required()
      ->check(a_name());
  command->add_option(
      "--dump", arguments->dump,
      "Folder to write what the tracker saw to, frame by frame: a picture with the squares that "
      "it looked at, and a JSON file");
  command
      ->add_option("VIDEO", arguments->video, "Video file, or a pattern of still images such as f_%04d.png")
      ->required();
  command->callback([&context, arguments] { track(context, *arguments); });
}

}  // namespace arthronaut::command_line
