#include "navigation/markers/marker_pattern.h"

#include <algorithm>
#include <opencv2/aruco.hpp>

namespace arthronaut::markers {
namespace {

// Along an edge of one cell, as a share of the cell. The outer ones are kept only where the next cell
// continues the edge.
constexpr std::array<double, 5> kAlong = {0.1, 0.3, 0.5, 0.7, 0.9};

// Rows and columns count from the top left; everything outside the square is its white margin.
float brightness(const MarkerCode& code, int row, int column) {
  if (row < 0 || column < 0 || row >= code.cells || column >= code.cells) return 1;
  return code.is_bright(row, column) ? 1 : 0;
}

// The four cells across the edge line `line` of the lane `lane`, in the order of rising x or of rising y (so
// falling row).
std::array<float, 4> cells_across(const MarkerCode& code, int axis, int line, int lane) {
  std::array<float, 4> cells{};
  for (int k = 0; k < 4; ++k) {
    cells[k] = axis == 0 ? brightness(code, lane, line - 2 + k) : brightness(code, line + 1 - k, lane);
  }
  return cells;
}

int side_of(const MarkerCode& code, int axis, int line) {
  if (line != 0 && line != code.cells) return -1;
  return axis == 0 ? (line == 0 ? 3 : 1) : (line == 0 ? 0 : 2);
}

}  // namespace

std::vector<MarkerCode> codes_4x4_50() { return predefined_codes(cv::aruco::DICT_4X4_50); }

std::vector<MarkerCode> predefined_codes(int opencv_dictionary) {
  const auto dictionary = cv::aruco::getPredefinedDictionary(opencv_dictionary);
  std::vector<MarkerCode> codes;
  for (int id = 0; id < dictionary->bytesList.rows; ++id) {
    const cv::Mat bits =
        cv::aruco::Dictionary::getBitsFromByteList(dictionary->bytesList.row(id), dictionary->markerSize);
    MarkerCode code;
    code.id = id;
    code.cells = dictionary->markerSize + 2;
    for (int row = 0; row < bits.rows; ++row) {
      for (int column = 0; column < bits.cols; ++column) {
        code.bright[(row + 1) * code.cells + column + 1] = bits.at<std::uint8_t>(row, column) != 0;
      }
    }
    codes.push_back(code);
  }
  return codes;
}

std::vector<EdgeSample> edge_samples(const MarkerCode& code) {
  std::vector<EdgeSample> samples;
  const double cell = 1.0 / code.cells;
  for (int axis = 0; axis < 2; ++axis) {
    for (int line = 0; line <= code.cells; ++line) {
      for (int lane = 0; lane < code.cells; ++lane) {
        const auto cells = cells_across(code, axis, line, lane);
        if (cells[1] == cells[2]) continue;
        for (const double along : kAlong) {
          const int next = along < 0.25 ? lane - 1 : along > 0.75 ? lane + 1 : lane;
          const auto beside = cells_across(code, axis, line, next);
          if (beside[1] != cells[1] || beside[2] != cells[2]) continue;
          EdgeSample sample;
          sample.axis = axis;
          sample.cells = cells;
          sample.side = side_of(code, axis, line);
          const double across_units = line * cell, along_units = (lane + along) * cell;
          sample.x = (axis == 0 ? across_units : along_units) - 0.5;
          sample.y = 0.5 - (axis == 0 ? along_units : across_units);
          samples.push_back(sample);
        }
      }
    }
  }
  std::stable_sort(samples.begin(), samples.end(),
                   [](const EdgeSample& a, const EdgeSample& b) { return (a.side >= 0) > (b.side >= 0); });
  return samples;
}

}  // namespace arthronaut::markers
