// What a hard clip is made of: one kind of hardness, everything else drawn by seed. Even seeds are for
// setting thresholds and may be looked at frame by frame; odd seeds are for reporting, and only as totals.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace arthronaut::hard_clips {

enum class Hardness {
  Clean,
  Glare,       // highlights that saturate 5 to 30 % of a marker, with motion of up to 9 px
  Cover,       // fingers and instruments pass in front
  Blood,       // clouds and drops
  Debris,      // flecks that drift by
  Bubbles,     // rims, highlights, a shifted picture inside
  Smoke,       // of bone dust: a veil that takes the contrast
  Smear,       // 3 to 40 px over the exposure, with turning
  Exposure,    // steps of exposure and gain
  Rolling,     // the sensor is read row by row
  Interlaced,  // two fields, half a frame apart
  Coded,       // H.264 at 2 to 8 Mbit/s
  Mixed,       // three of the above
};
inline constexpr std::array kAllHardness = {
    Hardness::Clean,      Hardness::Glare, Hardness::Cover, Hardness::Blood,    Hardness::Debris,
    Hardness::Bubbles,    Hardness::Smoke, Hardness::Smear, Hardness::Exposure, Hardness::Rolling,
    Hardness::Interlaced, Hardness::Coded, Hardness::Mixed};
[[nodiscard]] std::string_view to_text(Hardness hardness);

struct ClipRecipe {
  Hardness hardness = Hardness::Clean;
  std::uint64_t seed = 0;
  int frame_count = 40;
  int width = 1280, height = 720;
  double frames_per_second = 60;
  double exposure_share = 0.5;  // of the time between frames
  double optics_sigma_px = 1, gamma = 2.2, noise_grey = 1.5;
  double marker_size_mm = 4, distance_mm = 25;
  double smear_px = 1;      // of the markers over the exposure, where they move fastest
  double turn_share = 0.3;  // of that, by turning
  double bit_rate = 0;      // bit/s; 0: not coded
  bool has_subsampled_chroma = false;
  bool has_glare = false, has_cover = false, has_blood = false, has_debris = false, has_bubbles = false,
       has_smoke = false, has_exposure_steps = false;
  double readout_share = 0;  // of the time between frames, from the first row to the last
  bool is_interlaced = false;
};

// The same arguments, the same recipe.
[[nodiscard]] ClipRecipe recipe_of(Hardness hardness, std::uint64_t seed, int frame_count);

}  // namespace arthronaut::hard_clips
