#include "app/review/ct_beside.h"

#include <gtest/gtest.h>

#include <cmath>

#include "app/review/slice_letters.h"

namespace arthronaut::review {
namespace {

using widgets::Severity;

tunnels::Tunnel planned() {
  return {.entry_mm = {1, 2, 3}, .direction = Eigen::Vector3d::UnitZ(), .diameter_mm = 9};
}

// A tunnel 3 mm and 4 degrees off, by a CT that is relied on.
postop::Comparison found() {
  postop::Comparison comparison;
  comparison.bone.is_found = comparison.bone.reliable = true;
  comparison.bone.reasons.clear();
  postop::AchievedTunnel& tunnel = comparison.tunnel;
  tunnel.is_found = tunnel.reliable = true;
  tunnel.reasons.clear();
  tunnel.angle_rad = 4 * EIGEN_PI / 180;
  tunnel.tunnel = {.entry_mm = {4, 2, 3},
                   .direction = Eigen::Vector3d(std::sin(tunnel.angle_rad), 0, std::cos(tunnel.angle_rad)),
                   .diameter_mm = 9};
  tunnel.offset_mm = 3;
  return comparison;
}

TEST(CtBeside, SaysWhatTheCtShowsOfThisPlanAlone) {
  EXPECT_EQ(ct_in_words(found(), planned()).text, "offset of the entry 3.0 mm, angle 4.0\u00B0");
  EXPECT_EQ(ct_in_words(found(), planned()).severity, Severity::Quiet);
  tunnels::Tunnel another = planned();
  another.entry_mm.x() += 1;
  EXPECT_EQ(ct_in_words(found(), another).text, "compared with another plan than this");
}

TEST(CtBeside, IsNeverSurerThanTheComparison) {
  postop::Comparison doubted = found();
  doubted.tunnel.reliable = false;
  doubted.tunnel.reasons = {"metal fills it"};
  EXPECT_EQ(ct_in_words(doubted, planned()).text,
            "offset of the entry 3.0 mm, angle 4.0\u00B0; not reliable: metal fills it");
  EXPECT_EQ(ct_in_words(doubted, planned()).severity, Severity::Caution);
  // These words are of entry and direction: that it is not known how wide it is is no matter here.
  using enum tunnels::Quantity;
  doubted.tunnel.known = {Entry, Direction, Length};
  EXPECT_EQ(ct_in_words(doubted, planned()).text, ct_in_words(found(), planned()).text);
  EXPECT_EQ(ct_in_words(doubted, planned()).severity, Severity::Quiet);
  doubted.tunnel.known = {Entry};
  EXPECT_EQ(
      ct_in_words(doubted, planned()).text,
      "offset of the entry 3.0 mm, angle 4.0\u00B0; reliable in part, entry; not the direction, diameter "
      "and length: metal fills it");
  EXPECT_EQ(ct_in_words(doubted, planned()).severity, Severity::Caution);
  doubted.tunnel.is_found = false;
  EXPECT_EQ(ct_in_words(doubted, planned()).text, "the tunnel was not found: metal fills it");
}

// A coronal slice as it is hung: the patient's right on the left, the head above.
TEST(SliceLetters, NameTheBorders) {
  const scene::SlicePlane coronal{{0, 0, 0}, Eigen::Vector3d::UnitX(), -Eigen::Vector3d::UnitZ(), 0.5};
  EXPECT_EQ(side_letters(coronal), (std::array<std::string, 4>{"R", "L", "H", "F"}));
}

}  // namespace
}  // namespace arthronaut::review
