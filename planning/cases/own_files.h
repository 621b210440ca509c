// Which files are a case's own: what is written under a name of the user's must not take their place.
#pragma once

#include <filesystem>

namespace arthronaut::cases {

// By its place alone, whether it is there or not: what this program keeps in a case and reads back, and
// whatever lies in the case's own folders (sessions, painting, ...). Reports beside these are not.
[[nodiscard]] bool is_own_file(const std::filesystem::path& file);

}  // namespace arthronaut::cases
