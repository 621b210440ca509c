// Scores as JSON: of one exercise (format "arthronaut.score", version 1), and all of a user over time
// ("arthronaut.training", version 1).
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "navigation/training/score.h"

namespace arthronaut::training {

// Atomic; "-" is standard output. Throws IoError.
void write_score_file(const std::filesystem::path& file, const Score& score);

// In the order in which they were added; none where there is no such file. Throws IoError or InvalidInput
// (file, place, reason) for one that is broken, which is then left as it is.
[[nodiscard]] std::vector<Score> read_training_file(const std::filesystem::path& file);
// Adds one to the file, whose folder is made, private, where it is missing. Atomic: a crash leaves all the
// scores of before. Programs that add at the same moment take turns, by the lock of the library's files
// (library.lock beside it), where the file system knows locks. Throws as reading does, and IoError.
void add_to_training_file(const std::filesystem::path& file, const Score& score);

// The user's: $XDG_DATA_HOME/arthronaut/training.json, else ~/.local/share/...
[[nodiscard]] std::filesystem::path training_file();

// Whose score it is that the window keeps; others are of a simulated trainee, or of a hand that is played
// again.
inline constexpr const char* kByHand = "by hand";

// The most points of an exercise at a level that was done by hand; of equals the one that took less time. By
// the exercise's rule of now; where none is, by an earlier one, which is_by_earlier_rule() tells. Null: none.
[[nodiscard]] const Score* best_of(const std::vector<Score>& scores, std::string_view exercise, Level level);

}  // namespace arthronaut::training
