// When a recorded clip was recorded.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace arthronaut::sources {

// ISO 8601 to the second: the earlier of what the container says (its creation_time) and of the file's last
// change, so that a clip that was copied or wrapped anew is no younger than it says itself. A copy that took
// no time along, of a container that says none, is as old as the copy: nothing tells it. nullopt: no file, or
// neither time can be true (before 2000, after now_utc).
[[nodiscard]] std::optional<std::string> recorded_utc(const std::filesystem::path& file,
                                                      const std::string& now_utc);

}  // namespace arthronaut::sources
