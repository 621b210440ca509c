#include "app/guidance_severity/guidance_severity.h"

#include <gtest/gtest.h>

#include <limits>

namespace arthronaut::guidance_severity {
namespace {

// The signs turn where the header says.
TEST(GuidanceSeverity, FollowTheThresholds) {
  guidance::GuidanceNumbers g;
  g.offset_mm = 0.9;
  g.sigma_offset_mm = 0.4;
  EXPECT_EQ(severity_of_offset(g), widgets::Severity::Good);
  g.sigma_offset_mm = 1.5;  // a small number that nobody knows well is not good
  EXPECT_EQ(severity_of_offset(g), widgets::Severity::Caution);
  g.sigma_offset_mm = 2.5;
  EXPECT_EQ(severity_of_offset(g), widgets::Severity::Bad);
  g.angle_deg = 3;
  EXPECT_EQ(severity_of_angle(g), widgets::Severity::Caution);
}

// A small angle that nobody knows well is not green, as with the offset.
TEST(GuidanceSeverity, Hazard11TheAnglesSeverityTakesItsSigma) {
  guidance::GuidanceNumbers g;
  g.angle_deg = 0.5;
  g.sigma_angle_deg = 0.8;
  EXPECT_EQ(severity_of_angle(g), widgets::Severity::Good);
  g.sigma_angle_deg = 2.5;
  EXPECT_EQ(severity_of_angle(g), widgets::Severity::Caution);
  g.sigma_angle_deg = 4.5;
  EXPECT_EQ(severity_of_angle(g), widgets::Severity::Bad);
  g.sigma_angle_deg = std::numeric_limits<double>::quiet_NaN();  // not known at all
  EXPECT_EQ(severity_of_angle(g), widgets::Severity::Bad);
}

// What remains and what is left to the far side count, whichever is worse.
TEST(GuidanceSeverity, Hazard7TheDrillsSeverityWarnsOfTheFarSide) {
  guidance::DrillDepth drill;
  drill.remaining_mm = 20;
  EXPECT_EQ(severity_of_drill(drill), widgets::Severity::Quiet);
  drill.remaining_mm = 4;
  EXPECT_EQ(severity_of_drill(drill), widgets::Severity::Caution);
  drill.remaining_mm = 1;
  EXPECT_EQ(severity_of_drill(drill), widgets::Severity::Bad);
  drill.remaining_mm = 20;
  drill.breakout = guidance::Breakout::Near;
  EXPECT_EQ(severity_of_drill(drill), widgets::Severity::Caution);
  drill.breakout = guidance::Breakout::Imminent;
  EXPECT_EQ(severity_of_drill(drill), widgets::Severity::Bad);
}

// In words, not by a colour and a shape alone; a drill that is too deep is not told by a minus.
TEST(GuidanceSeverity, Hazard7TheDrillIsWarnedOfInWords) {
  const auto text_at = [](double remaining_mm) {
    guidance::DrillDepth drill;
    drill.remaining_mm = drill.to_exit_mm = remaining_mm;
    drill.breakout = guidance::breakout_of(remaining_mm, 0.4);
    const DrillText text = drill_text(drill);
    return text.name + " " + text.mm;
  };
  EXPECT_EQ(text_at(20), "Remaining 20.0");
  EXPECT_EQ(text_at(5.3), "Exit near 5.3") << "the predicted error counts against the drill";
  EXPECT_EQ(text_at(2.3), "Stop: exit 2.3");
  EXPECT_EQ(text_at(0), "Too deep 0.0");
  EXPECT_EQ(text_at(-1.25), "Too deep 1.2");
}

// The bone may end before the plan does, and beside the plan nothing remains of it.
TEST(GuidanceSeverity, Hazard7ADrillIsWarnedOfWhereItsOwnAxisLeavesTheBone) {
  const auto text_at = [](double remaining_mm, double lateral_mm, double to_exit_mm) {
    guidance::DrillDepth drill;
    drill.remaining_mm = remaining_mm;
    drill.lateral_mm = lateral_mm;
    drill.to_exit_mm = to_exit_mm;
    drill.breakout = guidance::breakout_of(to_exit_mm, 0.4);
    const DrillText text = drill_text(drill);
    return severity_of_drill(drill) == widgets::Severity::Quiet ? "quiet" : text.name + " " + text.mm;
  };
  EXPECT_EQ(text_at(6, 3, 2.1), "Stop: exit 2.1");
  EXPECT_EQ(text_at(4, 3, -0.5), "Out of bone 0.5");
  EXPECT_EQ(text_at(1, 8, 12), "quiet") << "of the plan it is not";
  EXPECT_EQ(text_at(12, 8, 4), "Exit near 4.0");
  EXPECT_EQ(text_at(12, 8, 1.5), "Stop: exit 1.5");
  EXPECT_EQ(text_at(12, 8, -2), "Out of bone 2.0");
  EXPECT_EQ(text_at(12, 8, std::numeric_limits<double>::quiet_NaN()), "quiet") << "nobody knows";
}

// Older records do not say where the drill was: there a length would be of a place that nobody knows.
TEST(GuidanceSeverity, Hazard7NoLengthIsSaidOfADrillThatIsNotAtThePlan) {
  guidance::DrillDepth drill;
  EXPECT_EQ(drill_doubt(drill), "");
  drill.exit_lateral_mm = geometry::kNotKnown;
  EXPECT_EQ(drill_doubt(drill), "");
  drill.lateral_mm = geometry::kNotKnown;
  EXPECT_EQ(drill_doubt(drill), "where it was is not known");
  drill.lateral_mm = 5.1;
  EXPECT_EQ(drill_doubt(drill), "beside the plan");
}

// The parts of the offset in the bone's words, of whichever two directions lie across the plan.
TEST(GuidanceSeverity, Hazard31TheOffsetsPartsAreNamedByTheBonesAxes) {
  guidance::GuidanceNumbers g;
  g.offset_anterior_mm = -1.2;
  g.offset_proximal_mm = 0.4;
  EXPECT_EQ(offset_parts(g).side, "1.2 too posterior");
  EXPECT_EQ(offset_parts(g).up, "0.4 too proximal");
  g.across_plan.up_is = landmarks::AnatomicalDirection::Anterior;
  g.across_plan.side_is = landmarks::AnatomicalDirection::Lateral;
  g.offset_lateral_mm = -2;
  EXPECT_EQ(offset_parts(g).side, "2.0 too medial");
  EXPECT_EQ(offset_parts(g).up, "1.2 too posterior");
  g.offset_anterior_mm = 0.04;
  EXPECT_EQ(offset_parts(g).up, "0.0 anterior") << "of nothing there is not too much";
}

// Markers are called by what they are fixed to; one that is declared nowhere, by its number.
TEST(GuidanceSeverity, NameTheMarkers) {
  const tools::ToolSet tools = tools::standard_tools();
  EXPECT_EQ(marker_name(tools, 0), "Femur marker");
  EXPECT_EQ(marker_name(tools, 1), "Tibia marker");
  EXPECT_EQ(marker_name(tools, 3), "Femoral guide");
  EXPECT_EQ(marker_name(tools, 41), "Marker 41");
}

// One drill needs no name: "Depth" is its own.
TEST(GuidanceSeverity, Hazard7OfSeveralDrillsTheNameIsSaid) {
  tools::ToolSet tools = tools::standard_tools();
  const auto add = [&](const char* name, int marker_id) {
    tools::Tool drill;
    drill.name = name;
    drill.marker_id = marker_id;
    drill.kind = tools::ToolKind::Drill;
    tools.tools.push_back(drill);
  };
  guidance::DrillDepth depth;
  depth.marker_id = 9;
  add("femoral drill", 8);
  EXPECT_EQ(drill_name(tools, depth), "");
  add("tibial drill", 9);
  EXPECT_EQ(drill_name(tools, depth), "Tibial drill");
  depth.marker_id.reset();
  EXPECT_EQ(drill_name(tools, depth), "") << "an older record does not say";
}

}  // namespace
}  // namespace arthronaut::guidance_severity
