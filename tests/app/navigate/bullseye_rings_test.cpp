#include "app/navigate/bullseye_rings.h"

#include <gtest/gtest.h>

#include <array>
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

constexpr float kLetters_px = 50;

float width_for_afar(const std::string& text) { return 26.F * static_cast<float>(text.size()); }

const DirectionNames kOfFemur{"proximal", "distal", "anterior", "posterior"},
    kOfTibia{"anterior", "posterior", "medial", "lateral"};

// In the squares of a second screen and beside the numbers, and in the narrow panels of one screen: no word
// stands in the rings of 1 and 2 mm, by which is aimed at last, in another word or outside the panel.
TEST(TargetWords, LeaveTheMiddleOfTheTarget) {
  for (const ImVec2 panel : {ImVec2{450, 440}, {214, 206}, {214, 162}, {300, 146}})
    for (const DirectionNames& names : {kOfFemur, kOfTibia}) {
      SCOPED_TRACE(panel.y);
      const TargetWords words = words_in_target(panel.y, panel.x, names, kLetters_px, width_for_afar);
      ASSERT_TRUE(words.fits);
      const std::array all{&words.up, &words.down, &words.left, &words.right};
      for (std::size_t i = 0; i < all.size(); ++i) {
        const widgets::Rect& place = all[i]->place;
        SCOPED_TRACE(all[i]->text);
        EXPECT_FALSE(all[i]->text.empty());
        EXPECT_GE(place.x, -panel.x);
        EXPECT_LE(place.x + place.width, panel.x);
        EXPECT_GE(place.y, -panel.y);
        EXPECT_LE(place.y + place.height, panel.y);
        const float dx = std::max({place.x, -place.x - place.width, 0.F}),
                    dy = std::max({place.y, -place.y - place.height, 0.F});
        EXPECT_GE(std::hypot(dx, dy), panel.y * 2 / kShown_mm);
        for (std::size_t k = i + 1; k < all.size(); ++k) {
          const widgets::Rect& other = all[k]->place;
          EXPECT_TRUE(place.x + place.width <= other.x || other.x + other.width <= place.x ||
                      place.y + place.height <= other.y || other.y + other.height <= place.y)
              << all[k]->text;
        }
      }
      EXPECT_LT(words.up.place.y, words.down.place.y);
      EXPECT_LT(words.left.place.x, words.right.place.x);
    }
}

// Letters that leave nothing of the target are not asked for.
TEST(TargetWords, AreTooLargeForASmallOne) {
  EXPECT_FALSE(words_in_target(100, 110, kOfFemur, kLetters_px, width_for_afar).fits);
  EXPECT_FALSE(words_in_target(20, 20, kOfFemur, kLetters_px, width_for_afar).fits);
}

}  // namespace
}  // namespace arthronaut::navigate
