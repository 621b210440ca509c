// The wall clock as files and pages name it: always UTC, so that two machines mean the same. For dates, and
// for what other machines are told; intervals are measured on a steady clock.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

namespace arthronaut::files {

// ISO 8601, to the second: "2026-01-31T12:00:00Z".
[[nodiscard]] std::string utc_now();
[[nodiscard]] double utc_now_s();  // since 1970
// Another moment in the same form: of two the earlier one is the lesser text.
[[nodiscard]] std::string utc_of(std::chrono::system_clock::time_point moment);
// What utc_of() wrote, or a date alone, which is its midnight. nullopt: it is no date that there is, or has a
// fraction of a second or a zone other than Z, which this program never writes.
[[nodiscard]] std::optional<std::chrono::sys_seconds> time_of_utc(std::string_view utc);
// Now, as strftime writes it: utc_now_as("%Y-%m-%d"). At most 63 characters.
[[nodiscard]] std::string utc_now_as(const char* format);
// As people read it: "2026-01-31 12:00:00 UTC" of "2026-01-31T12:00:00Z"; anything else as it is.
[[nodiscard]] std::string utc_in_words(const std::string& utc);

}  // namespace arthronaut::files
