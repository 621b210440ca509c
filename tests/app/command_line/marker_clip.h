// A short video of markers that face a plain pinhole camera: every pose is known from where the marker was
// drawn.
#pragma once

#include <string>

#include "tests/app/command_line/program.h"
#include "tests/temporary_folder.h"

namespace arthronaut::test {

inline constexpr int kClipFrames = 24;
inline constexpr double kClipFocalPx = 400, kClipMarkerPx = 84, kClipMarkerMm = 4;
inline constexpr double kClipDepthMm = kClipFocalPx * kClipMarkerMm / kClipMarkerPx;

// x of the middle of the probe's marker in a frame; it moves by 2 px a frame. y is 240 px, the image's
// middle.
[[nodiscard]] double clip_probe_x_px(int frame);

// Writes clip.mkv, camera.json and tools.json (world marker 0, probe 2).
void write_marker_clip(const TemporaryFolder& folder);

// The two JSON files as text, to be spoilt by tests.
[[nodiscard]] std::string clip_camera_json();
[[nodiscard]] std::string clip_tools_json();

}  // namespace arthronaut::test
