#include "app/guidance_severity/guidance_severity.h"

#include <gtest/gtest.h>

namespace arthronaut::guidance_severity {
namespace {

// The signs turn where the header says.
TEST(Readings, FollowTheThresholds) {
  guidance::GuidanceNumbers g;
  g.axis_to_entry_mm = 0.9;
  g.sigma_offset_mm = 0.4;
  EXPECT_EQ(severity_of_offset(g), widgets::Severity::Good);
  g.sigma_offset_mm = 1.5;  // a small number that nobody knows well is not good
  EXPECT_EQ(severity_of_offset(g), widgets::Severity::Caution);
  g.sigma_offset_mm = 2.5;
  EXPECT_EQ(severity_of_offset(g), widgets::Severity::Bad);
  g.angle_deg = 3;
  EXPECT_EQ(severity_of_angle(g), widgets::Severity::Caution);
  g.remaining_mm = 1;
  EXPECT_EQ(severity_of_remaining(g), widgets::Severity::Bad);
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
}  // namespace arthronaut::guidance_severity
