// tools.json: the markers and what they are fixed to.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "planning/bones/bone.h"

namespace arthronaut::tools {

struct WorldMarker {
  bones::BoneKind bone = bones::BoneKind::Femur;
  int marker_id = 0;
  double size_mm = 4;  // side of the black square, border included
};

struct ToolAxis {
  Eigen::Vector3d point_mm = Eigen::Vector3d::Zero();     // in the marker frame: the guide's distal end
  Eigen::Vector3d direction = -Eigen::Vector3d::UnitY();  // unit, the direction of drilling
};

struct Tool {
  std::string name;
  int marker_id = 0;
  double size_mm = 4;
  std::optional<Eigen::Vector3d> tip_mm;  // in the marker frame
  std::optional<ToolAxis> axis;
  // RMS of the calibration that tip or axis come from; empty: not known.
  std::optional<double> residual_mm = std::nullopt;
};

// Of a tool with a tip, about: unit, in the marker frame, from the tip towards the marker, which sits on the
// handle's side. Empty without a tip, or when it lies in the marker itself.
[[nodiscard]] std::optional<Eigen::Vector3d> shaft_direction(const Tool& tool);

struct ToolSet {
  std::vector<WorldMarker> world_markers;
  std::vector<Tool> tools;

  [[nodiscard]] const Tool* find_tool(std::string_view name) const;
  [[nodiscard]] const WorldMarker* find_world_marker(bones::BoneKind bone) const;
};

// The standard ids: 0 femur, 1 tibia, 2 probe, 3 femoral guide, 4 tibial guide, with the built-in
// instruments' geometry.
[[nodiscard]] ToolSet standard_tools();

// Refuses a marker id used twice, ids outside DICT_4X4_50, sizes that are not above 0, a zero axis direction.
// Throws IoError or InvalidInput.
[[nodiscard]] ToolSet read_tools_file(const std::filesystem::path& file);
void write_tools_file(const std::filesystem::path& file, const ToolSet& tools);

}  // namespace arthronaut::tools
