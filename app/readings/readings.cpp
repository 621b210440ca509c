#include "app/readings/readings.h"

namespace arthronaut::readings {

double offset_mm(const guidance::GuidanceNumbers& guidance) { return guidance.axis_to_entry_mm; }

widgets::Sign sign_of_offset(const guidance::GuidanceNumbers& guidance) {
  if (guidance.sigma_offset_mm > 2) return widgets::Sign::Bad;
  if (guidance.axis_to_entry_mm < 1 && guidance.sigma_offset_mm < 1) return widgets::Sign::Good;
  return guidance.axis_to_entry_mm < 2 ? widgets::Sign::Caution : widgets::Sign::Bad;
}

widgets::Sign sign_of_angle(const guidance::GuidanceNumbers& guidance) {
  if (guidance.angle_deg < 2) return widgets::Sign::Good;
  return guidance.angle_deg < 4 ? widgets::Sign::Caution : widgets::Sign::Bad;
}

widgets::Sign sign_of_remaining(const guidance::GuidanceNumbers& guidance) {
  if (guidance.remaining_mm < 2) return widgets::Sign::Bad;
  return guidance.remaining_mm < 5 ? widgets::Sign::Caution : widgets::Sign::Quiet;
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

}  // namespace arthronaut::readings
