// One 3D view of a knee, drawn by VTK into a texture of the caller's OpenGL context. Everything here runs on
// the thread that owns the context, with the context current, and the view dies before it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "app/scene/image.h"
#include "app/scene/scene_camera.h"
#include "app/scene/scene_content.h"

namespace arthronaut::scene {

class SceneView {
 public:
  // make_current makes the caller's context current on this thread.
  explicit SceneView(std::function<void()> make_current);
  ~SceneView();
  SceneView(const SceneView&) = delete;
  SceneView& operator=(const SceneView&) = delete;

  void resize(int width_px, int height_px);  // at least 1 x 1
  void show(const SceneContent& content);
  void look(const SceneCamera& camera);
  void set_background(const Color& bottom, const Color& top);
  // While something moves a volume is drawn as coarsely as a frame's time asks for; at rest as finely as a
  // quarter of a second allows. True at first. Everything else is drawn alike.
  void set_still(bool is_still);

  // Gives the picture's memory back, as of a view that is not on the screen now: on software OpenGL a large
  // one holds some 100 MB. The next resize() to another size than 1 x 1 has it drawn again.
  void let_go_of_picture();

  // Draws when something changed since the last time; returns whether it did. Leaves the OpenGL state to be
  // reset by the caller: bind framebuffer 0, set the viewport, disable the scissor test.
  bool render_if_dirty();

  // The picture: an OpenGL texture, bottom row first; 0 before the first render_if_dirty().
  [[nodiscard]] std::uint32_t texture() const;
  [[nodiscard]] Image read_image();  // renders first, a volume as finely as can be

 private:
  void draw(double pixels_per_ray);

  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace arthronaut::scene
