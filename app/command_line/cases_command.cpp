#include <iostream>
#include <set>

#include "app/case/case_side.h"
#include "app/command_line/command.h"
#include "app/library/plan_verdict.h"
#include "app/library/workstation_library.h"
#include "planning/cases/case_lock.h"
#include "planning/cases/case_note.h"
#include "planning/files/atomic_file.h"
#include "planning/files/within_folder.h"
#include "planning/geometry/error.h"
#include "planning/library/case_query.h"
#include "planning/library/cohort.h"
#include "planning/library/folder_search.h"

namespace arthronaut::command_line {

namespace {

namespace fs = std::filesystem;
using library::CaseRecord;

struct CasesArguments {
  std::string add, forget, note;
  std::string note_text;
  std::string set_side, to_side, take_over;
  std::string side, state, order = "newest";
  std::string search;
  bool as_json = false, as_csv = false, with_identity = false, checks = false;
};

// What was done, in words; nothing beside what another program is to read.
void say_done(const Context& context, const CasesArguments& arguments, const std::string& line) {
  if (!arguments.as_json && !arguments.as_csv) context.say(line);
}

// What was found there.
std::set<fs::path> add_folder(const Context& context, library::Library& known,
                              const CasesArguments& arguments) {
  Progress progress("Looking through folders", 0);
  const auto found =
      library::find_case_folders(arguments.add, [&](long looked) { progress.advance_to(looked); });
  if (found.empty()) throw InvalidInput(arguments.add, "", "holds no case");
  const std::size_t fresh = known.add(found);
  say_done(context, arguments,
           std::to_string(found.size()) + (found.size() == 1 ? " case found, " : " cases found, ") +
               std::to_string(fresh) + " of them new.");
  return {found.begin(), found.end()};
}

std::vector<CaseRecord> looked_at(library::Library& known) {
  std::unique_ptr<Progress> progress;
  std::size_t all = 0;
  return known.look([&](std::size_t done, std::size_t count) {
    if (progress == nullptr || count != all)
      progress = std::make_unique<Progress>("Reading cases", static_cast<long>(all = count));
    progress->advance_to(static_cast<long>(done));
    return true;
  });
}

// As far as they are known; those that are not are made where that is asked for, seconds each.
library::PlanVerdicts verdicts_of(const std::vector<CaseRecord>& records, bool checks) {
  Progress progress("Checking plans", static_cast<long>(records.size()));
  library::PlanVerdicts verdicts;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const CaseRecord& record = records[i];
    progress.advance_to(static_cast<long>(i));
    if (!record.is_there || !record.problem.empty()) continue;
    if (record.planned.empty()) {
      auto bones = workstation_library::judge_bones(record.folder);
      if (!bones.is_fine()) verdicts[record.folder] = std::move(bones);
      continue;
    }
    auto verdict = workstation_library::plan_verdict(record.folder);
    if (!verdict && checks) {
      verdict = workstation_library::judge_plan(cases::load_case(record.folder),
                                                cases::load_bone_doubts(record.folder));
      workstation_library::keep_plan_verdict(record.folder, *verdict);
    }
    if (verdict) verdicts[record.folder] = *std::move(verdict);
  }
  return verdicts;
}

void print(const Context& context, const std::vector<CaseRecord>& records,
           const library::PlanVerdicts& verdicts, std::size_t known_count) {
  for (const CaseRecord& record : records) {
    context.say(record.name + (record.side ? ", " + library::word_of(record.side) + " knee" : "") + ": " +
                std::string(to_text(record.state())));
    context.say("    " + record.folder.string());
    const std::string outcome = record.last_outcome();
    if (record.is_there && record.problem.empty()) {
      const std::size_t count = record.sessions.size();
      const auto verdict = verdicts.find(record.folder);
      std::string line =
          "    changed " + record.changed_utc.substr(0, 10) + "; " +
          workstation_library::plan_in_words(record, verdict == verdicts.end() ? nullptr : &verdict->second);
      if (count > 0)
        line +=
            "; " + std::to_string(count) + (count == 1 ? " session" : " sessions") + ", the last: " + outcome;
      context.say(line);
    } else {
      context.say("  ! " + outcome);
    }
    if (!record.part_problem.empty())
      context.say("  ! in part not to be read: " + files::within_folder(record.folder, record.part_problem));
    if (!record.note.empty()) {
      std::string note = record.note;
      for (std::size_t at = 0; (at = note.find('\n', at)) != std::string::npos; at += 5)
        note.replace(at, 1, "\n    ");
      context.say("    \"" + note + "\"");
    }
  }
  if (records.empty())
    context.say(known_count == 0
                    ? "No case. \"arthronaut cases --add FOLDER\" looks for cases in a folder."
                    : "None of the " + std::to_string(known_count) + " known cases is like that.");
}

void list_cases(const Context& context, const CasesArguments& arguments) {
  library::CaseQuery query{.words = arguments.search};
  if (!arguments.side.empty()) query.side = bones::side_from_text(arguments.side);
  if (!arguments.state.empty()) query.state = library::case_state_from_text(arguments.state);
  query.order = library::case_order_from_text(arguments.order);
  const auto opened = workstation_library::open_library();
  library::Library& known = *opened;
  for (const std::string& notice : known.notices()) std::cerr << "arthronaut: " << notice << '\n';
  std::set<fs::path> added;
  if (!arguments.add.empty()) added = add_folder(context, known, arguments);
  if (!arguments.forget.empty()) {
    known.forget(arguments.forget);
    say_done(context, arguments, "Forgot " + arguments.forget + "; the folder stays as it is.");
  }
  if (!arguments.note.empty()) {
    cases::CaseLock lock;
    if (fs::exists(fs::path(arguments.note) / "case.json")) lock = cases::lock_or_refuse(arguments.note);
    if (!lock.notice().empty()) say_done(context, arguments, lock.notice() + ".");
    const std::string before = cases::load_note(arguments.note).text;
    cases::save_note_over(arguments.note, arguments.note_text, before);
    (void)known.add(std::vector<fs::path>{arguments.note});
    say_done(context, arguments,
             (arguments.note_text.empty() ? "Took the note off " : "Noted with ") + arguments.note + ".");
  }
  if (!arguments.take_over.empty()) {
    const cases::CaseLock lock(arguments.take_over, cases::LockTaking::FromOtherHost);
    if (!lock.is_held()) throw InvalidInput(arguments.take_over, "", lock.refusal());
    say_done(
        context, arguments,
        lock.notice().empty() ? "No other machine has " + arguments.take_over + "." : lock.notice() + ".");
  }
  if (!arguments.set_side.empty()) {
    const cases::CaseLock lock = cases::lock_or_refuse(arguments.set_side);
    if (!lock.notice().empty()) say_done(context, arguments, lock.notice() + ".");
    const auto said = open_case::say_side(arguments.set_side, bones::side_from_text(arguments.to_side));
    (void)known.add(std::vector<fs::path>{arguments.set_side});
    for (const std::string& line : said.lines)
      say_done(context, arguments, (&line == said.lines.data() ? arguments.set_side + ": " : "    ") + line);
  }
  const bool only_changes = !arguments.forget.empty() || !arguments.note.empty() ||
                            !arguments.set_side.empty() || !arguments.take_over.empty();
  if (only_changes && !arguments.as_json && !arguments.as_csv) return;
  const std::vector<CaseRecord> all = looked_at(known);
  // All of them only where words may find one: each is a file to be read.
  library::Identities identities;
  const library::Identities* named = arguments.with_identity ? &identities : nullptr;
  if (named != nullptr && !query.words.empty()) identities = library::read_identities(all);
  std::vector<CaseRecord> records;
  for (const std::size_t i : library::find_cases(all, query, named)) records.push_back(all[i]);
  // Whoever adds a folder wants to see what was in it; what other programs read is the whole list.
  if (!added.empty() && !arguments.as_json && !arguments.as_csv)
    std::erase_if(records, [&](const CaseRecord& record) { return !added.contains(record.folder); });
  if (named != nullptr && query.words.empty()) identities = library::read_identities(records);
  library::PlanVerdicts verdicts;
  if (!arguments.as_csv || arguments.checks)  // the cohort's rows name none
    verdicts = verdicts_of(records, arguments.checks);
  if (arguments.as_json)
    library::write_cases_json("-", records, named, verdicts);
  else if (arguments.as_csv)
    files::write_atomically("-", library::cohort_csv(records, named));
  else
    print(context, records, verdicts, all.size());
}

}  // namespace

