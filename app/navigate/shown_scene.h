// What the 3D view beside the video is made of, and when it is made anew. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "app/navigate/navigate_display.h"
#include "app/widgets/draw_pace.h"
#include "navigation/operation/operation_state.h"
#include "planning/geometry/triangle_mesh.h"

namespace arthronaut::navigate {

// Alike: the picture is the same.
struct ShownScene {
  std::shared_ptr<const geometry::TriangleMesh> drawn_bone;
  std::optional<std::array<double, 7>> plan;      // entry, direction and length of the one in force
  operation::RegistrationStatePtr registration;   // null: no operation
  std::int64_t tip_frame = -1, guide_frame = -1;  // whose tip or guide is shown; -1: none
  NavigateLayout layout = NavigateLayout::Guide;
  int selected_stroke = -1;
  bool operator==(const ShownScene&) const = default;
};

class SceneRenewal {
 public:
  // Whether what is to be shown now is drawn, in place of what was drawn before. A tip or guide that is
  // still seen and only lies elsewhere, and strokes that have only become longer, wait as MotionPace says;
  // whatever else has changed is drawn in this frame, above all that one of them is gone.
  [[nodiscard]] bool is_due(ShownScene wanted, double now_s, bool by_processor);
  [[nodiscard]] const ShownScene& shown() const { return shown_; }

 private:
  ShownScene shown_;
  widgets::MotionPace pace_;
};

}  // namespace arthronaut::navigate
