#include "app/command_line/kept_versions.h"

#include <algorithm>

#include "app/command_line/option_checks.h"
#include "planning/files/utc_clock.h"
#include "planning/geometry/error.h"

namespace arthronaut::command_line {

VersionOptions add_version_options(CLI::App& plan, VersionArguments& arguments) {
  VersionOptions options{};
  options.take = plan.add_option("--take", arguments.taken, "Take a kept version as the plan")
                     ->check(whole_between(1, 1000000));
  options.keep =
      plan.add_flag("--keep", arguments.keeps, "Keep the plan as a version beside the one that is worked on");
  options.versions =
      plan.add_flag("--versions", arguments.lists, "List the kept versions and how each differs");
  options.name_version = plan.add_option("--name-version", arguments.named,
                                         "Give this kept version --name and --note, in place of its own")
                             ->check(whole_between(1, 1000000));
  options.keep->excludes(options.name_version);
  plan.add_option("--name", arguments.words.name,
                  "What the version is called that is kept or named; no patient's name");
  plan.add_option("--note", arguments.words.note, "What is to be said of it");
  return options;
}

void refuse_words_of_nothing(const VersionArguments& arguments) {
  if (arguments.words != cases::VersionWords{} && !arguments.writes())
    throw CLI::RequiredError("beside --name and --note, --keep or --name-version");
  // Before anything is planned.
  if (arguments.words.name.size() > cases::kLongestVersionName)
    throw CLI::ValidationError("--name",
                               "is at most " + std::to_string(cases::kLongestVersionName) + " bytes long");
  if (arguments.words.note.size() > cases::kLongestVersionNote)
    throw CLI::ValidationError("--note",
                               "is at most " + std::to_string(cases::kLongestVersionNote) + " bytes long");
}

int keep_replaced(const std::string& case_folder, const cases::Plan& before, const cases::Case& now,
                  std::vector<std::string>& notes) {
  std::string replaced;
  for (const auto& difference : cases::compare_plans(now.plan, before))
    if (difference.is_lost_here()) replaced += (replaced.empty() ? "" : "; ") + difference.in_words();
  if (replaced.empty()) return 0;
  const auto versions = cases::load_plan_versions(case_folder);
  const auto same = std::ranges::find_if(versions, [&](const cases::PlanVersion& version) {
    return std::ranges::none_of(cases::compare_plans(version.plan, before),
                                &cases::TunnelDifference::is_lost_here);
  });
  const int kept =
      same != versions.end() ? same->number : cases::keep_plan_version(case_folder, before, now.side).number;
  const std::string number = std::to_string(kept);
  notes.push_back("The plan that was there is kept as version " + number + ", --take " + number +
                  " brings it back. Against the one that is there now, " + replaced + ".");
  return kept;
}

void take_version(const std::string& case_folder, int number, const std::vector<bones::BoneKind>& bones,
                  cases::Case& knee) {
  cases::Plan& plan = knee.plan;
  const auto versions = cases::load_plan_versions(case_folder);
  const auto found = std::ranges::find(versions, number, &cases::PlanVersion::number);
  if (found == versions.end()) {
    throw InvalidInput(
        case_folder, "plan_versions",
        "holds no version " + std::to_string(number) + " (it holds " + std::to_string(versions.size()) + ")");
  }
  if (const std::string refusal = cases::side_refusal(*found, knee.side); !refusal.empty())
    throw InvalidInput(case_folder, "plan_versions", refusal);
  for (const bones::BoneKind bone : bones) {
    for (const tunnels::TunnelKey& key : plan.of(bone)) plan.remove(key);
    for (const tunnels::TunnelKey& key : found->plan.of(bone)) {
      const auto mesh = found->plan.mesh_sha256.find(key);
      plan.put(found->plan.tunnels.at(key), mesh != found->plan.mesh_sha256.end() ? mesh->second : "");
    }
  }
}

void list_versions(const std::string& case_folder, const Context& context, const cases::Plan& plan) {
  const auto versions = cases::load_plan_versions(case_folder);
  if (versions.empty()) context.say("No version is kept. --keep keeps the plan as it is.");
  for (const cases::PlanVersion& version : versions) {
    context.say(version.title() + ", kept " + files::utc_in_words(version.kept_utc) +
                (version.side ? ", of a " + std::string(bones::to_text(*version.side)) + " knee" : "") +
                ", against the plan as it is:");
    if (!version.words.note.empty()) context.say("  \"" + version.words.note + "\"");
    for (const auto& difference : cases::compare_plans(plan, version.plan))
      context.say("  " + difference.in_words());
  }
}

}  // namespace arthronaut::command_line
