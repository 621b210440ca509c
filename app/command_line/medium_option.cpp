#include "app/command_line/medium_option.h"

#include "navigation/camera/medium.h"
#include "planning/geometry/error.h"

namespace arthronaut::command_line {

CLI::Option* add_medium_option(CLI::App& subcommand, std::optional<double>& index,
                               const std::string& description) {
  const auto parse = [&index](const CLI::results_t& results) {
    try {
      index = camera::refractive_index_from_text(results.front());
    } catch (const InvalidInput& error) {
      // On the command line a bad word is wrong usage (2), not bad input (3).
      throw CLI::ValidationError("--medium", error.what());
    }
    return true;
  };
  return subcommand.add_option("--medium", parse, description)->type_name("MEDIUM")->expected(1);
}

}  // namespace arthronaut::command_line
