// Pages that are filled from top to bottom: what does not fit below goes onto the next page. Inner header of
// report.
#pragma once

#include <string>
#include <vector>

#include "app/report/pdf_document.h"

namespace arthronaut::report {

class FlowingPages {
 public:
  // Wide enough for everything that is set on it, in the middle of either paper.
  static constexpr double kWidthMm = 170;

  // `foot`: in a line below every page, cut where it is too long. `pdf` must outlive it.
  FlowingPages(PdfDocument& pdf, std::string foot);

  void begin_page(const std::string& title);
  // Begins a page where less than this is left: with the title given to continue_as(), else of the same
  // title, "continued".
  void need(double height_mm);
  void continue_as(const std::string& title) { next_title_ = title; }
  void heading(const std::string& text, double with_mm = 20);  // stays with so much of what follows it
  // What is higher than a page goes on on the next one, here and in a row of a table.
  void sentence(const std::string& text, const TextStyle& style = {});
  // The first row is the heading and stands above every page's part.
  void table(const std::vector<double>& widths_mm, std::vector<std::vector<std::string>> rows);
  // Names and their values; two such rows beside each other where both values are short, read line by line.
  void pairs(const std::vector<std::vector<std::string>>& rows);
  // A table of which no more than `most` rows are shown below the heading, the first and the last; between
  // them stands how many more there are, and that the report as JSON has them.
  void list(const std::vector<double>& widths_mm, std::vector<std::vector<std::string>> rows,
            std::size_t most);
  void skip(double height_mm) { y_mm_ += height_mm; }

  [[nodiscard]] PdfDocument& pdf() { return pdf_; }
  [[nodiscard]] int page_count() const { return page_; }
  [[nodiscard]] double left_mm() const { return (pdf_.width_mm() - kWidthMm) / 2; }
  [[nodiscard]] double y_mm() const { return y_mm_; }
  [[nodiscard]] double bottom_mm() const { return pdf_.height_mm() - 18; }

 private:
  PdfDocument& pdf_;
  std::string foot_, title_, next_title_ = {};
  double y_mm_ = 0;
  int page_ = 0;
};

}  // namespace arthronaut::report
