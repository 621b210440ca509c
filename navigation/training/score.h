// What an exercise was worth, part by part, each with its value, its limit, its points and one sentence that
// says why; and what to do better. How something was done (quickly, without waste, without a mistake) earns
// points only where what the exercise is for has earned some. Pure: the same facts, the same score.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "navigation/training/exercise_facts.h"

namespace arthronaut::training {

struct ScorePart {
  Measure measure = Measure::Time;
  std::optional<double> value;  // in unit_of(measure); empty: it never came to that, which is worth nothing
  double good = 0, limit = 0;   // see Mark
  double points = 0, most_points = 0;
  std::optional<double> caps_at;  // it holds the whole score at no more than this; see Mark
  std::string reason;  // "The axis is 4.0 deg off the plan's (all points at 2.0 deg or less, no points ...)."
  std::string advice;  // what to do better; empty where all points were earned
};

struct Score {
  std::string exercise;  // id
  Level level = Level::Easy;
  double points = 0;  // of 100, rounded to whole ones; 0 as long as the trainee was not done
  bool is_done = false;
  std::vector<ScorePart> parts;     // in the exercise's order
  std::vector<std::string> better;  // what to do better, what costs most first; three at most
  int rule = 1;                     // see Exercise; of a score that names none it was the first
  // Where it comes from; filled in by whoever ran it.
  std::uint64_t seed = 0;
  std::string knee, when_utc, session, trainee;
  // When the case was made that holds the session (cases::Case::created_utc): its name may be another one's,
  // and may change. Empty: of an older version, or no case.
  std::string case_created_utc = {};
};

// Whether it is the score of that session of that case.
[[nodiscard]] bool is_of_session(const Score& score, const std::string& session, const std::string& case_name,
                                 const std::string& case_created_utc);

// It was scored by other marks than those of now: it says nothing of how well the exercise is done by these.
[[nodiscard]] bool is_by_earlier_rule(const Score& score);
[[nodiscard]] Score score_of(const Exercise& exercise, Level level, const ExerciseFacts& facts);

}  // namespace arthronaut::training
