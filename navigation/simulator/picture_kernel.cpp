#include "navigation/simulator/picture_kernel.h"

#include "navigation/simulator/picture_loops.h"

namespace arthronaut::simulator {

const PictureKernel& plain_picture_kernel() { return kKernel; }

bool draws_by_avx2() {
#if defined(__x86_64__)
  static const bool has = __builtin_cpu_supports("avx2") != 0;
  return has;
#else
  return false;
#endif
}

const PictureKernel& picture_kernel() {
  return draws_by_avx2() ? avx2_picture_kernel() : plain_picture_kernel();
}

}  // namespace arthronaut::simulator
