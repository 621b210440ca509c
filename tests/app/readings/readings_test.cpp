#include "app/readings/readings.h"

#include <gtest/gtest.h>

namespace arthronaut::readings {
namespace {

// The signs turn where the header says.
TEST(Readings, FollowTheThresholds) {
  guidance::GuidanceNumbers g;
  g.axis_to_entry_mm = 0.9;
  g.sigma_offset_mm = 0.4;
  EXPECT_EQ(sign_of_offset(g), widgets::Sign::Good);
  g.sigma_offset_mm = 1.5;  // a small number that nobody knows well is not good
  EXPECT_EQ(sign_of_offset(g), widgets::Sign::Caution);
  g.sigma_offset_mm = 2.5;
  EXPECT_EQ(sign_of_offset(g), widgets::Sign::Bad);
  g.angle_deg = 3;
  EXPECT_EQ(sign_of_angle(g), widgets::Sign::Caution);
  g.remaining_mm = 1;
  EXPECT_EQ(sign_of_remaining(g), widgets::Sign::Bad);
}

// Markers are called by what they are fixed to; one that is declared nowhere, by its number.
TEST(Readings, NameTheMarkers) {
  const tools::ToolSet tools = tools::standard_tools();
  EXPECT_EQ(marker_name(tools, 0), "Femur marker");
  EXPECT_EQ(marker_name(tools, 1), "Tibia marker");
  EXPECT_EQ(marker_name(tools, 3), "Femoral guide");
  EXPECT_EQ(marker_name(tools, 41), "Marker 41");
}

}  // namespace
}  // namespace arthronaut::readings
