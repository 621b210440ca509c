#include "planning/library/folder_search.h"

#include <algorithm>

#include "planning/geometry/error.h"

namespace arthronaut::library {

namespace fs = std::filesystem;

bool is_case_folder(const fs::path& folder) {
  std::error_code error;
  return fs::is_regular_file(folder / "case.json", error);
}

std::vector<fs::path> find_case_folders(const fs::path& root, const std::function<void(long)>& on_folder) {
  std::error_code error;
  const fs::path from = fs::canonical(root, error);
  if (error) throw IoError(root, error.message());
  if (!fs::is_directory(from)) throw IoError(root, "is not a folder");
  if (is_case_folder(from)) return {from};
  std::vector<fs::path> found;
  long looked = 0;
  fs::recursive_directory_iterator entry(from, fs::directory_options::skip_permission_denied, error);
  if (error) throw IoError(root, error.message());
  for (; entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    if (error) break;  // a folder that went while it was looked into: what was found counts
    std::error_code ignored;
    if (entry->is_symlink(ignored) || !entry->is_directory(ignored)) continue;
    const fs::path& folder = entry->path();
    if (++looked > kMostFolders)
      throw InvalidInput(root, "", "holds more than " + std::to_string(kMostFolders) + " folders");
    if (on_folder) on_folder(looked);
    const bool is_case = folder.extension() == ".arthro" && is_case_folder(folder);
    if (is_case) found.push_back(folder);
    if (is_case || folder.filename().string().starts_with(".")) entry.disable_recursion_pending();
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace arthronaut::library
