// What a calibration found, taken into the tool of tools.json that it is of, with where it comes from. What
// was found is measured from then on; what was not stays what it was (nominal_parts()).
#pragma once

#include "navigation/tools/pivot_calibration.h"
#include "navigation/tools/spin_calibration.h"
#include "navigation/tools/tool_set.h"

namespace arthronaut::tools {

// Precondition of both: the summary is usable, and in the tool's frame.
void take_tip(Tool& tool, const PivotCalibrationSummary& found, const provenance::Provenance& provenance);
// Turning tells the line, not where on it the guide ends: the end stays as far along as it was declared, and
// the direction's error comes on top there.
void take_axis(Tool& tool, const SpinCalibrationSummary& found, const provenance::Provenance& provenance);

}  // namespace arthronaut::tools
