#include "app/report/flowing_pages.h"

#include <utility>

namespace arthronaut::report {

namespace {

constexpr TextStyle kTitle{.size_pt = 16, .bold = true, .ink = kAccent};
constexpr TextStyle kFoot{.size_pt = 7.5, .bold = false, .ink = kGray};

}  // namespace

FlowingPages::FlowingPages(PdfDocument& pdf, std::string foot) : pdf_(pdf), foot_(std::move(foot)) {}

void FlowingPages::begin_page(const std::string& title) {
  title_ = title;
  next_title_.clear();
  pdf_.add_page();
  ++page_;
  const double line_mm = pdf_.height_mm() - 15;
  pdf_.text(left_mm(), 20, title, kTitle);
  pdf_.line(left_mm(), line_mm, left_mm() + kWidthMm, line_mm);
  const std::string number =
      " \u00B7 page " + std::to_string(page_) + " \u00B7 research software, not a medical device";
  pdf_.text(left_mm(), line_mm + 4,
            pdf_.cut_to(foot_, kWidthMm - pdf_.text_width_mm(number, kFoot), kFoot) + number, kFoot);
  y_mm_ = 28;
}

void FlowingPages::need(double height_mm) {
  constexpr std::string_view kContinued = ", continued";
  if (y_mm_ + height_mm <= bottom_mm()) return;
  if (!next_title_.empty()) return begin_page(std::string(next_title_));
  begin_page(title_.ends_with(kContinued) ? title_ : title_ + std::string(kContinued));
}

void FlowingPages::heading(const std::string& text, double with_mm) {
  need(6 + with_mm);
  y_mm_ += 5;
  pdf_.text(left_mm(), y_mm_, text, {.size_pt = 11.5, .bold = true});
  y_mm_ += 1;
}

void FlowingPages::sentence(const std::string& text, const TextStyle& style) {
  need(4 + pdf_.paragraph_height_mm(kWidthMm, text, style));
  y_mm_ = pdf_.paragraph(left_mm(), y_mm_ + 4, kWidthMm, text, style) - 3;
}

void FlowingPages::table(const std::vector<double>& widths_mm,
                         const std::vector<std::vector<std::string>>& rows) {
  std::size_t done = 0;
  while (done < rows.size()) {
    std::vector<std::vector<std::string>> part{rows.front()};
    double height_mm = pdf_.row_height_mm(widths_mm, rows.front(), true);
    done = std::max<std::size_t>(done, 1);
    const std::size_t first = done;
    for (; done < rows.size(); ++done) {
      height_mm += pdf_.row_height_mm(widths_mm, rows[done], false);
      if (y_mm_ + height_mm > bottom_mm() && (done > first || y_mm_ > 40)) break;
      part.push_back(rows[done]);
    }
    if (part.size() > 1 || rows.size() == 1) y_mm_ = pdf_.table(left_mm(), y_mm_, widths_mm, part);
    if (done < rows.size()) need(bottom_mm());
  }
}

}  // namespace arthronaut::report
