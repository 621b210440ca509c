// The cases that were opened last, newest first, so that a surgeon finds his again. A file of the user's own
// beside the built-in case; it names folders and cases, never a patient.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace arthronaut::start {

struct RecentCase {
  std::filesystem::path folder;
  std::string name;        // of the case
  std::string side;        // "left", "right"
  std::string opened_utc;  // ISO 8601
};

// $XDG_DATA_HOME/arthronaut/recent.json, else ~/.local/share/...
[[nodiscard]] std::filesystem::path recent_cases_file();

// Empty where there is no file, or one that cannot be read: it is a convenience. Cases whose folder is gone
// stand in it all the same: a drive may be unplugged.
[[nodiscard]] std::vector<RecentCase> load_recent_cases(const std::filesystem::path& file);

// Puts the case at the top, once; keeps the 20 newest. What cannot be written is left: nothing hangs on it.
void note_recent_case(const std::filesystem::path& file, const RecentCase& opened) noexcept;

// "just now", "2 h ago", "yesterday", "2026-01-31": of a time in ISO 8601, seen at another.
[[nodiscard]] std::string when_in_words(const std::string& utc, const std::string& now_utc);

}  // namespace arthronaut::start
