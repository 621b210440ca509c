#include <nlohmann/json.hpp>

#include "app/command_line/command.h"
#include "app/command_line/named_session.h"
#include "navigation/recording/session_check.h"
#include "planning/files/json_document.h"

namespace arthronaut::command_line {

namespace {

using recording::SessionCheck;

struct VerifyArguments {
  std::string case_folder, session;
  bool json = false;
};

nlohmann::ordered_json json_of(const std::string& session, const SessionCheck& check) {
  nlohmann::ordered_json json;
  json["session"] = session;
  json["unbroken"] = check.is_unbroken();
  json["has_hashes"] = check.outcome != SessionCheck::Outcome::NoChain;
  json["was_finished"] = check.was_finished;
  json["hashes"] = check.record_count;
  json["covered_bytes"] = check.covered_bytes;
  json["last_hash"] = check.head;
  json["findings"] = nlohmann::ordered_json::array();
  for (const recording::CheckFinding& finding : check.findings)
    json["findings"].push_back({{"of", finding.of},
                                {"from", finding.from},
                                {"to", finding.to},
                                {"what", finding.what},
                                {"text", finding.text()}});
  json["notes"] = check.notes;
  return json;
}

void verify(Context& context, const VerifyArguments& arguments) {
  std::vector<std::string> reasons;
  nlohmann::ordered_json document = {
      {"format", "arthronaut.verify"}, {"version", 1}, {"sessions", nlohmann::ordered_json::array()}};
  for (const std::filesystem::path& folder : sessions_named(arguments.case_folder, arguments.session)) {
    const std::string session = folder.filename();
    SessionCheck check;
    {
      Progress progress("verifying " + session, 100);
      check = recording::check_session(folder, [&](std::int64_t done, std::int64_t count) {
        progress.advance_to(static_cast<long>(100 * done / count));
      });
    }
    if (arguments.json) {
      document["sessions"].push_back(json_of(session, check));
    } else {
      context.say("session " + session + ": " + recording::check_words(check));
      for (const std::string& note : check.notes) context.say("  " + note);
      if (!check.head.empty()) context.say("  last hash " + check.head);
    }
    if (check.outcome == SessionCheck::Outcome::NoChain)
      reasons.push_back(session + ": " + recording::check_words(check));
    for (const recording::CheckFinding& finding : check.findings)
      reasons.push_back(session + ": " + finding.text());
  }
  if (arguments.json) files::write_json("-", document);
  if (!reasons.empty()) context.say_unreliable("the record", reasons);
}

}  // namespace

void add_verify_command(CLI::App& app, Context& context) {
  const auto arguments = std::make_shared<VerifyArguments>();
  CLI::App* sub = add_subcommand(
      app, context, "verify", "Tell whether a case's sessions are still what was recorded, by their hashes",
      "arthronaut verify Knee.arthro");
  sub->add_option("case", arguments->case_folder, "Case folder")->required();
  sub->add_option("--session", arguments->session, "This session alone; all of them when left out");
  sub->add_flag("--json", arguments->json, "As JSON");
  sub->callback([arguments, &context] { verify(context, *arguments); });
}

}  // namespace arthronaut::command_line
