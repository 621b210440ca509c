#include "navigation/pipeline/standing_parts.h"

#include <algorithm>
#include <cstdlib>

namespace arthronaut::pipeline {

namespace {

// From here on what repeats is no longer told by its tiles alone (torn_picture.cpp). Measured on path-traced
// arthroscopy at 1080p: clean clips, H.264 at CRF 33 or 1 Mb/s, one on end at most.
constexpr int kSameOnEnd = 3;
// A key frame codes a lost part anew too.
constexpr int kRenewedOnEnd = 3;
constexpr double kStandingShare = 0.5;  // a marker that lies across the edge of such a part is of two moments

}  // namespace

void StandingParts::observe(std::span<const std::uint8_t> now, std::span<const std::uint8_t> before,
                            int width, double most_repeat) {
  if (width < kColumns) return;
  const int rows = static_cast<int>(now.size()) / width;
  width_ = width;
  parts_.resize(static_cast<std::size_t>(rows) * kColumns);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const int from = row * width + column * width / kColumns,
                to = row * width + (column + 1) * width / kColumns;
      int sum = 0;
      for (int i = from; i < to; ++i)
        sum += std::abs(static_cast<int>(now[static_cast<std::size_t>(i)]) -
                        static_cast<int>(before[static_cast<std::size_t>(i)]));
      const bool is_renewed = sum >= most_repeat * (to - from);
      Part& part = parts_[static_cast<std::size_t>(row * kColumns + column)];
      part.same_on_end = is_renewed ? 0 : part.same_on_end + 1;
      part.renewed_on_end = is_renewed ? part.renewed_on_end + 1 : 0;
      if (part.same_on_end >= kSameOnEnd) part.stands = true;
      if (part.renewed_on_end >= kRenewedOnEnd) part.stands = false;
    }
  }
}

bool StandingParts::stand(int row_from, int row_to, int column_from, int column_to) const {
  int count = 0, standing = 0;
  const int rows = static_cast<int>(parts_.size()) / kColumns;
  for (int row = std::max(0, row_from); row < std::min(rows, row_to); ++row) {
    for (int part = 0; part < kColumns; ++part) {
      const int left = part * width_ / kColumns, right = (part + 1) * width_ / kColumns;
      if (right <= column_from || left >= column_to) continue;
      ++count;
      standing += parts_[static_cast<std::size_t>(row * kColumns + part)].stands ? 1 : 0;
    }
  }
  return count > 0 && standing >= kStandingShare * count;
}

}  // namespace arthronaut::pipeline
