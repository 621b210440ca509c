#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/command_line/command.h"
#include "app/command_line/kept_versions.h"
#include "app/command_line/option_checks.h"
#include "app/command_line/plan_report.h"
#include "planning/bones/mesh_hash.h"
#include "planning/cases/bone_doubts.h"
#include "planning/cases/case.h"
#include "planning/cases/case_lock.h"
#include "planning/cases/own_files.h"
#include "planning/cases/plan_versions.h"
#include "planning/default_plan/default_plan.h"
#include "planning/files/format.h"
#include "planning/files/json_document.h"
#include "planning/files/whole_folder.h"
#include "planning/geometry/error.h"
#include "planning/geometry/surface.h"
#include "planning/landmarks/grid_landmarks.h"
#include "planning/landmarks/insertion_grids.h"
#include "planning/landmarks/propose.h"
#include "planning/plan_export/markups_file.h"
#include "planning/plan_export/plan_export.h"
#include "planning/plan_review/proposed_landmarks.h"
#include "planning/plan_review/tunnel_verdict.h"
#include "planning/tunnels/diameter_range.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::command_line {

namespace {

// An entry that lies further off the bone is a slip, not a rounding.
constexpr double kSnapMm = 5.0;
constexpr double kToldMm = 0.02;  // a move that is more than the rounding of what is typed

struct PlanArguments {
  std::string case_folder, bone;
  Eigen::Vector3d entry_mm = Eigen::Vector3d::Zero(), direction = Eigen::Vector3d::Zero();
  double diameter_mm = 9.0;
  std::string type = "single", export_folder, markups;
  bool at_footprint = false, by_default = false, list = false, as_json = false, removes = false;
  bool names_type = false, names_diameter = false;  // whether the user said so
  VersionArguments versions;
};

// The tunnel that is placed or removed.
tunnels::TunnelKey key_of(const PlanArguments& arguments) {
  return {bones::bone_kind_from_text(arguments.bone), norms::bundle_from_text(arguments.type)};
}

double diameter_mm_of(const PlanArguments& arguments) {
  return arguments.names_diameter ? arguments.diameter_mm
                                  : tunnels::usual_diameter_mm(norms::bundle_from_text(arguments.type));
}

// moved_mm: how far the entry was, to lie on the bone.
tunnels::Tunnel planned_tunnel(const PlanArguments& arguments, const cases::Case& knee,
                               const geometry::Surface& surface, double& moved_mm,
                               std::vector<std::string>& notes) {
  const tunnels::TunnelKey key = key_of(arguments);
  const bones::BoneKind kind = key.bone;
  tunnels::Tunnel tunnel{.bone = kind,
                         .entry_mm = arguments.entry_mm,
                         .direction = arguments.direction.normalized(),
                         .diameter_mm = diameter_mm_of(arguments),
                         .bundle = key.bundle};
  if (arguments.at_footprint) {
    const auto marks = knee.landmarks.find(kind);
    if (marks == knee.landmarks.end() || !marks->second.contains("native_footprint")) {
      throw InvalidInput(arguments.case_folder, std::string(bones::to_text(kind)),
                         "has no landmark native_footprint: give --entry");
    }
    tunnel.entry_mm = marks->second.at("native_footprint");
  }
  const auto nearest = surface.closest_point(tunnel.entry_mm);
  const Eigen::Vector3d moved = nearest.point_mm - tunnel.entry_mm;
  moved_mm = moved.norm();
  if (moved_mm > kSnapMm) {
    throw InvalidInput(arguments.case_folder, arguments.bone,
                       files::format("--entry lies %.1f mm off it, more than %.0f mm", moved_mm, kSnapMm));
  }
  if (moved_mm > kToldMm)
    notes.push_back(files::format(
        "The entry lay %.2f mm off the bone and was moved to its nearest point; the axis is %.2f mm beside "
        "the one that was asked for.",
        moved_mm, (moved - moved.dot(tunnel.direction) * tunnel.direction).norm()));
  tunnel.entry_mm = nearest.point_mm;
  if (!tunnels::measure(tunnel, surface).enters_bone) {
    throw InvalidInput(arguments.case_folder, arguments.bone, "--direction leads out of it at this entry");
  }
  return tunnel;
}

// By norms and landmarks. Where those of the case give no grid, the proposed ones become the case's: whoever
// reads it, as a report, has the grid that was planned by. Throws InvalidInput where there is no default;
// `verdict` says how far it may be relied on, `by_shape` what the shape gave where it was asked.
tunnels::Tunnel default_tunnel(const PlanArguments& arguments, cases::Case& knee, bones::BoneKind kind,
                               const std::shared_ptr<const geometry::Surface>& surface, PlanVerdict& verdict,
                               plan_review::ProposedBone& by_shape) {
  const Progress progress("Making the default plan", 0);
  landmarks::Landmarks& marks = knee.landmarks[kind];
  landmarks::LandmarkStates& states = knee.landmark_states[kind];
  const bones::Bone& bone = knee.bones.at(kind);
  if (!landmarks::is_grid_confirmed(kind, marks, states)) {
    by_shape.surface = surface;
    by_shape.proposal = landmarks::propose(bone.mesh, kind, {.side = knee.side, .surface = surface.get()});
    if (!landmarks::has_grid(bone.mesh, kind, knee.side, marks))
      take_proposal(by_shape.proposal, marks, states);
  }
  default_plan::BoneInput input{
      .bone = &bone, .surface = surface.get(), .landmarks = marks, .states = states};
  if (by_shape.surface) input.proposal = &by_shape.proposal;
  const norms::Bundle bundle = norms::bundle_from_text(arguments.type);
  input.beside = default_plan::beside({kind, bundle}, knee.plan.tunnels);
  const auto planned =
      default_plan::plan_bone(input, knee.side, {.bundle = bundle, .diameter_mm = diameter_mm_of(arguments)});
  if (!planned.is_usable())
    throw InvalidInput(arguments.case_folder, "", "has no default plan: " + planned.message);
  verdict = {.is_reliable = planned.doubts.empty(),
             .reasons = planned.doubts,
             .source = planned.source,
             .place = planned.place,
             .off_norm_mm = planned.off_norm_mm,
             .passing_entry_mm = planned.passing_entry_mm};
  for (const tunnels::PlanCheck& check : planned.failed) {
    verdict.is_reliable = false;
    verdict.reasons.push_back("no direction that a drill can follow from there passes the check \"" +
                              check.name + "\": " + check.text);
  }
  return planned.tunnel;
}

// Tunnels as another program moved them; only those of bones that the case holds.
void put(const tunnels::Tunnel& tunnel, const std::string& mesh_sha256, cases::Case& knee,
         std::vector<std::string>& notes) {
  const auto before = knee.plan.of(tunnel.bone);
  knee.plan.put(tunnel, mesh_sha256);
  for (const tunnels::TunnelKey& key : before) {
    if (!knee.plan.tunnels.contains(key))
      notes.push_back("The tunnel " + tunnels::name_of(key) +
                      " is no longer planned: a bone has a single tunnel, or those of bundles.");
  }
}

bool is_asked_for(const PlanArguments& arguments, bones::BoneKind bone) {
  return arguments.bone.empty() || arguments.bone == bones::to_text(bone);
}

void take_markups(const PlanArguments& arguments, cases::Case& knee, std::vector<std::string>& notes) {
  // Of a file that is moved and taken more than once it is so, too: a question, and no failure.
  const std::string doubt =
      plan_export::origin_doubt(arguments.markups, knee, cases::load_plan_versions(arguments.case_folder));
  if (!doubt.empty()) notes.push_back("Look: " + doubt);
  std::map<bones::BoneKind, geometry::Surface> surfaces;
  const auto surface_of = [&](bones::BoneKind kind) -> const geometry::Surface* {
    const auto bone = knee.bones.find(kind);
    return bone == knee.bones.end() ? nullptr : &surfaces.try_emplace(kind, bone->second.mesh).first->second;
  };
  const plan_export::TakenTunnels taken = plan_export::read_tunnels(arguments.markups, knee.plan, surface_of);
  if (!taken.note.empty()) notes.push_back("The " + taken.note + ".");
  for (const auto& [key, tunnel] : taken.tunnels)
    if (is_asked_for(arguments, key.bone))
      put(tunnel, bones::mesh_sha256(knee.bones.at(key.bone).mesh), knee, notes);
}

// The tunnels of what was asked for.
std::vector<tunnels::TunnelKey> asked_for(const PlanArguments& arguments, const cases::Plan& plan) {
  std::vector<tunnels::TunnelKey> keys;
  for (const auto& [key, tunnel] : plan.tunnels)
    if (is_asked_for(arguments, key.bone) &&
        (!arguments.names_type || arguments.type == norms::to_text(key.bundle)))
      keys.push_back(key);
  return keys;
}

void show(const PlanArguments& arguments, const Context& context, const cases::Case& knee,
          const plan_review::CaseReview& review, cases::BoneDoubts doubts, const PlanVerdict& verdict) {
  auto tunnels_json = nlohmann::ordered_json::array();
  bool has_any = false;
  for (const tunnels::TunnelKey& key : asked_for(arguments, knee.plan)) {
    if (!review.has_bone(key.bone))
      throw InvalidInput(arguments.case_folder, "plan.json", "plans a bone that the case lacks");
    has_any = true;
    if (arguments.as_json) {
      const bool is_judged = !verdict.source.empty();  // the default that was made now
      tunnels_json.push_back(tunnel_to_json(
          knee, review, key, is_judged ? verdict : judged(knee, review, key, doubts, verdict)));
      tunnels_json.back()["bone_doubts"] = words_of(doubts[key.bone]);
    } else {
      describe_tunnel(context, knee, review, key, verdict);
      const std::string side = plan_review::side_doubt(doubts);
      if (!side.empty()) context.say("  x Side: " + side);
      for (const std::string& doubt : plan_review::doubts_but_side(doubts, key.bone))
        context.say("  ! Bone: " + doubt);
    }
  }
  if (!arguments.as_json) {
    if (!has_any)
      context.say("No " + (arguments.bone.empty() ? "" : arguments.bone + " ") + "tunnel is planned" +
                  (arguments.names_type ? " of type " + arguments.type : "") + ".");
    return;
  }
  // Of one bone the tunnel itself; of a bone with two it is never one of them unasked.
  const bool is_one = !arguments.bone.empty() && tunnels_json.size() == 1;
  nlohmann::ordered_json document = {{"format", is_one ? "arthronaut.tunnel" : "arthronaut.tunnels"},
                                     {"version", 1}};
  if (is_one)
    document.update(tunnels_json[0]);
  else
    document["tunnels"] = std::move(tunnels_json);
  files::write_json("-", document);
}

// Throws InvalidInput where there is no such tunnel, or two of which none is named.
void remove_tunnel(const PlanArguments& arguments, cases::Case& knee) {
  const auto keys = knee.plan.of(bones::bone_kind_from_text(arguments.bone));
  if (keys.size() == 1 && !arguments.names_type) return knee.plan.remove(keys.front());
  if (keys.size() > 1 && !arguments.names_type)
    throw InvalidInput(arguments.case_folder, "plan.json",
                       "plans two tunnels in the " + arguments.bone + ": say by --type which, am or pl");
  const tunnels::TunnelKey key = key_of(arguments);
  if (!knee.plan.tunnels.contains(key))
    throw InvalidInput(arguments.case_folder, "plan.json", "holds no tunnel " + tunnels::name_of(key));
  knee.plan.remove(key);
}

// An earlier export may be written over, a case's plan not.
void refuse_export(const std::string& folder) {
  if (cases::is_own_file(std::filesystem::path(folder) / "plan.json"))
    throw InvalidInput(folder, "", "is a case's own folder: the export needs another one");
  files::refuse_unwritable(folder);
  plan_export::refuse_foreign(folder);
}

plan_export::ExportSummary exported(const PlanArguments& arguments, const cases::Case& knee) {
  if (knee.plan.tunnels.empty())
    throw InvalidInput(arguments.case_folder, "plan.json", "plans nothing, so there is nothing to export");
  const Progress progress("Drilling the bones", 0);
  return plan_export::export_plan(knee, arguments.export_folder);
}

// wrong: what speaks against the plan, which is written as it is: told, and no doubt about what was written,
// unless it is of the other knee.
void export_to(const PlanArguments& arguments, Context& context, const cases::Case& knee,
               const std::vector<std::string>& wrong, const std::string& side_doubt) {
  auto summary = exported(arguments, knee);
  if (!side_doubt.empty()) summary.doubts.insert(summary.doubts.begin(), side_doubt);
  if (!arguments.as_json)
    for (const auto& file : summary.files) context.say("Wrote " + file.string());
  if (!arguments.as_json)
    for (const std::string& one : wrong) context.say("Wrong, and exported all the same: " + one);
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
  auto* entry =
      add_vector_option(
          *sub, "--entry", arguments->entry_mm,
          "Entry on the joint side, mm, LPS; up to 5 mm off the bone it is moved onto it, and that is said")
          ->needs(bone);
  auto* direction =
      add_vector_option(*sub, "--direction", arguments->direction, "Direction of drilling, into the bone")
          ->needs(bone);
  auto* footprint =
      sub->add_flag("--at-footprint", arguments->at_footprint, "Enter at the native footprint's centre")
          ->needs(bone)
          ->excludes(entry);
  auto* diameter =
      sub->add_option("--diameter-mm", arguments->diameter_mm, "Diameter; by default 9, of AM 7, of PL 6")
          ->check(between(tunnels::kLeastDiameter_mm, tunnels::kGreatestDiameter_mm));
  auto* by_default =
      sub->add_flag(
             "--default", arguments->by_default,
             "By norms and landmarks, proposed ones where none are confirmed, aimed as a drill can follow")
          ->needs(bone)
          ->excludes(entry)
          ->excludes(direction)
          ->excludes(footprint);
  auto* type =
      sub->add_option("--type", arguments->type,
                      "Which tunnel of the bone: single, or am and pl of two bundles; one of two takes "
                      "the place of a single one, a single one that of both")
          ->check(CLI::IsMember({"single", "am", "pl"}))
          ->needs(bone)
          ->capture_default_str();
  auto* remove = sub->add_flag("--remove", arguments->removes, "Remove the bone's tunnel")
                     ->needs(bone)
                     ->excludes(by_default)
                     ->excludes(direction);
  auto* markups =
      sub->add_option("--from-markups", arguments->markups, "Take the tunnels from a .mrk.json of 3D Slicer")
          ->excludes(by_default)
          ->excludes(direction)
          ->excludes(type)
          ->excludes(remove);
  auto* exports =
      sub->add_option(
             "--export", arguments->export_folder,
             "Folder for plan.json, plan.csv, plan.mrk.json and the drilled bones (STL and PLY), in "
             "place of an earlier export; no case's, and nothing that another program changed or wrote")
          ->check(a_file());
  auto* json =
      sub->add_flag("--json", arguments->as_json, "Print the tunnel as JSON, without --bone every tunnel");
  auto* list = sub->add_flag("--list", arguments->list, "Show the plan")
                   ->excludes(direction)
                   ->excludes(by_default)
                   ->excludes(markups);
  const auto [take, keep, versions, name_version] = add_version_options(*sub, arguments->versions);
  for (CLI::Option* other : {by_default, markups, direction, type, remove}) take->excludes(other);
  for (CLI::Option* looks : {versions, name_version})
    for (CLI::Option* other : {by_default, markups, direction, take, remove, keep, exports, list, json})
      looks->excludes(other);
  entry->needs(direction);
  footprint->needs(direction);
  sub->callback([arguments, entry, direction, type, diameter, &context] {
    arguments->names_type = type->count() > 0;
    arguments->names_diameter = diameter->count() > 0;
    const bool writes = direction->count() > 0 || arguments->by_default || !arguments->markups.empty() ||
                        arguments->versions.taken > 0 || arguments->removes;
    // What the parser cannot ask for.
    if (direction->count() > 0 && entry->count() == 0 && !arguments->at_footprint)
      throw CLI::RequiredError("beside --direction, --entry or --at-footprint");
    if (direction->count() > 0 && arguments->direction.norm() < 1e-9)
      throw CLI::ValidationError("--direction", "must not be zero");
    if (arguments->names_diameter && direction->count() == 0 && !arguments->by_default)
      throw CLI::RequiredError("beside --diameter-mm, --default or --direction");
    if (!arguments->export_folder.empty()) refuse_export(arguments->export_folder);
    cases::CaseLock lock;
    refuse_words_of_nothing(arguments->versions);
    if (writes || arguments->versions.writes()) lock = cases::lock_or_refuse(arguments->case_folder);
    if (!lock.notice().empty() && !arguments->as_json) context.say(lock.notice() + ".");
    auto knee = cases::load_case(arguments->case_folder);
    // Before anything is written: a file that cannot be read leaves the plan as it was.
    cases::BoneDoubts doubts = cases::load_bone_doubts(arguments->case_folder);
    PlanVerdict verdict;
    plan_review::ProposedBone proposed;  // of the bone that a default plan was made of
    std::vector<std::string> notes;      // said once it is so on the disk
    const cases::Plan before = knee.plan;
    if (!arguments->markups.empty()) {
      take_markups(*arguments, knee, notes);
    } else if (arguments->versions.taken > 0) {
      std::vector<bones::BoneKind> asked_for{bones::BoneKind::Femur, bones::BoneKind::Tibia};
      std::erase_if(asked_for, [&](bones::BoneKind kind) { return !is_asked_for(*arguments, kind); });
      take_version(arguments->case_folder, arguments->versions.taken, asked_for, knee);
    } else if (arguments->removes) {
      remove_tunnel(*arguments, knee);
    } else if (writes) {
      const auto kind = bones::bone_kind_from_text(arguments->bone);
      const auto bone_of_case = knee.bones.find(kind);
      if (bone_of_case == knee.bones.end()) {
        throw InvalidInput(arguments->case_folder, "case.json", "holds no " + arguments->bone);
      }
      const auto surface = std::make_shared<const geometry::Surface>(bone_of_case->second.mesh);
      put(arguments->by_default ? default_tunnel(*arguments, knee, kind, surface, verdict, proposed)
                                : planned_tunnel(*arguments, knee, *surface, verdict.entry_moved_mm, notes),
          bones::mesh_sha256(bone_of_case->second.mesh), knee, notes);
      arguments->names_type = true;  // what was placed is shown
    }
    if (writes) {
      verdict.kept_version = keep_replaced(arguments->case_folder, before, knee, notes);
      cases::name_meshes(knee);
      if (arguments->by_default) cases::save_landmarks(arguments->case_folder, knee);
      knee.plan_version = cases::save_plan_over(arguments->case_folder, knee.plan, knee.plan_version);
    }
    if (!arguments->as_json)
      for (const std::string& note : notes) context.say(note);
    if (arguments->versions.named > 0)
      cases::say_of_version(arguments->case_folder, arguments->versions.named, arguments->versions.words);
    if (arguments->versions.lists || arguments->versions.named > 0)
      return list_versions(arguments->case_folder, context, knee.plan);
    // What the case lacks is proposed, as the window and the report have it, and not kept.
    // Seconds each: only of bones that are shown or lack a grid, and not again of the one just proposed.
    cases::Case shown = knee;
    const bool is_proposed = proposed.surface != nullptr;
    std::erase_if(shown.plan.tunnels, [&](const auto& one) {
      return !is_asked_for(*arguments, one.first.bone) ||
             (is_proposed && one.first.bone == key_of(*arguments).bone);
    });
    auto by_shape = plan_review::propose_landmarks(shown, plan_review::Proposing::Planned);
    shown.plan = knee.plan;
    if (is_proposed) by_shape.try_emplace(key_of(*arguments).bone, std::move(proposed));
    const plan_review::CaseReview review(shown, by_shape, plan_review::side_doubt(doubts));
    if (arguments->by_default) verdict = judged(shown, review, key_of(*arguments), doubts, verdict);
    show(*arguments, context, shown, review, doubts, verdict);
    if (arguments->versions.keeps) {
      const auto kept =
          cases::keep_plan_version(arguments->case_folder, knee.plan, knee.side, arguments->versions.words);
      if (!arguments->as_json) context.say("Kept as version " + std::to_string(kept.number) + ".");
    }
    if (!arguments->export_folder.empty())
      export_to(*arguments, context, knee,
                plan_review::verdict_of_plan(shown, plan_review::checks_of_plan(review), doubts).wrong,
                plan_review::side_doubt(doubts));
    if (!verdict.is_reliable) context.say_unreliable("The default plan", verdict.reasons);
  });
}

}  // namespace arthronaut::command_line
