// The rim of the round view: where it may be (from nothing), where it runs (sub-pixel, ray by ray), and the
// circle through it. Inside the module; users of the lens take lens_tracker.h.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "navigation/camera/camera_model.h"
#include "navigation/camera/frame.h"

namespace arthronaut::lens {

inline constexpr int kRayCount = 720;
inline constexpr double kRayStepDeg = 360.0 / kRayCount;

enum class RayState : std::uint8_t {
  Edge,     // the mask ends and the lit scene begins at radius_px
  Dark,     // nothing lit within reach: the scene says nothing about the rim here
  Clipped,  // the picture ends before the mask begins, or what should be mask is lit
};

// Ray i leaves the centre at i * kRayStepDeg (image axes, towards +y).
struct RimProfile {
  camera::Boundary about;  // the centre of the rays and the radius that was expected
  std::array<RayState, kRayCount> state{};
  std::array<float, kRayCount> radius_px{};     // meaningful where state is Edge
  std::array<float, kRayCount> inside_light{};  // of the scene just inside that edge, linear, 0 to 1
  double dark_level = 0;                        // grey value of the mask
  double dark_share = 0, clipped_share = 0;     // of all rays
};

// The mask's grey level is taken from the outer end of the rays, the edge is where the light (not the grey
// value: a display gamma of 2.2 is undone) has risen half way from it. Rays reach from `inner` to `outer`
// times the radius. About a centre outside the picture all of them are clipped.
void measure_rim(const camera::GrayView& picture, const camera::Boundary& expected, double inner,
                 double outer, RimProfile& profile);

struct CircleFit {
  bool ok = false;
  camera::Boundary circle;
  double coverage_deg = 0;  // rays within 1.5 px of the circle
  double rms_px = -1;       // of those
};

// Least squares circle through the profile's edges, robust against what crosses the rim (Tukey). Edges
// further than gate_px from the expected circle are not looked at. ok needs 90 degrees of rim, on two sides.
[[nodiscard]] CircleFit fit_circle(const RimProfile& profile, double gate_px);

// The round view of a picture about which nothing is known: first light along rows and columns, then
// consensus. nullopt when no circle explains it. About 3 px accurate. Deterministic.
struct SearchScratch {
  std::vector<Eigen::Vector2d> points;  // kept between calls, so that a search allocates once
};
[[nodiscard]] std::optional<camera::Boundary> search_circle(const camera::GrayView& picture,
                                                            SearchScratch& scratch);

}  // namespace arthronaut::lens
