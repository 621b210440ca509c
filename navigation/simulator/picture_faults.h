// What spoils a picture in front of the lens or behind it: blood in the fluid, a glare that wanders, no
// picture at all. Deterministic by seed and time.
#pragma once

#include <cstdint>

#include "navigation/camera/frame.h"

namespace arthronaut::simulator {

// Red clouds that drift and thin out what is behind them; strength from 0 (nothing) to 1 (at its thickest
// next to nothing is seen). Throws nothing; a strength outside is cut.
void add_bleeding(camera::Frame& frame, std::uint64_t seed, double time_s, double strength);
// One bright spot that wanders through the middle of the picture and saturates it; its radius at strength 1
// is a third of the picture's height.
void add_glare(camera::Frame& frame, std::uint64_t seed, double time_s, double strength);
// A lens that is fogged: what it shows is blurred, its round border is not. At strength 1 an edge of the
// board is 16 px wide in a picture 540 px high.
void add_fog(camera::Frame& frame, double strength);
// Black but for the sensor's noise.
void black_out(camera::Frame& frame, std::uint64_t seed);

}  // namespace arthronaut::simulator
