// Moments as the people in the room name them: by the clock on the wall, of this machine's time zone. For the
// screen alone; files and reports say UTC (utc_clock.h).
#pragma once

#include <string>

namespace arthronaut::files {

// "2026-01-31 13:00:00" of "2026-01-31T12:00:00Z" where clocks are an hour ahead; anything else as it is.
[[nodiscard]] std::string local_time_in_words(const std::string& utc);
// Its day, "2026-01-31"; of anything else the first ten characters, as of a day without a time.
[[nodiscard]] std::string local_day(const std::string& utc);

}  // namespace arthronaut::files
