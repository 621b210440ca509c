#include "navigation/strokes/curves.h"
#include "planning/geometry/error.h"

namespace arthronaut::strokes {

namespace {

// Collects the points of one stroke after the other and drops those that are too short to say anything.
class StrokeCutter {
 public:
  explicit StrokeCutter(const StrokeOptions& options) : options_(options) {}

  void add(double time_s, const Eigen::Vector3d& tip_mm,
           const std::optional<Eigen::Vector3d>& shaft_direction) {
    if (!stroke_.empty()) {
      const bool gap = time_s - *stroke_.back().time_s > options_.max_gap_s;
      const double hop_mm = (tip_mm - stroke_.back().position_mm).norm();
      if (gap || hop_mm > options_.max_hop_mm) {
        finish_stroke();
      } else {
        length_mm_ += hop_mm;
      }
    }
    stroke_.push_back({next_curve_, time_s, tip_mm, shaft_direction});
  }

  Curves take() {
    finish_stroke();
    return std::move(curves_);
  }

 private:
  void finish_stroke() {
    if (length_mm_ >= options_.min_length_mm) {
      curves_.insert(curves_.end(), stroke_.begin(), stroke_.end());
      ++next_curve_;
    }
    stroke_.clear();
    length_mm_ = 0;
  }

  StrokeOptions options_;
  Curves curves_, stroke_;
  double length_mm_ = 0;
  int next_curve_ = 0;
};

}  // namespace

Curves digitise(const std::vector<PoseRow>& poses, const tools::ToolSet& tools, bones::BoneKind bone,
                std::string_view tool_name, const StrokeOptions& options) {
  const tools::WorldMarker* world = tools.find_world_marker(bone);
  if (world == nullptr) {
    throw InvalidInput("the tools declare no world marker for the " + std::string(bones::to_text(bone)));
  }
  const tools::Tool* tool = tools.find_tool(tool_name);
  if (tool == nullptr)
    throw InvalidInput("the tools declare no tool named \"" + std::string(tool_name) + "\"");
  if (!tool->tip_mm) throw InvalidInput("the tool \"" + std::string(tool_name) + "\" has no tip_mm");

  const std::optional<Eigen::Vector3d> shaft_in_tool = tools::shaft_direction(*tool);
  StrokeCutter cutter(options);
  for (std::size_t first = 0; first < poses.size();) {
    const PoseRow* world_row = nullptr;
    const PoseRow* tool_row = nullptr;
    std::size_t next = first;
    for (; next < poses.size() && poses[next].frame == poses[first].frame; ++next) {
      if (poses[next].marker_id == world->marker_id) world_row = &poses[next];
      if (poses[next].marker_id == tool->marker_id) tool_row = &poses[next];
    }
    if (world_row != nullptr && tool_row != nullptr) {
      const geometry::RigidTransform world_from_tool =
          world_row->camera_from_marker.inverse() * tool_row->camera_from_marker;
      std::optional<Eigen::Vector3d> shaft_in_world;
      if (shaft_in_tool) shaft_in_world = world_from_tool.rotation * *shaft_in_tool;
      cutter.add(poses[first].time_s, world_from_tool * *tool->tip_mm, shaft_in_world);
    }
    first = next;
  }
  return cutter.take();
}

}  // namespace arthronaut::strokes
