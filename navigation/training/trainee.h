// A trainee made of numbers: does an exercise on its own, by pushing what a hand would push, well or badly as
// it is told. For the command line, for tests, and as somebody to be measured against. It sees the scene's
// truth and nothing of the operation; it is deterministic.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "navigation/training/exercise.h"

namespace arthronaut::training {

struct Skill {
  std::uint64_t seed = 1;
  double pace = 0.8;            // share of the greatest speed
  double offset_mm = 0.4;       // how far beside the entry it sets the guide, in a direction by seed
  double angle_deg = 0.8;       // and how far aslant
  double depth_error_mm = 0.5;  // beyond the plan
  double draws_mm = 150;        // strokes on the bone, before it touches
  bool stops_drawing = true;    // when it lifts the tip
  int touches = 3;              // that verify; each at a place of its own
  int useless_touches = 0;      // more of them at the place of the last one
  double tilts_deg = 32;        // Pivot: half-angle of the cone
  double looks_s = 4;           // with the guide on the plan, before it drills or says that it is done
  int pictures = 5;             // Calibrate: of the board
  double turns_lens_deg = 50;   // from one to the next
  double rests_s = 0.6;         // with the board at rest, before each
};
[[nodiscard]] Skill careful(std::uint64_t seed);
[[nodiscard]] Skill hasty(std::uint64_t seed);

// A trainee for one run; it holds its own progress.
[[nodiscard]] simulator::Hand make_trainee(Goal goal, const Skill& skill);

// A hand from a file (format "arthronaut.hand", version 1): what is pushed from which frame on, as
// write_hand_file() keeps it of a run. After the last frame that it names the exercise is over.
// Throws IoError or InvalidInput (file, place, reason).
[[nodiscard]] simulator::Hand read_hand_file(const std::filesystem::path& file);
// Atomic. Throws IoError.
void write_hand_file(const std::filesystem::path& file, const std::vector<simulator::HandTruth>& frames);

}  // namespace arthronaut::training
