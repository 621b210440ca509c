#include <algorithm>
#include <memory>

#include "app/command_line/command.h"
#include "app/command_line/demo_operation.h"
#include "app/command_line/option_checks.h"
#include "app/library/workstation_library.h"
#include "planning/files/whole_folder.h"

namespace arthronaut::command_line {

namespace {

namespace fs = std::filesystem;

struct DemoArguments {
  std::string output, side = "right";
  std::uint64_t seed = 1;
  std::vector<std::string> surroundings;
};

simulator::SurroundingsOptions surroundings_from(const std::vector<std::string>& names) {
  const auto has = [&](const char* name) { return std::ranges::find(names, name) != names.end(); };
  return {.soft_tissue = has("soft-tissue"), .motes = has("motes"), .other_hand = has("other-hand")};
}

// Without a name of the user's: the first of demo.arthro, demo-2.arthro, ... that is not there.
fs::path folder_of(const DemoArguments& arguments) {
  if (!arguments.output.empty()) {
    files::refuse_taken(arguments.output);
    files::refuse_unwritable(arguments.output);
    return arguments.output;
  }
  fs::path folder = "demo.arthro";
  for (int i = 2; fs::exists(folder); ++i) folder = "demo-" + std::to_string(i) + ".arthro";
  return folder;
}

}  // namespace

void add_demo_command(CLI::App& app, Context& context) {
  CLI::App* command =
      add_subcommand(app, context, "demo",
                     "The whole workflow on the built-in phantom and the simulated arthroscope, from "
                     "plan to report",
                     "arthronaut demo -o demo.arthro --side left --seed 3");
  const auto arguments = std::make_shared<DemoArguments>();
  command
      ->add_option("-o,--output", arguments->output,
                   "Case folder to write: absent, or empty; default: demo.arthro, or the next free name")
      ->check(a_file());
  command->add_option("--side", arguments->side, "left or right")
      ->check(CLI::IsMember({"left", "right"}))
      ->capture_default_str();
  command->add_option("--seed", arguments->seed, "Another knee and another hand for each seed")
      ->check(a_seed())
      ->capture_default_str();
  command
      ->add_option("--surroundings", arguments->surroundings,
                   "What else the joint shows, separated by commas: soft-tissue, motes, other-hand")
      ->delimiter(',')
      ->check(CLI::IsMember({"soft-tissue", "motes", "other-hand"}));
  command->callback([&context, arguments] {
    const std::filesystem::path folder = folder_of(*arguments);
    run_demo(context, {.case_folder = folder,
                       .seed = arguments->seed,
                       .side = bones::side_from_text(arguments->side),
                       .surroundings = surroundings_from(arguments->surroundings)});
    workstation_library::note_case(folder);
  });
}

}  // namespace arthronaut::command_line
