// Which letters the glyphs of a PDF's text are, for those who search it, copy from it or read it aloud.
#pragma once

#include <string>

namespace arthronaut::report {

// A PDF that libharu made with UTF-8 fonts, and behind it, as the format has it for changes, other text maps.
// libharu writes a map of glyphs there (cidrange), which readers warn of and need not take. Throws IoError
// where it is not built as expected.
[[nodiscard]] std::string with_text_map(std::string pdf);

}  // namespace arthronaut::report
