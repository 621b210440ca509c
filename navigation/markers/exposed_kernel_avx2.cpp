// Compiled for processors with AVX2, where the compiler knows how.
#include "navigation/markers/exposed_loops.h"

namespace arthronaut::markers {

void look_at_code_avx2(const ExposedMoments& code, const LookedAt& at, SeenLevels& seen) {
  look(code, at, seen);
}

void add_products_avx2(const float (&rows)[kPixelsTogether][kProductSize],
                       float (&sum)[kProductSize][kProductSize]) {
  add_up(rows, sum);
}

}  // namespace arthronaut::markers
