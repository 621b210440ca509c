// What the surgeon should touch next, and how far a registration is from being confirmed.
#pragma once

#include "navigation/registration/online/online_registration.h"
#include "navigation/registration/verdict/confidence.h"

namespace arthronaut::registration {

// What the advice goes by beside what is published.
struct CoachFacts {
  const SurfaceIndex::Data& bone;
  const PosePool& pool;
  const WeightedPoints& points;
  Eigen::Vector3d target_mm;
  int agreeing_solutions, agreeing_solutions_wanted;
  double refine_every_mm;
};

// How far it is to a confirmation, what is missing, and where the next stroke helps most. Of what is
// confirmed it says nothing to do: what follows, and whether it is in force at all, the operation knows.
[[nodiscard]] Coach advise(const OnlineResult& result, const CoachFacts& facts);

}  // namespace arthronaut::registration
