// Where on its pages a PDF has something, as Poppler reads and renders it.
#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace arthronaut::test {

struct Page {
  double width_pt = 0, height_pt = 0;
  int words = 0;
  // The least distance of a word from an edge, negative beyond it, and the word that has it.
  double least_distance_mm = std::numeric_limits<double>::infinity();
  std::string outermost;
  std::vector<double> above_bottom_mm = {};  // of each word's lower side
  bool has_empty_edge = false;               // 5 mm from each edge, and beyond, no line, picture or letter

  [[nodiscard]] bool words_lie_within(double margin_mm) const { return least_distance_mm >= margin_mm; }
};

[[nodiscard]] std::vector<Page> pages_of(const std::filesystem::path& pdf);

}  // namespace arthronaut::test
