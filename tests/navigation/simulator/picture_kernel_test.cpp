#include "navigation/simulator/picture_kernel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace arthronaut::simulator {
namespace {

constexpr int kCount = 64;

struct Numbers {
  explicit Numbers(unsigned seed) : random(seed) {}
  std::vector<float> between(float low, float high, std::size_t count = kCount) {
    std::uniform_real_distribution<float> uniform(low, high);
    std::vector<float> values(count);
    for (float& value : values) value = uniform(random);
    return values;
  }
  std::mt19937 random;
};

// Everything that a kernel draws from the same numbers, one after the other.
std::vector<float> drawn_by(const PictureKernel& kernel, unsigned seed) {
  Numbers numbers(seed);
  std::vector<float> all;
  const auto keep = [&all](const auto& values) {
    for (const auto value : values) all.push_back(static_cast<float>(value));
  };
  const auto x = numbers.between(-0.5f, 0.5f), y = numbers.between(-0.5f, 0.5f);
  const auto ground = numbers.between(15, 60);
  const RayRow rays{x.data(), y.data(), ground.data()};
  std::vector<float> depth(kCount, 1e9f), normal[3];
  for (auto& axis : normal) axis.assign(kCount, 0.1f);
  std::vector<std::int32_t> part(kCount, 0);
  const MetRow met{depth.data(), part.data(), {normal[0].data(), normal[1].data(), normal[2].data()}};
  const float c = std::cos(0.4f), s = std::sin(0.4f);
  PrintNumbers print;
  print.cells_per_mm = 1.5f;
  print.count = 6;
  for (std::int32_t& word : print.words) word = static_cast<std::int32_t>(numbers.random());
  PlateNumbers plate{.axes = {{1, 0, 0}, {0, -c, s}, {0, -s, -c}},
                     .origin_mm = {0.3f, -2, 20},
                     .half_size_mm = {3, 3},
                     .thickness_mm = 2,
                     .tick_spacing_mm = 1,
                     .prints = &print,
                     .print_count = 1};
  BoardNumbers board{
      .axes = {{1, 0, 0}, {0, -c, s}, {0, -s, -c}}, .origin_mm = {0, 0, 40}, .square_mm = 1.5f};
  const RodNumbers rod{.from_mm = {-4, 1, 25}, .along = {0.8f, 0, 0.6f}, .radius_mm = 2, .length_mm = 9};
  kernel.meet_board(board, rays, kCount, 10, met);
  kernel.meet_plate(plate, rays, kCount, 1, met);
  plate.is_round = true;
  plate.origin_mm[0] = 5;
  kernel.meet_plate(plate, rays, kCount, 4, met);
  kernel.meet_rod(rod, rays, kCount, 7, met);
  keep(part);
  keep(depth);
  for (const auto& axis : normal) keep(axis);
  for (int i = 0; i + 2 * kTogether < kCount; i += kTogether) {
    PartCount counts[3];
    const int found = kernel.count_parts(part.data(), kCount - i, 3, counts);
    for (int k = 0; k < found; ++k)
      keep(std::vector<int>{counts[k].part, counts[k].first_sample, counts[k].count});
    const Seams seams = kernel.seams(part.data() + i, part.data() + i + kTogether);
    keep(std::vector<std::uint32_t>{seams.is_seam, seams.is_face});
  }
  std::vector<PartLook> looks(13);
  for (std::size_t i = 0; i < looks.size(); ++i)
    looks[i] = {{0.1f, 0.2f, 0.05f * static_cast<float>(i)}, 0.5f, static_cast<int>(i % 7)};
  std::vector<float> bgr(3 * kCount);
  kernel.light_parts(looks.data(), rays, kCount, met, 300, bgr.data());
  keep(bgr);
  kernel.light_backdrop(rays, kCount, 300, bgr.data());
  keep(bgr);
  std::vector<float> sample_x(kCount), sample_y(kCount), sample_ground(kCount);
  const PixelRays pixel{{0.1f, -0.2f}, {0.0011f, 0.0002f}, {-0.0001f, 0.0012f}};
  kernel.begin_samples(pixel, {x.data(), y.data()}, kCount, 21, 1e9f, sample_x.data(), sample_y.data(),
                       sample_ground.data(), met);
  for (const auto* values : {&sample_x, &sample_y, &sample_ground, &depth}) keep(*values);
  keep(part);

  std::vector<std::int32_t> triangles(kCount, -1);
  depth = numbers.between(10, 40);
  kernel.draw_triangle({7, -0.2f, 0.02f, 0.9f, -0.01f, 20, 1, -2}, 3, 59, depth.data(), triangles.data());
  keep(triangles);
  keep(depth);
  const auto lattice = numbers.between(-1, 1, kLatticeFloats);
  std::vector<std::vector<float>> noise(8, std::vector<float>(kCount));
  const auto at = numbers.between(-80, 80);
  for (const std::size_t first : {0, 4})
    kernel.noise_at(
        lattice.data(), {at.data(), x.data(), y.data()}, first == 0 ? 2.2f : 0.4f, kCount,
        {noise[first].data(), noise[first + 1].data(), noise[first + 2].data(), noise[first + 3].data()});
  for (const auto& values : noise) keep(values);
  BoneAttributes attributes;
  std::vector<std::vector<float>> values;
  for (int k = 0; k < BoneAttributes::kCount; ++k) values.push_back(numbers.between(0.1f, k < 3 ? 30 : 1));
  for (std::size_t k = 0; k < values.size(); ++k) attributes.at[k] = values[k].data();
  kernel.light_bone(attributes, {noise[0].data(), noise[1].data(), noise[2].data(), noise[3].data()},
                    {noise[4].data(), noise[5].data(), noise[6].data(), noise[7].data()}, kCount, 300,
                    bgr.data());
  keep(bgr);
  const auto low = numbers.between(19, 20, kCount), high = numbers.between(20, 20.3f, kCount);
  std::vector<int> columns(kCount, 0);
  depth = numbers.between(19.8f, 20.2f, 2 * kCount);
  all.push_back(static_cast<float>(
      kernel.list_breaks(depth.data(), low.data(), high.data(), 1.02f, 5, 49, columns.data())));
  keep(columns);

  const auto light = numbers.between(0, 1.2f, 7 * kCount);
  const float weights[kBlurReach + 1] = {0.4f, 0.24f, 0.054f, 0.0044f};
  std::vector<float> across(kCount + 18, 0.3f), along(kCount);
  const float* in = light.data();
  kernel.blur_across({in, in + 64, in + 128, in + 192, in + 256, in + 320, in + 384}, weights, kCount,
                     across.data() + 9);
  kernel.blur_along(across.data() + 9, weights, kCount, along.data());
  keep(along);
  const auto deviates = numbers.between(-3, 3);
  std::vector<std::uint8_t> grey(kCount);
  kernel.expose({4, 0.02f}, along.data(), deviates.data(), kCount, grey.data());
  keep(grey);
  return all;
}

// A simulation gives the same pictures on every machine.
TEST(PictureKernel, DrawsTheSameBitsOnEveryProcessor) {
  if (!draws_by_avx2()) GTEST_SKIP() << "no AVX2 here";
  for (unsigned seed = 0; seed < 20; ++seed)
    EXPECT_EQ(drawn_by(plain_picture_kernel(), seed), drawn_by(avx2_picture_kernel(), seed)) << seed;
}

// Parts in the order in which they were met, up to the last sample and to as many as there is room for.
TEST(PictureKernel, CountsTheSamplesOfEachPart) {
  std::vector<std::int32_t> parts(PictureKernel::kMostSamples, 9);
  const std::vector<std::int32_t> met{0, 4, 4, 0, 2, 4, 2, 2, 2, 7, 0, 4};
  std::copy(met.begin(), met.end(), parts.begin());
  for (const PictureKernel* kernel : {&plain_picture_kernel(), &picture_kernel()}) {
    PartCount counts[4];
    ASSERT_EQ(kernel->count_parts(parts.data(), 12, 4, counts), 3);
    const PartCount expected[] = {{4, 1, 4}, {2, 4, 4}, {7, 9, 1}};
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(counts[k].part, expected[k].part);
      EXPECT_EQ(counts[k].first_sample, expected[k].first_sample);
      EXPECT_EQ(counts[k].count, expected[k].count);
    }
    EXPECT_EQ(kernel->count_parts(parts.data(), 12, 2, counts), 2);
    EXPECT_EQ(kernel->count_parts(parts.data(), 1, 4, counts), 0);
    ASSERT_EQ(kernel->count_parts(parts.data(), PictureKernel::kMostSamples, 4, counts), 4);
    EXPECT_EQ(counts[3].count, PictureKernel::kMostSamples - 12);
  }
}

