#include <algorithm>

#include "navigation/strokes/body_rows.h"
#include "navigation/strokes/curves.h"
#include "planning/geometry/error.h"

namespace arthronaut::strokes {

namespace {

// Those that count, numbered from 0.
Curves strokes_that_count(const Curves& points, const StrokeOptions& options) {
  Curves curves;
  int number = 0;
  for (auto first = points.begin(); first != points.end();) {
    const auto end = std::find_if(first, points.end(),
                                  [&](const CurvePoint& point) { return point.curve != first->curve; });
    if (counts({first, end}, options)) {
      for (auto it = first; it != end; ++it) curves.push_back(*it), curves.back().curve = number;
      ++number;
    }
    first = end;
  }
  return curves;
}

}  // namespace

bool goes_on(const CurvePoint& last, double time_s, const Eigen::Vector3d& tip_in_marker_mm,
             const StrokeOptions& options) {
  const double since_s = time_s - last.time_s.value_or(time_s);
  return since_s >= 0 && since_s <= options.max_gap_s &&
         (tip_in_marker_mm - last.position_mm).norm() <= options.max_hop_mm;
}

bool counts(std::span<const CurvePoint> stroke, const StrokeOptions& options) {
  double length_mm = 0;
  for (std::size_t i = 1; i < stroke.size(); ++i)
    length_mm += (stroke[i].position_mm - stroke[i - 1].position_mm).norm();
  return length_mm >= options.min_length_mm;
}

Curves digitise(const std::vector<PoseRow>& marker_poses, const tools::ToolSet& tools, bones::BoneKind bone,
                std::string_view tool_name, const StrokeOptions& options) {
  const tools::WorldMarker* world = tools.find_world_marker(bone);
  if (world == nullptr) {
    throw InvalidInput("the tools declare no world marker for the " + std::string(bones::to_text(bone)));
  }
  const tools::Tool* tool = tools.find_tool(tool_name);
  if (tool == nullptr)
    throw InvalidInput("the tools declare no tool named \"" + std::string(tool_name) + "\"");
  if (!tool->tip_mm) throw InvalidInput("the tool \"" + std::string(tool_name) + "\" has no tip_mm");

  const std::vector<PoseRow> poses = body_rows(marker_poses, tools);
  const std::optional<Eigen::Vector3d> shaft_in_tool = tools::shaft_direction(*tool);
  Curves points;
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
      const double time_s = poses[first].time_s;
      const Eigen::Vector3d tip_mm = world_from_tool * *tool->tip_mm;
      const int before = points.empty() ? 0 : points.back().curve;
      const bool is_new = !points.empty() && !goes_on(points.back(), time_s, tip_mm, options);
      points.push_back({before + (is_new ? 1 : 0), time_s, tip_mm, shaft_in_world});
    }
    first = next;
  }
  return strokes_that_count(points, options);
}

}  // namespace arthronaut::strokes
