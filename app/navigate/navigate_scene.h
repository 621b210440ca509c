// The bone in 3D beside the video: the plan, the guide or the probe's tip, and what was touched. The picture
// is made anew only when something that it shows has changed.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>

#include "app/navigate/navigate_panels.h"
#include "app/navigate/touched_picture.h"
#include "app/widgets/scene_pane.h"

namespace arthronaut::navigate {

class NavigateScene {
 public:
  explicit NavigateScene(std::function<void()> make_current) : pane_(std::move(make_current)) {}

  void look(const scene::SceneCamera& camera) { pane_.look(camera); }
  // Nothing without a bone to draw.
  void draw(const widgets::Ui& ui, const widgets::Rect& area, const NavigateScreen& screen);

 private:
  // What the picture is made of; alike: the picture is the same.
  struct Shown {
    std::shared_ptr<const geometry::TriangleMesh> drawn_bone;
    std::optional<std::array<double, 7>> plan;      // entry, direction and length of the one in force
    operation::RegistrationStatePtr registration;   // null: no operation
    std::int64_t tip_frame = -1, guide_frame = -1;  // whose tip or guide is shown; -1: none
    NavigateLayout layout = NavigateLayout::Guide;
    int selected_stroke = -1;
    bool operator==(const Shown&) const = default;
  };
  [[nodiscard]] static Shown shown_of(const NavigateScreen& screen);
  void show(const NavigateScreen& screen);

  widgets::ScenePane pane_;
  TouchedPicture touched_;
  Shown shown_;
};

}  // namespace arthronaut::navigate
