// How wrong a registration may be, and whether it may be relied on. The residual says almost nothing about
// the error at the target; what counts is what the touched surface holds fast, how the errors along a stroke
// correlate, and whether another pose fits as well.
#pragma once

#include <optional>

#include "navigation/registration/bone/surface_index.h"
#include "navigation/registration/search/pose_pool.h"

namespace arthronaut::registration {

// A pose of less stroke, or of lower odds (VerdictEvidence::log_odds), is not to be relied on. While more may
// be drawn, waiting costs little, and what fits another bone by chance is asked about again and again.
inline constexpr double kMinLength_mm = 100;
inline constexpr double kNeededLogOdds = 4, kNeededLogOddsWhileDrawing = 7;

// The strokes that a pose is judged against.
struct TouchedCurves {
  const strokes::Curves& curves;
  const WeightedPoints& points;  // chosen from them
  double length_mm = 0;          // of what was not left out
  double white_noise_mm = 0;     // of the tip, one coordinate, from the strokes alone
  // By point of the curves, how far off the mesh it touched; nullopt: not known, left out. Empty: on the
  // mesh, all of them.
  std::vector<std::optional<double>> offsets_mm = {};
  // What the pose is uncertain by beyond what the points say: twist of the bone frame about its origin, one
  // sigma. See CartilageFit::drift.
  geometry::Vector6d drift = geometry::Vector6d::Zero();
};
[[nodiscard]] double white_noise_of(const std::vector<strokes::OrientedPoint>& oriented);

// The best pose of the pool with all that can be said about it, as if the bone's mirror image came nowhere
// near: judge_odds says the rest. An empty pool gives a summary without a pose.
[[nodiscard]] RegistrationSummary summarise(const SurfaceIndex::Data& bone, const PosePool& pool,
                                            const TouchedCurves& touched, const RegistrationOptions& options);

// The verdict once it is known how far the pose leads over the best one on the mirror image (nullopt: it was
// not asked, as if that came nowhere near): one that misses its strokes and is held loosely needs more of
// that lead. Can only add a doubt.
void judge_odds(RegistrationSummary& summary, const std::optional<double>& side_lead, double needed_log_odds);

// By how much the points miss the surface, over what a good tracker's errors make of this white noise at
// most. Above 1 it is another bone's surface.
[[nodiscard]] double share_of_bearable_misfit(const RegistrationSummary& summary, double white_noise_mm);

// The strokes are larger or smaller than the bone, by more than their errors explain and by more than does
// not matter: what a marker of another size than stated does, or another bone. True is a reason of summarise.
[[nodiscard]] bool differ_in_size(const StrokeScale& scale);

}  // namespace arthronaut::registration
