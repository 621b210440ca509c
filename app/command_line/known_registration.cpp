#include "app/command_line/known_registration.h"

#include <string>

#include "navigation/operation/operation.h"
#include "navigation/recording/case_sessions.h"
#include "navigation/registration/given_registration.h"
#include "navigation/registration/registration_file.h"
#include "planning/geometry/error.h"

namespace arthronaut::command_line {

namespace {

// The newest session alone is asked: what an older one says of the bone may have been overtaken by it.
constexpr const char* kOlder = "; --registration takes an older session's registration.json";

// Of other programs' files, which may leave it out.
void say_what_it_leaves_out(const Context& context, const registration::RegistrationRecord& record) {
  if (!record.of)
    context.say("registration: given; it is not said of which camera and marker it is: that is your word");
  if (record.registration.has_pose && record.registration.point_count == 0)
    context.say("registration: given; it is not said of how many points it is");
}

}  // namespace

std::optional<operation::GiveRegistration> known_registration(const Context& context,
                                                              const std::filesystem::path& given,
                                                              const std::filesystem::path& case_folder,
                                                              const cases::Case& knee,
                                                              const theatre::NavigateOptions& options) {
  const registration::Provenance now = operation::provenance_of(options.operation, options.source);
  const bones::BoneKind bone = options.operation.bone;
  const bool is_live = now.source == sources::SourceKind::Live;
  registration::GivenUse use{*options.operation.surface, options.source.pipeline.tools, bone};
  if (options.operation.plan) use.target_in_bone_mm = options.operation.plan->tunnel.entry_mm;
  if (!given.empty()) {
    auto record = registration::read_registration_record(given);
    const auto mismatch = record.of ? registration::mismatch_of(*record.of, now) : std::nullopt;
    if (mismatch)
      throw InvalidInput(given, "of",
                         "does not match: " + registration::in_words(*mismatch, *record.of, now));
    if (record.mesh && !registration::may_be(*record.mesh, knee.bones.at(bone).mesh))
      throw InvalidInput(given, "mesh",
                         "does not match: the bone that it was found on lies elsewhere than the case's " +
                             std::string(bones::to_text(bone)));
    registration::judge_given(record.registration, use);
    say_what_it_leaves_out(context, record);
    if (is_live)
      context.say("registration: given; that the world marker has not moved since it was found is your word");
    return operation::GiveRegistration{record.registration, record.of.value_or(now)};
  }
  auto known = recording::find_registration(case_folder, bone, options.source.pipeline.tools);
  if (!known) return std::nullopt;
  const std::string session = known->session_folder.filename().string();
  for (const std::string& broken : known->passed_over) context.say("registration: passed over " + broken);
  if (!known->is_usable()) {
    context.say("registration: that of session " + session + " is not used: " + known->refusal + kOlder);
    return std::nullopt;
  }
  if (const auto mismatch = known->of ? registration::mismatch_of(*known->of, now) : std::nullopt) {
    context.say("registration: that of session " + session +
                " is not used: " + registration::in_words(*mismatch, *known->of, now) + kOlder);
    return std::nullopt;
  }
  registration::judge_given(known->registration, use);
  if (!known->registration.reliable) {
    context.say("registration: that of session " + session +
                " is not used: " + known->registration.reasons.front() + kOlder);
    return std::nullopt;
  }
  // Here nobody touches the bone: no hand would show that its marker sits where it sat.
  if (is_live) {
    context.say("registration: that of session " + session +
                " is not used: nobody has seen the world marker since; strokes give a new one, and "
                "--registration takes " +
                (known->session_folder / "registration.json").string() + " at your word");
    return std::nullopt;
  }
  context.say("registration: of session " + session);
  return operation::GiveRegistration{known->registration, known->of.value_or(now)};
}

}  // namespace arthronaut::command_line
