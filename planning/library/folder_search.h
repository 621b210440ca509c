// The cases that lie in a folder, however deep.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

namespace arthronaut::library {

// Whether it holds a case.json.
[[nodiscard]] bool is_case_folder(const std::filesystem::path& folder);

// Folders called *.arthro that hold a case, and `root` itself where it is one; absolute, sorted. Folders that
// may not be looked into, hidden ones and links are passed over; a case is not looked into. on_folder is
// called with how many have been looked into. Throws IoError when root cannot be listed, InvalidInput when it
// is deeper or larger than kMostFolders.
inline constexpr long kMostFolders = 1'000'000;
[[nodiscard]] std::vector<std::filesystem::path> find_case_folders(
    const std::filesystem::path& root, const std::function<void(long looked)>& on_folder = {});

}  // namespace arthronaut::library
