// The brush by keys: it stands at the cross-hair of the slice that is framed, and paints where that goes
// while it is down.
#include <GLFW/glfw3.h>

#include <array>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>

#include "app/paint/paint_view.h"

namespace arthronaut::paint {

namespace {

constexpr double kCross_px = 2;  // of the slice: zoomed in it moves less
constexpr double kShift_px = 30;

}  // namespace

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
  const ImGuiIO& io = ImGui::GetIO();
  for (std::size_t i = 0; i < areas.size(); ++i)
    if (areas[i].contains(io.MousePos) && (io.MouseClicked[0] || io.MouseClicked[1] || io.MouseClicked[2])) {
      keys_.pane = i;
      keys_.is_down = false;
    }
  const widgets::Rect& pane = areas[keys_.pane];
  ImGui::GetWindowDrawList()->AddRect(pane.min(), pane.max(), widgets::kAccent, 0, 0, ui.theme.px(2));
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
  struct Arrow {
    std::string word;
    int key;
    Eigen::Vector2d way;  // of the screen, rows down
  };
  const std::array<Arrow, 4> arrows{Arrow{"left", GLFW_KEY_LEFT, {-1, 0}},
                                    Arrow{"right", GLFW_KEY_RIGHT, {1, 0}}, Arrow{"up", GLFW_KEY_UP, {0, -1}},
                                    Arrow{"down", GLFW_KEY_DOWN, {0, 1}}};
  for (const Arrow& arrow : arrows) {
    actions.add({"paint.cross_" + arrow.word,
                 "Cross-hair " + arrow.word,
                 "Moves the framed slice's cross-hair; with the brush down it paints",
                 arrow.key,
                 GLFW_MOD_ALT,
                 true,
                 is_shown,
                 {},
                 [this, way = arrow.way] { move_cross(panes_[keys_.pane].way_mm(kCross_px * way)); }});
    actions.add({"paint.shift_" + arrow.word,
                 "Shift " + arrow.word,
                 "Shifts the framed slice",
                 arrow.key,
                 GLFW_MOD_CONTROL | GLFW_MOD_SHIFT,
                 true,
                 is_shown,
                 {},
                 [this, way = arrow.way] { panes_[keys_.pane].shift(kShift_px * way); }});
  }
  for (const auto& [id, label, key, steps] : {std::tuple{"paint.zoom_in", "Zoom in", GLFW_KEY_EQUAL, 1.0},
                                              std::tuple{"paint.zoom_out", "Zoom out", GLFW_KEY_MINUS, -1.0}})
    actions.add({id,
                 label,
                 "The framed slice, about its cross-hair",
                 key,
                 GLFW_MOD_CONTROL,
                 true,
                 is_shown,
                 {},
                 [this, by = steps] { panes_[keys_.pane].zoom(by, look_.cross_mm); }});
  for (const auto& [id, label, key, images] :
       {std::tuple{"paint.next_image", "Next image", GLFW_KEY_PAGE_UP, 1},
        std::tuple{"paint.image_before", "Image before", GLFW_KEY_PAGE_DOWN, -1}})
    actions.add({id,
                 label,
                 "In the framed slice, as the wheel; lifts the brush",
                 key,
                 GLFW_MOD_SHIFT,
                 true,
                 is_shown,
                 {},
                 [this, by = images] {
                   keys_.is_down = false;
                   const plan::SlicePane& pane = panes_[keys_.pane];
                   move_cross(by * pane.step_mm(painting_->volume()) * pane.normal());
                 }});
}

}  // namespace arthronaut::paint
