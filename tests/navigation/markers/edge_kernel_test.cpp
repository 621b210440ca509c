#include "navigation/markers/edge_kernel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "navigation/markers/exposed_kernel.h"
#include "navigation/markers/exposed_loops.h"

namespace arthronaut::markers {
namespace {

constexpr double kDark = 20, kGain = 100;

// By the definition: a step of light, averaged over the box, seen through a Gaussian.
double smeared_step(double distance, double box, double sigma) {
  constexpr int kParts = 64;
  double level = 0;
  for (int i = 0; i < kParts; ++i) {
    const double t = distance + box * ((i + 0.5) / kParts - 0.5);
    level += 0.5 * std::erfc(-t / sigma / std::sqrt(2.0)) / kParts;
  }
  return level;
}

// Dark, dark, bright, dark, or some such: what lies along a profile whose edge is off by so much.
struct Scene {
  float cells[4] = {0, 0, 1, 0};
  float cell_px = 14, box_px = 1, sigma_px = 1.2F;
  double offset = 0, true_box_px = 1, true_sigma_px = 1.2;
  int reach = 6, search = 5;
};

EdgeProfile profile_of(const Scene& scene) {
  EdgeProfile profile;
  profile.reach = scene.reach;
  profile.search = scene.search;
  std::copy(std::begin(scene.cells), std::end(scene.cells), profile.cells);
  profile.cell_px = scene.cell_px;
  profile.box_px = scene.box_px;
  profile.sigma_px = scene.sigma_px;
  const int away = scene.reach + scene.search;
  for (int i = 0; i <= 2 * away; ++i) {
    double level = scene.cells[0];
    for (int edge = 0; edge < 3; ++edge)
      level += (scene.cells[edge + 1] - scene.cells[edge]) *
               smeared_step(i - away - scene.offset - (edge - 1) * scene.cell_px, scene.true_box_px,
                            scene.true_sigma_px);
    profile.light[i] = static_cast<float>(kDark + kGain * level);
  }
  return profile;
}

// As many whole pixels and parts of one as are searched, sharp and smeared over more than a cell.
TEST(EdgeKernel, FindsTheEdgeWhereItIs) {
  for (const float box : {1.0F, 6.0F, 16.0F}) {
    for (const double offset : {-4.3, -1.0, 0.0, 0.26, 2.5, 4.4}) {
      Scene scene;
      scene.box_px = box;
      scene.true_box_px = box;
      scene.reach = box > 10 ? 13 : 8;
      scene.offset = offset;
      EdgeMatch match;
      match_edge(profile_of(scene), match);
      ASSERT_EQ(match.outcome, EdgeMatch::Outcome::Matched) << box << " " << offset;
      EXPECT_NEAR(match.offset, offset, 0.005) << box;
      EXPECT_NEAR(match.gain, kGain, 0.5) << box;
      EXPECT_GT(match.likeness, 0.9999F);
    }
  }
}

// The smear is told from the residuals: each step is short, as gain and bias have explained a part, but they
// lead to the smear that is there.
TEST(EdgeKernel, TellsTheSmearFromWhatIsLeft) {
  Scene scene;
  scene.true_sigma_px = 1.35;
  for (int step = 0; step < 12; ++step) {
    EdgeMatch match;
    match_edge(profile_of(scene), match);
    ASSERT_EQ(match.outcome, EdgeMatch::Outcome::Matched);
    scene.sigma_px += match.sigma_gain / match.sigma_weight;
  }
  EXPECT_NEAR(scene.sigma_px, 1.35, 0.005);
  scene = Scene();
  scene.reach = 9;
  scene.box_px = 6;
  scene.true_box_px = 7;
  for (int step = 0; step < 12; ++step) {
    EdgeMatch match;
    match_edge(profile_of(scene), match);
    ASSERT_EQ(match.outcome, EdgeMatch::Outcome::Matched);
    scene.box_px += match.box_gain / match.box_weight;
  }
  EXPECT_NEAR(scene.box_px, 7, 0.02);
}

TEST(EdgeKernel, LeavesOutWhatIsSaturated) {
  Scene scene;
  scene.offset = 0.3;
  EdgeProfile profile = profile_of(scene);
  for (int i = 16; i < 23; ++i) profile.light[i] = -1;
  EdgeMatch match;
  match_edge(profile, match);
  ASSERT_EQ(match.outcome, EdgeMatch::Outcome::Matched);
  EXPECT_NEAR(match.offset, 0.3, 0.01);
}

TEST(EdgeKernel, SaysWhyNothingWasMatched) {
  EdgeProfile flat = profile_of(Scene());
  for (float& light : flat.light) light = 40;
  EdgeMatch match;
  match_edge(flat, match);
  EXPECT_NE(match.outcome, EdgeMatch::Outcome::Matched);
  Scene far;
  far.offset = 5.4;
  match = EdgeMatch();
  match_edge(profile_of(far), match);
  EXPECT_EQ(match.outcome, EdgeMatch::Outcome::AtTheEnd);
}

// A recording gives the same poses on every machine.
TEST(EdgeKernel, GivesTheSameBitsOnEveryProcessor) {
  if (!processor_has_avx2()) GTEST_SKIP() << "no AVX2 here";
  std::mt19937 random(11);
  std::uniform_real_distribution<float> share(0, 1);
  for (int trial = 0; trial < 500; ++trial) {
    Scene scene;
    for (float& cell : scene.cells) cell = share(random) > 0.5F ? 1 : 0;
    scene.cells[2] = 1 - scene.cells[1];
    scene.cell_px = 6 + 20 * share(random);
    scene.box_px = 1 + 15 * share(random);
    scene.true_box_px = scene.box_px;
    scene.offset = 6 * share(random) - 3;
    scene.reach = 2 + static_cast<int>(14 * share(random));
    scene.search = trial % 3 ? std::min(10, EdgeProfile::kMostReach - scene.reach) : 0;
    EdgeProfile profile = profile_of(scene);
    for (float& light : profile.light) {
      light += 10 * (share(random) - 0.5F);
      if (share(random) > 0.95F) light = -1;
    }
    EdgeMatch plain, wide;
    match_edge(profile, plain);
    match_edge_avx2(profile, wide);
    EXPECT_EQ(std::memcmp(&plain, &wide, sizeof plain), 0) << trial;
  }
}

// What is left out far from an edge changes no bit.
TEST(EdgeKernel, GivesTheSameBitsFarFromAnEdge) {
  const auto are_same = [](const Floats& a, const Floats& b) { return std::memcmp(&a, &b, sizeof a) == 0; };
  for (float first = -20; first < 20; first += 0.25F) {
    for (const float step : {0.1F, 0.8F, 3.0F}) {
      const Floats z = Floats{0, 1, 2, 3, 4, 5, 6, 7} * step + first;
      Floats density, cumulative, density_along, cumulative_along;
      normal_at(z, density, cumulative);
      normal_along(z, density_along, cumulative_along);
      EXPECT_TRUE(are_same(density, density_along) && are_same(cumulative, cumulative_along)) << first;
    }
  }
  std::mt19937 random(5);
  std::uniform_real_distribution<float> share(0, 1);
  for (int trial = 0; trial < 500; ++trial) {
    Floats place{}, scale{};
    for (int lane = 0; lane < 8; ++lane) {
      place[lane] = 1.4F * share(random) - 0.2F;
      scale[lane] = (trial % 2 ? 4.0F : 15.0F) + 10 * share(random);
    }
    Shares shares;
    find_shares(place, scale, shares);
    for (int line = 0; line < 2; ++line) {
      const Floats z = (place - static_cast<float>(line)) * scale;
      Floats density, level;
      normal_at(z, density, level);
      EXPECT_TRUE(are_same(shares.level[line], level)) << trial;
      EXPECT_TRUE(are_same(shares.by_place[line], density * scale)) << trial;
      EXPECT_TRUE(are_same(shares.by_smear[line], -z * density)) << trial;
    }
  }
}

}  // namespace
}  // namespace arthronaut::markers
