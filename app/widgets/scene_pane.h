// A 3D view on the screen: draws a SceneView's texture and turns, shifts and zooms it by the mouse.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>

#include "app/scene/scene_view.h"
#include "app/widgets/controls.h"

namespace arthronaut::widgets {

// What the mouse did over the view in this frame. Pixels count from the view's top-left corner.
struct PaneInput {
  bool is_hovered = false;
  Eigen::Vector2d mouse_px = Eigen::Vector2d::Zero();
  Eigen::Vector2d size_px = Eigen::Vector2d::Ones();
  bool was_clicked = false;     // pressed and let go in one place, which mouse_px then is
  bool handle_pressed = false;  // pressed on a handle, see below
  bool handle_dragged = false;
};

class ScenePane {
 public:
  // What draws is made when something is shown first: a program that starts has a window before that.
  explicit ScenePane(std::function<void()> make_current);

  void show(const scene::SceneContent& content);
  // False: nothing is drawn once more at twice the size while it rests. Beside pictures that come, the next
  // one of them would wait for it.
  void smooth_at_rest(bool smooths) { smooths_ = smooths; }
  void look(const scene::SceneCamera& camera) { camera_ = camera; }
  [[nodiscard]] const scene::SceneCamera& camera() const { return camera_; }
  // For a pane that is not drawn for a while: its picture goes until it is.
  void let_go_of_picture() {
    if (view_ != nullptr) view_->let_go_of_picture();
    changed_ = true;  // first at the quick size
  }

  // Left drag turns, right or middle drag shifts, the wheel zooms; a press where is_handle(pixel) holds drags
  // the handle instead. While nothing moves the picture is drawn once more at twice the size, for smooth
  // edges.
  PaneInput draw(const Ui& ui, const char* name, const Rect& rect,
                 const std::function<bool(const Eigen::Vector2d&)>& is_handle = {});

 private:
  void follow_mouse(const PaneInput& input);
  void render(const Ui& ui, const Rect& rect);
  [[nodiscard]] scene::SceneView& view();

  std::function<void()> make_current_;
  std::unique_ptr<scene::SceneView> view_;  // null before the first use
  scene::SceneCamera camera_, drawn_camera_;
  bool drags_handle_ = false, changed_ = true, smooths_ = true;
  std::uint64_t version_ = 0;  // of the picture (draw_damage.h)
  float press_travel_px_ = 0;
  Eigen::Vector2d press_px_ = Eigen::Vector2d::Zero();
  double changed_at_s_ = 0;
};

}  // namespace arthronaut::widgets
