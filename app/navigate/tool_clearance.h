// Where the tools lie in the picture: nothing is drawn over them, so that the surgeon sees what is done.
#pragma once

#include <vector>

#include "app/scene/plan_overlay.h"
#include "navigation/pipeline/navigation_pipeline.h"

namespace arthronaut::navigate {

// Discs over every tool that is tracked in this frame: a wide one over its working end, others along its
// shaft, none wider than a quarter of the view. The shaft follows the tool's axis where it has one, else the
// line from the tip to the marker; discs overlap.
[[nodiscard]] std::vector<scene::ClearDisc> clear_discs_of(const pipeline::FrameResult& result,
                                                           const tools::ToolSet& tools);

}  // namespace arthronaut::navigate
