// The last fit of the pose that was chosen: along the strokes, where refine() takes each point by itself.
//
// What a tip does lasts. It stays on the bone, on soft tissue or in the air for millimetres of path, so the
// three explanations of a residual form a chain along each stroke, whose probabilities come forwards and
// backwards along it (L. R. Rabiner, "A tutorial on hidden Markov models", Proceedings of the IEEE 77, 1989).
// And what it is off by besides white noise, by tracking and by the mesh, changes slowly: that error is a
// vector at knots every few millimetres, linear in between, and is found with the pose. Taken out, it leaves
// the white noise alone, by which contact and soft tissue are told apart far better. So each sample says what
// its white noise lets it say, and a stroke as much as its knots leave over.
//
// It moves hard strokes by some tenths of a millimetre and finds nothing new: the start is to be the right
// pose, refined.
#pragma once

#include "navigation/registration/bone/surface_index.h"
#include "navigation/registration/search/refinement.h"
#include "navigation/registration/search/weighted_points.h"

namespace arthronaut::registration {

struct AlongStrokesOptions {
  double white_noise_mm = 0.2;  // as white_noise_of has it
  // By the field first, then by the mesh itself, which takes out the grid's rounding and takes longer.
  int iterations_by_field = 4, iterations_by_mesh = 0;
};

// points: with paths, in the order that they were drawn in. start: refined on them.
[[nodiscard]] geometry::RigidTransform fit_along_strokes(const SurfaceIndex::Data& bone,
                                                         const WeightedPoints& points,
                                                         const RefinedPose& start, const MarkerPrior& prior,
                                                         const AlongStrokesOptions& options);

}  // namespace arthronaut::registration