// A pixel of nothing is neither; one whose corners differ anywhere is a seam.
TEST(PictureKernel, TellsSeamsFromFaces) {
  const std::vector<std::int32_t> upper{0, 0, 3, 3, 3, 5, 5, 5, 5}, lower{0, 0, 3, 3, 3, 5, 5, 6, 5};
  for (const PictureKernel* kernel : {&plain_picture_kernel(), &picture_kernel()}) {
    const Seams seams = kernel->seams(upper.data(), lower.data());
    EXPECT_EQ(seams.is_seam, 0b11010010U);
    EXPECT_EQ(seams.is_face, 0b00101100U);
  }
}

// Noise is the lattice's own at its nodes, between its neighbours elsewhere, and goes on beyond its end.
TEST(PictureKernel, TakesNoiseBetweenNodes) {
  Numbers numbers(1);
  auto lattice = numbers.between(-1, 1, kLatticeFloats);
  constexpr std::size_t kRow = 4 * (kLattice + 1);
  for (std::size_t row = 0; row < kLattice * kLattice; ++row)
    for (std::size_t c = 0; c < 4; ++c) lattice[kRow * row + 4 * kLattice + c] = lattice[kRow * row + c];
  const auto node = [&](int x, int y, int z, std::size_t c) {
    const auto wrapped = [](int i) { return static_cast<std::size_t>(i & (kLattice - 1)); };
    return lattice[kRow * (kLattice * wrapped(z) + wrapped(y)) + 4 * wrapped(x) + c];
  };
  const std::vector<float> x{0, 3, 31.5f, -1, -0.5f, 5, 40, 7}, y{0, -7, 2, 33, 1, 5.5f, 8, 31},
      z{0, 2, 9, -32, 4, 1, -5.5f, 31};
  std::vector<std::vector<float>> values(4, std::vector<float>(kTogether));
  picture_kernel().noise_at(lattice.data(), {x.data(), y.data(), z.data()}, 1, kTogether,
                            {values[0].data(), values[1].data(), values[2].data(), values[3].data()});
  for (std::size_t c = 0; c < 4; ++c) {
    EXPECT_FLOAT_EQ(values[c][0], node(0, 0, 0, c));
    EXPECT_FLOAT_EQ(values[c][1], node(3, -7, 2, c));
    EXPECT_NEAR(values[c][2], 0.5f * (node(31, 2, 9, c) + node(0, 2, 9, c)), 1e-6f);
    EXPECT_FLOAT_EQ(values[c][3], node(-1, 33, -32, c));
    EXPECT_NEAR(values[c][4], 0.5f * (node(-1, 1, 4, c) + node(0, 1, 4, c)), 1e-6f);
    EXPECT_NEAR(values[c][5], 0.5f * (node(5, 5, 1, c) + node(5, 6, 1, c)), 1e-6f);
    EXPECT_NEAR(values[c][6], 0.5f * (node(40, 8, -6, c) + node(40, 8, -5, c)), 1e-6f);
    EXPECT_FLOAT_EQ(values[c][7], node(7, 31, 31, c));
  }
}

}  // namespace
}  // namespace arthronaut::simulator
