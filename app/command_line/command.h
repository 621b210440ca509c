// The command line: one file a subcommand, each of which adds itself to the parser and does its work in one
// function.
//
// Exit codes: 0 done and reliable; 1 internal error; 2 wrong usage; 3 unreadable or invalid input; 4 done,
// but the result is not reliable (it is written, with its reasons). Exceptions end in run_command_line,
// nowhere else.
#pragma once

#include <CLI/CLI.hpp>
#include <Eigen/Core>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace arthronaut::command_line {

enum ExitCode : int { kDone = 0, kInternalError = 1, kWrongUsage = 2, kInvalidInput = 3, kUnreliable = 4 };

// Progress on a terminal, silence in a pipe. One line, rewritten; removed at the end.
class Progress {
 public:
  // total <= 0: unknown; that it goes on is then shown at once.
  explicit Progress(std::string_view what, long total);
  ~Progress();
  void advance_to(long done);
  void name(std::string_view what);  // another part of the same work, from the next advance on

 private:
  std::string what_;
  long total_;
  int last_percent_ = -1;
  bool shown_;
};

// What every subcommand gets. A subcommand's callback sets exit_code (kDone unless it says otherwise).
struct Context {
  int exit_code = kDone;
  bool quiet = false, verbose = false;
  std::string log_file;  // empty: no log
  // A line for the user on standard output unless --quiet, and for the log. Results asked for with "-o -" are
  // not sent through here.
  void say(const std::string& line) const;
  // What is amiss with what was done as asked, on standard error and in the log; the exit code stays.
  void say_amiss(const std::string& what, const std::vector<std::string>& reasons) const;
  // The reasons of an unreliable result, on standard error and in the log, and exit code 4.
  void say_unreliable(const std::string& what, const std::vector<std::string>& reasons);
};

// --log, --verbose and --quiet, which the workstation has too.
void add_log_options(CLI::App& app, Context& context);
// Adds a subcommand with the options that all have (--log, --verbose, --quiet) and an example under its help.
CLI::App* add_subcommand(CLI::App& app, Context& context, const std::string& name,
                         const std::string& description, const std::string& example);
// Adds an option that takes "x,y,z" (mm or a direction), up to a million each; may start with a minus sign.
CLI::Option* add_vector_option(CLI::App& subcommand, const std::string& name, Eigen::Vector3d& value,
                               const std::string& description);

// One a file, app/command_line/NAME_command.cpp, in the order of --help.
void add_import_command(CLI::App& app, Context& context);
void add_cases_command(CLI::App& app, Context& context);
void add_series_command(CLI::App& app, Context& context);
void add_sources_command(CLI::App& app, Context& context);
void add_landmarks_command(CLI::App& app, Context& context);
void add_segment_command(CLI::App& app, Context& context);
void add_plan_command(CLI::App& app, Context& context);
void add_calibrate_command(CLI::App& app, Context& context);
void add_check_fluid_command(CLI::App& app, Context& context);
void add_accuracy_command(CLI::App& app, Context& context);
void add_track_command(CLI::App& app, Context& context);
void add_pivot_command(CLI::App& app, Context& context);
void add_digitise_command(CLI::App& app, Context& context);
void add_register_command(CLI::App& app, Context& context);
void add_navigate_command(CLI::App& app, Context& context);
void add_replay_command(CLI::App& app, Context& context);
void add_verify_command(CLI::App& app, Context& context);
void add_resume_command(CLI::App& app, Context& context);
void add_rig_command(CLI::App& app, Context& context);
void add_compare_command(CLI::App& app, Context& context);
void add_report_command(CLI::App& app, Context& context);
void add_dicom_command(CLI::App& app, Context& context);
void add_pacs_command(CLI::App& app, Context& context);
void add_markers_command(CLI::App& app, Context& context);
void add_phantom_command(CLI::App& app, Context& context);
void add_demo_command(CLI::App& app, Context& context);
void add_train_command(CLI::App& app, Context& context);
void add_experiment_command(CLI::App& app, Context& context);

// What the user asked of the window.
struct WorkstationRequest {
  std::string case_folder;  // or what is to be imported; empty: the list of cases
  bool built_in = false;    // the built-in case
  long frames = 0;          // close after so many frames; 0: when the user quits
  bool list_widgets = false;
};

// The whole program: parses, dispatches, turns every exception into its exit code and one line on standard
// error. open_workstation is called when no subcommand was given, and returns the exit code.
int run_command_line(int argc, char** argv,
                     const std::function<int(const WorkstationRequest&)>& open_workstation);

}  // namespace arthronaut::command_line
