// The three slices of a case, linked by one cross-hair, with one window of grey values and the measuring
// tools. The images are loaded on a thread of their own when they are first wanted.
#pragma once

#include <array>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/plan/slice_pane.h"
#include "app/plan/tunnel_planes.h"
#include "navigation/worker/awaited.h"
#include "planning/cases/case.h"

namespace arthronaut::plan {

enum class MeasuringTool { None, Distance, Angle };

class SlicePanes {
 public:
  // wake: called from the loading thread when it ends.
  explicit SlicePanes(std::function<void()> wake);
  ~SlicePanes();  // stops loading
  SlicePanes(const SlicePanes&) = delete;
  SlicePanes& operator=(const SlicePanes&) = delete;

  // Another case; its images are not read yet. joint: what is shown of them at first, the cross-hair in its
  // middle.
  void open(const cases::Case& knee, const std::filesystem::path& folder, const geometry::Bounds& joint);
  [[nodiscard]] bool has_images() const { return !images_.empty(); }
  // Begins to load, once.
  void want();
  void tick();  // takes over what was loaded
  [[nodiscard]] bool is_loading() const { return loading_.is_busy(); }
  [[nodiscard]] const images::Volume* volume() const { return volume_.get(); }
  [[nodiscard]] const std::shared_ptr<const images::Volume>& shared_volume() const { return volume_; }
  // Why there is nothing to show; empty when there is.
  [[nodiscard]] std::string reason() const;

  void go_to_next_window();
  void set_cross(const Eigen::Vector3d& point_mm) { cross_mm_ = point_mm; }
  [[nodiscard]] const Eigen::Vector3d& cross_mm() const { return cross_mm_; }
  // The cross-hair goes there; of slices along a tunnel to its depth, and they turn so that the first along
  // it holds the point.
  void show_point(const Eigen::Vector3d& point_mm);
  void fit();

  // In place of axial, coronal and sagittal: across the tunnel at the cross-hair, which stays on its axis,
  // and two slices that hold the axis, square to each other. The wheel goes along the one and turns the
  // others. nullopt: axial, coronal, sagittal. To be told in every frame, the tunnel moves.
  void follow(const std::optional<TunnelAxis>& tunnel);
  void turn(double by_deg) { turned_deg_ = std::remainder(turned_deg_ + by_deg, 360); }
  [[nodiscard]] double turned_deg() const { return turned_deg_; }

  // What the mouse does in one of the three (0 to 2), for keys: to the next images, the cross-hair by so many
  // pixels right and down, nearer about the cross-hair, the picture by so many pixels. Precondition:
  // volume().
  void scroll(std::size_t pane, int images);
  void move_cross(std::size_t pane, const Eigen::Vector2d& by_px);
  void zoom(std::size_t pane, double steps) { panes_[pane].zoom(steps, cross_mm_); }
  void shift(std::size_t pane, const Eigen::Vector2d& by_px) { panes_[pane].shift(by_px); }

  void use(MeasuringTool tool);
  void measure_here() { add_measured({cross_mm_}); }  // a point at the cross-hair. Precondition: a tool
  [[nodiscard]] MeasuringTool tool() const { return tool_; }
  // A measurement whose last point was just set; once.
  [[nodiscard]] std::optional<std::vector<Eigen::Vector3d>> take_measured();

  // Over `areas`, axial, coronal and sagittal. content: meshes, marks, lines and revision; the rest is filled
  // in.
  void draw(const widgets::Ui& ui, const std::array<widgets::Rect, 3>& areas, SliceContent content);

 private:
  struct Loaded {
    std::shared_ptr<const images::Volume> volume;
    scene::GreyWindow automatic;
    std::string failure;
  };
  void stop_loading();
  void show_joint();
  void lay_along(const TunnelAxis& tunnel);
  // Where the cross-hair is wanted in a slice: of one along the tunnel what is across it is a turn.
  void set_cross_in(std::size_t pane, const Eigen::Vector3d& point_mm);
  void add_measured(const std::vector<Eigen::Vector3d>& points_mm);
  [[nodiscard]] std::size_t points_asked() const { return tool_ == MeasuringTool::Angle ? 3 : 2; }

  std::function<void()> wake_;
  std::vector<cases::CaseImage> images_;
  std::filesystem::path folder_;
  worker::Awaited<Loaded> loading_;
  std::atomic<double> loaded_{0};
  std::atomic<bool> stops_{false};
  std::shared_ptr<const images::Volume> volume_;
  std::string failure_;
  scene::GreyWindow window_, automatic_;
  geometry::Bounds joint_{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  Eigen::Vector3d cross_mm_ = Eigen::Vector3d::Zero();
  MeasuringTool tool_ = MeasuringTool::None;
  std::vector<Eigen::Vector3d> points_mm_;    // of the measurement that is being made
  std::vector<Eigen::Vector3d> reaching_mm_;  // from there to the mouse
  std::optional<TunnelAxis> tunnel_;
  double turned_deg_ = 0;
  std::array<SlicePane, 3> panes_;
};

}  // namespace arthronaut::plan
