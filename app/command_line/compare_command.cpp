#include <limits>
#include <memory>

#include "app/case/postop_comparison.h"
#include "app/command_line/command.h"
#include "app/command_line/option_checks.h"
#include "planning/cases/case_lock.h"
#include "planning/files/format.h"
#include "planning/geometry/error.h"
#include "planning/postop/achieved_file.h"

namespace arthronaut::command_line {

namespace {

struct CompareArguments {
  std::string case_folder, source, output, bone, series;
  std::vector<int> labels;
  bool replaces = false, takes_another_patient = false;
};

// Where it lies: which way its entry is off, its percentages, its wall.
std::string place_line(const tunnels::TunnelKey& key, const postop::AchievedPlace& place) {
  std::string line = tunnels::name_of(key) + ": entry " + postop::off_in_words(place);
  if (const std::string grid = postop::grid_in_words(place); !grid.empty()) line += "; " + grid;
  if (const std::string wall = postop::wall_in_words(place); !wall.empty()) line += "; least wall " + wall;
  return line;
}

std::string line_of(const tunnels::TunnelKey& key, const postop::AchievedTunnel& tunnel) {
  std::string line = tunnels::name_of(key) + ": ";
  if (!tunnel.is_found) return line + "no tunnel found";
  line +=
      files::format("entry %.1f mm off the plan, axis %.1f deg; diameter %.1f mm, length ", tunnel.offset_mm,
                    geometry::deg_from_rad(tunnel.angle_rad), tunnel.tunnel.diameter_mm) +
      postop::length_in_words(tunnel);
  if (const std::string widths = postop::widths_in_words(tunnel.widths); !widths.empty())
    line += "; along the wall " + widths;
  return line;
}

// The case that a file of this name would lie in; empty: none.
std::filesystem::path case_around(const std::string& file) {
  if (file == "-") return {};
  std::filesystem::path folder = std::filesystem::weakly_canonical(std::filesystem::absolute(file));
  while (folder != folder.root_path()) {
    folder = folder.parent_path();
    if (std::filesystem::exists(folder / "case.json")) return folder;
  }
  return {};
}

// With one bone alone: what was compared of the other one stands in the same file.
void refuse_to_drop(const CompareArguments& arguments) {
  if (arguments.bone.empty() || arguments.output == "-" || !std::filesystem::exists(arguments.output)) return;
  for (const auto& [key, comparison] : postop::read_achieved_file(arguments.output))
    if (bones::to_text(key.bone) != arguments.bone)
      throw InvalidInput(arguments.output, "",
                         "holds the comparison of the " + std::string(bones::to_text(key.bone)) +
                             ", which would be lost: leave --bone out, or write another file");
}

void compare(Context& context, const CompareArguments& arguments) {
  refuse_before_the_work(
      {.read = {arguments.source}, .written = {arguments.output}, .makes = "achieved.json"});
  // What a workstation that has the case open compares goes into the same file.
  cases::CaseLock lock;
  const std::filesystem::path case_of_output = case_around(arguments.output);
  if (!case_of_output.empty()) lock = cases::lock_or_refuse(case_of_output);
  refuse_to_drop(arguments);
  if (!lock.notice().empty()) context.say(lock.notice() + ".");
  Progress progress("Comparing", 100);
  open_case::PostopQuestion question{arguments.case_folder,
                                     arguments.source,
                                     arguments.bone,
                                     arguments.series,
                                     {arguments.labels.begin(), arguments.labels.end()}};
  // What a case keeps of its own patient stays; elsewhere nobody waits for what he did not mean.
  question.refuses_another_patient = !case_of_output.empty() || !arguments.takes_another_patient;
  question.on_progress = [&](const std::string&, double share) {
    progress.advance_to(static_cast<long>(100 * share));
  };
  const open_case::PostopAnswer answer = open_case::compare_with_postop(question);
  if (question.refuses_another_patient && !answer.other_patient.empty())
    throw InvalidInput(arguments.source, "",
                       "is of " + answer.other_patient + ", another patient than the case: " +
                           (case_of_output.empty() ? "not compared; --another-patient"
                                                   : "nothing is written into the case; --another-patient, "
                                                     "and -o elsewhere,") +
                           " compares it all the same");
  const bool keeps = !case_of_output.empty() && !arguments.replaces;
  std::vector<open_case::BetterKept> better;
  if (keeps) {
    better = open_case::keep_tunnel_by_tunnel(arguments.output, arguments.case_folder, answer);
  } else {
    if (arguments.output != "-") better = open_case::better_kept_in(arguments.output, answer);
    postop::write_achieved_file(arguments.output, answer.comparisons, answer.places);
  }
  const bool is_written = !keeps || better.size() < answer.comparisons.size();
  if (arguments.output != "-") {
    for (const auto& [key, comparison] : answer.comparisons) {
      if (comparison.bone.is_found)
        context.say(files::format("%s: found in the images, %.2f mm (rms) off their edges",
                                  tunnels::name_of(key).c_str(), comparison.bone.rms_mm));
      context.say(line_of(key, comparison.tunnel));
      if (const std::string known = known_in_words(relied_on(comparison)); !known.empty())
        context.say(tunnels::name_of(key) + ": reliable in part: " + known);
      if (const auto place = answer.places.find(key); place != answer.places.end())
        context.say(place_line(key, place->second));
    }
    if (is_written) context.say("Wrote " + arguments.output + ".");
  }
  auto doubts = answer.doubts();
  for (const auto& [key, why_not_now] : better)
    doubts.push_back(tunnels::name_of(key) + ": " + arguments.output + " held one that is reliable" +
                     (keeps ? ", which the case keeps; this one is not written: -o elsewhere, or --replace"
                            : ", which this one has replaced"));
  if (!answer.other_patient.empty()) doubts.push_back("the images are of " + answer.other_patient);
  if (!doubts.empty()) context.say_unreliable("The comparison", doubts);
}

}  // namespace

void add_compare_command(CLI::App& app, Context& context) {
  const auto arguments = std::make_shared<CompareArguments>();
  CLI::App* sub =
      add_subcommand(app, context, "compare",
                     "Find the drilled tunnels in a post-operative CT and compare them with the plan",
                     "arthronaut compare Knee.arthro --postop postop_ct/ -o achieved.json");
  sub->add_option("case", arguments->case_folder, "Case folder with a plan")->required();
  sub->add_option("--postop", arguments->source,
                  "CT after the operation: DICOM (folder, DICOMDIR or enhanced file) or volume (NIfTI, NRRD, "
                  "MetaImage); also a label map, or a mesh of the drilled bone")
      ->required();
  sub->add_option("-o,--output", arguments->output,
                  "achieved.json to write; CASE/achieved.json keeps it in the case, where report and Review "
                  "have it; - is standard output")
      ->required()
      ->check(a_name());
  sub->add_option("--bone", arguments->bone, "femur or tibia; default: every bone with planned tunnels")
      ->check(CLI::IsMember({"femur", "tibia"}));
  sub->add_option("--series", arguments->series, "Series number or UID, for DICOM with several");
  sub->add_option("--label", arguments->labels, "Label maps: the labels that are bone; default: all but 0")
      ->delimiter(',')
      ->check(whole_between(0, std::numeric_limits<int>::max()))
      ->allow_extra_args(false);  // the case may follow
  sub->add_flag("--replace", arguments->replaces,
                "In a case: also in the place of a tunnel that it holds reliable, and that is not so now. "
                "Default: that one stays");
  sub->add_flag("--another-patient", arguments->takes_another_patient,
                "Also where the images say that they are of another patient than the case; into a case "
                "nothing is written then. Default: refused before anything is sought");
  sub->callback([&context, arguments] { compare(context, *arguments); });
}

}  // namespace arthronaut::command_line
