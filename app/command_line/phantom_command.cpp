#include "app/command_line/command.h"
#include "app/command_line/option_checks.h"
#include "app/library/workstation_library.h"
#include "planning/cases/case.h"
#include "planning/files/whole_folder.h"
#include "planning/phantom/phantom_case.h"

namespace arthronaut::command_line {

void add_phantom_command(CLI::App& app, Context& context) {
  struct Arguments {
    std::string output, side = "right";
    std::uint64_t seed = 1;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* sub = add_subcommand(app, context, "phantom",
                                 "Write the built-in knee as a case folder: meshes, landmarks, plan",
                                 "arthronaut phantom -o Phantom.arthro --side left --seed 3");
  sub->add_option("-o,--output", arguments->output, "Case folder to write: absent, or empty")
      ->required()
      ->check(a_file());
  sub->add_option("--side", arguments->side, "left or right")
      ->check(CLI::IsMember({"left", "right"}))
      ->capture_default_str();
  sub->add_option("--seed", arguments->seed, "Another knee for each seed")
      ->check(a_seed())
      ->capture_default_str();
  sub->callback([arguments, &context] {
    const std::filesystem::path folder = arguments->output;
    files::refuse_taken(folder);
    files::refuse_unwritable(folder);
    const auto knee =
        phantom::make_phantom_knee({.side = bones::side_from_text(arguments->side), .seed = arguments->seed});
    files::make_whole_folder(folder, [&](const std::filesystem::path& unfinished) {
      cases::save_case(unfinished, phantom::case_of(knee, folder.stem().string()));
    });
    workstation_library::note_case(folder);
    context.say("Wrote " + folder.string() + ": a " + arguments->side + " knee with its plan.");
  });
}

}  // namespace arthronaut::command_line
