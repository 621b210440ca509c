// A camera of the kernel's (V4L2) as a source, in a mode that is chosen or wished.
#pragma once

#include <memory>

#include "navigation/sources/camera_modes.h"
#include "navigation/sources/frame_source.h"

namespace arthronaut::sources {

// As open_device(), in the mode that is wished. Throws DeviceError, which names what the camera gives
// instead.
[[nodiscard]] std::unique_ptr<FrameSource> open_camera(const CameraAddress& address);

}  // namespace arthronaut::sources
