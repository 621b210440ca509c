#include <algorithm>
#include <map>
#include <memory>

#include "app/command_line/command.h"
#include "planning/cases/case.h"
#include "planning/cases/identity.h"
#include "planning/files/format.h"
#include "planning/geometry/error.h"
#include "planning/postop/achieved_file.h"
#include "planning/postop/postop_source.h"

namespace arthronaut::command_line {

namespace {

struct CompareArguments {
  std::string case_folder, source, output, bone, series;
  std::vector<int> labels;
};

// The planned tunnels that are asked for. Throws InvalidInput when there is none, or one that was planned on
// another bone than the case holds.
std::vector<tunnels::Tunnel> planned(const cases::Case& knee, const CompareArguments& arguments) {
  std::vector<tunnels::Tunnel> wanted;
  for (const auto& [key, tunnel] : knee.plan.tunnels) {
    if (!arguments.bone.empty() && bones::bone_kind_from_text(arguments.bone) != key.bone) continue;
    if (const cases::PlanFit fit = cases::plan_fit(knee, key); !fit.is_valid())
      throw InvalidInput(arguments.case_folder, "plan.json", fit.reason);
    wanted.push_back(tunnel);
  }
  if (wanted.empty())
    throw InvalidInput(arguments.case_folder, "plan.json",
                       "holds no tunnel" + (arguments.bone.empty() ? "" : " in the " + arguments.bone) +
                           ": there is nothing to compare with");
  return wanted;
}

images::Volume read(const CompareArguments& arguments) {
  Progress progress("Reading", 100);
  postop::PostopSourceOptions options;
  options.series = arguments.series;
  options.labels = {arguments.labels.begin(), arguments.labels.end()};
  options.on_progress = [&](double fraction) { progress.advance_to(static_cast<long>(100 * fraction)); };
  return postop::read_postop(arguments.source, options);
}

// Where both say whose knee it is.
bool is_another_patient(const images::Volume& volume, const std::string& case_folder) {
  const cases::Identity images{volume.patient.name, volume.patient.id, volume.patient.birth_date};
  const auto of_case = cases::load_identity(case_folder);
  return of_case && !images.is_empty() && *of_case != images;
}

using Comparisons = std::map<tunnels::TunnelKey, postop::Comparison>;

Comparisons compared(const cases::Case& knee, const images::Volume& volume,
                     const std::vector<tunnels::Tunnel>& plan, const std::string& source) {
  Progress progress("Comparing", static_cast<long>(plan.size()));
  progress.advance_to(0);
  Comparisons comparisons;
  try {
    const postop::PostopImages images(volume);
    for (const tunnels::Tunnel& tunnel : plan) {
      std::vector<tunnels::Tunnel> others;
      for (const tunnels::Tunnel& other : plan)
        if (other.bone == tunnel.bone && other.bundle != tunnel.bundle) others.push_back(other);
      comparisons[tunnel.key()] = images.compare(knee.bones.at(tunnel.bone).mesh, tunnel, others);
      progress.advance_to(static_cast<long>(comparisons.size()));
    }
  } catch (const InvalidInput& error) {
    throw InvalidInput(source, "", error.what());
  }
  return comparisons;
}

void doubt(postop::Comparison& comparison, const std::string& reason) {
  comparison.bone.reliable = comparison.tunnel.reliable = false;
  comparison.bone.reasons.push_back(reason);
  comparison.tunnel.reasons.push_back(reason);
}

std::string line_of(const tunnels::TunnelKey& key, const postop::AchievedTunnel& tunnel) {
  std::string line = tunnels::name_of(key) + ": ";
  if (!tunnel.is_found) return line + "no tunnel found";
  line += files::format("entry %.1f mm off the plan, axis %.1f deg; diameter %.1f mm, length %.1f mm",
                        tunnel.offset_mm, geometry::deg_from_rad(tunnel.angle_rad), tunnel.tunnel.diameter_mm,
                        tunnel.length_mm);
  if (!tunnel.comes_out) line += " (a socket)";
  const auto widest =
      std::max_element(tunnel.widths.begin(), tunnel.widths.end(),
                       [](const auto& a, const auto& b) { return a.diameter_mm < b.diameter_mm; });
  if (widest != tunnel.widths.end())
    line += files::format("; %.1f mm at its widest, %.0f mm from the entry", widest->diameter_mm,
                          widest->from_entry_mm);
  return line;
}

void compare(Context& context, const CompareArguments& arguments) {
  const cases::Case knee = cases::load_case(arguments.case_folder);
  const auto plan = planned(knee, arguments);
  const images::Volume volume = read(arguments);
  auto comparisons = compared(knee, volume, plan, arguments.source);
  if (is_another_patient(volume, arguments.case_folder)) {
    for (auto& [key, comparison] : comparisons)
      doubt(comparison, "the images say that they are of another patient than the case");
  }
  postop::write_achieved_file(arguments.output, comparisons);
  std::vector<std::string> reasons;
  for (const auto& [key, comparison] : comparisons) {
    const std::string name = tunnels::name_of(key);
    if (arguments.output != "-") {
      if (comparison.bone.is_found)
        context.say(files::format("%s: found in the images, %.2f mm (rms) off their edges", name.c_str(),
                                  comparison.bone.rms_mm));
      context.say(line_of(key, comparison.tunnel));
    }
    for (const std::string& reason : comparison.bone.reasons) reasons.push_back(name + ": " + reason);
    for (const std::string& reason : comparison.tunnel.reasons)
      reasons.push_back(name + ", tunnel: " + reason);
  }
  if (arguments.output != "-") context.say("Wrote " + arguments.output + ".");
  if (!reasons.empty()) context.say_unreliable("The comparison", reasons);
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
  sub->add_option("-o,--output", arguments->output, "achieved.json to write; - is standard output")
      ->required();
  sub->add_option("--bone", arguments->bone, "femur or tibia; default: every bone with planned tunnels")
      ->check(CLI::IsMember({"femur", "tibia"}));
  sub->add_option("--series", arguments->series, "Series number or UID, for DICOM with several");
  sub->add_option("--label", arguments->labels, "Label maps: the labels that are bone; default: all but 0")
      ->delimiter(',');
  sub->callback([&context, arguments] { compare(context, *arguments); });
}

}  // namespace arthronaut::command_line
