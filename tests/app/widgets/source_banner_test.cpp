#include "app/widgets/source_banner.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace arthronaut::widgets {
namespace {

using sources::SourceKind;

// Three kinds, three words, three colours.
TEST(SourceBannerHazard2, NamesEachKind) {
  EXPECT_EQ(banner_word(SourceKind::Live, true), "LIVE");
  EXPECT_EQ(banner_word(SourceKind::Recording, true), "RECORDING");
  EXPECT_EQ(banner_word(SourceKind::Simulation, true), "SIMULATION");
  EXPECT_EQ(std::set<ImU32>({banner_color(SourceKind::Live, true), banner_color(SourceKind::Recording, true),
                             banner_color(SourceKind::Simulation, true)})
                .size(),
            3U);
}

// The last picture of a camera that has ended, or gives none, is not live, and is not called so; the others
// never were.
TEST(SourceBannerHazard2, WhatIsNotOfNowIsNotCalledLive) {
  EXPECT_EQ(banner_word(SourceKind::Live, false), "NOT LIVE");
  EXPECT_NE(banner_color(SourceKind::Live, false), banner_color(SourceKind::Live, true));
  for (const SourceKind kind : {SourceKind::Recording, SourceKind::Simulation})
    EXPECT_EQ(banner_word(kind, false), banner_word(kind, true));
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
