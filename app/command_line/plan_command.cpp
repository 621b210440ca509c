#include <nlohmann/json.hpp>
#include <utility>

#include "app/command_line/command.h"
#include "app/command_line/option_checks.h"
#include "app/command_line/plan_changes.h"
#include "planning/cases/bone_doubts.h"
#include "planning/cases/case_lock.h"
#include "planning/cases/own_files.h"
#include "planning/cases/plan_versions.h"
#include "planning/files/json_document.h"
#include "planning/files/whole_folder.h"
#include "planning/geometry/error.h"
#include "planning/plan_export/plan_export.h"
#include "planning/plan_review/proposed_landmarks.h"
#include "planning/plan_review/tunnel_verdict.h"
#include "planning/tunnels/diameter_range.h"

namespace arthronaut::command_line {

namespace {

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
      if (const std::string note = plan_review::side_note(doubts); !note.empty())
        context.say("    Side: " + note);
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

// The plan that was there is kept before it goes.
void save_changed(const PlanArguments& arguments, const cases::Plan& before, ChangedPlan& changed) {
  cases::Case& knee = changed.knee;
  changed.verdict.kept_version = keep_replaced(arguments.case_folder, before, knee, changed.notes);
  cases::name_meshes(knee);
  if (arguments.by_default) cases::save_landmarks(arguments.case_folder, knee);
  knee.plan_version = cases::save_plan_over(arguments.case_folder, knee.plan, knee.plan_version);
}

// The case with what it lacks proposed, as the window and the report have it, and not kept. `by_shape`: what
// was proposed. Seconds a bone: only of those that are shown or lack a grid, and not again of the one just
// proposed.
cases::Case with_proposals(const PlanArguments& arguments, const ChangedPlan& changed,
                           std::map<bones::BoneKind, plan_review::ProposedBone>& by_shape) {
  cases::Case shown = changed.knee;
  const bool is_proposed = changed.proposed.surface != nullptr;
  std::erase_if(shown.plan.tunnels, [&](const auto& one) {
    return !is_asked_for(arguments, one.first.bone) ||
           (is_proposed && one.first.bone == key_of(arguments).bone);
  });
  by_shape = plan_review::propose_landmarks(shown, plan_review::Proposing::Planned);
  shown.plan = changed.knee.plan;
  if (is_proposed) by_shape.try_emplace(key_of(arguments).bone, changed.proposed);
  return shown;
}

void run_plan(PlanArguments& arguments, Context& context) {
  const VersionArguments& versions = arguments.versions;
  if (!arguments.export_folder.empty()) refuse_export(arguments.export_folder);
  cases::CaseLock lock;
  if (arguments.changes() || versions.writes()) lock = cases::lock_or_refuse(arguments.case_folder);
  if (!lock.notice().empty() && !arguments.as_json) context.say(lock.notice() + ".");
  cases::Case knee = cases::load_case(arguments.case_folder);
  const cases::Plan before = knee.plan;
  // Before anything is written: a file that cannot be read leaves the plan as it was.
  const cases::BoneDoubts doubts = cases::load_bone_doubts(arguments.case_folder);
  ChangedPlan changed = changed_plan(arguments, std::move(knee), doubts);
  if (arguments.places()) arguments.names_type = true;  // what was placed is shown
  if (arguments.changes()) save_changed(arguments, before, changed);
  if (!arguments.as_json)
    for (const std::string& note : changed.notes) context.say(note);
  if (versions.named > 0) cases::say_of_version(arguments.case_folder, versions.named, versions.words);
  if (versions.lists || versions.named > 0)
    return list_versions(arguments.case_folder, context, changed.knee.plan);
  std::map<bones::BoneKind, plan_review::ProposedBone> by_shape;
  const cases::Case shown = with_proposals(arguments, changed, by_shape);
  const std::string side_doubt = plan_review::side_doubt(doubts);
  const plan_review::CaseReview review(shown, by_shape, doubts);
  PlanVerdict& verdict = changed.verdict;
  if (arguments.by_default) verdict = judged(shown, review, key_of(arguments), doubts, verdict);
  show(arguments, context, shown, review, doubts, verdict);
  if (versions.keeps) {
    const auto kept =
        cases::keep_plan_version(arguments.case_folder, changed.knee.plan, changed.knee.side, versions.words);
    if (!arguments.as_json) context.say("Kept as version " + std::to_string(kept.number) + ".");
  }
  if (!arguments.export_folder.empty())
    export_to(arguments, context, changed.knee,
              plan_review::verdict_of_plan(shown, plan_review::checks_of_plan(review), doubts).wrong,
              side_doubt);
  if (!verdict.is_reliable) return context.say_unreliable("The default plan", verdict.reasons);
  std::vector<std::string> wrong;
  for (const tunnels::TunnelKey& key : asked_for(arguments, shown.plan))
    for (const std::string& one : tunnels::wrong_in_words(review.checks(key)))
      wrong.push_back("the " + tunnels::name_of(key) + "'s tunnel: " + one);
  if (!wrong.empty()) context.say_amiss("The plan is wrong as it is, and kept as asked", wrong);
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
  sub->add_flag(
         "--within-spread", arguments->within_spread,
         "Where a check fails at the norm's place: enter at the nearest place within the norm's spread "
         "that passes every check, or where none does and it is wrong there, where nothing is; how far off "
         "that is is said")
      ->needs(by_default);
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
  auto* list = sub->add_flag("--list")
                   ->description("Show the plan")
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
    arguments->names_direction = direction->count() > 0;
    arguments->names_type = type->count() > 0;
    arguments->names_diameter = diameter->count() > 0;
    // What the parser cannot ask for.
    if (arguments->names_direction && entry->count() == 0 && !arguments->at_footprint)
      throw CLI::RequiredError("beside --direction, --entry or --at-footprint");
    if (arguments->names_direction && arguments->direction.norm() < 1e-9)
      throw CLI::ValidationError("--direction", "must not be zero");
    if (arguments->names_diameter && !arguments->places())
      throw CLI::RequiredError("beside --diameter-mm, --default or --direction");
    refuse_words_of_nothing(arguments->versions);
    run_plan(*arguments, context);
  });
}

}  // namespace arthronaut::command_line
