#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

#include "app/command_line/command.h"
#include "app/command_line/plan_report.h"
#include "planning/bones/mesh_hash.h"
#include "planning/cases/case.h"
#include "planning/cases/case_lock.h"
#include "planning/cases/plan_versions.h"
#include "planning/default_plan/default_plan.h"
#include "planning/files/format.h"
#include "planning/geometry/error.h"
#include "planning/geometry/surface.h"
#include "planning/plan_export/markups_file.h"
#include "planning/plan_export/plan_export.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::command_line {

namespace {

// An entry that lies further off the bone is a slip, not a rounding.
constexpr double kSnapMm = 5.0;

struct PlanArguments {
  std::string case_folder, bone;
  Eigen::Vector3d entry_mm = Eigen::Vector3d::Zero(), direction = Eigen::Vector3d::Zero();
  double diameter_mm = 9.0;
  std::string type = "single", export_folder, markups;
  bool at_footprint = false, by_default = false, list = false, as_json = false;
  bool keeps = false, lists_versions = false;
  int version = 0;  // that is to be taken; 0: none
};

tunnels::Tunnel planned_tunnel(const PlanArguments& arguments, const cases::Case& knee, bones::BoneKind kind,
                               const geometry::Surface& surface, bool has_entry) {
  tunnels::Tunnel tunnel{.bone = kind,
                         .entry_mm = arguments.entry_mm,
                         .direction = arguments.direction.normalized(),
                         .diameter_mm = arguments.diameter_mm};
  if (arguments.at_footprint) {
    const auto marks = knee.landmarks.find(kind);
    if (marks == knee.landmarks.end() || !marks->second.contains("native_footprint")) {
      throw InvalidInput(arguments.case_folder, std::string(bones::to_text(kind)),
                         "has no landmark native_footprint: give --entry");
    }
    tunnel.entry_mm = marks->second.at("native_footprint");
  } else if (!has_entry) {
    throw InvalidInput("plan: --entry (or --at-footprint) is needed beside --direction");
  }
  const auto nearest = surface.closest_point(tunnel.entry_mm);
  const double off_mm = (nearest.point_mm - tunnel.entry_mm).norm();
  if (off_mm > kSnapMm) {
    throw InvalidInput(
        files::format("plan: --entry lies %.1f mm off the bone, more than %.0f mm", off_mm, kSnapMm));
  }
  tunnel.entry_mm = nearest.point_mm;
  if (!tunnels::measure(tunnel, surface).enters_bone) {
    throw InvalidInput("plan: --direction leads out of the bone at this entry");
  }
  return tunnel;
}

// By norms and landmarks. Throws InvalidInput where there is no default; `verdict` says how far it may be
// relied on.
tunnels::Tunnel default_tunnel(const PlanArguments& arguments, const cases::Case& knee, bones::BoneKind kind,
                               const geometry::Surface& surface, PlanVerdict& verdict) {
  default_plan::BoneInput input{
      .bone = &knee.bones.at(kind), .surface = &surface, .landmarks = {}, .states = {}};
  if (const auto marks = knee.landmarks.find(kind); marks != knee.landmarks.end())
    input.landmarks = marks->second;
  if (const auto states = knee.landmark_states.find(kind); states != knee.landmark_states.end())
    input.states = states->second;
  const auto planned = default_plan::plan_bone(
      input, knee.side,
      {.bundle = norms::bundle_from_text(arguments.type), .diameter_mm = arguments.diameter_mm});
  if (!planned.is_usable())
    throw InvalidInput(arguments.case_folder, "", "has no default plan: " + planned.message);
  verdict = {planned.doubts.empty(), planned.doubts, planned.source};
  return planned.tunnel;
}

// Tunnels as another program moved them; only those of bones that the case holds.
void take_markups(const PlanArguments& arguments, cases::Case& knee) {
  const auto markups = plan_export::read_markups(arguments.markups);
  bool took = false;
  for (const auto& [kind, tunnel] : markups.tunnels) {
    const auto bone = knee.bones.find(kind);
    if (bone == knee.bones.end()) continue;
    if (!tunnels::measure(tunnel, geometry::Surface(bone->second.mesh)).enters_bone) {
      throw InvalidInput(arguments.markups, std::string(bones::to_text(kind)) + " tunnel",
                         "does not enter the case's bone: markups of another knee?");
    }
    knee.plan.tunnels[kind] = tunnel;
    knee.plan.mesh_sha256[kind] = bones::mesh_sha256(bone->second.mesh);
    took = true;
  }
  if (!took)
    throw InvalidInput(arguments.markups, "markups", "hold no line \"femur tunnel\" or \"tibia tunnel\"");
}

void show(const PlanArguments& arguments, const Context& context, const cases::Case& knee,
          const PlanVerdict& verdict) {
  const plan_review::CaseReview review(knee);
  auto tunnels_json = nlohmann::ordered_json::array();
  for (const auto& [kind, tunnel] : knee.plan.tunnels) {
    if (!arguments.bone.empty() && arguments.bone != bones::to_text(kind)) continue;
    if (!review.has_bone(kind))
      throw InvalidInput(arguments.case_folder, "plan.json", "plans a bone that the case lacks");
    if (arguments.as_json) {
      tunnels_json.push_back(tunnel_to_json(knee, review, kind, verdict));
    } else {
      describe_tunnel(context, knee, review, kind);
    }
  }
  if (!arguments.as_json && knee.plan.tunnels.empty()) context.say("No tunnel is planned.");
  if (!arguments.as_json) return;
  if (!arguments.bone.empty()) {
    std::cout << (tunnels_json.empty() ? nlohmann::ordered_json() : tunnels_json[0]).dump(2) << '\n';
  } else {
    std::cout << nlohmann::ordered_json({{"tunnels", tunnels_json}}).dump(2) << '\n';
  }
}

// Of the same bones' meshes as it was kept: plan_fit says where that is no longer the case's.
void take_version(const PlanArguments& arguments, cases::Case& knee) {
  const auto versions = cases::load_plan_versions(arguments.case_folder);
  const auto found = std::ranges::find(versions, arguments.version, &cases::PlanVersion::number);
  if (found == versions.end()) {
    throw InvalidInput(arguments.case_folder, "plan_versions",
                       "holds no version " + std::to_string(arguments.version) + " (it holds " +
                           std::to_string(versions.size()) + ")");
  }
  knee.plan = found->plan;
}

void list_versions(const PlanArguments& arguments, const Context& context, const cases::Case& knee) {
  const auto versions = cases::load_plan_versions(arguments.case_folder);
  if (versions.empty()) context.say("No version is kept. --keep keeps the plan as it is.");
  for (const cases::PlanVersion& version : versions) {
    context.say("Version " + std::to_string(version.number) + ", kept " + version.kept_utc +
                ", against the plan as it is:");
    for (const auto& difference : cases::compare_plans(knee.plan, version.plan))
      context.say("  " + difference.in_words());
  }
}

void export_to(const PlanArguments& arguments, Context& context, const cases::Case& knee) {
  const auto summary = plan_export::export_plan(knee, arguments.export_folder);
  for (const auto& file : summary.files) context.say("Wrote " + file.string());
  if (!summary.doubts.empty()) context.say_unreliable("The exported plan", summary.doubts);
}

}  // namespace

