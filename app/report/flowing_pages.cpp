#include "app/report/flowing_pages.h"

#include <utility>

namespace arthronaut::report {

namespace {

constexpr TextStyle kTitle{.size_pt = 16, .bold = true, .ink = kAccent};
constexpr double kTopMm = 28, kAboveMm = 4;  // of a page; above a sentence
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
  y_mm_ = kTopMm;
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
  const double line_mm = PdfDocument::line_height_mm(style);
  const auto lines = pdf_.lines_of(text, kWidthMm, style);
  const double height_mm = kAboveMm + line_mm * static_cast<double>(lines.size());
  if (height_mm <= bottom_mm() - kTopMm) need(height_mm);
  y_mm_ += kAboveMm;
  for (const std::string& line : lines) {
    need(line_mm);
    if (!line.empty()) pdf_.text(left_mm(), y_mm_, line, style);
    y_mm_ += line_mm;
  }
  y_mm_ -= kAboveMm - 1;
}

void FlowingPages::table(const std::vector<double>& widths_mm, std::vector<std::vector<std::string>> rows) {
  const double heading_mm = pdf_.row_height_mm(widths_mm, rows.front(), true);
  std::size_t done = 0;
  while (done < rows.size()) {
    std::vector<std::vector<std::string>> part{rows.front()};
    double height_mm = heading_mm;
    for (done = std::max<std::size_t>(done, 1); done < rows.size(); ++done) {
      const double row_mm = pdf_.row_height_mm(widths_mm, rows[done], false);
      if (y_mm_ + height_mm + row_mm <= bottom_mm()) {
        height_mm += row_mm;
        part.push_back(rows[done]);
        continue;
      }
      if (kTopMm + heading_mm + row_mm > bottom_mm())
        if (auto begun = pdf_.take_lines(widths_mm, rows[done], bottom_mm() - y_mm_ - height_mm);
            !begun.empty())
          part.push_back(std::move(begun));
      break;
    }
    if (part.size() > 1 || rows.size() == 1) y_mm_ = pdf_.table(left_mm(), y_mm_, widths_mm, part);
    if (done < rows.size()) need(bottom_mm());
  }
}

void FlowingPages::pairs(const std::vector<std::vector<std::string>>& rows) {
  const std::vector<double> beside{38, 47, 38, 47}, alone{38, 132};
  const auto height_mm = [&](const std::vector<std::string>& row) {
    return pdf_.row_height_mm(row.size() > 2 ? beside : alone, row, false);
  };
  // A sentence is not broken to stand beside another one.
  const double line_mm = height_mm({"", ""});
  const auto is_short = [&](const std::vector<std::string>& row) {
    return height_mm({"", row.back(), "", ""}) <= line_mm;
  };
  for (std::size_t at = 0; at < rows.size();) {
    std::vector<std::string> row = rows[at++];
    if (at < rows.size() && is_short(row) && is_short(rows[at])) {
      row.insert(row.end(), rows[at].begin(), rows[at].end());
      ++at;
    }
    const auto& widths_mm = row.size() > 2 ? beside : alone;
    while (kTopMm + height_mm(row) > bottom_mm()) {
      if (const auto begun = pdf_.take_lines(widths_mm, row, bottom_mm() - y_mm_); !begun.empty())
        y_mm_ = pdf_.row(left_mm(), y_mm_, widths_mm, begun);
      need(bottom_mm());
    }
    need(height_mm(row));
    y_mm_ = pdf_.row(left_mm(), y_mm_, widths_mm, row);
  }
  y_mm_ += 2;
}

void FlowingPages::list(const std::vector<double>& widths_mm, std::vector<std::vector<std::string>> rows,
                        std::size_t most) {
  if (rows.size() > most + 1) {
    const auto first = static_cast<std::ptrdiff_t>(1 + (most + 1) / 2),
               rest = static_cast<std::ptrdiff_t>(rows.size() - 1 - most);
    std::vector<std::string> gap(widths_mm.size());
    gap.back() = "\u2026 and " + std::to_string(rest) + " more here: the report as JSON has them all";
    rows.erase(rows.begin() + first, rows.begin() + first + rest);
    rows.insert(rows.begin() + first, std::move(gap));
  }
  table(widths_mm, std::move(rows));
}

}  // namespace arthronaut::report
