// The bones in 3D with what can be taken hold of. Shows what it is given, turns by the mouse, and tells what
// the hand did; it changes nothing of the plan.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/case/plan_model.h"
#include "app/plan/visible_bones.h"
#include "app/scene/drawn_volume.h"
#include "app/widgets/scene_pane.h"

namespace arthronaut::plan {

// A place with a sign and a word over the picture. The signs differ in shape, not only in colour.
struct PaneMark {
  enum class Shape {
    Ring,     // a ring with a dot: an entry
    Diamond,  // an aim
    Cross,    // a landmark
    Pin,      // a place that is pointed at
    Dot,      // one of many places that are good, to be looked at,
    Circle,
    Saltire,  // or bad
  } shape = Shape::Pin;
  std::string id;    // "entry": stable, for events and tests; empty: one of many
  std::string word;  // beside it; empty: none
  Eigen::Vector3d point_mm = Eigen::Vector3d::Zero();
  ImU32 color = widgets::kText;
  bool can_be_dragged = false;
  std::string tooltip = {};
  std::vector<Eigen::Vector3d> area_mm = {};  // closed: within it the tooltip is shown, too
  bool shows_through = false;                 // it lies in the bone, which does not hide it
};

struct PaneEvent {
  std::optional<scene::SceneRay> click;  // pressed and let go in one place, on no mark
  std::string pressed;                   // id of the mark that was pressed just now; empty: none
  std::string dragged;                   // id of the mark that is dragged; empty: none
  std::optional<scene::SceneRay> hover;  // under the mouse, where no mark says anything
  scene::SceneRay drag_ray =
      {};  // through the mark, not the mouse: where it was taken hold of stays under the mouse
};

class BonePane {
 public:
  explicit BonePane(std::function<void()> make_current);

  // Another case: looks at it from the front.
  void open(const open_case::PlanModel* model);
  // From a named side of the bone; Notch cuts the medial condyle away.
  void look_from(scene::ViewDirection view);
  // A point of a bone straight from outside, 160 mm away; the bone alone and whole.
  void look_at(const Eigen::Vector3d& point_mm, bones::BoneKind bone);
  // As a hand turns, shifts or zooms it: what is shown stays.
  void look(const scene::SceneCamera& camera) { pane_.look(camera); }
  // nullopt: from no named side, at a point.
  [[nodiscard]] const std::optional<scene::ViewDirection>& looked_from() const { return looked_from_; }
  // From there, and not turned by hand since.
  [[nodiscard]] bool is_seen_from(scene::ViewDirection view) const;
  // The one bone that the view is of; nullopt: both are shown.
  [[nodiscard]] std::optional<bones::BoneKind> only() const { return only_; }
  [[nodiscard]] bool shows(bones::BoneKind bone) const { return !only_ || *only_ == bone; }
  [[nodiscard]] const scene::SceneCamera& camera() const { return pane_.camera(); }
  void let_go_of_picture() { pane_.let_go_of_picture(); }
  void see_through(bool on);
  [[nodiscard]] bool is_see_through() const { return is_see_through_; }
  // The images in the bones' place, cut as these are, an MR also cut open; nullptr: the bones. What is seen
  // and taken hold of stays the bones' surface, which lies where the images' does.
  void show_volume(const std::shared_ptr<const scene::VolumeItem>& item);
  // What is drawn beside the bones, and the tunnels' lines; kept until it is set again.
  void set_content(scene::SceneContent beside_the_bones);

  PaneEvent draw(const widgets::Ui& ui, const widgets::Rect& area, const std::vector<PaneMark>& marks);
  // Where those of them stand that can be dragged.
  [[nodiscard]] std::vector<ImVec2> handles_on_screen(const widgets::Rect& area,
                                                      const std::vector<PaneMark>& marks) const;
  // What the eye sees of the bones, for picking.
  [[nodiscard]] VisibleBones visible() const;

 private:
  void show();
  [[nodiscard]] std::optional<scene::CutPlane> cut_of_other_bone() const;
  [[nodiscard]] bool is_out_of_sight(const PaneMark& mark) const;
  [[nodiscard]] std::vector<Eigen::Vector2d> outline_on_screen(const std::vector<Eigen::Vector3d>& outline_mm,
                                                               const Eigen::Vector2d& size_px) const;
  // Whether one of them says something under the mouse.
  bool draw_marks(const widgets::Ui& ui, const widgets::Rect& area, const std::vector<PaneMark>& marks,
                  bool is_hovered) const;

  const open_case::PlanModel* model_ = nullptr;
  widgets::ScenePane pane_;
  scene::SceneContent beside_;
  std::shared_ptr<const scene::VolumeItem> volume_;
  std::optional<scene::ViewDirection> looked_from_;
  scene::SceneCamera named_;  // of looked_from_
  std::optional<bones::BoneKind> only_;
  std::optional<scene::CutPlane> cut_;
  scene::CutPlane open_;  // through the middle of what is looked at, towards the eye: of an MR in 3D
  bool is_see_through_ = false, is_stale_ = true;
  double aspect_ = 1.5;
  std::string held_;                                          // the mark that is dragged
  Eigen::Vector2d held_offset_px_ = Eigen::Vector2d::Zero();  // from the mouse to the mark
};

}  // namespace arthronaut::plan
