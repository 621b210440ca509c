// What can be done while bones are painted: buttons, keys and the list of keys are these.
#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>

#include "app/paint/paint_view.h"
#include "planning/painting/label_edits.h"
#include "planning/segmentation/dark_rim.h"

namespace arthronaut::paint {

using images::Volume;
using painting::Labels;
using painting::Layer;

void PaintView::add_actions(widgets::Actions& actions) {
  add_brush_actions(actions);
  add_preview_actions(actions);
  add_edit_actions(actions);
  add_making_actions(actions);
  add_history_actions(actions);
  add_key_actions(actions);
}

void PaintView::add_brush_actions(widgets::Actions& actions) {
  const auto edits = [this] { return can_edit(); };
  const auto label = [&](const char* id, const char* name, const char* tooltip, int key, std::uint8_t value) {
    actions.add({id, name, tooltip, key, 0, false, edits, [this, value] { return brushing_.label == value; },
                 [this, value] {
                   brushing_.label = value;
                   // Bones are what is painted as bone: what surrounds them is nothing there.
                   if (value == painting::kSurroundings) brushing_.layer = Layer::Strokes;
                   ++look_.labels_revision;
                 }});
  };
  label("paint.femur", "Femur", "The brush paints femur: drag over a slice with the left button", GLFW_KEY_1,
        painting::kFemur);
  label("paint.tibia", "Tibia", "The brush paints tibia", GLFW_KEY_2, painting::kTibia);
  label("paint.surroundings", "Surroundings",
        "The brush paints what is neither: cartilage, muscle, air, fibula and patella", GLFW_KEY_3,
        painting::kSurroundings);
  label("paint.eraser", "Eraser", "The brush takes away what is painted, of strokes or of bones", GLFW_KEY_E,
        painting::kNothing);
  const auto layer = [&](const char* id, const char* name, const char* tooltip, int key, Layer value) {
    actions.add({id, name, tooltip, key, 0, false, edits, [this, value] { return brushing_.layer == value; },
                 [this, value] {
                   brushing_.layer = value;
                   if (value == Layer::Bones && brushing_.label == painting::kSurroundings)
                     brushing_.label = painting::kNothing;
                 }});
  };
  layer("paint.strokes", "Strokes", "The brush paints strokes, which bones are grown from", GLFW_KEY_S,
        Layer::Strokes);
  layer("paint.bones", "Bones", "The brush corrects the bones themselves, voxel by voxel", GLFW_KEY_B,
        Layer::Bones);
  const auto size = [&](const char* id, const char* name, int key, double factor) {
    actions.add({id,
                 name,
                 "The brush's size; or Shift and the wheel over a slice",
                 key,
                 0,
                 true,
                 edits,
                 {},
                 [this, factor] {
                   brushing_.brush.radius_mm = std::clamp(brushing_.brush.radius_mm * factor, 0.3, 40.0);
                 }});
  };
  size("paint.smaller", "Smaller", GLFW_KEY_MINUS, 1 / 1.25);
  size("paint.larger", "Larger", GLFW_KEY_EQUAL, 1.25);
  actions.add({"paint.ball", "Ball", "The brush paints a ball, through the slices; else in this slice alone",
               GLFW_KEY_O, 0, false, edits, [this] { return brushing_.brush.is_ball; },
               [this] { brushing_.brush.is_ball = !brushing_.brush.is_ball; }});
  const auto is_shown = [this] { return is_ready(); };
  actions.add({"paint.window", "Window", plan::kWindowTooltip, GLFW_KEY_W, 0, false, is_shown, {}, [this] {
                 look_.window =
                     scene::next_window(look_.window, look_.automatic, painting_->volume().modality);
               }});
  actions.add({"paint.fit",
               "Whole",
               "Shows the whole slices again; Ctrl and the wheel zoom, Shift and drag shifts",
               GLFW_KEY_V,
               0,
               false,
               is_shown,
               {},
               [this] {
                 for (plan::SlicePane& pane : panes_) pane.fit(painting_->volume());
               }});
  actions.add({"paint.hide", "Hide", "The images without what is painted", GLFW_KEY_X, 0, false, is_shown,
               [this] { return look_.hides_labels; },
               [this] {
                 look_.hides_labels = !look_.hides_labels;
                 ++look_.labels_revision;
               }});
}

void PaintView::add_preview_actions(widgets::Actions& actions) {
  actions.add({"paint.grow", "Grow",
               "The bones grow from the strokes to the edges in the images; shown first, then taken. Needs "
               "strokes of a bone and of what surrounds it",
               GLFW_KEY_G, 0, false,
               [this] {
                 const auto has = [this](std::uint8_t label) {
                   return painting_->holds(Layer::Strokes, label);
                 };
                 return can_edit() && !job_.is_running() && previewing_.kind == Preview::None &&
                        has(painting::kFemur) + has(painting::kTibia) + has(painting::kSurroundings) >= 2;
               },
               [this] { return previewing_.kind == Preview::Growth; }, [this] { begin_growth(); }});
  actions.add({"paint.threshold", "Threshold",
               "In a CT: what is at least so dense is coloured; then part, fill and correct it", GLFW_KEY_T,
               0, false,
               [this] {
                 return can_edit() && painting_->volume().modality == images::Modality::Ct &&
                        !job_.is_running() && previewing_.kind != Preview::Growth;
               },
               [this] { return previewing_.kind == Preview::Threshold; },
               [this] {
                 if (previewing_.kind == Preview::Threshold)
                   drop_preview();
                 else
                   begin_threshold();
               }});
  const auto step = [&](const char* id, const char* name, int key, int mods, double by) {
    actions.add({id,
                 name,
                 "Moves the threshold",
                 key,
                 mods,
                 true,
                 [this] { return can_edit() && previewing_.kind == Preview::Threshold; },
                 {},
                 [this, by] {
                   previewing_.threshold = std::clamp(previewing_.threshold + by, -1000.0, 4000.0);
                   ++look_.labels_revision;
                 }});
  };
  step("paint.threshold_up", "Higher", GLFW_KEY_UP, 0, 10);
  step("paint.threshold_down", "Lower", GLFW_KEY_DOWN, 0, -10);
  actions.add({"paint.take",
               "Take it",
               "What is shown becomes the bones; undo brings back what was there",
               GLFW_KEY_ENTER,
               0,
               false,
               [this] {
                 if (!can_edit() || job_.is_running()) return false;
                 return previewing_.kind == Preview::Threshold ||
                        (previewing_.kind == Preview::Growth && !previewing_.grown.empty() &&
                         previewing_.of_revision == painting_->revision());
               },
               {},
               [this] { take_preview(); }});
  actions.add({"paint.stop",
               "Stop",
               "Stops what runs; nothing that was painted is lost",
               GLFW_KEY_ESCAPE,
               0,
               false,
               [this] { return is_working(); },
               {},
               [this] { put_aside(); }});
  actions.add({"paint.put_aside",
               "Back to painting",
               "Leaves what is shown; nothing that was painted is lost",
               GLFW_KEY_ESCAPE,
               0,
               false,
               [this] { return can_stop() && !is_working(); },
               {},
               [this] { put_aside(); }});
}

void PaintView::put_aside() {
  hint_.clear();
  making_.cancel();
  if (previewing_.kind != Preview::None)
    drop_preview();
  else
    job_.cancel();
}

void PaintView::add_edit_actions(widgets::Actions& actions) {
  const auto of_label = [this] {
    const bool is_bone = brushing_.label == painting::kFemur || brushing_.label == painting::kTibia;
    return can_edit() && is_bone && !job_.is_running() && previewing_.kind == Preview::None &&
           painting_->holds(Layer::Bones, brushing_.label);
  };
  const auto add = [&](const char* id, const char* name, const char* tooltip, int key, int mods,
                       const std::string& what, auto change) {
    actions.add({id, name, tooltip, key, mods, false, of_label, {}, [this, what, change] {
                   edit(what + " of the " + label_name(brushing_.label),
                        [change, label = brushing_.label](Labels& labels, const Volume& volume) {
                          change(labels, volume, label);
                        });
                 }});
  };
  actions.add({"paint.part",
               "Part",
               "Bones that touch are parted at the thinnest place between the strokes of femur, tibia and "
               "surroundings",
               GLFW_KEY_P,
               0,
               false,
               [this] {
                 return can_edit() && !job_.is_running() && previewing_.kind == Preview::None &&
                        painting_->holds(Layer::Bones) && painting_->holds(Layer::Strokes);
               },
               {},
               [this] {
                 edit("Part the bones",
                      [strokes = painting_->labels(Layer::Strokes)](Labels& labels, const Volume& volume) {
                        painting::part_by_strokes(labels, volume, strokes);
                      });
               }});
  add("paint.island", "Largest", "Of the bone that is chosen only the largest piece stays", GLFW_KEY_I, 0,
      "Keep the largest piece", [](Labels& labels, const Volume& volume, std::uint8_t label) {
        painting::keep_largest(labels, volume, label);
      });
  add("paint.holes", "Fill", "What the chosen bone encloses becomes bone: marrow, gaps within a slice",
      GLFW_KEY_H, 0, "Fill the holes", [](Labels& labels, const Volume& volume, std::uint8_t label) {
        painting::fill_holes(labels, volume, label);
      });
  add("paint.gaps", "Close", "Gaps of the chosen bone up to 4 mm are closed, then what it encloses is filled",
      GLFW_KEY_H, GLFW_MOD_SHIFT, "Close the gaps",
      [](Labels& labels, const Volume& volume, std::uint8_t label) {
        constexpr double kGap_mm = 2;
        painting::fill_holes(labels, volume, label, kGap_mm);
      });
  add("paint.cortex", "Cortex",
      "In an MR: the dark rim about the chosen bone becomes bone, as its cortex is; growing takes it in by "
      "itself",
      GLFW_KEY_C, 0, "Take in the cortex", [](Labels& labels, const Volume& volume, std::uint8_t label) {
        const std::array others{label == painting::kFemur ? painting::kTibia : painting::kFemur};
        (void)segmentation::take_in_dark_rim(labels, volume, label, others, {});
      });
  add("paint.smooth", "Smooth", "Rounds the chosen bone off by a millimetre; its volume stays", GLFW_KEY_M, 0,
      "Smooth the border", [](Labels& labels, const Volume& volume, std::uint8_t label) {
        constexpr double kRadius_mm = 1;
        painting::smooth(labels, volume, label, kRadius_mm);
      });
  actions.add({"paint.between",
               "Between",
               "The chosen bone, painted in a few slices, passes over from one to the next; in the direction "
               "of the slices that were painted last",
               GLFW_KEY_F,
               0,
               false,
               of_label,
               {},
               [this] {
                 const int axis = painting::axis_along(painting_->volume(), panes_[brushing_.pane].normal());
                 edit("Fill between slices of the " + label_name(brushing_.label),
                      [axis, label = brushing_.label](Labels& labels, const Volume& volume) {
                        painting::fill_between(labels, volume, axis, label);
                      });
               }});
}

void PaintView::add_making_actions(widgets::Actions& actions) {
  actions.add({"paint.make",
               "Make bones",
               "Surfaces of what is painted, to be judged before they become the bones of the case",
               GLFW_KEY_A,
               0,
               false,
               [this] {
                 return can_edit() && !job_.is_running() && previewing_.kind == Preview::None &&
                        painting_->holds(Layer::Bones);
               },
               {},
               [this] { make_bones(); }});
  actions.add({"paint.accept",
               "Take as the bones",
               "These surfaces become the bones of the case; landmarks of bones that were there go",
               GLFW_KEY_ENTER,
               0,
               false,
               [this] {
                 return is_judging() &&
                        std::ranges::all_of(making_.qualities(), &importing::BoneQuality::is_closed);
               },
               {},
               [this] { making_.save(); }});
  actions.add({"paint.leave",
               "Back",
               "Back to what was shown before; what is painted is kept in the case",
               GLFW_KEY_ESCAPE,
               0,
               false,
               [this] { return making_.state() != BoneMaking::State::Saving && !can_stop(); },
               {},
               [this] {
                 hint_.clear();
                 callbacks_.leave();
               }});
}

void PaintView::add_history_actions(widgets::Actions& actions) {
  const auto can_go = [this] {
    return can_edit() && !(job_.is_running() && previewing_.kind == Preview::None);
  };
  actions.add({"paint.undo",
               "Undo",
               "Takes the last edit back",
               GLFW_KEY_Z,
               GLFW_MOD_CONTROL,
               true,
               [this, can_go] { return can_go() && painting_->can_undo(); },
               {},
               [this] { painting_->undo(); }});
  actions.add({"paint.redo",
               "Redo",
               "Does it again",
               GLFW_KEY_Y,
               GLFW_MOD_CONTROL,
               true,
               [this, can_go] { return can_go() && painting_->can_redo(); },
               {},
               [this] { painting_->redo(); }});
}

}  // namespace arthronaut::paint
