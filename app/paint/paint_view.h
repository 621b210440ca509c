// Painting bones in the images of a case: strokes that bones are grown from, threshold, brush and eraser on
// the bones themselves, on three linked slices; then surfaces that are judged and become the case's bones.
//
// Everything that is painted is saved in the case by itself and can be undone; what takes longer than a frame
// goes on beside the screen.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/paint/bone_making.h"
#include "app/paint/label_job.h"
#include "app/paint/paint_store.h"
#include "app/paint/paint_words.h"
#include "app/plan/slice_pane.h"
#include "app/widgets/scene_pane.h"

namespace arthronaut::paint {

struct PaintCallbacks {
  std::function<void()> make_current;  // the window's OpenGL context
  std::function<void()> wake;          // ends the window's wait, from any thread
  std::function<void()> leave;         // back to what was shown before
  std::function<void()> bones_made;    // the case holds other bones now: it must be opened anew
};

class PaintView {
 public:
  explicit PaintView(PaintCallbacks callbacks);

  void add_actions(widgets::Actions& actions);  // all start with "paint."
  // Another case, or the same one again, whose painting is then kept. The case has a grey image.
  void open(const cases::Case& knee, const std::filesystem::path& case_folder, bool read_only);
  void close();  // another case is open: forgets this one, whose painting is on disk
  // Another mode comes to the front, or the program ends: what is painted is on disk then.
  void leave();
  void tick(double now_s);
  void draw(const widgets::Ui& ui, const widgets::Rect& area);

  [[nodiscard]] bool is_busy() const;
  // What the end of the program would cut off.
  [[nodiscard]] bool has_running_work() const { return making_.state() == BoneMaking::State::Saving; }

 private:
  // paint_actions.cpp
  void add_brush_actions(widgets::Actions& actions);
  void add_preview_actions(widgets::Actions& actions);
  void add_edit_actions(widgets::Actions& actions);
  void add_making_actions(widgets::Actions& actions);
  void add_history_actions(widgets::Actions& actions);

  // paint_keys.cpp
  void add_key_actions(widgets::Actions& actions);
  [[nodiscard]] std::size_t sharpest_pane() const;
  void draw_keyed_pane(const widgets::Ui& ui, const std::array<widgets::Rect, 3>& areas);
  void move_cross(const Eigen::Vector3d& way_mm);

  [[nodiscard]] bool is_ready() const { return painting_.has_value(); }
  [[nodiscard]] bool can_edit() const;
  [[nodiscard]] bool is_working() const;  // something runs that Esc stops
  [[nodiscard]] bool can_stop() const;    // the same, or something is shown before it is taken
  void put_aside();
  [[nodiscard]] bool is_judging() const { return making_.state() == BoneMaking::State::Judging; }
  void begin_growth();
  void grow();
  void begin_threshold();
  void take_preview();
  void drop_preview();
  // An edit of the bones' label map, beside the screen.
  void edit(const std::string& what, std::function<void(painting::Labels&, const images::Volume&)> change);
  void take_job();
  void make_bones();

  // paint_panel.cpp
  void draw_panel(const widgets::Ui& ui, const widgets::Rect& area);
  [[nodiscard]] std::string next_step_here() const;
  void draw_steps(const widgets::Ui& ui);
  void draw_quality(const widgets::Ui& ui);
  void draw_work(const widgets::Ui& ui);
  void draw_slices(const widgets::Ui& ui, const std::array<widgets::Rect, 3>& areas);
  void draw_model(const widgets::Ui& ui, const widgets::Rect& area);
  void note_states(const widgets::Ui& ui) const;
  [[nodiscard]] plan::SliceLabels labels_shown();
  void follow(std::size_t pane, const plan::SliceEvent& event);
  // False, and why not is said, where nothing can be painted now.
  bool paint(std::size_t pane, const plan::SliceEvent::Painted& drawn);

  struct Brushing {
    std::uint8_t label = painting::kFemur;  // kNothing: the eraser
    painting::Layer layer = painting::Layer::Strokes;
    painting::Brush brush;
    std::size_t pane = 0;  // that was last painted in
  };
  struct Keys {
    std::size_t pane = 0;                   // in which they act
    bool is_down = false;                   // the brush: painting goes on with the cross-hair
    std::uint8_t label = painting::kFemur;  // of the step that goes on
    painting::Layer layer = painting::Layer::Strokes;
  };
  struct Previewing {
    Preview kind = Preview::None;
    painting::Labels grown;         // empty until something has grown
    std::uint64_t of_revision = 0;  // of the painting that was grown, or is growing
    double threshold = 250, changed_at_s = 0;
    std::uint64_t seen_revision = 0;  // of the painting
  };
  struct Look {
    scene::GreyWindow window, automatic;
    Eigen::Vector3d cross_mm = Eigen::Vector3d::Zero();
    bool hides_labels = false;
    std::uint64_t labels_revision = 1;  // of what is drawn over the slices
    std::uint64_t drawn_revision = 0;   // of the painting
    std::uint64_t judged = 0;           // counts the surfaces
    double value = 0;
  };

  PaintCallbacks callbacks_;
  cases::Case knee_;
  std::filesystem::path case_folder_;
  bool is_read_only_ = false;
  std::optional<geometry::Bounds> joint_;  // of the case's bones
  std::string hint_;                       // why the last thing did not go; empty else
  PaintStore store_;
  std::optional<painting::Painting> painting_;
  LabelJob job_;
  BoneMaking making_;
  std::array<plan::SlicePane, 3> panes_;
  widgets::ScenePane model_;
  Brushing brushing_;
  Keys keys_;
  Previewing previewing_;
  Look look_;
};

}  // namespace arthronaut::paint
