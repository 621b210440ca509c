// Whether the bone's surface looks as it did: the share of the pieces that are compared (surface_memory.h)
// which are found where they were kept, each held against how alike it was while all was well. It says that
// what is seen is another surface, not where the bone went. A piece that is seen too dimly, too smeared or
// too glaringly to be compared is not asked, so that blood and highlights make fewer pieces, not other ones.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "navigation/contour/surface_memory.h"

namespace arthronaut::contour {

struct AgreementOptions {
  double memory_s = 0.25;
  double alike_from_share = 0.6;  // of what a piece was alike before
  double fewest_pieces = 5;       // in the memory, of a frame
  // Above the first share what is seen is learned; below the second the surface is another one.
  double agrees_from_share = 0.6, differs_below_share = 0.4;
  double holds_s = 0.4;        // that it differs without a break, before it is told
  double recovers_s = 1.0;     // that it agrees again without a break, before that is over
  double learnt_share = 0.02;  // by which a piece's likeness follows what is seen
};

struct AgreementVerdict {
  bool is_asked = false;      // enough pieces can be compared now
  bool agrees = false;        // and they lie where they lay, in the newest frame too
  bool differs = false;       // and they do not
  bool is_otherwise = false;  // it has differed for long enough, and has not agreed for long enough since
  double share = 0;           // of the pieces that are asked, those that are alike
};

// Allocates nothing after the construction. Deterministic.
class Agreement {
 public:
  explicit Agreement(std::size_t place_count, const AgreementOptions& options = {});

  // A frame: each piece that was compared, then judge() once. `learns`: what is seen is known to lie where it
  // lay.
  void add(std::size_t index, const ShiftMap& map, bool learns);
  const AgreementVerdict& judge(double elapsed_s);
  [[nodiscard]] const AgreementVerdict& verdict() const { return verdict_; }
  void clear();

 private:
  AgreementOptions options_;
  std::vector<float> expected_;  // by place; below 0: not known yet
  int frame_asked_ = 0, frame_alike_ = 0;
  double asked_ = 0, alike_ = 0;  // in the memory
  double weight_ = 0, differed_for_s_ = 0, agreed_for_s_ = 0;
  AgreementVerdict verdict_;
};

}  // namespace arthronaut::contour
