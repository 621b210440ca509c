// Printable sheets at true size: markers of the tools, the two-marker ruler, a checkerboard; each with a 50
// mm rule to check the printer with.
#pragma once

#include <filesystem>
#include <vector>

namespace arthronaut::report {

struct MarkerSheetOptions {
  std::vector<int> ids = {0, 1, 2, 3, 4};  // of DICT_4X4_50
  double size_mm = 4.0;                    // side of the black square
  double ruler_size_mm = 2.89;             // markers 5 and 6, centres ruler_distance_mm apart
  double ruler_distance_mm = 10.0;
  double square_mm = 1.5;  // of the checkerboard
  int copies = 6;          // of each marker
};

// Throws InvalidInput for ids outside 0..49 and sizes that are not above 0 or do not fit the page; IoError.
void write_marker_sheet(const std::filesystem::path& file, const MarkerSheetOptions& options = {});

}  // namespace arthronaut::report
