// The bone in 3D beside the video: the plan, the guide or the probe's tip, and what was touched. The picture
// is made anew only when something that it shows has changed (SceneRenewal).
#pragma once

#include <functional>

#include "app/navigate/navigate_panels.h"
#include "app/navigate/shown_scene.h"
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
  void show(const widgets::Ui& ui, const NavigateScreen& screen);

  widgets::ScenePane pane_;
  TouchedPicture touched_;
  SceneRenewal renewal_;
};

}  // namespace arthronaut::navigate
