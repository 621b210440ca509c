#include "planning/tunnels/half_plane.h"

#include <gtest/gtest.h>

namespace arthronaut::tunnels {
namespace {

constexpr double kRadius_mm = 4.5, kLength_mm = 35, kSide_mm = 30, kBeyond_mm = 16;
constexpr LipEnds kOfMouth{{0.3, 0.3}, {0.6, 0.6}}, kOfNone{{-1, -1}, {-1, -1}};

// A block whose side runs 30 mm beside the axis. Its far face rises from the axis, where the tunnel leaves
// it, to a ridge of 1 mm, and falls from there to the block's side: all of it is the exit's own face.
double thinnest_mm(double ridge_mm) {
  HalfPlane plane(kLength_mm, kRadius_mm, -kBeyond_mm, kLength_mm + kBeyond_mm);
  plane.add({.from_mm = -0.5,
             .to_mm = 0,
             .from_radius_mm = kSide_mm,
             .to_radius_mm = 0,
             .entry_lip = kOfMouth,
             .exit_lip = kOfNone});
  plane.add({.from_mm = -0.5,
             .to_mm = kLength_mm - 1,
             .from_radius_mm = kSide_mm,
             .to_radius_mm = kSide_mm,
             .comes_out = true,
             .entry_lip = kOfNone,
             .exit_lip = kOfNone});
  plane.add({.from_mm = kLength_mm - 1,
             .to_mm = kLength_mm + 1,
             .from_radius_mm = kSide_mm,
             .to_radius_mm = ridge_mm,
             .comes_out = true,
             .entry_lip = kOfNone,
             .exit_lip = kOfMouth});
  plane.add({.from_mm = kLength_mm,
             .to_mm = kLength_mm + 1,
             .from_radius_mm = 0,
             .to_radius_mm = ridge_mm,
             .entry_lip = kOfNone,
             .exit_lip = kOfMouth});
  return plane.thinnest().radius_mm;
}

// Wherever the ridge stands, and though it stands just where the tunnel's side comes out: beyond it nothing
// of the bone is beside the axis any more, and the side lies outside with it.
TEST(HalfPlane, TheSideThatLeavesThroughTheTopOfARidgeIsNoBreach) {
  for (const double off_mm : {-2.0, -1e-2, -1e-7, -1e-9, 0.0, 1e-9, 1e-7, 1e-2, 2.0})
    EXPECT_NEAR(thinnest_mm(kRadius_mm + off_mm), kSide_mm, 1e-6) << off_mm;
}

}  // namespace
}  // namespace arthronaut::tunnels
