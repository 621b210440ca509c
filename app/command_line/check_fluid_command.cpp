#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/command_line/command.h"
#include "app/command_line/medium_option.h"
#include "navigation/calibration/ruler_sightings.h"
#include "navigation/camera/camera_file.h"
#include "navigation/camera/medium.h"
#include "navigation/experiments/lens_rotation.h"
#include "navigation/sources/frame_source.h"
#include "planning/files/json_document.h"
#include "planning/geometry/error.h"

namespace arthronaut::command_line {

namespace {

using calibration::FluidCheckSummary;

struct CheckFluidArguments {
  std::string camera, tools, ruler, output, video;
  std::optional<double> medium_index;
  std::vector<int> ids;
  double spacing_mm = 10;
  bool fixed_lens = false;
};

template <typename... Values>
std::string line(const char* format, Values... values) {
  char text[300];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

// The size of both markers, which a ruler has in common.
double common_size_mm(const std::string& file, const std::vector<markers::DeclaredMarker>& declared,
                      int first, int second) {
  const auto size_of = [&](int id) {
    for (const auto& marker : declared)
      if (marker.id == id) return marker.size_mm;
    throw InvalidInput(file, "marker " + std::to_string(id), "is not declared");
  };
  const double size_mm = size_of(first);
  if (std::abs(size_of(second) - size_mm) > 1e-6)
    throw InvalidInput(file, "marker " + std::to_string(second),
                       "is not of the size of marker " + std::to_string(first));
  return size_mm;
}

calibration::RulerSightingsOptions options_of(const CheckFluidArguments& arguments) {
  calibration::RulerSightingsOptions options;
  options.calibration = camera::read_camera_file(arguments.camera).calibration;
  options.follow_lens = !arguments.fixed_lens;
  options.refractive_index = camera::kSalineIndex;
  options.ruler.first_from_second.translation_mm = {arguments.spacing_mm, 0, 0};
  std::vector<int> ids = arguments.ids;
  const auto declared = markers::declared_markers(tools::read_tools_file(arguments.tools));
  if (!arguments.ruler.empty()) {
    const experiments::RulerInFluid seen = experiments::read_ruler_file(arguments.ruler);
    ids = {seen.ruler.first_id, seen.ruler.second_id};
    options.ruler.first_from_second = seen.ruler.first_from_second;
    options.refractive_index = seen.refractive_index;
  }
  if (ids.empty()) {
    if (declared.size() != 2)
      throw InvalidInput(arguments.tools, "tools",
                         "declare " + std::to_string(declared.size()) +
                             " markers: say with --markers which two are the ruler's");
    ids = {declared[0].id, declared[1].id};
  }
  options.ruler.first_id = ids[0];
  options.ruler.second_id = ids[1];
  options.ruler.size_mm = common_size_mm(arguments.tools, declared, ids[0], ids[1]);
  options.refractive_index = arguments.medium_index.value_or(options.refractive_index);
  return options;
}

// A recorded clip is looked at whole.
FluidCheckSummary check(const CheckFluidArguments& arguments, calibration::RulerSightingsOptions options,
                        std::vector<std::string>& losses, std::size_t& frame_count) {
  const auto source = sources::open_video(arguments.video);
  options.most = std::numeric_limits<std::size_t>::max();
  calibration::RulerSightings sightings(options);
  Progress progress("looking for the ruler", static_cast<long>(source->info().frame_count));
  while (const camera::FramePtr frame = source->next()) {
    const calibration::RulerLook& seen = sightings.look(*frame);
    if (!seen.is_taken) losses.push_back(seen.reason);
    progress.advance_to(static_cast<long>(sightings.frame_count()));
  }
  frame_count = sightings.frame_count();
  calibration::FluidCheckOptions limits;
  limits.refractive_index = options.refractive_index;
  return calibration::check_fluid(sightings.sightings(), options.ruler, options.calibration, limits);
}

nlohmann::ordered_json document_of(const FluidCheckSummary& summary, std::size_t frames,
                                   double stated_index) {
  nlohmann::ordered_json document;
  document["format"] = "arthronaut.fluid_check";
  document["version"] = 1;
  document["medium"] = camera::medium_to_text(stated_index);
  document["frames"] = frames;
  document["frames_with_ruler"] = summary.frame_count;
  document["models"] = nlohmann::ordered_json::array();
  for (const auto& row : summary.rows)
    document["models"].push_back({{"model", calibration::to_text(row.hypothesis)},
                                  {"rms_px", row.rms_px},
                                  {"median_mm", row.median_mm},
                                  {"median_deg", row.median_deg},
                                  {"p95_mm", row.worst_mm},
                                  {"p95_deg", row.worst_deg}});
  document["best_index"] = summary.best_index;
  document["index_sigma"] = summary.index_sigma;
  document["reliable"] = summary.is_trusted();
  document["reasons"] = summary.reasons;
  return document;
}

void say_table(const Context& context, const FluidCheckSummary& summary, double stated_index) {
  context.say("model of the fluid         ruler, px    median mm   median deg    95 % mm    95 % deg");
  for (const auto& row : summary.rows)
    context.say(line("%-26s %9.3f %12.3f %12.2f %10.3f %11.2f", std::string(to_text(row.hypothesis)).c_str(),
                     row.rms_px, row.median_mm, row.median_deg, row.worst_mm, row.worst_deg));
  context.say(line("a flat port explains the frames best with an index of %.4f (+- %.4f); stated: %s, %.4f",
                   summary.best_index, std::max(0.0, summary.index_sigma),
                   camera::medium_to_text(stated_index).c_str(), stated_index));
}

// The most frequent reason why frames were of no use.
std::string main_loss(const std::vector<std::string>& losses) {
  std::string most;
  for (const std::string& loss : losses)
    if (std::count(losses.begin(), losses.end(), loss) > std::count(losses.begin(), losses.end(), most))
      most = loss;
  return most;
}

void run_check_fluid(Context& context, const CheckFluidArguments& arguments) {
  const calibration::RulerSightingsOptions options = options_of(arguments);
  std::vector<std::string> losses;
  std::size_t frame_count = 0;
  FluidCheckSummary summary = check(arguments, options, losses, frame_count);
  if (!losses.empty() && !summary.is_trusted())
    summary.reasons.push_back("frames without the ruler, mostly: " + main_loss(losses));
  if (!arguments.output.empty())
    files::write_json(arguments.output, document_of(summary, frame_count, options.refractive_index));
  if (arguments.output != "-") {
    context.say(line("%zu frames, the ruler's markers %d and %d together in %zu", frame_count,
                     options.ruler.first_id, options.ruler.second_id, summary.frame_count));
    if (summary.frame_count > 0) say_table(context, summary, options.refractive_index);
    if (summary.is_trusted()) context.say("the stated medium, behind a flat port, can be trusted");
  }
  if (!summary.is_trusted()) context.say_unreliable("the model of the fluid", summary.reasons);
}

}  // namespace

void add_check_fluid_command(CLI::App& app, Context& context) {
  CLI::App* command = add_subcommand(
      app, context, "check-fluid",
      "Which model of the fluid explains a ruler with two markers, and whether the stated medium can be "
      "trusted",
      "arthronaut check-fluid --camera camera.json --tools ruler.json --medium saline clip.mkv");
  const auto arguments = std::make_shared<CheckFluidArguments>();
  command->add_option("--camera", arguments->camera, "camera.json of the arthroscope")->required();
  command->add_option("--tools", arguments->tools, "tools.json that declares the ruler's two markers")
      ->required();
  add_medium_option(
      *command, arguments->medium_index,
      "What is said to be before the scope: air, water, saline (default) or a refractive index");
  auto* ids = command
                  ->add_option("--markers", arguments->ids,
                               "The ruler's two ids, first,second, where the tools declare more than two")
                  ->delimiter(',')
                  ->expected(2);
  auto* spacing =
      command
          ->add_option("--spacing-mm", arguments->spacing_mm,
                       "The second marker's centre along the first one's x axis, mm (default: 10); "
                       "both face the same way")
          ->check(CLI::PositiveNumber);
  command
      ->add_option("--ruler", arguments->ruler,
                   "ruler.json: the two markers' relative pose, where it is another")
      ->excludes(ids)
      ->excludes(spacing);
  command->add_flag("--fixed-lens", arguments->fixed_lens,
                    "The lens stays at the calibration's reference angle; the lens mark is not needed");
  command->add_option("-o,--output", arguments->output, "JSON file for the result; - is standard output");
  command
      ->add_option("VIDEO", arguments->video, "Video file, or a pattern of still images such as f_%04d.png")
      ->required();
  command->callback([&context, arguments] { run_check_fluid(context, *arguments); });
}

}  // namespace arthronaut::command_line
