#include "app/command_line/lens_rotation_command.h"

#include <cmath>
#include <filesystem>
#include <memory>

#include "app/command_line/medium_option.h"
#include "app/command_line/option_checks.h"
#include "navigation/camera/camera_file.h"
#include "navigation/experiments/lens_rotation.h"
#include "navigation/tools/tool_set.h"
#include "planning/files/format.h"
#include "planning/geometry/error.h"

namespace arthronaut::command_line {

namespace {

namespace fs = std::filesystem;
using experiments::LensRotationResult;

struct LensRotationArguments {
  int frames = 500;
  std::uint64_t seed = 1;
  std::string video, camera, tools, truth, output;
  std::optional<double> medium;
};

// The ruler's markers as the tools declare them must be those of the truth.
void check_tools(const std::string& file, const calibration::Ruler& ruler) {
  const tools::ToolSet set = tools::read_tools_file(file);
  for (const int id : {ruler.first_id, ruler.second_id}) {
    double size_mm = 0;
    const auto look = [&](const auto& body) {
      for (const tools::BodyMarker& marker : tools::markers_of(body))
        if (marker.marker_id == id) size_mm = marker.size_mm;
    };
    for (const auto& world : set.world_markers) look(world);
    for (const auto& tool : set.tools) look(tool);
    if (std::abs(size_mm - ruler.size_mm) > 1e-6) {
      throw InvalidInput(file, "marker " + std::to_string(id),
                         "is not declared with the size of the ruler's truth");
    }
  }
}

LensRotationResult run_on_clip(Context& context, const LensRotationArguments& arguments) {
  experiments::RulerInFluid ruler = experiments::read_ruler_file(arguments.truth);
  if (!arguments.tools.empty()) check_tools(arguments.tools, ruler.ruler);
  if (arguments.medium) ruler.refractive_index = *arguments.medium;
  const camera::Calibration camera = camera::read_camera_file(arguments.camera).calibration;
  const auto source = sources::open_video(arguments.video);
  context.say(arguments.video + ", camera " + arguments.camera);
  Progress progress("tracking", static_cast<long>(source->info().frame_count));
  return experiments::run_lens_rotation(*source, camera, ruler, [&](int done) { progress.advance_to(done); });
}

LensRotationResult run_simulated(Context& context, const LensRotationArguments& arguments) {
  experiments::SimulatedLensRotation simulated;
  {
    Progress progress("simulating", arguments.frames);
    simulated = experiments::simulate_lens_rotation(arguments.frames, arguments.seed,
                                                    [&](int done) { progress.advance_to(done); });
  }
  context.say(files::format(
      "simulator, seed %llu; camera calibrated from its stills: focal length %.2f px (true %.2f)",
      static_cast<unsigned long long>(arguments.seed), simulated.calibrated.focal_px,
      simulated.truth.focal_px));
  return simulated.result;
}

void run(Context& context, const LensRotationArguments& arguments) {
  const bool on_clip = !arguments.video.empty();
  const LensRotationResult result =
      on_clip ? run_on_clip(context, arguments) : run_simulated(context, arguments);
  context.say(
      files::format("%zu frames, the lens turned over %.0f deg", result.frames.size(), result.rotation_deg));
  context.say("                       frames   translation, mm     rotation, deg");
  context.say("                                median    95 %      median    95 %");
  for (std::size_t i = 0; i < experiments::kLensModes.size(); ++i) {
    const experiments::LensModeSummary& mode = result.modes[i];
    context.say(files::format("%-22s %6d   %6.3f   %6.3f     %6.3f   %6.3f",
                              std::string(to_text(experiments::kLensModes[i])).c_str(), mode.frame_count,
                              mode.median_mm, mode.p95_mm, mode.median_deg, mode.p95_deg));
  }
  if (!arguments.output.empty()) {
    const fs::path folder = arguments.output;
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw IoError(folder, "can't be made: " + error.message());
    const std::string title = std::string("Lens rotation, ") +
                              (on_clip ? fs::path(arguments.video).filename().string() : "simulator") +
                              ", in fluid";
    experiments::write_lens_rotation_plot(folder / "lens_rotation.png", result, title);
    experiments::write_lens_rotation_table(folder / "lens_rotation.csv", result);
    context.say("plot and figures: " + (folder / "lens_rotation.png").string() + ", lens_rotation.csv");
  }
  const auto tracked = static_cast<std::size_t>(result.modes[0].frame_count);
  if (2 * tracked < result.frames.size()) {
    context.say_unreliable("the experiment", {"both markers had a pose in less than half of the frames"});
  }
}

}  // namespace

void add_lens_rotation_experiment(CLI::App& experiment, Context& context) {
  CLI::App* command = add_subcommand(experiment, context, "lens-rotation",
                                     "The paper's first experiment: the relative pose of two markers in "
                                     "fluid while the lens turns, on the simulator or "
                                     "on a recorded clip",
                                     "arthronaut experiment lens-rotation --frames 500 -o rotation");
  const auto arguments = std::make_shared<LensRotationArguments>();
  auto* frames = command->add_option("--frames", arguments->frames, "Frames to simulate")
                     ->check(whole_between(1, 100000));
  auto* seed = command
                   ->add_option("--seed", arguments->seed,
                                "Seed of the simulation; the same seed gives the same figures")
                   ->check(a_seed());
  command->add_option("-o", arguments->output, "Folder for the plot and the figures of every frame")
      ->check(a_file());
  auto* video =
      command->add_option("--video", arguments->video, "A recorded clip of a ruler instead of the simulator");
  auto* camera = command->add_option("--camera", arguments->camera, "camera.json of the clip");
  auto* truth =
      command->add_option("--truth", arguments->truth, "ruler.json: the true pose of the ruler's markers");
  auto* tools =
      command->add_option("--tools", arguments->tools, "tools.json of the clip, checked against the truth");
  auto* medium =
      add_medium_option(*command, arguments->medium, "Fluid of the clip, when it is not that of the truth");
  video->needs(camera)->needs(truth)->excludes(frames)->excludes(seed);
  camera->needs(video);
  truth->needs(video);
  tools->needs(video);
  medium->needs(video);
  command->callback([&context, arguments] { run(context, *arguments); });
}

}  // namespace arthronaut::command_line
