#include "navigation/tools/measured_part.h"

#include <cmath>

namespace arthronaut::tools {

void take_tip(Tool& tool, const PivotCalibrationSummary& found, const provenance::Provenance& provenance) {
  tool.nominal = nominal_parts(tool);  // before the origin changes, which they follow from
  tool.nominal.tip = false;
  tool.tip_mm = found.tip_in_tool_mm;
  tool.tip_covariance_mm2 = found.tip_error_mm2();
  tool.residual_mm = found.rms_mm;
  tool.provenance = provenance;
}

void take_axis(Tool& tool, const SpinCalibrationSummary& found, const provenance::Provenance& provenance) {
  tool.nominal = nominal_parts(tool);
  tool.nominal.axis = false;
  const Eigen::Vector3d& direction = found.axis_direction_in_tool;
  const double along_mm = tool.axis ? (tool.axis->point_mm - found.axis_point_in_tool_mm).dot(direction) : 0;
  tool.axis = ToolAxis{found.axis_point_in_tool_mm + along_mm * direction, direction};
  tool.axis_direction_sigma_deg = found.direction_sigma_deg;
  tool.axis_point_sigma_mm =
      std::hypot(found.point_sigma_mm, along_mm * geometry::rad_from_deg(found.direction_sigma_deg));
  tool.residual_mm = found.rms_mm;
  tool.provenance = provenance;
}

}  // namespace arthronaut::tools
