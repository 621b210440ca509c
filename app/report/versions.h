// What a report was made with.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace arthronaut::report {

// (name, version) of the program and of the libraries whose results stand in a report.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> versions();
// "Arthronaut 0.1.0 · OpenCV 4.6.0 · ..."
[[nodiscard]] std::string versions_in_words();

}  // namespace arthronaut::report
