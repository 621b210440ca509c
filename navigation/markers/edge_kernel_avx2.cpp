// Compiled for processors with AVX2, where the compiler knows how.
#include "navigation/markers/edge_loops.h"

namespace arthronaut::markers {

void match_edge_avx2(const EdgeProfile& profile, EdgeMatch& match) { match_profile(profile, match); }

}  // namespace arthronaut::markers
