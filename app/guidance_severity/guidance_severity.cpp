#include "app/guidance_severity/guidance_severity.h"

namespace arthronaut::guidance_severity {

double offset_mm(const guidance::GuidanceNumbers& guidance) { return guidance.axis_to_entry_mm; }

widgets::Severity severity_of_offset(const guidance::GuidanceNumbers& guidance) {
  if (guidance.sigma_offset_mm > 2) return widgets::Severity::Bad;
  if (guidance.axis_to_entry_mm < 1 && guidance.sigma_offset_mm < 1) return widgets::Severity::Good;
  return guidance.axis_to_entry_mm < 2 ? widgets::Severity::Caution : widgets::Severity::Bad;
}

widgets::Severity severity_of_angle(const guidance::GuidanceNumbers& guidance) {
  if (guidance.angle_deg < 2) return widgets::Severity::Good;
  return guidance.angle_deg < 4 ? widgets::Severity::Caution : widgets::Severity::Bad;
}

widgets::Severity severity_of_remaining(const guidance::GuidanceNumbers& guidance) {
  if (guidance.remaining_mm < 2) return widgets::Severity::Bad;
  return guidance.remaining_mm < 5 ? widgets::Severity::Caution : widgets::Severity::Quiet;
}

std::string marker_name(const tools::ToolSet& tools, int marker_id) {
  for (const tools::WorldMarker& marker : tools.world_markers)
    if (marker.marker_id == marker_id)
      return marker.bone == bones::BoneKind::Femur ? "Femur marker" : "Tibia marker";
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
