#include "navigation/pipeline/torn_picture.h"

#include <algorithm>

namespace arthronaut::pipeline {

namespace {

// Below this nobody can tell noise from a codec's rounding; sensors under theatre light have 1 to 4.
constexpr float kLeastNoise = 0.6F;
// A repeat differs by nothing, or by what a codec makes of the same picture.
constexpr float kRepeats = 0.25F, kMoves = 0.6F;
// The least change lately: up by so much a frame, so that a scene that comes to rest is not taken for a
// repeat.
constexpr float kForgetting = 0.01F;
constexpr int kLeastTiles = 4;            // of a row, with noise
constexpr std::ptrdiff_t kLeastRows = 2;  // at either end
// Of repeats alone. What goes on without a seam is a codec's way with a part that does not move.
constexpr int kMostInARow = 3;
constexpr std::int64_t kNotJudgedFor_ns = 10'000'000'000;
// Tiles of one pair of rows that vote for a seam, less those against it. Measured as in picture_seam.cpp:
// clean pictures 5 at most (MJPEG, coarse), torn ones up to 10. With repeats on one side of it fewer tell.
constexpr int kClearSeam = 6;
constexpr int kSeamWithRepeats = 3;
// Of what changed most in a row in the picture before. Measured of H.264 (8 Mb/s, 640 x 480): a part that was
// not renewed 0.04 of its motion in all, and 0.3 in its slowest row.
constexpr float kRowStopped = 0.35F, kRowMovesOn = 0.5F, kPartStopped = 0.1F;
// A key frame codes a lost part anew too.
constexpr int kRenewedOnEnd = 3;

}  // namespace

TornPicture::RowState TornPicture::state_of(std::span<const float, kColumns> step,
                                            std::size_t first_tile) const {
  int repeats = 0, moves = 0, known = 0;
  for (std::size_t i = 0; i < kColumns; ++i) {
    const float noise = noise_[first_tile + i];
    if (noise < kLeastNoise) continue;
    ++known;
    repeats += step[i] < kRepeats * noise ? 1 : 0;
    moves += step[i] >= kMoves * noise ? 1 : 0;
  }
  if (known < kLeastTiles) return RowState::Unknown;
  if (repeats == known) return RowState::Repeats;
  return moves == known ? RowState::Moves : RowState::Mixed;
}

bool TornPicture::is_parted(std::span<const RowState> rows, RowState above, RowState below) {
  const auto upper = std::find_if(rows.begin(), rows.end(), [&](RowState s) { return s != above; });
  const auto lower = upper != rows.end() && *upper == RowState::Mixed ? upper + 1 : upper;
  return upper - rows.begin() >= kLeastRows && rows.end() - lower >= kLeastRows &&
         std::all_of(lower, rows.end(), [&](RowState s) { return s == below; });
}

bool TornPicture::has_stopped(Steps step) {
  RowStates rows{};
  std::size_t count = 0;
  float most = 0, most_before = 0;  // of the rows that stopped
  float most_moving = 0;            // of those that move on
  std::array<float, kRows> moved_before{};
  for (std::size_t row = 0; row < kRows; ++row) {
    const auto tiles = step.subspan(row * kColumns, kColumns);
    Moved& moved = moved_[row];
    // A jump of one picture, as a cut makes it or a tool that is put elsewhere, ends in the next: it is no
    // motion that stops. Where every other picture is torn only every other one moves.
    moved_before[row] = std::min(moved[0], std::max(moved[1], moved[2]));
    moved = {*std::max_element(tiles.begin(), tiles.end()), moved[0], moved[1]};
  }
  const float still = kPartStopped * *std::max_element(moved_before.begin(), moved_before.end());
  for (std::size_t row = 0; row < kRows; ++row) {
    const float now = moved_[row][0], before = moved_before[row];
    if (before < kLeastNoise) continue;
    const bool stopped = now < kRowStopped * before;
    // As still as a part that stopped, and had hardly moved: it may belong to either.
    if (!stopped && now < still) continue;
    rows[count++] = stopped                      ? RowState::Repeats
                    : now > kRowMovesOn * before ? RowState::Moves
                                                 : RowState::Mixed;
    if (rows[count - 1] == RowState::Moves) most_moving = std::max(most_moving, now);
    if (!stopped) continue;
    most = std::max(most, now);
    most_before = std::max(most_before, before);
  }
  const std::span<const RowState> known(rows.data(), count);
  // A tool that comes to rest leaves the noise, as large as beside it.
  return most < kRowStopped * most_moving && most < kPartStopped * most_before &&
         (is_parted(known, RowState::Moves, RowState::Repeats) ||
          is_parted(known, RowState::Repeats, RowState::Moves));
}

// Until it has changed in a few pictures on end.
bool TornPicture::is_still_stale(const RowStates& rows) {
  bool is_known = false, repeats = true;
  for (std::size_t row = stale_.from; row < stale_.to; ++row) {
    is_known = is_known || rows[row] != RowState::Unknown;
    repeats = repeats && (rows[row] == RowState::Unknown || rows[row] == RowState::Repeats);
  }
  if (is_known && repeats) {
    stale_.has_stood = true;
    stale_.renewed_in_a_row = 0;
    return true;
  }
  if (stale_.has_stood && ++stale_.renewed_in_a_row < kRenewedOnEnd) return true;
  stale_ = {};
  return false;
}

bool TornPicture::observe(Steps step, const PictureSeam::Signs& seam, int height_px,
                          std::int64_t timestamp_ns) {
  const bool has_stopped_part = has_stopped(step);
  RowStates states{},
      rows{};  // the second: those that are known, from above; a tear goes through one of them
  std::size_t count = 0;
  for (std::size_t row = 0; row < kRows; ++row) {
    states[row] =
        state_of(std::span<const float, kColumns>(step.data() + row * kColumns, kColumns), row * kColumns);
    if (states[row] != RowState::Unknown) rows[count++] = states[row];
  }
  const std::span<const RowState> known(rows.data(), count);
  const bool is_lower_repeated = is_parted(known, RowState::Moves, RowState::Repeats);
  const bool is_parted_now = is_lower_repeated || is_parted(known, RowState::Repeats, RowState::Moves);
  torn_in_a_row_ = is_parted_now ? torn_in_a_row_ + 1 : 0;

  const bool is_seam_of_parts =
      is_parted_now && seam.lower_is_older == is_lower_repeated && seam.votes >= kSeamWithRepeats;
  const bool is_stale = stale_.to > stale_.from && is_still_stale(states);
  if (!is_stale && (seam.votes >= kClearSeam || is_seam_of_parts)) {
    const auto tile_row = std::min(kRows - 1, static_cast<std::size_t>(seam.row) * kRows /
                                                  static_cast<std::size_t>(std::max(1, height_px)));
    stale_ = seam.lower_is_older ? StalePart{tile_row + 1, kRows} : StalePart{0, tile_row};
  }
  has_seam_ = is_stale || is_seam_of_parts || (is_parted_now && has_seam_);
  if (torn_in_a_row_ > kMostInARow && !has_seam_) not_before_ns_ = timestamp_ns + kNotJudgedFor_ns;

  const bool is_whole_repeat =
      count > 0 && std::all_of(known.begin(), known.end(), [](RowState s) { return s == RowState::Repeats; });
  for (std::size_t i = 0; i < noise_.size(); ++i) {
    // What repeats says nothing of the noise, unless it goes on without a seam.
    const bool is_repeat = (is_parted_now || is_whole_repeat || is_stale) && step[i] < kRepeats * noise_[i];
    if (is_repeat && (torn_in_a_row_ <= kMostInARow || has_seam_)) continue;
    noise_[i] = noise_[i] == 0 ? step[i] : std::min(step[i], noise_[i] + kForgetting);
  }
  return has_stopped_part || is_stale || seam.votes >= kClearSeam || seam.is_lasting || is_seam_of_parts ||
         (is_parted_now && timestamp_ns >= not_before_ns_);
}

}  // namespace arthronaut::pipeline
