// What a report was made with.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace arthronaut::report {

// (name, version) of the program, its build (recording::build_identity) and of the libraries whose results
// stand in a report.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> versions();
// "Arthronaut 0.1.0, build 3dd6dcd64e4a": the beginning of the build, which may be empty.
[[nodiscard]] std::string program_in_words(const std::string& version, const std::string& build);
// "Arthronaut 0.1.0, build 3dd6dcd64e4a · OpenCV 4.6.0 · ..."
[[nodiscard]] std::string versions_in_words();

}  // namespace arthronaut::report
