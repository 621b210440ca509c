#include "app/command_line/predicted_error_command.h"

#include <algorithm>
#include <memory>

#include "app/command_line/option_checks.h"
#include "navigation/experiments/predicted_error.h"
#include "planning/files/format.h"

namespace arthronaut::command_line {

namespace {

using experiments::ErrorRatios;
using experiments::Setup;

struct PredictedErrorArguments {
  int operations = 100;
  std::uint64_t seed = 1;
  std::string table;
};

void say(const Context& context, const std::string& which, const ErrorRatios& ratios) {
  if (ratios.count == 0) return;
  context.say(files::format(
      "%-22s %3d: offset %.2f mm, angle %.2f deg; error / predicted: offset %.2f, angle %.2f, tip %.2f; "
      "without tools and camera: %.2f, %.2f; above twice the prediction: %.0f %%, %.0f %%",
      which.c_str(), ratios.count, ratios.median_offset_mm, ratios.median_angle_deg, ratios.offset,
      ratios.angle, ratios.tip, ratios.plain_offset, ratios.plain_angle, 100 * ratios.offset_above_two,
      100 * ratios.angle_above_two));
}

void run(Context& context, const PredictedErrorArguments& arguments) {
  refuse_before_the_work({.read = {}, .written = {arguments.table}});
  experiments::PredictedErrorOptions options;
  options.operation_count = arguments.operations;
  options.seed = arguments.seed;
  experiments::PredictedErrorResult result;
  {
    Progress progress("operating", options.operation_count);
    result = experiments::run_predicted_error(options, [&](int done) { progress.advance_to(done); });
  }
  if (!arguments.table.empty()) experiments::write_predicted_error_table(arguments.table, result);
  context.say("medians; of the operations:");
  say(context, "all", result.all());
  for (const Setup setup : {Setup::Careful, Setup::PoorTools, Setup::PoorCamera, Setup::PoorBoth})
    say(context, to_text(setup), result.of(setup));
  constexpr double kLeast = 0.5, kMost = 1.6;
  const ErrorRatios all = result.all();
  if (std::min(all.offset, all.angle) < kLeast || std::max(all.offset, all.angle) > kMost)
    context.say_unreliable("the prediction", {"the error is not the one that is predicted"});
}

}  // namespace

void add_predicted_error_experiment(CLI::App& experiment, Context& context) {
  CLI::App* command =
      add_subcommand(experiment, context, "predicted-error",
                     "Whether the error that the screen predicts is the error there is: operations without "
                     "pictures, with poor tools and a poor camera among them",
                     "arthronaut experiment predicted-error --operations 100 -o errors.csv");
  const auto arguments = std::make_shared<PredictedErrorArguments>();
  command->add_option("--operations", arguments->operations, "Number of operations")
      ->check(whole_between(1, 1000000));
  command
      ->add_option("--seed", arguments->seed, "Seed of the operations; the same seed gives the same figures")
      ->check(a_seed());
  command->add_option("-o,--output", arguments->table, "CSV to write one row an operation into");
  command->callback([&context, arguments] { run(context, *arguments); });
}

}  // namespace arthronaut::command_line
