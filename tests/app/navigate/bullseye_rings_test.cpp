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

}  // namespace
}  // namespace arthronaut::navigate
