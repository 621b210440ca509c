// Where the outer face of a thin cortex lies in what a scanner blurs it to. Inner header of segmentation.
//
// Half-way between outside and the peak is where the edge of a thick cortex is. A cortex that is not much
// thicker than the blur no longer reaches its own value: the peak is too low, and half-way to it too far out,
// by up to 1.2 times the blur's sigma. Treece et al. 2010 (Medical Image Analysis 14:276) find the edges by
// fitting a blurred layer to each profile,
//   v(x) = s + (c - s) P((x - x0) / sigma) + (m - c) P((x - x0 - w) / sigma),
// P the normal distribution, x inwards, s, c, m outside, cortex and marrow, w the thickness, with one c for
// the whole bone. Here the noise is averaged away first: profiles of alike rise are laid over each other, c
// is one for all of them and sigma about one, and the fit gives for each rise at which share of it the edge
// lies.
#pragma once

#include <vector>

namespace arthronaut::segmentation {

struct CortexProfile {
  float low = 0, high = 0;         // outside, and the peak, as whoever asks for the share measures them
  float edge_mm = 0;               // inwards from the first value: where it passes half-way between them
  std::vector<float> values = {};  // from outside inwards, kProfileStep_mm apart
};
inline constexpr double kProfileStep_mm = 0.2;

// At which share of the way from low to high the edge lies: 0.5 for a cortex that is thick.
class EdgeShare {
 public:
  // One half for every rise: too few profiles, or no blurred layer explains them.
  EdgeShare() = default;
  [[nodiscard]] static EdgeShare of(std::vector<CortexProfile> profiles);

  [[nodiscard]] float at(float rise) const;  // high - low, HU; between the fitted rises by a straight line
  [[nodiscard]] bool is_fitted() const { return !fitted_.empty(); }
  [[nodiscard]] double blur_mm() const { return blur_mm_; }  // sigma, about the middle one; 0 unless fitted
  [[nodiscard]] double cortex_hu() const { return cortex_hu_; }  // of a cortex thick enough; 0 unless fitted

 private:
  struct Point {
    float rise, share;
  };
  std::vector<Point> fitted_;  // by rise
  double blur_mm_ = 0, cortex_hu_ = 0;
};

}  // namespace arthronaut::segmentation
