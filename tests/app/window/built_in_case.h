// The built-in knee as a case that is there already, its bones ready to be registered.
#pragma once

#include <filesystem>

namespace arthronaut::test {

// A copy of what was made when the tests were built. A workstation that finds no such case makes it itself,
// which the tests of Workstation, TourWindow and SettingUp leave to it.
inline void put_built_in_case(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder.parent_path());
  std::filesystem::copy(ARTHRONAUT_BUILT_IN_CASE, folder, std::filesystem::copy_options::recursive);
}

}  // namespace arthronaut::test
