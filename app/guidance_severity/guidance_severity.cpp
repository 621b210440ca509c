#include "app/guidance_severity/guidance_severity.h"

#include <algorithm>
#include <cmath>

namespace arthronaut::guidance_severity {

namespace {

using widgets::Severity;

std::string part(const guidance::GuidanceNumbers& guidance, landmarks::AnatomicalDirection direction) {
  const double value = guidance.offset_in_mm(direction);
  const std::string mm = widgets::fixed(std::abs(value), 1);
  return mm + (mm == "0.0" ? " " : " too ") + std::string(landmarks::to_text(direction, value >= 0));
}

}  // namespace

std::string_view drill_doubt(const guidance::DrillDepth& drill) {
  if (drill.is_at_plan()) return "";
  return drill.is_beside_plan() ? "beside the plan" : "where it was is not known";
}

OffsetParts offset_parts(const guidance::GuidanceNumbers& guidance) {
  return {part(guidance, guidance.across_plan.side_is), part(guidance, guidance.across_plan.up_is)};
}

Severity severity_of(operation::Grade grade) {
  switch (grade) {
    case operation::Grade::None:
      return Severity::Quiet;
    case operation::Grade::Good:
      return Severity::Good;
    case operation::Grade::Caution:
      return Severity::Caution;
    case operation::Grade::Bad:
      return Severity::Bad;
  }
  return Severity::Bad;
}

Severity severity_of_offset(const guidance::GuidanceNumbers& guidance) {
  return severity_of(operation::grades_of(guidance).offset);
}

Severity severity_of_angle(const guidance::GuidanceNumbers& guidance) {
  return severity_of(operation::grades_of(guidance).angle);
}

Severity severity_of_drill(const guidance::DrillDepth& drill) {
  using guidance::Breakout;
  const double left_mm = drill.is_beside_plan() ? drill.to_exit_mm : drill.remaining_mm;
  if (left_mm < 2 || drill.breakout == Breakout::Imminent || drill.breakout == Breakout::Through)
    return Severity::Bad;
  return left_mm < 5 || drill.breakout == Breakout::Near ? Severity::Caution : Severity::Quiet;
}

DrillText drill_text(const guidance::DrillDepth& drill) {
  using guidance::Breakout;
  // Of what remains and the exit that which is nearer; beside the plan nothing remains of it.
  const double exit_mm = drill.to_exit_mm;
  if (drill.breakout == Breakout::Through && (drill.is_beside_plan() || exit_mm < drill.remaining_mm))
    return {"Out of bone", widgets::fixed(std::abs(exit_mm), 1)};
  if (!drill.is_beside_plan() && (drill.breakout == Breakout::Through || drill.remaining_mm < 0))
    return {"Too deep", widgets::fixed(std::abs(drill.remaining_mm), 1)};
  switch (severity_of_drill(drill)) {
    case Severity::Bad:
      return {"Stop: exit", widgets::fixed(exit_mm, 1)};
    case Severity::Caution:
      return {"Exit near", widgets::fixed(exit_mm, 1)};
    default:
      return {"Remaining", widgets::fixed(drill.remaining_mm, 1)};
  }
}

std::string drill_name(const tools::ToolSet& tools, const guidance::DrillDepth& drill) {
  return drill.marker_id && tools.has_several_drills() ? marker_name(tools, *drill.marker_id) : "";
}

std::string marker_name(const tools::ToolSet& tools, int marker_id) {
  for (const tools::WorldMarker& marker : tools.world_markers)
    if (marker.marker_id == marker_id)
      return marker.bone == bones::BoneKind::Femur ? "Femur marker" : "Tibia marker";
  // One of a body's further markers: as the body, and which.
  const auto is_further = [&](const auto& body) {
    return std::any_of(body.markers.begin(), body.markers.end(), [&](const tools::BodyMarker& marker) {
      return marker.marker_id == marker_id && marker_id != body.marker_id;
    });
  };
  const std::string which = " (" + std::to_string(marker_id) + ")";
  for (const tools::WorldMarker& world : tools.world_markers)
    if (is_further(world)) return marker_name(tools, world.marker_id) + which;
  for (const tools::Tool& tool : tools.tools)
    if (is_further(tool)) return marker_name(tools, tool.marker_id) + which;
  for (const tools::Tool& tool : tools.tools) {
    if (tool.marker_id != marker_id || tool.name.empty()) continue;
    std::string name = tool.name;
    if (name.front() >= 'a' && name.front() <= 'z')
      name.front() = static_cast<char>(name.front() - 'a' + 'A');
    return name;
  }
  return "Marker " + std::to_string(marker_id);
}

}  // namespace arthronaut::guidance_severity
