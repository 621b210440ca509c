// Pictures of a plan for the report and the demonstration: bones, tunnels, the tunnel as drilled and what the
// probe drew, from named sides. Rendered off-screen by EGL: works with and without a display, from any one
// thread at a time.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>
#include <vector>

#include "app/scene/image.h"
#include "planning/cases/case.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::scene {

// Where the eye stands. Medial and lateral follow the case's side.
enum class ViewDirection {
  Anterior,
  Posterior,
  Medial,
  Lateral,
  Distal,   // the femur from the joint
  Notch,    // the lateral wall of the femur's notch, the medial condyle cut away
  Plateau,  // the tibia from the joint
};
[[nodiscard]] std::string_view to_text(ViewDirection view);  // "anterior", ...

struct PictureRequest {
  const cases::Case* knee = nullptr;  // not null
  std::optional<bones::BoneKind>
      only_bone;  // empty: both; Distal and Notch show the femur, Plateau the tibia
  std::vector<tunnels::Tunnel> achieved = {};         // as drilled, drawn in another colour and pattern
  std::vector<Eigen::Vector3d> curve_points_in_bone;  // mm, LPS
  ViewDirection view = ViewDirection::Anterior;
  int width = 800, height = 600;
  bool light_background = false;  // for paper
};

// Of each bone what is near to the joint, and the planned tunnels, fill the picture. The tunnels are seen
// through the bone. Throws DeviceError when no OpenGL context can be made, InvalidInput
// when the case has none of the bones asked for or the size is not in 16..8192.
[[nodiscard]] Image render_plan_picture(const PictureRequest& request);

}  // namespace arthronaut::scene