void add_plan_command(CLI::App& app, Context& context) {
  const auto arguments = std::make_shared<PlanArguments>();
  CLI::App* sub =
      add_subcommand(app, context, "plan", "Place a tunnel, or show the plan when no bone is given",
                     "arthronaut plan Knee.arthro --bone femur --entry -10.1,12.9,-0.3 --direction "
                     "-0.83,-0.37,0.41 --diameter-mm 9");
  sub->add_option("case", arguments->case_folder, "Case folder")->required();
  auto* bone =
      sub->add_option("--bone", arguments->bone, "femur or tibia")->check(CLI::IsMember({"femur", "tibia"}));
  auto* entry = add_vector_option(*sub, "--entry", arguments->entry_mm, "Entry on the joint side, mm, LPS")
                    ->needs(bone);
  auto* direction =
      add_vector_option(*sub, "--direction", arguments->direction, "Direction of drilling, into the bone")
          ->needs(bone);
  auto* footprint =
      sub->add_flag("--at-footprint", arguments->at_footprint, "Enter at the native footprint's centre")
          ->needs(bone)
          ->excludes(entry);
  sub->add_option("--diameter-mm", arguments->diameter_mm, "Diameter")
      ->check(CLI::Range(3.0, 15.0))
      ->capture_default_str();
  auto* by_default =
      sub->add_flag(
             "--default", arguments->by_default,
             "By norms and landmarks, proposed ones where none are confirmed, aimed as a drill can follow")
          ->needs(bone)
          ->excludes(entry)
          ->excludes(direction)
          ->excludes(footprint);
  sub->add_option("--type", arguments->type, "With --default: single, am or pl")
      ->check(CLI::IsMember({"single", "am", "pl"}))
      ->needs(by_default)
      ->capture_default_str();
  auto* markups =
      sub->add_option("--from-markups", arguments->markups, "Take the tunnels from a .mrk.json of 3D Slicer")
          ->excludes(by_default)
          ->excludes(direction);
  sub->add_option("--export", arguments->export_folder,
                  "Folder for plan.json, plan.csv, plan.mrk.json and the drilled bones");
  sub->add_flag("--json", arguments->as_json, "Print the tunnel as JSON, without --bone every tunnel");
  sub->add_flag("--list", arguments->list, "Show the plan")
      ->excludes(direction)
      ->excludes(by_default)
      ->excludes(markups);
  auto* take = sub->add_option("--take", arguments->version, "Take a kept version as the plan")
                   ->check(CLI::PositiveNumber)
                   ->excludes(by_default)
                   ->excludes(markups)
                   ->excludes(direction);
  sub->add_flag("--keep", arguments->keeps, "Keep the plan as a version beside the one that is worked on");
  sub->add_flag("--versions", arguments->lists_versions, "List the kept versions and how each differs")
      ->excludes(by_default)
      ->excludes(markups)
      ->excludes(direction)
      ->excludes(take);
  entry->needs(direction);
  footprint->needs(direction);
  sub->callback([arguments, entry, direction, &context] {
    const bool writes = direction->count() > 0 || arguments->by_default || !arguments->markups.empty() ||
                        arguments->version > 0;
    cases::CaseLock lock;
    if (writes || arguments->keeps) lock = cases::lock_or_refuse(arguments->case_folder);
    if (!lock.notice().empty() && !arguments->as_json) context.say(lock.notice() + ".");
    auto knee = cases::load_case(arguments->case_folder);
    PlanVerdict verdict;
    if (!arguments->markups.empty()) {
      take_markups(*arguments, knee);
    } else if (arguments->version > 0) {
      take_version(*arguments, knee);
    } else if (writes) {
      if (!arguments->by_default && arguments->direction.norm() < 1e-9)
        throw InvalidInput("plan: --direction must not be zero");
      const auto kind = bones::bone_kind_from_text(arguments->bone);
      const auto bone_of_case = knee.bones.find(kind);
      if (bone_of_case == knee.bones.end()) {
        throw InvalidInput(arguments->case_folder, "case.json", "holds no " + arguments->bone);
      }
      const geometry::Surface surface(bone_of_case->second.mesh);
      knee.plan.tunnels[kind] = arguments->by_default
                                    ? default_tunnel(*arguments, knee, kind, surface, verdict)
                                    : planned_tunnel(*arguments, knee, kind, surface, entry->count() > 0);
      knee.plan.mesh_sha256[kind] = bones::mesh_sha256(bone_of_case->second.mesh);
    }
    if (writes) {
      cases::name_meshes(knee);
      knee.plan_version = cases::save_plan_over(arguments->case_folder, knee.plan, knee.plan_version);
    }
    if (arguments->lists_versions) return list_versions(*arguments, context, knee);
    show(*arguments, context, knee, verdict);
    if (arguments->keeps) {
      const auto kept = cases::keep_plan_version(arguments->case_folder, knee.plan);
      if (!arguments->as_json) context.say("Kept as version " + std::to_string(kept.number) + ".");
    }
    if (!arguments->export_folder.empty()) export_to(*arguments, context, knee);
    if (!verdict.is_reliable) context.say_unreliable("The default plan", verdict.reasons);
  });
}

}  // namespace arthronaut::command_line
