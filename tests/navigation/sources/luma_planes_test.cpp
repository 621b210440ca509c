#include "navigation/sources/luma_planes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace arthronaut::sources {
namespace {

// Every step from 16 to 235 becomes what the standard says, rounded, and what lies outside is cut off.
TEST(LumaPlane, StretchesToAllSteps) {
  std::vector<std::uint8_t> sent(256), luma;
  for (int i = 0; i < 256; ++i) sent[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(i);
  const LumaPlane plane{.data = sent.data(), .stride = 256, .width = 256, .height = 1};
  plane.write(luma);
  for (int i = 0; i < 256; ++i) {
    const double exact = std::clamp((i - 16) * 255.0 / 219, 0.0, 255.0);
    EXPECT_NEAR(luma[static_cast<std::size_t>(i)], exact, 0.6) << i;
  }
  EXPECT_EQ(plane.in_place().data, nullptr);
}

// Many samples at a time and the few at a row's end are brought to the same, of planar and packed rows alike,
// and no byte after a row's last sample is looked at or written.
TEST(LumaPlane, IsTheSameWhereverInARowItStands) {
  std::vector<std::uint8_t> all(256), by_value;
  for (int i = 0; i < 256; ++i) all[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(i);
  for (const std::uint8_t& value : all) {
    std::vector<std::uint8_t> one;
    LumaPlane{.data = &value, .stride = 1, .width = 1, .height = 1}.write(one);
    by_value.push_back(one.front());
  }
  for (const int step : {1, 2})
    for (const int width : {1, 31, 32, 33, 63, 64, 65, 200}) {
      std::vector<std::uint8_t> sent(static_cast<std::size_t>(2 * step * width - (step - 1)), 7), wanted,
          luma;
      for (int i = 0; i < 2 * width; ++i) {
        const auto value = static_cast<std::uint8_t>(i * 37);
        sent[static_cast<std::size_t>(i * step)] = value;
        wanted.push_back(by_value[value]);
      }
      // To its last byte: the address sanitizer says if one after it is read.
      sent.shrink_to_fit();
      LumaPlane{.data = sent.data(), .stride = width * step, .step = step, .width = width, .height = 2}.write(
          luma);
      EXPECT_EQ(luma, wanted) << step << ", " << width;
    }
}

// Looked at where it is, rows apart as the driver has them.
TEST(LumaPlane, IsLeftWhereItIsWhenNothingIsToBeDone) {
  const std::vector<std::uint8_t> sent{1, 2, 0, 3, 4, 0};
  const LumaPlane plane{.data = sent.data(), .stride = 3, .is_full_range = true, .width = 2, .height = 2};
  EXPECT_EQ(plane.in_place().data, sent.data());
  EXPECT_EQ(plane.in_place().row(1)[1], 4);
}

// YUYV and UYVY: every second byte. P010: ten bits at the upper end of two bytes; I010: at the lower end.
TEST(LumaPlane, TakesWhatIsPackedAndWhatHasMoreBits) {
  std::vector<std::uint8_t> luma;
  const std::vector<std::uint8_t> yuyv{10, 99, 20, 98, 30, 97, 40, 96};
  LumaPlane{.data = yuyv.data(), .stride = 8, .step = 2, .is_full_range = true, .width = 4, .height = 1}
      .write(luma);
  EXPECT_EQ(luma, (std::vector<std::uint8_t>{10, 20, 30, 40}));
  LumaPlane{.data = yuyv.data() + 1, .stride = 8, .step = 2, .is_full_range = true, .width = 4, .height = 1}
      .write(luma);
  EXPECT_EQ(luma, (std::vector<std::uint8_t>{99, 98, 97, 96}));
  const std::vector<std::uint8_t> p010{0xC0, 0x7F, 0x00, 0x80};  // 511 and 512 of 1023
  LumaPlane{.data = p010.data(),
            .stride = 4,
            .step = 2,
            .bits = 10,
            .shift = 6,
            .is_full_range = true,
            .width = 2,
            .height = 1}
      .write(luma);
  EXPECT_EQ(luma, (std::vector<std::uint8_t>{127, 128}));
  const std::vector<std::uint8_t> i010{0xFF, 0x01, 0x00, 0x02};
  LumaPlane{
      .data = i010.data(), .stride = 4, .step = 2, .bits = 10, .is_full_range = true, .width = 2, .height = 1}
      .write(luma);
  EXPECT_EQ(luma, (std::vector<std::uint8_t>{127, 128}));
}

}  // namespace
}  // namespace arthronaut::sources
