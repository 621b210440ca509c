// Where a picture is put together of two moments: its rows above a seam of one, those below of another.
//
// At a seam the lower row does not go on from the row above it, but from the row that was there in the
// picture before: that one is of the same moment. In a picture of one moment it is the other way round
// wherever anything moves, and neither where nothing does. So tiles of every pair of rows vote: a row that
// fits the picture before better than its own neighbour, by more than noise explains, is a vote for a seam,
// the contrary one against it. It needs no noise and no still part, only motion: while nothing moves a
// picture of two moments does no harm. A seam in every picture collects its votes where it is, picture after
// picture.
//
// What blurs a seam hides it: a source that codes its pictures coarsely after they were torn.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "navigation/camera/frame.h"

namespace arthronaut::pipeline {

// Stateful over the frames of one source; one thread at a time; deterministic. Allocates nothing after the
// first frame of a size. Pictures narrower than 512 pixels are not judged.
class PictureSeam {
 public:
  struct Signs {
    int votes = 0;  // for the likeliest seam of this picture, less those against it; 16 at most
    int row = 0;    // the last one above it
    bool lower_is_older = true;
    bool is_lasting = false;  // a seam has stood at one row for many pictures
  };
  // Frames in order of time.
  [[nodiscard]] Signs observe(const camera::GrayView& picture);
  void reset() { height_ = 0; }

 private:
  static constexpr std::size_t kTiles = 16;
  template <int Strip>
  Signs judge(const camera::GrayView& picture);

  int width_ = 0, height_ = 0;
  std::vector<std::uint8_t> before_;  // of the picture before: a strip of each tile, row by row
  std::array<std::vector<float>, 2>
      collected_;  // of each row, for the lower and for the upper part as the older
};

}  // namespace arthronaut::pipeline
