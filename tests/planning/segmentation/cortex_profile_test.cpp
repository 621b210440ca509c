#include "planning/segmentation/cortex_profile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace arthronaut::segmentation {
namespace {

struct Layer {
  double outside_hu = 50, cortex_hu = 1200, marrow_hu = 150, thickness_mm = 1.5, blur_mm = 0.5;

  [[nodiscard]] double at(double inwards_mm) const {
    const auto p = [&](double x) { return 0.5 * std::erfc(-x / blur_mm * M_SQRT1_2); };
    return outside_hu + (cortex_hu - outside_hu) * p(inwards_mm) +
           (marrow_hu - cortex_hu) * p(inwards_mm - thickness_mm);
  }
};

constexpr double kFace_mm = 2.5;  // of the cortex, from the first value

// As it is measured: low and high are the least and the greatest value, the edge half-way between.
CortexProfile measured(const Layer& layer, std::mt19937& random) {
  std::normal_distribution<double> noise_hu(0, 25), place_mm(0, 0.2);
  CortexProfile profile;
  const double face_mm = kFace_mm + place_mm(random);
  for (int i = 0; i < 31; ++i)
    profile.values.push_back(static_cast<float>(layer.at(i * kProfileStep_mm - face_mm) + noise_hu(random)));
  const auto top = std::ranges::max_element(profile.values);
  profile.high = *top;
  profile.low = *std::min_element(profile.values.begin(), top);
  const float half = 0.5F * (profile.low + profile.high);
  auto inside = top;
  while (*inside >= half) --inside;
  profile.edge_mm = static_cast<float>(kProfileStep_mm * (std::distance(profile.values.begin(), inside) +
                                                          (half - *inside) / (inside[1] - *inside)));
  return profile;
}

std::vector<CortexProfile> many(double thinnest_mm, double thickest_mm, const Layer& like = {}) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> thickness_mm(thinnest_mm, thickest_mm);
  std::vector<CortexProfile> profiles;
  for (int i = 0; i < 6000; ++i) {
    Layer layer = like;
    layer.thickness_mm = thickness_mm(random);
    profiles.push_back(measured(layer, random));
  }
  return profiles;
}

// How far from the face a layer's edge is found, without noise: outwards is negative.
double error_mm(const EdgeShare& share, const Layer& layer) {
  double high = 0;
  for (double x = 0; x < 4; x += 0.01) high = std::max(high, layer.at(x));
  const double rise = high - layer.outside_hu;
  const double level = layer.outside_hu + share.at(static_cast<float>(rise)) * rise;
  double x = -3;
  while (layer.at(x) < level) x += 0.001;
  return x;
}

// Half-way to the peak, a layer of 1 mm blurred by 0.5 mm is found 0.2 mm too far out. The face is found to
// 0.05 mm, a tenth of the blur, for each thickness that was there.
TEST(EdgeShare, FindsTheFaceOfACortexThatIsThinnerThanTheBlurAllows) {
  const EdgeShare share = EdgeShare::of(many(0.8, 3.0));
  ASSERT_TRUE(share.is_fitted());
  EXPECT_NEAR(share.blur_mm(), 0.5, 0.05);
  EXPECT_NEAR(share.cortex_hu(), 1200, 60);
  for (const double thickness_mm : {0.9, 1.0, 1.2, 1.5, 2.0, 2.8}) {
    Layer layer;
    layer.thickness_mm = thickness_mm;
    EXPECT_NEAR(error_mm(share, layer), 0, 0.05) << thickness_mm;
  }
  Layer thin;
  thin.thickness_mm = 1.0;
  EXPECT_LT(error_mm(EdgeShare(), thin), -0.15);
}

// Everywhere alike, nothing tells a dark cortex from a thin one but the shape of the profile and what cortex
// usually is: 0.1 mm then.
TEST(EdgeShare, OfEvenThicknessIsNotFarOff) {
  for (const double thickness_mm : {1.0, 1.5}) {
    Layer layer;
    layer.thickness_mm = thickness_mm;
    const EdgeShare share = EdgeShare::of(many(thickness_mm, thickness_mm));
    EXPECT_NEAR(error_mm(share, layer), 0, 0.1) << thickness_mm;
  }
}

// Voxels are longer across the slices, and so is the blur: 0.4 to 0.7 mm by the direction of the profile. The
// face is found within 0.1 mm all the same; with one blur for all of them 0.3 to 0.5 mm too far in, as a
// thinner and brighter cortex explains them better then.
TEST(EdgeShare, FindsTheFaceWhereTheBlurDependsOnTheDirection) {
  for (const double thickness_mm : {1.5, 1.8, 2.2}) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> cosine(0, 1);  // to the slices' normal, all over a sphere
    std::vector<CortexProfile> profiles;
    Layer layer{.outside_hu = 40, .cortex_hu = 1100, .marrow_hu = 280, .thickness_mm = thickness_mm};
    for (int i = 0; i < 6000; ++i) {
      layer.blur_mm = std::hypot(0.4, std::sqrt(0.7 * 0.7 - 0.4 * 0.4) * cosine(random));
      profiles.push_back(measured(layer, random));
    }
    const EdgeShare share = EdgeShare::of(profiles);
    ASSERT_TRUE(share.is_fitted());
    EXPECT_NEAR(share.cortex_hu(), 1100, 80) << thickness_mm;
    for (const double blur_mm : {0.4, 0.5, 0.6, 0.7}) {
      layer.blur_mm = blur_mm;
      EXPECT_NEAR(error_mm(share, layer), 0, 0.1) << thickness_mm << " " << blur_mm;
    }
  }
}

TEST(EdgeShare, OfAThickCortexIsOneHalf) {
  const EdgeShare share = EdgeShare::of(many(4, 8));
  for (const float rise : {1100.0F, 1150.0F, 1200.0F}) EXPECT_NEAR(share.at(rise), 0.5, 0.03);
}

// Too few to take the noise out of them, and values that no layer explains.
TEST(EdgeShare, WithoutAFitIsOneHalf) {
  auto few = many(1, 2);
  few.resize(500);
  EXPECT_FALSE(EdgeShare::of(few).is_fitted());
  EXPECT_EQ(EdgeShare::of(few).at(700), 0.5F);
  std::mt19937 random(9);
  std::uniform_real_distribution<float> any_hu(-1000, 3000);
  auto senseless = many(1, 2);
  for (auto& profile : senseless)
    for (std::size_t i = 0; i < profile.values.size(); ++i)
      profile.values[i] = i % 7 < 3 ? 3000.0F : -1000.0F + any_hu(random) / 10;
  const EdgeShare share = EdgeShare::of(senseless);
  EXPECT_FALSE(share.is_fitted());
  EXPECT_EQ(share.at(700), 0.5F);
}

}  // namespace
}  // namespace arthronaut::segmentation
