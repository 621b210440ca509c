#include "tests/benchmarks/hard_clips/recipe.h"

#include <cmath>

#include "tests/benchmarks/hard_clips/draw.h"

namespace arthronaut::hard_clips {
namespace {

void add(Hardness hardness, Draw& draw, ClipRecipe& recipe) {
  switch (hardness) {
    case Hardness::Clean:
      break;
    case Hardness::Glare:
      recipe.has_glare = true;
      recipe.smear_px = std::max(recipe.smear_px, draw.between(1, 9));
      break;
    case Hardness::Cover:
      recipe.has_cover = true;
      recipe.smear_px = std::max(recipe.smear_px, draw.between(0.5, 5));
      break;
    case Hardness::Blood:
      recipe.has_blood = true;
      break;
    case Hardness::Debris:
      recipe.has_debris = true;
      break;
    case Hardness::Bubbles:
      recipe.has_bubbles = true;
      break;
    case Hardness::Smoke:
      recipe.has_smoke = true;
      break;
    case Hardness::Smear:
      // Even over the logarithm: as many of 3 to 10 as of 12 to 40.
      recipe.smear_px = 3 * std::pow(40.0 / 3, draw.between(0, 1));
      recipe.turn_share = draw.between(0, 0.6);
      recipe.exposure_share = draw.between(0.4, 0.8);
      break;
    case Hardness::Exposure:
      recipe.has_exposure_steps = true;
      break;
    case Hardness::Rolling:
      recipe.readout_share = draw.between(0.3, 0.95);
      recipe.smear_px = std::max(recipe.smear_px, draw.between(0.5, 4));
      break;
    case Hardness::Interlaced:
      recipe.is_interlaced = true;
      recipe.smear_px = std::max(recipe.smear_px, draw.between(0.2, 3));
      break;
    case Hardness::Coded:
      recipe.bit_rate = draw.between(2e6, 8e6);
      recipe.smear_px = std::max(recipe.smear_px, draw.between(0.5, 4));
      break;
    case Hardness::Mixed: {
      constexpr Hardness kMixable[] = {Hardness::Glare,  Hardness::Cover,    Hardness::Blood,
                                       Hardness::Debris, Hardness::Bubbles,  Hardness::Smoke,
                                       Hardness::Smear,  Hardness::Exposure, Hardness::Coded};
      const int first = draw.below(9), step = 1 + draw.below(4);
      for (int i = 0; i < 3; ++i) add(kMixable[(first + i * step) % 9], draw, recipe);
      break;
    }
  }
}

}  // namespace

std::string_view to_text(Hardness hardness) {
  constexpr std::string_view kNames[] = {"clean",      "glare", "cover", "blood",          "debris",
                                         "bubbles",    "smoke", "smear", "exposure steps", "rolling shutter",
                                         "interlaced", "coded", "mixed"};
  return kNames[static_cast<int>(hardness)];
}

ClipRecipe recipe_of(Hardness hardness, std::uint64_t seed, int frame_count) {
  Draw draw(seed * 1000003 + static_cast<std::uint64_t>(hardness));
  ClipRecipe recipe;
  recipe.hardness = hardness;
  recipe.seed = seed;
  recipe.frame_count = frame_count;
  const double size = draw.between(0, 1);
  recipe.height = size < 0.55 ? 720 : size < 0.96 ? 1080 : 2160;
  recipe.width = recipe.height * 16 / 9;
  constexpr double kRates[] = {30, 50, 60, 100, 120};
  recipe.frames_per_second = kRates[draw.below(5)];
  recipe.exposure_share = draw.between(0.25, 0.7);
  recipe.optics_sigma_px = draw.between(0.8, 1.3) * (recipe.height > 1080 ? 1.6 : 1);
  recipe.gamma = draw.between(1.9, 2.4);
  recipe.noise_grey = draw.between(1, 2.5);
  recipe.marker_size_mm = draw.happens(0.6) ? 4 : 2.89;
  recipe.distance_mm = draw.between(15, 32);
  recipe.smear_px = draw.between(0.3, 2);
  recipe.has_subsampled_chroma = draw.happens(0.5);
  add(hardness, draw, recipe);
  return recipe;
}

}  // namespace arthronaut::hard_clips
