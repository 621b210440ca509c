#include "navigation/markers/edge_kernel.h"

#include "navigation/markers/edge_loops.h"

namespace arthronaut::markers {

void match_edge(const EdgeProfile& profile, EdgeMatch& match) { match_profile(profile, match); }

}  // namespace arthronaut::markers
