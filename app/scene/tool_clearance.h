// Where the tools lie in the picture: nothing is drawn over them, so that the surgeon sees what is done.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "app/scene/plan_overlay.h"
#include "navigation/pipeline/navigation_pipeline.h"
#include "navigation/tools/tool_set.h"

namespace arthronaut::scene {

// The pose of a tool in a frame; nullopt: it was not tracked there.
using CameraFromTool = std::function<std::optional<geometry::RigidTransform>(const tools::Tool& tool)>;

// Discs over every tool that is tracked in a frame: a wide one over its working end, others along its
// shaft, none wider than a quarter of the view. The shaft follows the tool's axis where it has one, else the
// line from the tip to the marker; discs overlap.
[[nodiscard]] std::vector<ClearDisc> clear_discs_of(const camera::CameraModel& camera,
                                                    const tools::ToolSet& tools,
                                                    const CameraFromTool& camera_from_tool);
[[nodiscard]] std::vector<ClearDisc> clear_discs_of(const pipeline::FrameResult& result,
                                                    const tools::ToolSet& tools);

}  // namespace arthronaut::scene
