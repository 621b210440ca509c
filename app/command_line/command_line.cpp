#include <arthronaut/version.h>

#include <cctype>
#include <filesystem>
#include <iostream>
#include <vector>

#include "app/command_line/command.h"
#include "app/command_line/option_checks.h"
#include "navigation/sources/frame_source.h"
#include "planning/geometry/error.h"
#include "planning/log/log.h"

namespace arthronaut::command_line {

namespace {

// "--target -74.5,16.1,-9.7": joins an option and a value that starts with a minus sign, which the parser
// would take for another option.
std::vector<std::string> joined_negative_values(int argc, char** argv) {
  std::vector<std::string> arguments;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const bool is_negative_number = argument.size() > 1 && argument[0] == '-' &&
                                    (std::isdigit(static_cast<unsigned char>(argument[1])) != 0 ||
                                     (argument[1] == '.' && argument.size() > 2));
    if (is_negative_number && !arguments.empty() && arguments.back().starts_with("--") &&
        arguments.back().find('=') == std::string::npos) {
      arguments.back() += "=" + argument;
    } else {
      arguments.push_back(argument);
    }
  }
  return arguments;
}

// A word that is neither a subcommand nor a folder is a slip of the keyboard.
bool is_slip(const std::string& word) { return !word.empty() && !std::filesystem::exists(word); }

int tell_slip(const std::string& word) {
  std::cerr << "arthronaut: \"" << word
            << "\" is neither a subcommand nor a case folder; see arthronaut --help\n";
  return kWrongUsage;
}

// No subcommand: the window.
int open_window(const WorkstationRequest& request,
                const std::function<int(const WorkstationRequest&)>& open) {
  return is_slip(request.case_folder) ? tell_slip(request.case_folder) : open(request);
}

// As every other error begins; and where more is said of the command that was meant.
std::string usage_error(const CLI::App* app, const CLI::Error& error) {
  std::string command = app->get_name();
  for (auto chosen = app->get_subcommands(); !chosen.empty(); chosen = chosen.front()->get_subcommands())
    command += " " + chosen.front()->get_name();
  return std::string("arthronaut: ") + error.what() + "; see " + command + " --help\n";
}

int report_error(const std::exception& error, int exit_code) {
  std::cerr << "arthronaut: " << error.what() << '\n';
  log::error(error.what());
  return exit_code;
}

void open_log(const Context& context, const std::vector<std::string>& arguments) {
  if (context.log_file.empty()) return;
  log::open(context.log_file, context.verbose ? log::Level::Debug : log::Level::Info);
  std::string line = std::string("started: arthronaut ") + kProgramVersion;
  for (const std::string& argument : arguments) line += " " + sources::shown_address(argument);
  log::info(line);
}

int parse_and_do(CLI::App& app, const Context& context, const std::vector<std::string>& arguments,
                 const std::function<int()>& open) {
  try {
    std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());  // what CLI11 expects
    app.parse(reversed);
    return app.get_subcommands().empty() ? open() : context.exit_code;
  } catch (const CLI::ParseError& error) {
    // Its options are no slip of the one who wrote them.
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError) &&
        app.get_subcommands().empty() && is_slip(arguments.front()) && !arguments.front().starts_with('-'))
      return tell_slip(arguments.front());
    const bool asked_for =
        error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success);  // --help, --version
    app.exit(error);
    return asked_for ? kDone : kWrongUsage;
  }
}

// Parses and does what was asked for; every exception but those of the parser becomes an exit code.
int run_parsed(CLI::App& app, Context& context, const std::vector<std::string>& arguments,
               const std::function<int()>& open) {
  try {
    const int exit_code = parse_and_do(app, context, arguments, open);
    // What was said there is lost, and whoever reads it on must know.
    if (!std::cout.flush()) throw IoError("standard output: cannot write");
    return exit_code;
  } catch (const InvalidInput& error) {
    return report_error(error, kInvalidInput);
  } catch (const IoError& error) {
    return report_error(error, kInvalidInput);
  } catch (const DeviceError& error) {
    return report_error(error, kInvalidInput);
  } catch (const std::filesystem::filesystem_error& error) {
    // In the words of every other error: the library's begin with the call that failed.
    return report_error(IoError(error.path1(), error.code().message()), kInvalidInput);
  } catch (const std::exception& error) {
    return report_error(error, kInternalError);
  }
}

}  // namespace

int run_command_line(int argc, char** argv,
                     const std::function<int(const WorkstationRequest&)>& open_workstation) {
  CLI::App app{
      "Arthronaut plans and navigates the reconstruction of the anterior cruciate ligament by the "
      "arthroscope's own\n"
      "video. Research software, not a medical device. Without a subcommand it opens the workstation."};
  app.name("arthronaut");
  app.set_version_flag("--version", std::string("arthronaut ") + kProgramVersion);
  app.require_subcommand(0, 1);
  app.failure_message(usage_error);
  app.footer(
      "Exit codes: 0 done and reliable; 1 internal error; 2 wrong usage; 3 unreadable or invalid input;\n"
      "4 done, but the result is not reliable (it is written, with its reasons).");
  WorkstationRequest request;
  app.add_option("case", request.case_folder,
                 "Case folder to open in the workstation, or images to import there");
  app.add_flag("--built-in", request.built_in, "Open the workstation on the built-in knee");
  app.add_option("--frames", request.frames, "Close the workstation after so many frames")
      ->check(whole_between(0, 1000000000));
  app.add_flag("--list-widgets", request.list_widgets,
               "Print where the workstation's widgets are, for tests");

  Context context;
  add_log_options(app, context);
  add_import_command(app, context);
  add_cases_command(app, context);
  add_series_command(app, context);
  add_sources_command(app, context);
  add_landmarks_command(app, context);
  add_segment_command(app, context);
  add_plan_command(app, context);
  add_calibrate_command(app, context);
  add_check_fluid_command(app, context);
  add_accuracy_command(app, context);
  add_track_command(app, context);
  add_pivot_command(app, context);
  add_digitise_command(app, context);
  add_register_command(app, context);
  add_navigate_command(app, context);
  add_replay_command(app, context);
  add_verify_command(app, context);
  add_resume_command(app, context);
  add_rig_command(app, context);
  add_compare_command(app, context);
  add_report_command(app, context);
  add_dicom_command(app, context);
  add_pacs_command(app, context);
  add_markers_command(app, context);
  add_phantom_command(app, context);
  add_demo_command(app, context);
  add_train_command(app, context);
  add_experiment_command(app, context);

  const std::vector<std::string> arguments = joined_negative_values(argc, argv);
  // Called when all is parsed, before the subcommand does its work.
  app.parse_complete_callback([&] { open_log(context, arguments); });
  const int exit_code =
      run_parsed(app, context, arguments, [&] { return open_window(request, open_workstation); });
  log::info("ended with exit code " + std::to_string(exit_code));
  return exit_code;
}

}  // namespace arthronaut::command_line
