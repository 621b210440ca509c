// The plan's lines drawn into a picture that is kept: of the report, of the demo. Those over the live picture
// are ImGui's (app/navigate/overlay_lines.h).
#pragma once

#include <Eigen/Core>

#include "app/scene/image.h"
#include "app/scene/plan_overlay.h"

namespace arthronaut::scene {

// What of a frame a picture shows: where its top left lies in the frame, and how many of the frame's pixels
// one of its own is.
struct FrameCut {
  Eigen::Vector2d corner_px = Eigen::Vector2d::Zero();
  double scale = 1;
};

// Lines of three pixels, no faces. Hidden ones are dotted: form, not colour alone, tells them apart.
void draw_overlay(Image& picture, const PlanOverlay& overlay, const FrameCut& cut = {});

// Across the top, in the pixels: a picture that was drawn by a simulator is nobody's knee, wherever it goes.
void mark_simulated(Image& picture);

}  // namespace arthronaut::scene
