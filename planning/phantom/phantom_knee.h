// The built-in knee: implicit surfaces with known anatomy, deterministic by seed. The test bed, the built-in
// case and the simulator's scene. It is nobody's knee.
#pragma once

#include <cstdint>

#include "planning/bones/bone.h"
#include "planning/landmarks/landmarks.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::phantom {

struct PhantomOptions {
  bones::Side side = bones::Side::Right;
  std::uint64_t seed = 1;       // varies size and shape within the range of adults
  double edge_length_mm = 1.0;  // of the meshes
};

// LPS, mm; knee in extension; the origin between the epicondyles. x is left: lateral of a right knee is -x.
struct PhantomKnee {
  bones::Side side = bones::Side::Right;
  bones::Bone femur, tibia;
  landmarks::Landmarks femur_landmarks, tibia_landmarks;
  tunnels::Tunnel femoral_tunnel, tibial_tunnel;  // an anatomical plan through the footprint centres
};

[[nodiscard]] PhantomKnee make_phantom_knee(const PhantomOptions& options = {});

}  // namespace arthronaut::phantom
