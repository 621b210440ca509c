// Compiled for processors with AVX2, where the compiler knows how.
#include "navigation/simulator/picture_loops.h"

namespace arthronaut::simulator {

const PictureKernel& avx2_picture_kernel() { return kKernel; }

}  // namespace arthronaut::simulator
