#include "navigation/markers/exposed_kernel.h"

#include "navigation/markers/exposed_loops.h"

namespace arthronaut::markers {

bool processor_has_avx2() {
#if defined(__x86_64__)
  static const bool has = __builtin_cpu_supports("avx2") != 0;
  return has;
#else
  return false;
#endif
}

void look_at_code(const ExposedMoments& code, const LookedAt& at, SeenLevels& seen) {
  look<true>(code, at, seen);
}

void look_at_level(const ExposedMoments& code, const LookedAt& at, SeenLevels& seen) {
  look<false>(code, at, seen);
}

void explain_pixels(const FittedLight& light, const SeenPixels& pixels, const SeenLevels& levels,
                    ExplainedPixels& explained) {
  explain(light, pixels, levels, explained);
}

void add_products(const float (&rows)[kPixelsTogether][kProductSize], int count,
                  float (&sum)[kProductSize][kProductSize]) {
  add_up(rows, count, sum);
}

}  // namespace arthronaut::markers
