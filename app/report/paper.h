// The paper that a report is printed on, upright.
#pragma once

#include <string_view>

namespace arthronaut::report {

enum class Paper { A4, Letter };

// "a4", "letter"
[[nodiscard]] std::string_view to_text(Paper paper);
// Throws InvalidInput for any other word.
[[nodiscard]] Paper paper_from_text(std::string_view text);

struct PaperSize {
  double width_mm = 0, height_mm = 0;
};
[[nodiscard]] PaperSize size_of(Paper paper);

}  // namespace arthronaut::report
