// Units as people read them.
#pragma once

#include <string>

namespace arthronaut::files {

// What screens and pages write for the plain letters of files and terminals: "40 deg", "71 mm2" and
// "28.4 +- 5.1" become "40°", "71 mm²" and "28.4 ± 5.1".
[[nodiscard]] std::string with_signs(std::string plain);

}  // namespace arthronaut::files
