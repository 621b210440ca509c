#include "app/command_line/command.h"
#include "app/command_line/lens_rotation_command.h"
#include "app/command_line/predicted_error_command.h"
#include "app/command_line/registration_experiment_command.h"

namespace arthronaut::command_line {

void add_experiment_command(CLI::App& app, Context& context) {
  CLI::App* experiment = add_subcommand(
      app, context, "experiment", "The experiments of the paper, run again, and the program's own",
      "arthronaut experiment registration --bone femur.ply --trials 10 --noise dry");
  experiment->require_subcommand(1);
  add_lens_rotation_experiment(*experiment, context);
  add_registration_experiment(*experiment, context);
  add_predicted_error_experiment(*experiment, context);
}

}  // namespace arthronaut::command_line
