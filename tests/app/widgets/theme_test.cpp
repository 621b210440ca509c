#include "app/widgets/theme.h"

#include <gtest/gtest.h>

#include <cmath>

namespace arthronaut::widgets {
namespace {

// Under what angle capitals of that font are seen at 2 m.
double arc_minutes_of(float font_px, const Screen& screen) {
  const double mm_per_px = screen.diagonal_mm / std::hypot(screen.width_px, screen.height_px);
  return std::atan2(static_cast<double>(font_px) * 0.60 * mm_per_px, 2000.0) * 180 * 60 / 3.14159265358979;
}

// The rule against its definition.
TEST(Theme, LettersForAfarAreSixteenMinutesOfArcAtTwoMetres) {
  for (const Screen& screen :
       {Screen{1920, 1080, 685.8}, Screen{3840, 2160, 685.8}, Screen{1600, 1200, 540}}) {
    EXPECT_NEAR(arc_minutes_of(afar_needed_px(screen), screen), 16, 0.01);
  }
}

// On the usual screen, whatever its lines, what is used is what is needed.
TEST(Theme, TheUsualScreenKeepsTheRule) {
  for (const auto& [width, height] : {std::pair(1920, 1080), {1280, 720}, {3840, 2160}, {1920, 1200}}) {
    const Screen screen{width, height, kUsualDiagonal_mm};
    EXPECT_EQ(afar_px(Screen{width, height}, scale_for(width, height)),
              afar_px(screen, scale_for(width, height)))
        << "of a screen that does not say its size";
    EXPECT_GE(arc_minutes_of(afar_px(screen, scale_for(width, height)), screen), 16) << width;
  }
  // Half as large as usual: a layout of this scale cannot hold letters twice as large, and does not try.
  const Screen small{1920, 1080, kUsualDiagonal_mm / 2};
  EXPECT_FLOAT_EQ(afar_px(small, 1), std::ceil(1.2F * kAfar_px));
  EXPECT_LT(arc_minutes_of(afar_px(small, 1), small), 16);
  // Twice as large: the rule is more than kept.
  const Screen large{1920, 1080, kUsualDiagonal_mm * 2};
  EXPECT_GE(arc_minutes_of(afar_px(large, 1), large), 16);
}

}  // namespace
}  // namespace arthronaut::widgets
