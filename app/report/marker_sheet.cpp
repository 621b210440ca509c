#include "app/report/marker_sheet.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/aruco.hpp>

#include "app/report/pdf_document.h"
#include "planning/geometry/error.h"

namespace arthronaut::report {

namespace {

constexpr int kCells = 6;  // 4 x 4 bits and a border of one cell
// On A4: markers lie between these, the rule to check the printer with stands on the last.
constexpr double kLeft_mm = 40, kRight_mm = 190, kRule_mm = 280;

std::string mm_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g mm", value);
  return text;
}

// The black square whole, then the white cells on it: every edge of the code is where it belongs, and between
// two black cells there is no seam. White ones are drawn as runs in both directions, so that none shows
// between them either.
void draw_marker(PdfDocument& pdf, double x_mm, double y_mm, double size_mm, int id) {
  const auto dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50);
  cv::Mat cells;
  dictionary->drawMarker(id, kCells, cells, 1);
  const double cell = size_mm / kCells;
  pdf.filled_rectangle(x_mm, y_mm, size_mm, size_mm, {0, 0, 0});
  for (const bool is_row : {true, false}) {
    const auto is_white = [&](int line, int at) {
      return (is_row ? cells.at<std::uint8_t>(line, at) : cells.at<std::uint8_t>(at, line)) != 0;
    };
    for (int line = 0; line < kCells; ++line) {
      for (int from = 0; from < kCells;) {
        int to = from;
        while (to < kCells && is_white(line, to)) ++to;
        if (to > from)
          pdf.filled_rectangle(x_mm + (is_row ? from : line) * cell, y_mm + (is_row ? line : from) * cell,
                               (is_row ? to - from : 1) * cell, (is_row ? 1 : to - from) * cell, {1, 1, 1});
        from = to + 1;
      }
    }
  }
}

void draw_rule(PdfDocument& pdf) {
  constexpr double kX = 20, kY = kRule_mm;
  for (int mm = 0; mm <= 50; ++mm) {
    const double length = mm % 10 == 0 ? 4 : mm % 5 == 0 ? 3 : 2;
    pdf.line(kX + mm, kY, kX + mm, kY - length, 0.1, kBlack);
  }
  pdf.line(kX, kY, kX + 50, kY, 0.2, kBlack);
  pdf.text(kX + 55, kY, "This rule must measure 50 mm: print at 100 %, without scaling.", {.size_pt = 8.5});
}

void begin_page(PdfDocument& pdf, const std::string& title, const std::string& note) {
  pdf.add_page();
  pdf.text(20, 22, title, {.size_pt = 15, .bold = true, .ink = kAccent});
  pdf.paragraph(20, 29, 170, note, {.size_pt = 8.5, .ink = kGray});
  draw_rule(pdf);
}

void draw_markers(PdfDocument& pdf, const MarkerSheetOptions& options) {
  begin_page(pdf, "Markers, DICT_4X4_50, " + mm_text(options.size_mm),
             "The size is the side of the whole black square. Leave a white margin of two cells all round. "
             "Ids: 0 femur, "
             "1 tibia, 2 touch probe, 3 femoral guide, 4 tibial guide. Matt paper or engraving; glare hides "
             "corners.");
  const double pitch = std::max(options.size_mm * (1 + 4.0 / kCells) + 3, 12.0);
  double y = 42;
  for (const int id : options.ids) {
    if (y + pitch > 225)
      throw InvalidInput("markers: " + std::to_string(options.ids.size()) + " ids of " +
                         mm_text(options.size_mm) + " do not fit the page");
    pdf.text(20, y + options.size_mm / 2 + 1, "id " + std::to_string(id), {.size_pt = 9});
    for (int copy = 0; copy < options.copies; ++copy) {
      const double x = kLeft_mm + copy * pitch;
      if (x + options.size_mm > kRight_mm) break;
      draw_marker(pdf, x, y, options.size_mm, id);
    }
    y += pitch;
  }
  y += 6;
  const double ruler_y = y + 6;
  if (kLeft_mm + options.ruler_distance_mm + options.ruler_size_mm > kRight_mm ||
      ruler_y + options.ruler_size_mm > kRule_mm - 6)
    throw InvalidInput("markers: a ruler of " + mm_text(options.ruler_size_mm) + ", centres " +
                       mm_text(options.ruler_distance_mm) + " apart, does not fit the page");
  pdf.text(20, y,
           "Ruler: ids 5 and 6, " + mm_text(options.ruler_size_mm) + ", centres " +
               mm_text(options.ruler_distance_mm) + " apart",
           {.size_pt = 9});
  for (int i = 0; i < 2; ++i) {
    draw_marker(pdf, kLeft_mm + i * options.ruler_distance_mm, ruler_y, options.ruler_size_mm, 5 + i);
  }
}

void draw_checkerboard(PdfDocument& pdf, double square_mm) {
  begin_page(pdf, "Checkerboard, squares of " + mm_text(square_mm),
             "For the calibration of the arthroscope: glue it flat. The board may run past the view; how "
             "many squares it "
             "has does not matter, their size does.");
  const int columns = static_cast<int>(std::min(60.0, 150 / square_mm)), rows = columns;
  for (int row = 0; row < rows; ++row) {
    for (int column = row % 2; column < columns; column += 2) {
      pdf.filled_rectangle(20 + column * square_mm, 42 + row * square_mm, square_mm, square_mm, {0, 0, 0});
    }
  }
}

}  // namespace

void write_marker_sheet(const std::filesystem::path& file, const MarkerSheetOptions& options) {
  for (const int id : options.ids) {
    if (id < 0 || id > 49)
      throw InvalidInput("markers: id " + std::to_string(id) + " is not in DICT_4X4_50 (0 to 49)");
  }
  for (const double size :
       {options.size_mm, options.ruler_size_mm, options.ruler_distance_mm, options.square_mm}) {
    if (!(size >= 0.1 && size <= 100)) throw InvalidInput("markers: a size must lie between 0.1 and 100 mm");
  }
  if (options.ruler_distance_mm < options.ruler_size_mm) {
    throw InvalidInput("markers: the ruler's markers overlap");
  }
  PdfDocument pdf("Arthronaut markers");
  draw_markers(pdf, options);
  draw_checkerboard(pdf, options.square_mm);
  pdf.save(file);
}

}  // namespace arthronaut::report
