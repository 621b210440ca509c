#include <charconv>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "app/command_line/command.h"
#include "app/command_line/option_checks.h"
#include "app/own_process/own_process.h"
#include "app/report/report.h"
#include "planning/files/utc_clock.h"
#include "planning/geometry/error.h"

namespace arthronaut::command_line {

namespace {

// SOURCE_DATE_EPOCH, as reproducible-builds.org has it, in UTC; empty where nobody sets it. Throws
// InvalidInput.
std::string made_utc_of_environment() {
  const char* const text = std::getenv("SOURCE_DATE_EPOCH");
  if (text == nullptr || *text == '\0') return "";
  constexpr std::int64_t kYear10000_s = 253402300800;
  std::int64_t seconds = -1;
  const char* const end = text + std::strlen(text);
  const auto [rest, error] = std::from_chars(text, end, seconds);
  if (error != std::errc() || rest != end || seconds < 0 || seconds >= kYear10000_s)
    throw InvalidInput("SOURCE_DATE_EPOCH: \"" + std::string(text) + "\" are no whole seconds since 1970");
  return files::utc_of(std::chrono::system_clock::time_point(std::chrono::seconds(seconds)));
}

}  // namespace

void add_report_command(CLI::App& app, Context& context) {
  struct Arguments {
    std::string case_folder, output, paper = "a4";
    int progress_descriptor = -1;
    report::ReportOptions options;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* sub =
      add_subcommand(app, context, "report", "Write the report: plan, theatre, planned against achieved",
                     "arthronaut report Knee.arthro -o report.pdf");
  sub->add_option("case", arguments->case_folder, "Case folder")->required();
  sub->add_option("-o,--output", arguments->output,
                  "PDF to write; .json or .csv: the same numbers for other programs")
      ->required()
      ->check(a_file());
  sub->add_option("--session", arguments->options.session,
                  "The session's folder name; default: the newest with a drilled tunnel, else with a "
                  "registration");
  sub->add_flag("--with-identity", arguments->options.with_identity,
                "Name the patient (identity.json of the case); without it nobody is named, unless the case's "
                "own name does");
  sub->add_option("--paper", arguments->paper, "a4 or letter; default: a4")
      ->check(CLI::IsMember({"a4", "letter"}));
  sub->add_option("--progress-fd", arguments->progress_descriptor,
                  "For the program that started this one: an open file for what goes on")
      ->group("");
  sub->callback([arguments, &context] {
    // It says what is written; into a device or a pipe goes a PDF.
    refuse_another_ending(arguments->output, {".pdf", ".json", ".csv"});
    refuse_before_the_work({.read = {}, .written = {arguments->output}});
    arguments->options.made_utc = made_utc_of_environment();
    arguments->options.paper = report::paper_from_text(arguments->paper);
    std::vector<std::string> missing;
    {
      Progress progress("Reading the case and its sessions", 100);
      arguments->options.on_progress = [&](const std::string& what, double share) {
        progress.name(what);
        progress.advance_to(static_cast<long>(100 * share));
        if (arguments->progress_descriptor >= 0)
          own_process::tell_progress(arguments->progress_descriptor, what, share);
      };
      missing = report::write_report(arguments->case_folder, arguments->output, arguments->options);
    }
    context.say("Wrote " + arguments->output + ".");
    if (!missing.empty()) context.say_unreliable("the report", missing);
  });
}

}  // namespace arthronaut::command_line
