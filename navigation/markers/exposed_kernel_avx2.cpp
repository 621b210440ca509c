// Compiled for processors with AVX2, where the compiler knows how.
#include "navigation/markers/exposed_loops.h"

namespace arthronaut::markers {

void look_at_code_avx2(const ExposedMoments& code, const LookedAt& at, SeenLevels& seen) {
  look<true>(code, at, seen);
}

void look_at_level_avx2(const ExposedMoments& code, const LookedAt& at, SeenLevels& seen) {
  look<false>(code, at, seen);
}

void explain_pixels_avx2(const FittedLight& light, const SeenPixels& pixels, const SeenLevels& levels,
                         ExplainedPixels& explained) {
  explain(light, pixels, levels, explained);
}

void add_products_avx2(const float (&rows)[kPixelsTogether][kProductSize], int count,
                       float (&sum)[kProductSize][kProductSize]) {
  add_up(rows, count, sum);
}

}  // namespace arthronaut::markers
