#include "planning/phantom/knee_shape.h"

namespace arthronaut::phantom {

namespace {

// SplitMix64: the same numbers on every platform and standard library, which std's distributions do not
// promise.
class Draws {
 public:
  explicit Draws(std::uint64_t seed) : state_(seed) {}
  [[nodiscard]] double between(double low, double high) {
    state_ += 0x9E3779B97F4A7C15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    z ^= z >> 31;
    return low + (high - low) * static_cast<double>(z >> 11) * 0x1.0p-53;
  }

 private:
  std::uint64_t state_;
};

}  // namespace

KneeParameters vary(std::uint64_t seed) {
  Draws draws(seed);
  KneeParameters knee;
  knee.scale = draws.between(0.94, 1.06);
  knee.width_factor = draws.between(0.97, 1.03);
  knee.notch_half_width_mm = draws.between(9.0, 10.0);
  knee.roof_slope_deg = draws.between(35.0, 39.0);
  knee.groove_depth_mm = draws.between(5.8, 7.2);
  knee.medial_distal_mm = draws.between(1.0, 2.2);
  knee.shaft_valgus_deg = draws.between(5.5, 7.5);
  knee.plateau_slope_deg = draws.between(5.0, 9.0);
  knee.eminence_height_mm = draws.between(7.5, 9.5);
  for (double& phase : knee.ripple_phases) phase = draws.between(-3.14159, 3.14159);
  return knee;
}

}  // namespace arthronaut::phantom
