// The taking of calibration pictures as it is seen: the picture with the corners that were found in it, what
// is wanted or wrong, how good it is beside the limits, and which way the lens stood. Of a scope in Set up,
// of the simulated one in Training, which the window hands it.
#pragma once

#include "app/setup/calibrate_display.h"
#include "app/setup/setup_panels.h"

namespace arthronaut::setup {

// Returned: what is left free below the lens's dial, free_px high.
[[nodiscard]] widgets::Rect draw_capture(const widgets::Ui& ui, const widgets::Rect& area,
                                         widgets::VideoTexture& texture, const CalibrateStatus& job,
                                         const CalibrateDisplay& display, float free_px);
// The same of pictures that are made as they are looked at, and are thus always of now.
[[nodiscard]] widgets::Rect draw_exercise(const widgets::Ui& ui, const widgets::Rect& area,
                                          widgets::VideoTexture& texture, const CalibrateStatus& job,
                                          float free_px);

}  // namespace arthronaut::setup
