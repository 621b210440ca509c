// Whether a picture is torn: its upper part of one moment, its lower part of another, as when a capture card
// is read while it is written, or a band of a picture was lost on the way. Two markers on either side of the
// tear stand to each other as they never did.
//
// Two things tell. At the seam the rows do not fit each other, but the picture before (picture_seam.h): seen
// while anything moves, also where every picture is torn. And the rows that were not renewed repeat the
// picture before to the last bit of its noise, while the others have moved on: so each tile's own noise is
// learnt (the least that it changed by lately), and a picture is torn when all tiles with noise of one end of
// it, two rows of tiles or more, repeat, and those of the other end do not.
//
// A codec that leaves a still part of the scene as it is repeats it too, for many pictures on end. What parts
// the two is the seam: a part that was left as it was because nothing moved there fits its neighbours, one
// that was lost does not, as soon as the scope moves. With a seam the picture is torn until the part is
// renewed, however long that takes. Without one, more than three on end are a codec's, and repeating tiles
// alone tell nothing for a while; a marker in such a part is judged by itself (standing_parts.h).
//
// An encoder that is given torn pictures refines what was not renewed, and little is left of the repeat and
// of the seam. What it leaves is the stop: everything in one end of the picture that moved until the picture
// before stands still in this one, while the other end moves on. No hand does that. What changed in the
// picture before alone had jumped, and did not move.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "navigation/pipeline/picture_seam.h"

namespace arthronaut::pipeline {

class TornPicture {
 public:
  static constexpr std::size_t kColumns = 16, kRows = 8;
  using Steps = std::span<const float, kColumns * kRows>;

  // How much each tile changed since the frame before, row by row, mean difference in grey values; what its
  // rows say, and how many rows it has. True: torn. Frames of one source in order of time; deterministic,
  // allocates nothing.
  bool observe(Steps step, const PictureSeam::Signs& seam, int height_px, std::int64_t timestamp_ns);
  void reset() { *this = TornPicture(); }

 private:
  enum class RowState { Unknown, Repeats, Moves, Mixed };
  using RowStates = std::array<RowState, kRows>;
  // Whether the rows, from above, are of the one state and then of the other, but for one between them.
  [[nodiscard]] static bool is_parted(std::span<const RowState> rows, RowState above, RowState below);
  [[nodiscard]] RowState state_of(std::span<const float, kColumns> step, std::size_t first_tile) const;
  [[nodiscard]] bool is_still_stale(const RowStates& rows);
  // In one end alone, from the picture before to this one.
  [[nodiscard]] bool has_stopped(Steps step);

  std::array<float, kColumns * kRows> noise_{};  // 0: not known
  using Moved =
      std::array<float, 3>;  // what changed most of a row in the three pictures before, newest first
  std::array<Moved, kRows> moved_{};
  int torn_in_a_row_ = 0;
  bool has_seam_ = false;  // of those in a row
  std::int64_t not_before_ns_ = 0;
  // Rows of tiles, [from, to), that a seam has shown to be of an older moment; none: from == to.
  struct StalePart {
    std::size_t from = 0, to = 0;
    bool has_stood = false;  // it was not renewed since
    int renewed_in_a_row = 0;
  } stale_;
};

}  // namespace arthronaut::pipeline
