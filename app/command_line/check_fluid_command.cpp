#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/command_line/command.h"
#include "app/command_line/option_checks.h"
#include "app/command_line/ruler_option.h"
#include "navigation/camera/medium.h"
#include "planning/files/format.h"
#include "planning/files/json_document.h"

namespace arthronaut::command_line {

namespace {

using calibration::FluidCheckSummary;

struct CheckFluidArguments {
  RulerArguments ruler;
  std::string output;
};

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
    context.say(files::format("%-26s %9.3f %12.3f %12.2f %10.3f %11.2f",
                              std::string(to_text(row.hypothesis)).c_str(), row.rms_px, row.median_mm,
                              row.median_deg, row.worst_mm, row.worst_deg));
  context.say(
      files::format("a flat port explains the frames best with an index of %.4f (+- %.4f); stated: %s, %.4f",
                    summary.best_index, std::max(0.0, summary.index_sigma),
                    camera::medium_to_text(stated_index).c_str(), stated_index));
}

void run_check_fluid(Context& context, const CheckFluidArguments& arguments) {
  refuse_before_the_work(
      {.read = {arguments.ruler.camera, arguments.ruler.tools, arguments.ruler.ruler, arguments.ruler.video},
       .written = {arguments.output}});
  const RulerClip seen = look_at_ruler(arguments.ruler);
  const calibration::RulerSightingsOptions& options = seen.options;
  const FluidCheckSummary& summary = seen.summary;
  const std::size_t frame_count = seen.frame_count;
  if (!arguments.output.empty())
    files::write_json(arguments.output, document_of(summary, frame_count, options.refractive_index));
  if (arguments.output != "-") {
    context.say(files::format("%zu frames, the ruler's markers %d and %d together in %zu", frame_count,
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
  add_ruler_options(*command, arguments->ruler);
  command->add_option("-o,--output", arguments->output, "JSON file for the result; - is standard output")
      ->check(a_name());
  command->callback([&context, arguments] { run_check_fluid(context, *arguments); });
}

}  // namespace arthronaut::command_line
