// Poses from nothing: hypotheses from matching pairs, pruned by what is physically possible, scored with
// early way out.
#pragma once

#include <cstdint>
#include <vector>

#include "navigation/registration/bone/surface_index.h"
#include "navigation/registration/search/weighted_points.h"
#include "navigation/strokes/stroke_tangents.h"

namespace arthronaut::registration {

struct GlobalSearchOptions {
  std::uint64_t seed = 1;
  bool use_marker_prior = true;
  int curve_pair_count = 8;
  bool both_ways =
      true;  // each pair of curve points with its ends exchanged too; else half the work, and half the finds
  std::size_t keep_count = 24;                   // different hypotheses to hand on
  const std::vector<bool>* reachable = nullptr;  // by sample of the pair table: others are left out
};

struct Hypothesis {
  geometry::RigidTransform bone_from_marker;
  double score = 0;  // share of the test points that lie on the bone, soft; in [0, 1]
};

// Best first, different from one another by more than 0.15 rad or 3 mm at the touched points. Empty when the
// curves hold no pair of oriented points far enough apart.
[[nodiscard]] std::vector<Hypothesis> search_globally(const SurfaceIndex::Data& bone,
                                                      const std::vector<strokes::OrientedPoint>& oriented,
                                                      const WeightedPoints& points,
                                                      const GlobalSearchOptions& options);

}  // namespace arthronaut::registration
