// Text as it is looked for and compared: by whoever writes in capitals, or without accents, as scanners do.
#pragma once

#include <string>
#include <string_view>

namespace arthronaut::files {

// Small letters without accents, of UTF-8: so Dvořák is found, and stands, as by a keyboard without them.
// U+0000 to U+017F and accents of their own; what else there is stays.
[[nodiscard]] std::string folded(std::string_view text);

}  // namespace arthronaut::files
