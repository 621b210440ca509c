// A thin page of paper over libharu: millimetres from the top-left corner, UTF-8 text in DejaVu Sans.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/report/paper.h"

namespace arthronaut::report {

struct Ink {
  double red = 0, green = 0, blue = 0;
};
inline constexpr Ink kBlack{0.08, 0.09, 0.10};
inline constexpr Ink kGray{0.42, 0.45, 0.48};
inline constexpr Ink kAccent{0.05, 0.35, 0.52};
inline constexpr Ink kWarning{0.72, 0.22, 0.05};
inline constexpr Ink kCaution{0.66, 0.42, 0.0};

struct TextStyle {
  double size_pt = 9.5;
  bool bold = false;
  Ink ink = kBlack;
};

class PdfDocument {
 public:
  // Throws IoError when the font is not installed.
  explicit PdfDocument(const std::string& title, Paper paper = Paper::A4);
  ~PdfDocument();

  [[nodiscard]] double width_mm() const;
  [[nodiscard]] double height_mm() const;

  void add_page();
  // Draws on the last page. y is the text's baseline.
  void text(double x_mm, double y_mm, std::string_view text, const TextStyle& style = {});
  // Breaks at spaces, and within words that are longer than a line; returns the baseline below the last
  // line.
  double paragraph(double x_mm, double y_mm, double width_mm, std::string_view text,
                   const TextStyle& style = {});
  [[nodiscard]] double text_width_mm(std::string_view text, const TextStyle& style = {});
  [[nodiscard]] double paragraph_height_mm(double width_mm, std::string_view text,
                                           const TextStyle& style = {});
  // The lines that paragraph() breaks it into. Joined by spaces they are broken in the same places.
  [[nodiscard]] std::vector<std::string> lines_of(std::string_view text, double width_mm,
                                                  const TextStyle& style = {});
  [[nodiscard]] static double line_height_mm(const TextStyle& style);
  // The text, or as much of its beginning as is no wider, and an ellipsis.
  [[nodiscard]] std::string cut_to(std::string_view text, double width_mm, const TextStyle& style = {});
  void line(double x0_mm, double y0_mm, double x1_mm, double y1_mm, double width_mm = 0.2,
            const Ink& ink = kGray);
  void filled_rectangle(double x_mm, double y_mm, double width_mm, double height_mm, const Ink& ink = kBlack);
  // rgb: 3 * width * height bytes, top row first. Scaled to width_mm; returns the height in mm.
  double image(double x_mm, double y_mm, double width_mm, const std::vector<std::uint8_t>& rgb, int width,
               int height);
  // Rows of cells in columns of the given widths; the first row is the heading. Returns the y below the
  // table. Cells that are too long are broken into lines. Does not look where the page ends.
  double table(double x_mm, double y_mm, const std::vector<double>& widths_mm,
               const std::vector<std::vector<std::string>>& rows);
  // One row of such a table that is no heading. Returns the y below it.
  double row(double x_mm, double y_mm, const std::vector<double>& widths_mm,
             const std::vector<std::string>& cells, bool is_heading = false);
  [[nodiscard]] double row_height_mm(const std::vector<double>& widths_mm,
                                     const std::vector<std::string>& cells, bool is_heading);
  // Takes the beginning off a row, as many lines of each cell as make it no higher than this; empty, and the
  // row as it was, where there is not room for one line.
  [[nodiscard]] std::vector<std::string> take_lines(const std::vector<double>& widths_mm,
                                                    std::vector<std::string>& cells, double height_mm);

  // Atomic. Throws IoError.
  void save(const std::filesystem::path& file);
  // What save() would write. Throws IoError.
  [[nodiscard]] std::string bytes();

 private:
  struct Pdf;
  std::unique_ptr<Pdf> pdf_;
};

}  // namespace arthronaut::report
