#include <memory>
#include <nlohmann/json.hpp>

#include "app/case/exercise_case.h"
#include "app/command_line/command.h"
#include "app/command_line/interruption.h"
#include "app/command_line/option_checks.h"
#include "navigation/training/board_run.h"
#include "navigation/training/score_file.h"
#include "navigation/training/trainee.h"
#include "planning/cases/case.h"
#include "planning/cases/case_lock.h"
#include "planning/files/format.h"
#include "planning/files/json_document.h"
#include "planning/files/utc_clock.h"
#include "planning/geometry/error.h"
#include "planning/phantom/phantom_case.h"

namespace arthronaut::command_line {

namespace {

namespace fs = std::filesystem;
using files::format;
using training::Exercise;
using training::Level;
using training::Score;

struct Arguments {
  bool list = false, scores = false, keep = false;
  std::string exercise, level = "easy", hand = "careful", case_folder, output, keep_hand;
  std::uint64_t seed = 1;
};

constexpr Level kLevels[] = {Level::Easy, Level::Medium, Level::Hard};

void list_exercises(const Context& context) {
  const std::vector<Score> kept = training::read_training_file(training::training_file());
  for (const Exercise& exercise : training::exercises()) {
    context.say(std::string(exercise.id) + ": " + std::string(exercise.title) + ". " +
                std::string(exercise.what));
    for (const Level level : kLevels) {
      const Score* best = training::best_of(kept, exercise.id, level);
      context.say(format("    %-6s ", std::string(to_text(level)).c_str()) +
                  (best != nullptr ? format("best %3.0f of 100, %s%s; ", best->points,
                                            best->when_utc.substr(0, 10).c_str(),
                                            is_by_earlier_rule(*best) ? ", by an earlier rule" : "")
                                   : std::string("not done yet; ")) +
                  training::words_of_faults(exercise, level));
    }
  }
}

void list_scores(const Context& context, const Arguments& arguments) {
  const std::vector<Score> kept = training::read_training_file(training::training_file());
  std::size_t shown = 0;
  for (const Score& score : kept) {
    if (!arguments.exercise.empty() && score.exercise != arguments.exercise) continue;
    ++shown;
    const std::string points = score.is_done ? format("%3.0f", score.points) : "not done";
    context.say(format("%s  %-12s %-6s %s  %s, %s%s", score.when_utc.c_str(), score.exercise.c_str(),
                       std::string(to_text(score.level)).c_str(), points.c_str(), score.trainee.c_str(),
                       score.knee.c_str(), is_by_earlier_rule(score) ? ", by an earlier rule" : ""));
  }
  if (shown == 0) context.say("No score is kept. The window keeps those of your own hand; here --keep does.");
}

simulator::Hand hand_of(const Arguments& arguments, const Exercise& exercise) {
  if (arguments.hand == "careful") return make_trainee(exercise.goal, training::careful(arguments.seed));
  if (arguments.hand == "hasty") return make_trainee(exercise.goal, training::hasty(arguments.seed));
  return training::read_hand_file(arguments.hand);
}

void say_score(const Context& context, const Exercise& exercise, const Score& score) {
  context.say(format("%s, %s: %.0f of 100", std::string(exercise.title).c_str(),
                     std::string(to_text(score.level)).c_str(), score.points));
  for (const training::ScorePart& part : score.parts)
    context.say(format("  %5.1f of %2.0f  ", part.points, part.most_points) + part.reason);
  if (!score.better.empty()) context.say("To do better:");
  for (const std::string& advice : score.better) context.say("  - " + advice);
}

void train(Context& context, const Arguments& arguments) {
  const Exercise* exercise = training::find_exercise(arguments.exercise);
  const Level level = training::level_from_text(arguments.level);
  const bool is_operation = exercise->goal != training::Goal::Calibrate;
  if (!is_operation && !arguments.case_folder.empty())
    throw InvalidInput(
        "calibrating is no operation: it needs no knee and leaves no session; leave out --case");
  refuse_before_the_work({.read = {arguments.hand}, .written = {arguments.output, arguments.keep_hand}});
  // An operation of minutes is not lost to a list that nobody can add to.
  if (arguments.keep) (void)training::read_training_file(training::training_file());
  const simulator::Hand hand = hand_of(arguments, *exercise);
  training::ExerciseSetup setup{
      .exercise = *exercise, .level = level, .knee = {}, .plan = {}, .seed = arguments.seed};
  std::string knee =
      is_operation ? "built-in knee " + std::to_string(arguments.seed) : std::string(training::kBoardAlone);
  std::string case_created_utc;
  theatre::RecordOptions record;
  cases::CaseLock lock;
  const Interruption interruption;  // from before there is a session
  if (arguments.case_folder.empty()) {
    setup = training::standard_setup(*exercise, level, arguments.seed);
  } else {
    const cases::Case opened = cases::load_case(arguments.case_folder);
    if (!opened.bones.contains(exercise->bone))
      throw InvalidInput(arguments.case_folder, "", "has no " + std::string(bones::to_text(exercise->bone)));
    const auto planned = opened.plan.tunnels.find(exercise->bone);
    if (planned == opened.plan.tunnels.end())
      throw InvalidInput(arguments.case_folder, "",
                         "has no planned tunnel in the " + std::string(bones::to_text(exercise->bone)));
    setup.knee = phantom::knee_of(opened);
    setup.plan = planned->second;
    knee = opened.name;
    case_created_utc = opened.created_utc;
    lock = cases::lock_or_refuse(arguments.case_folder);
    if (const std::string refusal = open_case::refusal_to_train(arguments.case_folder); !refusal.empty())
      throw InvalidInput(arguments.case_folder, "", refusal);
    record.folder = cases::create_session_folder(arguments.case_folder);
    record.keep = recording::KeepVideo::Encode;
  }
  training::ExerciseOutcome outcome;
  try {
    Progress progress("Training", 0);
    outcome = training::run_exercise(setup, hand, record, [&](long frames) {
      progress.advance_to(frames);
      if (interruption.caught() != 0) throw DeviceError("the exercise was stopped by hand");
    });
    // And while its video and its score were made.
    if (interruption.caught() != 0) throw DeviceError("the exercise was stopped by hand");
  } catch (...) {  // a command that fails, or is stopped, leaves nothing behind
    std::error_code ignored;
    if (!record.folder.empty()) fs::remove_all(record.folder, ignored);
    if (interruption.caught() != 0) interruption.end_program();
    throw;
  }
  Score& score = outcome.score;
  score.when_utc = files::utc_now();
  score.knee = knee;
  score.case_created_utc = case_created_utc;
  score.trainee = arguments.hand == "careful" || arguments.hand == "hasty"
                      ? "simulated trainee, " + arguments.hand
                      : "hand of " + fs::path(arguments.hand).filename().string();
  score.session = record.folder.filename().string();
  if (!arguments.keep_hand.empty()) training::write_hand_file(arguments.keep_hand, outcome.frames);
  if (!arguments.output.empty()) training::write_score_file(arguments.output, score);
  if (arguments.output != "-") say_score(context, *exercise, score);
  if (arguments.keep) training::add_to_training_file(training::training_file(), score);
  if (!score.is_done) context.say_unreliable("the score", {"the exercise was not brought to its end"});
}

}  // namespace

void add_train_command(CLI::App& app, Context& context) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* sub = add_subcommand(
      app, context, "train",
      "Exercises on the simulator with a score, by a simulated trainee or a hand from a file",
      "arthronaut train --list\n"
      "  arthronaut train --exercise aim --level hard --seed 3 -o score.json\n"
      "  arthronaut train --exercise drill-femur --case Knee.arthro --hand hasty --keep-hand hand.json");
  CLI::Option* list =
      sub->add_flag("--list", arguments->list, "The exercises, their levels and the best scores");
  CLI::Option* scores =
      sub->add_flag("--scores", arguments->scores,
                    "All scores that were kept, oldest first; of --exercise alone where it is given");
  sub->add_option("--exercise", arguments->exercise, "Which one; --list names them")
      ->check(read_by([](const std::string& id) {
        if (training::find_exercise(id) == nullptr)
          throw InvalidInput("there is no exercise \"" + id + "\"; \"arthronaut train --list\" names them");
      }));
  sub->add_option("--level", arguments->level, "How much goes wrong")
      ->check(CLI::IsMember({"easy", "medium", "hard"}))
      ->capture_default_str();
  sub->add_option("--hand", arguments->hand,
                  "Who does it: careful, hasty, or a file that --keep-hand has written")
      ->capture_default_str();
  sub->add_option("--seed", arguments->seed, "Another knee and other places for each seed")
      ->check(a_seed())
      ->capture_default_str();
  sub->add_option(
      "--case", arguments->case_folder,
      "On this case's bones and plan, of one without a recorded operation; what was done becomes a session "
      "of it");
  sub->add_option("--keep-hand", arguments->keep_hand, "Where to keep what was pushed, to do it again")
      ->check(a_name());
  sub->add_flag("--keep", arguments->keep, "Puts the score on the user's own list");
  sub->add_option("-o,--output", arguments->output, "Where to write the score (JSON); \"-\": standard output")
      ->check(a_name());
  list->excludes(scores);
  sub->callback([&context, arguments] {
    if (arguments->list) return list_exercises(context);
    if (arguments->scores) return list_scores(context, *arguments);
    if (arguments->exercise.empty()) throw CLI::RequiredError("--list, --scores or --exercise");
    train(context, *arguments);
  });
}

}  // namespace arthronaut::command_line
