// Squares of which a corner is seen and no more of the outline need be: where dark meets bright in two
// straight edges that meet, a declared code is tried with that corner for each of its own, at every length
// that its sides may have. For markers of which so much is hidden, or joined to something dark, that no
// outline closes.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "navigation/camera/camera_model.h"
#include "navigation/markers/marker_pattern.h"
#include "navigation/markers/square_search.h"

namespace arthronaut::markers {

// A square that a code may fill. Of what lies in perspective nothing is known yet: it is a parallelogram.
struct SupposedSquare {
  FoundSquare square;
  std::size_t index = 0;  // of the code
  int turn = 0;           // the marker's top-left is the square's corner of this index
  double score = 0;       // of its cells: those that agree, less those that say the opposite
};

// For codes of 6 x 6 cells: with their margin they are the bits of a word. Has its memory from the beginning:
// a marker is lost for the first time in the middle of an operation.
class CornerSearch {
 public:
  CornerSearch();
  // The likeliest squares of the codes that are sought, the best of each first; none where something that is
  // `taken` (corners, clockwise) lies. So many corners at a time; what is left is looked at by the next
  // calls.
  [[nodiscard]] std::span<const SupposedSquare> find(const SquareSearch::SmallPicture& picture,
                                                     const camera::CameraModel& camera,
                                                     std::span<const MarkerCode> codes,
                                                     std::span<const char> is_sought,
                                                     std::span<const Corners> taken);
  void start_over() { next_row_ = 0; }

 private:
  struct Corner {
    Eigen::Vector2f at, along[2];  // from where its sides meet along both, the second clockwise of the first
    float seen_px[2];              // how far each is seen
    float dark = 0, bright = 0;
  };
  struct Pattern {
    std::size_t index = 0;
    int turn = 0;
    std::uint64_t bright = 0;  // by cell, of cells and margin
  };
  void mark_likely(const camera::GrayView& picture, int y);
  [[nodiscard]] bool measure_corner(const camera::GrayView& picture, int x, int y, Corner& corner) const;
  void try_codes(const SquareSearch::SmallPicture& picture, const camera::CameraModel& camera,
                 const Corner& corner);
  void take(const SquareSearch::SmallPicture& picture, const camera::CameraModel& camera,
            const Corner& corner, const Pattern& pattern, double score, float first_px, float second_px);

  std::vector<Pattern> patterns_;
  std::vector<SupposedSquare> found_;
  std::vector<Eigen::Vector2f> corners_;  // that were looked at in this call
  std::vector<std::uint8_t> is_likely_;   // of a row
  int cells_ = 6;
  int next_row_ = 0;
};

}  // namespace arthronaut::markers
