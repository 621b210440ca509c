// A folder or file that is typed instead of looked for: what it means, and how it goes on.
#pragma once

#include <filesystem>
#include <string>

namespace arthronaut::folders {

struct TypedPath {
  std::filesystem::path path;  // absolute
  std::string problem;         // why it cannot be gone to; empty where it can
};

// "~" and "~/..." begin in the user's own folder, what does not begin with "/" in `from`. Spaces around it
// are none of it, nor are the quotes or the "file://" that other programs copy a path with. Does not throw.
[[nodiscard]] TypedPath typed_path(const std::string& text, const std::filesystem::path& from);

// The text, as far on as all names agree that begin like its last part; a folder that alone does ends with
// "/". Hidden names where a dot was typed. The same text where nothing begins so. Does not throw.
[[nodiscard]] std::string completed_path(const std::string& text, const std::filesystem::path& from);

}  // namespace arthronaut::folders
