#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/command_line/command.h"
#include "navigation/recording/resumable.h"
#include "planning/bones/mesh_hash.h"
#include "planning/cases/case.h"
#include "planning/files/format.h"
#include "planning/files/json_document.h"
#include "planning/files/utc_clock.h"
#include "planning/geometry/error.h"

namespace arthronaut::command_line {

namespace {

struct ResumeArguments {
  std::string case_folder, bone = "femur";
  bool json = false;
};

nlohmann::ordered_json json_of(const recording::ResumeSearch& search) {
  nlohmann::ordered_json json = {
      {"format", "arthronaut.resumable"}, {"version", 1}, {"is_found", search.left.has_value()}};
  json["passed_over"] = search.passed_over;
  if (!search.left) {
    json["why_none"] = search.why_none;
    return json;
  }
  const recording::Resumable& found = *search.left;
  const operation::ResumeOperation& was = found.operation;
  json["session"] = was.session;
  json["bone"] = bones::to_text(found.header.bone);
  json["source"] = sources::to_text(found.header.source_kind.value());
  json["was_cut_off"] = !found.was_finished && !found.is_being_recorded;
  json["is_being_recorded"] = found.is_being_recorded;
  json["was_declined"] = found.was_declined;
  json["registration"] = nullptr;
  if (was.registration) {
    json["registration"] = {{"marker_from_bone", files::to_json(was.registration->marker_from_bone)},
                            {"predicted_tre_mm", was.registration->predicted_tre_mm},
                            {"was_verified", found.was_verified}};
  }
  json["refusal"] = found.refusal;
  json["strokes"] = was.stroke_count;
  json["stroke_length_mm"] = found.drawn_length_mm;
  json["touches"] = was.touches_mm.size();
  json["control_point"] = was.control_point_mm.has_value();
  json["has_plan"] = was.plan.has_value();
  json["tunnel"] = nullptr;
  if (was.plan) json["tunnel"] = tunnels::name_of(was.plan->tunnel.key());
  json["drilled"] = nlohmann::ordered_json::array();
  for (const tunnels::TunnelKey& key : found.drilled) json["drilled"].push_back(tunnels::name_of(key));
  json["said_drilled"] = nlohmann::ordered_json::array();
  for (const recording::SaidDrilled& said : found.said_drilled)
    json["said_drilled"].push_back({{"tunnel", said.tunnel}, {"said_utc", files::utc_of(said.when)}});
  json["depth_stop_mm"] = nullptr;
  if (was.depth_stop_mm) json["depth_stop_mm"] = *was.depth_stop_mm;
  return json;
}

void say(const Context& context, const recording::Resumable& found) {
  const operation::ResumeOperation& was = found.operation;
  context.say("session " + was.session + ", " + std::string(bones::to_text(found.header.bone)) + ", " +
              std::string(sources::to_text(found.header.source_kind.value())) +
              (found.is_being_recorded ? ", being recorded now"
               : found.was_finished    ? ""
                                       : ", cut off") +
              (found.was_declined ? "; declined in Navigate" : ""));
  if (was.registration)
    context.say(files::format("registration: predicted error %.2f mm%s; guides after one touch on the bone",
                              was.registration->predicted_tre_mm,
                              found.was_verified ? ", was verified" : ""));
  context.say(files::format("history: %d strokes (%.0f mm), %zu touches%s", was.stroke_count,
                            found.drawn_length_mm, was.touches_mm.size(),
                            was.control_point_mm ? ", the control point" : ""));
  context.say(was.plan ? files::format("plan in force: %s tunnel, %.1f mm wide, %.1f mm long",
                                       tunnels::name_of(was.plan->tunnel.key()).c_str(),
                                       was.plan->tunnel.diameter_mm, was.plan->length_mm)
                       : std::string("plan in force: none"));
  for (const tunnels::TunnelKey& key : found.drilled)
    context.say("drilled already: " + tunnels::name_of(key) + " tunnel");
  for (const recording::SaidDrilled& said : found.said_drilled)
    context.say("said to be drilled: " + said.tunnel + " tunnel, " +
                files::utc_in_words(files::utc_of(said.when)) + ", by word alone");
  if (was.depth_stop_mm) context.say(files::format("depth stop: %.1f mm, as read", *was.depth_stop_mm));
}

void resume(Context& context, const ResumeArguments& arguments) {
  const cases::Case knee = cases::load_case(arguments.case_folder);
  const bones::BoneKind kind = bones::bone_kind_from_text(arguments.bone);
  const auto bone = knee.bones.find(kind);
  if (bone == knee.bones.end())
    throw InvalidInput(arguments.case_folder, "", "the case has no " + arguments.bone);
  const recording::ResumeSearch search = recording::find_resumable(
      arguments.case_folder, kind, bones::mesh_sha256(bone->second.mesh), knee.plan.of(kind));
  if (arguments.json)
    files::write_json("-", json_of(search));
  else if (search.left)
    say(context, *search.left);
  if (!arguments.json)
    for (const std::string& broken : search.passed_over) context.say("passed over: " + broken);
  if (!search.left && !search.passed_over.empty())
    context.say_unreliable("what can be resumed", {"nothing is found, and some of it cannot be read"});
  else if (!search.left && !arguments.json)
    context.say("Nothing was left in the middle: " + search.why_none + ".");
  if (search.left && !search.left->refusal.empty())
    context.say_unreliable("the registration", {"is not brought back: " + search.left->refusal});
}

}  // namespace

void add_resume_command(CLI::App& app, Context& context) {
  CLI::App* command = add_subcommand(app, context, "resume",
                                     "Say what an operation that was cut off or left in the middle has come "
                                     "to, as Navigate offers to resume it",
                                     "arthronaut resume knee.arthro --bone femur");
  const auto arguments = std::make_shared<ResumeArguments>();
  command->add_option("CASE", arguments->case_folder, "Case folder")->required();
  command->add_option("--bone", arguments->bone, "femur or tibia")
      ->check(CLI::IsMember({"femur", "tibia"}))
      ->capture_default_str();
  command->add_flag(
      "--json", arguments->json,
      "As JSON on standard output; \"is_found\" is false when there is nothing, \"why_none\" says why");
  command->callback([&context, arguments] { resume(context, *arguments); });
}

}  // namespace arthronaut::command_line
