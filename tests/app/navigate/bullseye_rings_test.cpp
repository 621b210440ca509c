#include "app/navigate/bullseye_rings.h"

#include <gtest/gtest.h>

#include <cmath>

namespace arthronaut::navigate {
namespace {

constexpr float kLine_px = 20, kGap_px = 4;

float width_of(const std::string& text) { return 10.F * static_cast<float>(text.size()); }

// Whatever the size, a label lies inside its ring, and so clear of what is drawn along the rim; no two lie in
// each other.
TEST(BullseyeRings, EveryLabelLiesInsideItsRing) {
  for (float radius = 20; radius < 500; radius += 7) {
    SCOPED_TRACE(radius);
    const auto labels = ring_labels(radius, kLine_px, kGap_px, width_of);
    for (std::size_t i = 0; i < labels.size(); ++i) {
      const widgets::Rect& at = labels[i].place;
      const float ring = radius * std::stof(labels[i].text) / static_cast<float>(kShown_mm);
      EXPECT_LT(std::hypot(at.x + at.width, at.y + at.height), ring) << labels[i].text;
      EXPECT_GT(at.x, 0) << labels[i].text;
      EXPECT_GT(at.y, 0) << labels[i].text;
      if (i > 0) {
        EXPECT_LT(at.x + at.width, labels[i - 1].place.x) << labels[i].text;
      }
    }
  }
}

// The unit stands once, on the outer ring; a large bullseye names all three.
TEST(BullseyeRings, TheOuterOneBearsTheUnit) {
  const auto labels = ring_labels(400, kLine_px, kGap_px, width_of);
  ASSERT_EQ(labels.size(), 3U);
  EXPECT_EQ(labels[0].text, "5 mm");
  EXPECT_EQ(labels[1].text, "2");
  EXPECT_EQ(labels[2].text, "1");
}

// A guide at the rim that leans 11 degrees inwards has its whole tail, and one that leans outwards what the
// panel has room for: a tail that is gone says that there is no tilt.
TEST(TailEnd, IsCutByThePanelAlone) {
  const auto expect_end = [](const ImVec2& from, const ImVec2& lean, const ImVec2& expected) {
    const ImVec2 end = tail_end(from, lean, {80, 70});
    EXPECT_NEAR(end.x, expected.x, 1e-4);
    EXPECT_NEAR(end.y, expected.y, 1e-4);
  };
  expect_end({60, 0}, {-110, 0}, {-50, 0});
  expect_end({60, 0}, {110, 0}, {80, 0});
  expect_end({0, -60}, {40, -40}, {10, -70});
  expect_end({10, 20}, {0, 0}, {10, 20});
  expect_end({90, 0}, {10, 0}, {90, 0});  // beyond it already
}

}  // namespace
}  // namespace arthronaut::navigate
