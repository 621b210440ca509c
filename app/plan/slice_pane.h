// One slice of the case's images in a pane: zoomed, shifted, scrolled and windowed by the mouse, with the
// bones' outlines, the tunnels, the cross-hair, the patient's sides and a scale. It shows and tells; what is
// common to the three of them is slice_panes.h's.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/scene/label_slice.h"
#include "app/scene/reslice.h"
#include "app/widgets/color_texture.h"
#include "app/widgets/controls.h"
#include "app/widgets/grey_texture.h"

namespace arthronaut::plan {

// Of the action that goes through the windows of grey values.
inline constexpr const char* kWindowTooltip =
    "In a CT bone, soft tissue, as the values are; in an MR as the values are. Or drag with the right button";

// A surface whose outline is drawn.
struct OutlinedMesh {
  const geometry::TriangleMesh* mesh = nullptr;
  ImU32 color = widgets::kText;
  float line_px = 2;
};

// A named point that is drawn where the slice is near it.
struct SliceMark {
  std::string word;
  Eigen::Vector3d point_mm = Eigen::Vector3d::Zero();
  ImU32 color = widgets::kText;
};

// A measured line or angle, in the patient.
struct SliceLine {
  std::vector<Eigen::Vector3d> points_mm;  // two or three
  std::string word;
  bool is_being_made = false;  // follows the mouse, whichever slice it is in
};

// What is drawn of a line in a slice: all of it where all of its points lie there. Of one that only crosses
// it those points that do: a shadow of it would be of another length than the number beside it.
inline constexpr double kNearSlice_mm = 2;
[[nodiscard]] bool lies_in(const SliceLine& line, const scene::SlicePlane& plane);

// "R 66.1 mm": how far a slice of this normal through the point lies from the scanner's origin, and to which
// side of the patient. In LPS it is the coordinate, without a sign that each pane would take another way.
[[nodiscard]] std::string place_in_words(const Eigen::Vector3d& normal, const Eigen::Vector3d& point_mm);

// "W 2500 L 480".
[[nodiscard]] std::string window_in_words(const scene::GreyWindow& window);

// What is painted, over the grey picture.
struct SliceLabels {
  std::vector<scene::LabelLayer> layers;
  std::uint64_t revision = 0;  // another one draws them anew
};

struct SliceContent {
  const images::Volume* volume = nullptr;  // not null
  std::uint64_t revision = 0;              // of the outlined meshes: another one draws their outlines anew
  std::vector<OutlinedMesh> meshes;
  std::vector<SliceMark> marks;
  std::vector<SliceLine> lines;
  Eigen::Vector3d cross_mm = Eigen::Vector3d::Zero();
  scene::GreyWindow window;
  std::string place =
      {};  // where the slice lies, in the pane's lower corner; empty: from the scanner's origin
  bool measures = false;  // a click sets a point instead of the cross-hair, a drag two
  const SliceLabels* labels = nullptr;
  std::optional<double> brush_mm =
      {};                             // radius; the left button then paints instead of moving the cross-hair
  bool shows_brush_at_cross = false;  // where keys paint; else it is drawn at the mouse
};

struct SliceEvent {
  std::optional<Eigen::Vector3d> cross_mm;  // where the cross-hair is wanted
  std::optional<scene::GreyWindow> window;  // while it is dragged
  // Set just now: the point that was clicked, or both ends of what was dragged.
  std::vector<Eigen::Vector3d> measured_mm;
  // While one measures: where the button was pressed and is held, and where the mouse is.
  std::vector<Eigen::Vector3d> reaching_mm;
  // How far the brush was drawn over the slice, and whether the button was pressed just now.
  struct Painted {
    Eigen::Vector3d from_mm = Eigen::Vector3d::Zero(), to_mm = Eigen::Vector3d::Zero();
    bool begins = false;
  };
  std::optional<Painted> painted;
  float brush_steps = 0;  // of the wheel with Shift: larger or smaller
  bool is_hovered = false;
  std::optional<double> value;  // of the volume under the mouse
};

class SlicePane {
 public:
  // right and down: of the picture, unit, LPS. title: "Axial".
  SlicePane(std::string title, const Eigen::Vector3d& right, const Eigen::Vector3d& down);

  // Another plane; what stands in the middle stays there as far as it can.
  void turn_to(std::string title, const Eigen::Vector3d& right, const Eigen::Vector3d& down);
  // All of the volume, centred; or so much about a point.
  void fit(const images::Volume& volume);
  void show(const Eigen::Vector3d& center_mm, double extent_mm);
  // Left: cross-hair. Wheel: through the slices, with Ctrl zoom. Right drag: level up and down, width right
  // and left. Middle drag, or left with Shift: shift. With a brush: left paints
  // and moves the cross-hair with Ctrl, the wheel with Shift changes the brush's size.
  SliceEvent draw(const widgets::Ui& ui, const char* name, const widgets::Rect& rect,
                  const SliceContent& content);
  // What the mouse does, for keys: nearer by steps of the wheel, a place staying where it is; the picture by
  // so many pixels.
  void zoom(double steps, const Eigen::Vector3d& fixed_mm);
  void shift(const Eigen::Vector2d& by_px) { center_mm_ -= way_mm(by_px); }
  // So many pixels right and down in the picture.
  [[nodiscard]] Eigen::Vector3d way_mm(const Eigen::Vector2d& px) const {
    return mm_per_px_ * (px.x() * right_ + px.y() * down_);
  }
  // How far one step of the wheel goes.
  [[nodiscard]] double step_mm(const images::Volume& volume) const;
  [[nodiscard]] Eigen::Vector3d normal() const { return right_.cross(down_); }

 private:
  [[nodiscard]] scene::SlicePlane plane_through(const Eigen::Vector3d& cross_mm) const;
  SliceEvent follow_mouse(const widgets::Rect& rect, const SliceContent& content);
  void draw_overlay(const widgets::Ui& ui, const widgets::Rect& rect, const SliceContent& content);
  void draw_frame(const widgets::Ui& ui, const widgets::Rect& rect, const SliceContent& content) const;

  std::string title_;
  Eigen::Vector3d right_, down_;
  Eigen::Vector3d center_mm_ =
      Eigen::Vector3d::Zero();             // what stands in the middle of the pane, in the plane
  double mm_per_px_ = 0.5, fit_mm_ = 150;  // fit_mm: of the shorter side, until it is zoomed
  bool is_fitted_ = false, press_measures_ = false, press_paints_ = false;
  float press_travel_px_ = 0;
  float wheel_steps_ = 0;                                 // of the wheel, not a whole slice yet
  Eigen::Vector3d pressed_mm_ = Eigen::Vector3d::Zero();  // a slow frame sees the mouse let go somewhere else
  widgets::GreyTexture texture_;
  std::vector<std::uint8_t> grey_;
  struct Shown {
    scene::SlicePlane plane;
    Eigen::Vector2i size_px{0, 0};
    scene::GreyWindow window;
    const images::Volume* volume = nullptr;
    std::uint64_t revision = 0, labels_revision = 0;
    bool operator==(const Shown&) const = default;
  } shown_;
  widgets::ColorTexture labels_;
  std::vector<std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>>> outlines_;  // of each mesh
};

}  // namespace arthronaut::plan
