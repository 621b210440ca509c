// Pictures of the demo: a frame of the simulated arthroscope with the plan drawn on it.
#pragma once

#include <filesystem>
#include <optional>

#include "navigation/camera/frame.h"
#include "navigation/pipeline/navigation_pipeline.h"
#include "planning/geometry/triangle_mesh.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::command_line {

// PNG. The plan is drawn where registration and world marker of this frame put it; without them the frame
// alone. Throws IoError.
void write_frame_picture(const std::filesystem::path& file, const camera::Frame& frame,
                         const pipeline::FrameResult& result,
                         const std::optional<registration::RegistrationSummary>& registration,
                         const geometry::TriangleMesh& bone, const tunnels::Tunnel& plan,
                         double planned_length_mm);

}  // namespace arthronaut::command_line