void add_cases_command(CLI::App& app, Context& context) {
  const auto arguments = std::make_shared<CasesArguments>();
  CLI::App* sub = add_subcommand(app, context, "cases",
                                 "List the cases of this workstation: what is planned, done and reached",
                                 "arthronaut cases --add /data/knees\n"
                                 "  arthronaut cases --set-side Knee.arthro --to left\n"
                                 "  arthronaut cases --search \"left 2026-01\" --state drilled\n"
                                 "  arthronaut cases --csv > cohort.csv");
  sub->add_option("--add", arguments->add,
                  "Look through this folder for cases (*.arthro), know them and list these");
  sub->add_option("--forget", arguments->forget, "Take this case off the list; its folder stays as it is");
  CLI::Option* note = sub->add_option("--note", arguments->note, "Case folder to note --text with");
  CLI::Option* text =
      sub->add_option("--text", arguments->note_text, "The note, in place of the one there is; may be empty");
  note->needs(text);
  text->needs(note);
  CLI::Option* set_side = sub->add_option(
      "--set-side", arguments->set_side,
      "Case folder that is of the side --to: another one than it says, or the same, which "
      "somebody has checked then. Landmarks and plan of the other side are put aside, and are "
      "back when that is set again");
  CLI::Option* to_side =
      sub->add_option("--to", arguments->to_side, "left or right")->check(CLI::IsMember({"left", "right"}));
  set_side->needs(to_side);
  to_side->needs(set_side);
  sub->add_option(
         "--take-over", arguments->take_over,
         "Case folder that a program of another machine has open which is gone, or that is a copy of "
         "such a case: it can be opened and written from then on. Never one that is open on this machine")
      ->check(CLI::ExistingDirectory);
  sub->add_option(
      "--search", arguments->search,
      "Words that must all stand in name, note, side, dates, state or outcome; with --with-identity "
      "also in the patient's name, number or day of birth");
  sub->add_option("--side", arguments->side, "Only this side")->check(CLI::IsMember({"left", "right"}));
  sub->add_option("--state", arguments->state, "Only cases in this state")
      ->check(CLI::IsMember({"missing", "unreadable", "not planned", "planned", "navigated", "drilled"}));
  sub->add_option("--sort", arguments->order, "The order")
      ->check(CLI::IsMember({"newest", "name", "created", "state", "offset"}))
      ->capture_default_str();
  sub->add_flag("--check", arguments->checks,
                "Check the plans of the cases listed that nobody has checked as they are now: seconds each");
  CLI::Option* json = sub->add_flag("--json", arguments->as_json, "The list as JSON");
  sub->add_flag("--csv", arguments->as_csv, "The cohort as CSV, a row for each session")->excludes(json);
  sub->add_flag("--with-identity", arguments->with_identity,
                "Name the patients (identity.json of the cases) in JSON and CSV; without it nobody is named");
  sub->callback([&context, arguments] {
    if (arguments->with_identity && !arguments->as_json && !arguments->as_csv)
      throw CLI::ValidationError("--with-identity", "is of --json and --csv; the list names no patient");
    list_cases(context, *arguments);
  });
}

}  // namespace arthronaut::command_line
