// The brush by keys: it stands at the cross-hair of the slice that is framed, and paints where that goes
// while it is down.
#include <GLFW/glfw3.h>

#include <cmath>
#include <utility>

#include "app/paint/paint_view.h"
#include "app/plan/pane_keys.h"

namespace arthronaut::paint {

// The one that lies as the images were taken shows the most: it is where a hand begins.
std::size_t PaintView::sharpest_pane() const {
  const images::Volume& volume = painting_->volume();
  Eigen::Index across = 0;
  volume.spacing_mm().maxCoeff(&across);
  const Eigen::Vector3d normal = volume.lps_from_index.linear().col(across).normalized();
  std::size_t best = 0;
  for (std::size_t i = 1; i < panes_.size(); ++i)
    if (std::abs(panes_[i].normal().dot(normal)) > std::abs(panes_[best].normal().dot(normal))) best = i;
  return best;
}

void PaintView::draw_keyed_pane(const widgets::Ui& ui, const std::array<widgets::Rect, 3>& areas) {
  if (const auto pressed = plan::pressed_pane(areas)) {
    keys_.pane = *pressed;
    keys_.is_down = false;
  }
  plan::frame_keyed_pane(ui, areas[keys_.pane]);
}

void PaintView::move_cross(const Eigen::Vector3d& way_mm) {
  const Eigen::Vector3d from_mm = look_.cross_mm;
  look_.cross_mm = from_mm + way_mm;
  if (!keys_.is_down) return;
  // Another colour is another step, as another stroke of the mouse is.
  const bool goes_on = keys_.label == brushing_.label && keys_.layer == brushing_.layer;
  keys_.is_down = paint(keys_.pane, {from_mm, look_.cross_mm, !goes_on});
  keys_.label = brushing_.label;
  keys_.layer = brushing_.layer;
}

void PaintView::add_key_actions(widgets::Actions& actions) {
  const auto is_shown = [this] { return is_ready(); };
  actions.add(
      {"paint.brush_down", "Brush down",
       "Paints where the cross-hair of the framed slice is, and where Alt and the arrows take it, until "
       "it is lifted again",
       GLFW_KEY_SPACE, 0, false, [this] { return can_edit(); }, [this] { return keys_.is_down; },
       [this] {
         if (std::exchange(keys_.is_down, false)) return;
         keys_.label = brushing_.label;
         keys_.layer = brushing_.layer;
         keys_.is_down = paint(keys_.pane, {look_.cross_mm, look_.cross_mm, true});
       }});
  actions.add({"paint.next_pane",
               "Next pane",
               "Keys paint, move, shift, zoom and scroll in another slice",
               GLFW_KEY_S,
               GLFW_MOD_SHIFT,
               false,
               is_shown,
               {},
               [this] {
                 keys_.pane = (keys_.pane + 1) % panes_.size();
                 keys_.is_down = false;
               }});
  plan::add_pane_keys(actions,
                      {.mode = "paint",
                       .move_name = "cross",
                       .move_label = "Cross-hair",
                       .move_hint = "Moves the framed slice's cross-hair; with the brush down it paints",
                       .shift_hint = "Shifts the framed slice",
                       .zoom_hint = "The framed slice, about its cross-hair",
                       .scroll_hint = "In the framed slice, as the wheel; lifts the brush",
                       .is_possible = is_shown,
                       .can_scroll = is_shown,
                       .move =
                           [this](const Eigen::Vector2d& way) {
                             move_cross(panes_[keys_.pane].way_mm(plan::kKeyedCross_px * way));
                           },
                       .shift = [this](const Eigen::Vector2d& by_px) { panes_[keys_.pane].shift(by_px); },
                       .zoom = [this](double steps) { panes_[keys_.pane].zoom(steps, look_.cross_mm); },
                       .scroll =
                           [this](int images) {
                             keys_.is_down = false;
                             const plan::SlicePane& pane = panes_[keys_.pane];
                             move_cross(images * pane.step_mm(painting_->volume()) * pane.normal());
                           }});
}

}  // namespace arthronaut::paint
