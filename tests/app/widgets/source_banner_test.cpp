#include "app/widgets/source_banner.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace arthronaut::widgets {
namespace {

using sources::SourceKind;

// Three kinds, three words, three colours.
TEST(SourceBannerHazard2, NamesEachKind) {
  EXPECT_EQ(banner_word(SourceKind::Live), "LIVE");
  EXPECT_EQ(banner_word(SourceKind::Recording), "RECORDING");
  EXPECT_EQ(banner_word(SourceKind::Simulation), "SIMULATION");
  EXPECT_EQ(std::set<ImU32>({banner_color(SourceKind::Live), banner_color(SourceKind::Recording),
                             banner_color(SourceKind::Simulation)})
                .size(),
            3U);
}

// The rule of theme.h in numbers: the capitals of what is meant for the room are 16' high and more at 2 m on
// 27 inches (16 : 9) with 1080 lines.
TEST(SourceBannerHazard2, IsReadableAtTwoMetres) {
  const double screen_height_mm = 27 * 25.4 * 9 / std::hypot(16, 9);
  const double capitals_mm = kCapitalsOfSize * kAfar_px * screen_height_mm / 1080;
  const double minutes_of_arc = std::atan(capitals_mm / 2000) * 180 / 3.14159265 * 60;
  EXPECT_GE(minutes_of_arc, 16);
}

}  // namespace
}  // namespace arthronaut::widgets
