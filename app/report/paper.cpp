#include "app/report/paper.h"

#include <string>

#include "planning/geometry/error.h"

namespace arthronaut::report {

std::string_view to_text(Paper paper) { return paper == Paper::A4 ? "a4" : "letter"; }

Paper paper_from_text(std::string_view text) {
  for (const Paper paper : {Paper::A4, Paper::Letter})
    if (text == to_text(paper)) return paper;
  throw InvalidInput("\"" + std::string(text) + "\" is no paper: a4 or letter");
}

// ISO 216; ANSI/ASME Y14.1.
PaperSize size_of(Paper paper) {
  return paper == Paper::A4 ? PaperSize{210, 297} : PaperSize{8.5 * 25.4, 11 * 25.4};
}

}  // namespace arthronaut::report
