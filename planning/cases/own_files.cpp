#include "planning/cases/own_files.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>

namespace arthronaut::cases {

namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 18> kFiles{
    "case.json",   "plan.json",         "identity.json",       "study.json", "case.lock",
    "note.json",   "measurements.json", "bone_doubts.json",    "sides.json", "history.json",
    "fluid.json",  "femur.ply",         "femur_cartilage.ply", "tibia.ply",  "tibia_cartilage.ply",
    "camera.json", "tools.json",        "achieved.json"};
constexpr std::array<std::string_view, 7> kFolders{"sessions", "painting", "images",       "cache",
                                                   "screens",  "pictures", "plan_versions"};

}  // namespace

bool is_own_file(const fs::path& file) {
  std::error_code ignored;
  const fs::path whole = fs::weakly_canonical(fs::absolute(file), ignored);
  for (fs::path folder = whole.parent_path(); folder.has_relative_path(); folder = folder.parent_path()) {
    if (!fs::exists(folder / "case.json", ignored)) continue;
    const fs::path in_case = whole.lexically_relative(folder);
    const std::string first = in_case.begin()->string();
    return std::next(in_case.begin()) == in_case.end() ? std::ranges::find(kFiles, first) != kFiles.end()
                                                       : std::ranges::find(kFolders, first) != kFolders.end();
  }
  return false;
}

}  // namespace arthronaut::cases
