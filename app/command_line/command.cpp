#include "app/command_line/command.h"

#include <unistd.h>

#include <charconv>
#include <cmath>
#include <iostream>

#include "planning/log/log.h"

namespace arthronaut::command_line {

Progress::Progress(std::string_view what, long total)
    : what_(what), total_(total), shown_(::isatty(STDERR_FILENO) != 0) {
  if (total_ <= 0) advance_to(0);
}

Progress::~Progress() {
  if (shown_ && last_percent_ >= 0) std::cerr << "\r\033[K" << std::flush;
}

void Progress::name(std::string_view what) {
  if (what_ == what) return;
  what_ = what;
  last_percent_ = -1;
}

void Progress::advance_to(long done) {
  if (!shown_) return;
  // Without a total the count itself is shown, every ten steps.
  const int percent = static_cast<int>(total_ > 0 ? 100 * done / total_ : done / 10);
  if (percent == last_percent_) return;
  last_percent_ = percent;
  std::cerr << "\r\033[K" << what_;
  if (total_ > 0) std::cerr << ' ' << percent << " %";
  if (total_ <= 0 && done > 0) std::cerr << ' ' << done;
  std::cerr << std::flush;
}

void Context::say(const std::string& line) const {
  log::info(line);
  if (!quiet) std::cout << line << '\n' << std::flush;
}

void Context::say_amiss(const std::string& what, const std::vector<std::string>& reasons) const {
  std::cerr << "arthronaut: " << what << '\n';
  log::warning(what);
  for (const auto& reason : reasons) {
    std::cerr << "  - " << reason << '\n';
    log::warning("- " + reason);
  }
}

void Context::say_unreliable(const std::string& what, const std::vector<std::string>& reasons) {
  say_amiss(what + " is not reliable", reasons);
  exit_code = kUnreliable;
}

void add_log_options(CLI::App& app, Context& context) {
  app.add_option("--log", context.log_file, "Append what happens to this file: sources, errors, results");
  app.add_flag("--verbose", context.verbose, "Say more, and log more");
  app.add_flag("--quiet", context.quiet, "Say nothing but errors");
}

CLI::App* add_subcommand(CLI::App& app, Context& context, const std::string& name,
                         const std::string& description, const std::string& example) {
  CLI::App* subcommand = app.add_subcommand(name, description);
  subcommand->footer("Example:\n  " + example);
  add_log_options(*subcommand, context);
  return subcommand;
}

CLI::Option* add_vector_option(CLI::App& subcommand, const std::string& name, Eigen::Vector3d& value,
                               const std::string& description) {
  // What is wrong with it; empty when it was read.
  const auto read = [&value](const std::string& text) -> std::string {
    constexpr double kFarthest_mm = 1e6;  // a kilometre; what is reckoned with it stays finite
    const std::string no_numbers = "must be three numbers as X,Y,Z without spaces";
    const char* at = text.data();
    const char* const end = at + text.size();
    Eigen::Vector3d parsed;
    bool is_too_large = false;
    for (int i = 0; i < 3; ++i) {
      const auto [next, error] = std::from_chars(at, end, parsed[i]);
      const bool is_out_of_range = error == std::errc::result_out_of_range;
      if ((error != std::errc() && !is_out_of_range) || std::isnan(parsed[i])) return no_numbers;
      is_too_large = is_too_large || is_out_of_range || std::abs(parsed[i]) > kFarthest_mm;
      if (i < 2 && (next == end || *next != ',')) return no_numbers;
      at = next + (i < 2 ? 1 : 0);
    }
    if (at != end) return no_numbers;
    if (is_too_large) return "must be numbers of -1000000 to 1000000";
    value = parsed;
    return "";
  };
  const auto parse = [read, name](const CLI::results_t& results) {
    const std::string wrong = read(results.front());
    if (wrong.empty()) return true;
    throw CLI::ValidationError(name, "\"" + results.front() + "\" " + wrong);
  };
  return subcommand.add_option(name, parse, description)->type_name("X,Y,Z")->expected(1);
}

}  // namespace arthronaut::command_line
