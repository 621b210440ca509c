#include "navigation/simulator/picture_faults.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace arthronaut::simulator {
namespace {

camera::Frame grey_picture(std::uint8_t level = 128) {
  camera::Frame frame;
  frame.width = 160;
  frame.height = 90;
  frame.bgr.assign(3U * 160 * 90, level);
  frame.luma.assign(160U * 90, level);
  return frame;
}

double mean_of(const camera::Frame& frame, std::size_t channel) {
  double sum = 0;
  for (std::size_t i = channel; i < frame.bgr.size(); i += 3) sum += frame.bgr[i];
  return 3 * sum / static_cast<double>(frame.bgr.size());
}

// Blood takes blue and green before red; more of it takes more; none of it changes nothing.
TEST(PictureFaults, BleedingIsRed) {
  const camera::Frame clear = grey_picture();
  camera::Frame none = clear, some = clear, much = clear;
  add_bleeding(none, 1, 2, 0);
  EXPECT_EQ(none.bgr, clear.bgr);
  add_bleeding(some, 1, 2, 0.3);
  add_bleeding(much, 1, 2, 0.9);
  EXPECT_LT(mean_of(some, 0), mean_of(clear, 0) - 1);
  EXPECT_LT(mean_of(much, 0), mean_of(some, 0) - 1);
  EXPECT_GT(mean_of(much, 2), mean_of(much, 0) + 1);
  EXPECT_TRUE(much.luma.empty());  // of before
}

// It stays inside the field stop: what is black is not lit by it.
TEST(PictureFaults, BleedingLightsNothing) {
  camera::Frame dark = grey_picture(3);
  const camera::Frame before = dark;
  add_bleeding(dark, 1, 2, 1);
  EXPECT_EQ(dark.bgr, before.bgr);
}

TEST(PictureFaults, GlareSaturates) {
  camera::Frame frame = grey_picture();
  add_glare(frame, 4, 1, 0.6);
  EXPECT_EQ(*std::max_element(frame.bgr.begin(), frame.bgr.end()), 255);
  EXPECT_EQ(*std::min_element(frame.bgr.begin(), frame.bgr.end()), 128);  // it darkens nothing
}

TEST(PictureFaults, BlackIsBlack) {
  camera::Frame frame = grey_picture();
  black_out(frame, 4);
  EXPECT_LT(*std::max_element(frame.bgr.begin(), frame.bgr.end()), 8);
}

// The same for a seed and a time, another one for another time.
TEST(PictureFaults, AreDeterministic) {
  camera::Frame a = grey_picture(), b = grey_picture(), later = grey_picture();
  add_bleeding(a, 9, 1, 0.7);
  add_bleeding(b, 9, 1, 0.7);
  add_bleeding(later, 9, 3, 0.7);
  EXPECT_EQ(a.bgr, b.bgr);
  EXPECT_NE(a.bgr, later.bgr);
}

}  // namespace
}  // namespace arthronaut::simulator
