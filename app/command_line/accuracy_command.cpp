#include <memory>
#include <nlohmann/json.hpp>

#include "app/command_line/command.h"
#include "app/command_line/ruler_option.h"
#include "app/library/daily_check.h"
#include "app/library/workstation_library.h"
#include "planning/files/format.h"
#include "planning/files/json_document.h"
#include "planning/files/utc_clock.h"
#include "planning/geometry/error.h"
#include "planning/library/accuracy_checks.h"

namespace arthronaut::command_line {

namespace {

using library::AccuracyCheck;
using library::AccuracyStanding;

struct CheckArguments {
  RulerArguments ruler;
  std::string device;
  bool without_keeping = false;
};

void check_clip(Context& context, const CheckArguments& arguments) {
  const bool keeps = !arguments.without_keeping;
  const auto recorded = workstation_library::recorded_clip(arguments.ruler.video);
  // Before the long look. A clip that is not there is told by whoever opens it.
  if (const std::string why =
          library::why_clip_does_not_count(library::read_accuracy_checks(workstation_library::data_folder()),
                                           keeps && recorded ? recorded->sha256 : "");
      !why.empty())
    throw InvalidInput(arguments.ruler.video, "", why + " (--no-keep measures alone)");
  const RulerClip clip = look_at_ruler(arguments.ruler);
  const AccuracyCheck check = workstation_library::daily_check_of(
      clip.summary, {.ruler = clip.options.ruler,
                     .refractive_index = clip.options.refractive_index,
                     .camera_file = arguments.ruler.camera,
                     .source = std::filesystem::path(arguments.ruler.video).filename(),
                     .clip = recorded,
                     .device = arguments.device});
  context.say(
      files::format("%s, in %s: %zu frames", check.device.c_str(), check.medium.c_str(), check.frame_count));
  context.say(check.is_dated ? "recorded " + check.checked_utc
                             : "of a recorded clip, when recorded unknown: it does not count as today's");
  if (!(check.distance_mm > 0)) return context.say_unreliable("the check of accuracy", check.reasons);
  context.say(files::format("distance of the ruler's markers %.3f +- %.3f mm, made as %.3f mm: %+.3f mm",
                            check.distance_mm, check.spread_mm, check.true_mm, check.error_mm()));
  std::vector<AccuracyCheck> checks;
  if (keeps) {
    (void)library::keep_accuracy_check(workstation_library::data_folder(), check);
    checks = library::read_accuracy_checks(workstation_library::data_folder()).checks;
  } else {
    checks.push_back(check);
  }
  const AccuracyStanding standing =
      library::accuracy_standing(checks, library::device_of(check), files::utc_now());
  context.say(standing.text);
  if (standing.is_fine()) return;
  context.say_unreliable("the check of accuracy",
                         check.reasons.empty() ? std::vector<std::string>{standing.text} : check.reasons);
}

struct ListArguments {
  bool json = false;
};

nlohmann::ordered_json json_of(const library::AccuracyChecks& read, const std::string& now_utc) {
  nlohmann::ordered_json json;
  json["format"] = "arthronaut.accuracy_list";
  json["version"] = 1;
  json["devices"] = nlohmann::ordered_json::array();
  for (const library::AccuracyDevice& device : library::devices_of(read)) {
    const AccuracyStanding standing = library::accuracy_standing(read.checks, device, now_utc);
    nlohmann::ordered_json node = {{"device", device.name},
                                   {"camera_sha256", device.camera_sha256},
                                   {"fine", standing.is_fine()},
                                   {"text", standing.text}};
    node["limits_mm"] = nullptr;
    if (standing.limits.is_known)
      node["limits_mm"] = {standing.limits.lower, standing.limits.center, standing.limits.upper};
    json["devices"].push_back(std::move(node));
  }
  json["checks"] = nlohmann::ordered_json::array();
  for (const AccuracyCheck& check : read.checks)
    json["checks"].push_back({{"checked_utc", check.checked_utc},
                              {"dated", check.is_dated},
                              {"device", check.device},
                              {"camera_sha256", check.camera_sha256},
                              {"clip_sha256", check.clip_sha256},
                              {"medium", check.medium},
                              {"true_mm", check.true_mm},
                              {"distance_mm", check.distance_mm},
                              {"spread_mm", check.spread_mm},
                              {"frames", check.frame_count},
                              {"reasons", check.reasons}});
  json["problems"] = library::problems_of(read, now_utc);
  return json;
}

void list(Context& context, const ListArguments& arguments) {
  const library::AccuracyChecks read = library::read_accuracy_checks(workstation_library::data_folder());
  const std::string now_utc = files::utc_now();
  std::vector<std::string> reasons = library::problems_of(read, now_utc);
  if (read.checks.empty()) reasons.emplace_back("accuracy was never checked");
  for (const library::AccuracyDevice& device : library::devices_of(read)) {
    const AccuracyStanding standing = library::accuracy_standing(read.checks, device, now_utc);
    if (!standing.is_fine()) reasons.push_back(standing.text);
  }
  if (arguments.json) {
    files::write_json("-", json_of(read, now_utc));
  } else {
    for (const AccuracyCheck& check : read.checks)
      context.say(files::format("%s  %s  %s  %.3f of %.3f mm  %zu frames%s%s", check.checked_utc.c_str(),
                                library::shown_name(read.checks, library::device_of(check)).c_str(),
                                check.medium.c_str(), check.distance_mm, check.true_mm, check.frame_count,
                                check.reasons.empty() ? "" : "  not reliable",
                                check.is_dated ? "" : "  of a clip, when recorded unknown"));
  }
  if (!reasons.empty()) context.say_unreliable("the daily check", reasons);
}

}  // namespace

void add_accuracy_command(CLI::App& app, Context& context) {
  CLI::App* accuracy =
      add_subcommand(app, context, "accuracy",
                     "The daily check: measure a ruler with two markers, keep it, and see it over the days",
                     "arthronaut accuracy check --camera camera.json --tools ruler.json clip.mkv\n"
                     "  arthronaut accuracy list");
  accuracy->require_subcommand(1);
  const auto arguments = std::make_shared<CheckArguments>();
  CLI::App* check = add_subcommand(
      *accuracy, context, "check", "Measure the ruler in a clip of some seconds, and keep what came out",
      "arthronaut accuracy check --camera camera.json --tools ruler.json clip.mkv");
  add_ruler_options(*check, arguments->ruler);
  check->add_option("--device", arguments->device,
                    "What the arthroscope is called (default: scope and head of camera.json)");
  check->add_flag("--no-keep", arguments->without_keeping, "Measure alone");
  check->callback([&context, arguments] { check_clip(context, *arguments); });

  const auto listed = std::make_shared<ListArguments>();
  CLI::App* all = add_subcommand(*accuracy, context, "list",
                                 "All checks, and which arthroscope was not checked today or is off",
                                 "arthronaut accuracy list --json");
  all->add_flag("--json", listed->json, "As JSON, with the control limits of each arthroscope");
  all->callback([&context, listed] { list(context, *listed); });
}

}  // namespace arthronaut::command_line
