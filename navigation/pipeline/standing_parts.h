// Which parts of a picture stand still while the rest goes on: what was lost there, or was never written,
// shows where a marker was, not where it is.
//
// Where a marker lies changes in every picture of a live source, by the sensor's noise and by a hand that
// never holds still to a fraction of a pixel. Where it did not for more pictures on end than a codec leaves a
// marker as it is (one, at a tenth of the rate that it needs), the marker is not of this moment. What cannot
// be told apart: a scope that something holds still to a hundredth of a pixel, coded so coarsely that no
// noise is left. That is the safe side.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace arthronaut::pipeline {

// Stateful over the frames of one source; deterministic. Allocates nothing after the first frame of a size.
class StandingParts {
 public:
  // Some rows of this picture and of the one before, packed, `width` pixels each. Not for a picture that
  // repeats the one before as a whole. What differs by less than `most_repeat`, mean of a part, repeats.
  void observe(std::span<const std::uint8_t> now, std::span<const std::uint8_t> before, int width,
               double most_repeat);
  // Whether of these columns of these rows half or more stands still; [from, to) each.
  [[nodiscard]] bool stand(int row_from, int row_to, int column_from, int column_to) const;
  void reset() { parts_.clear(); }

 private:
  static constexpr int kColumns = 32;  // parts a row
  struct Part {
    int same_on_end = 0, renewed_on_end = 0;
    bool stands = false;
  };
  int width_ = 0;
  std::vector<Part> parts_;
};

}  // namespace arthronaut::pipeline
