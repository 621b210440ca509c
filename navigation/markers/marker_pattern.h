// What a printed marker looks like: its cells, and where on it straight edges can be measured.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace arthronaut::markers {

inline constexpr int kMaxCells = 10;

// A square code with its one-cell black border: cells x cells, row by row from the top left as printed.
struct MarkerCode {
  int id = 0;
  int cells = 6;
  std::array<bool, kMaxCells * kMaxCells> bright{};
  [[nodiscard]] bool is_bright(int row, int column) const { return bright[row * cells + column]; }
};

// The codes of OpenCV's dictionary DICT_4X4_50, or of another of its predefined dictionaries.
[[nodiscard]] std::vector<MarkerCode> codes_4x4_50();
[[nodiscard]] std::vector<MarkerCode> predefined_codes(int opencv_dictionary);

// A place on a straight dark-to-bright step, away from where the step ends.
struct EdgeSample {
  double x = 0, y = 0;  // in the marker frame (y up), in units of the side
  int axis = 0;         // the step is crossed along x (0) or y (1)
  // Brightness (0 or 1) of the four cells along +axis, the step between the second and the third. What is one
  // cell outside the square counts as bright: the white margin.
  std::array<float, 4> cells{};
  int side = -1;  // 0 top, 1 right, 2 bottom, 3 left for the outline of the square, -1 inside
};

// Samples along every edge of the code, outline first.
[[nodiscard]] std::vector<EdgeSample> edge_samples(const MarkerCode& code);

}  // namespace arthronaut::markers
