// The bone in 3D beside the video: the plan, the guide or the probe's tip, and what was touched. The picture
// is made anew only when something that it shows has changed.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "app/theatre_view/theatre_panels.h"
#include "app/theatre_view/touched_picture.h"
#include "app/widgets/scene_pane.h"

namespace arthronaut::theatre_view {

class TheatreScene {
 public:
  explicit TheatreScene(std::function<void()> make_current) : pane_(std::move(make_current)) {}

  void look(const scene::SceneCamera& camera) { pane_.look(camera); }
  // Nothing without a bone to draw.
  void draw(const widgets::Ui& ui, const widgets::Rect& area, const TheatreScreen& screen);

 private:
  // What the picture is made of; alike: the picture is the same.
  struct Shown {
    std::shared_ptr<const geometry::TriangleMesh> drawn_bone;
    std::uint64_t plan_revision = 0;
    std::shared_ptr<const RegistrationStatus> bone;  // null: no operation
    std::shared_ptr<const LiveFrame> tip, guide;     // whose tip or guide is shown; null: none
    TheatreLayout layout = TheatreLayout::Guide;
    int selected_stroke = -1;
    bool operator==(const Shown&) const = default;
  };
  [[nodiscard]] static Shown shown_of(const TheatreScreen& screen);
  void show(const TheatreScreen& screen);

  widgets::ScenePane pane_;
  TouchedPicture touched_;
  Shown shown_;
};

}  // namespace arthronaut::theatre_view
