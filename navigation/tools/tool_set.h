// tools.json: the markers and what they are fixed to.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "navigation/provenance/provenance.h"
#include "navigation/tools/body_marker.h"
#include "navigation/tools/outside_tracker.h"
#include "planning/bones/bone.h"

namespace arthronaut::tools {

struct WorldMarker {
  bones::BoneKind bone = bones::BoneKind::Femur;
  int marker_id = 0;   // of several, the first: it names the body
  double size_mm = 4;  // side of the black square, border included
  // Empty: the one marker is the world. Else all of them, marker_id and size_mm those of the first.
  std::vector<BodyMarker> markers = {};
};

struct ToolAxis {
  Eigen::Vector3d point_mm = Eigen::Vector3d::Zero();     // in the tool's frame: the guide's distal end
  Eigen::Vector3d direction = -Eigen::Vector3d::UnitY();  // unit, the direction of drilling
};

enum class ToolKind {
  Any,    // what it is follows from what it has: a tip, an axis
  Drill,  // a drill with a marker of its own: what it says about depth is seen, not supposed
};

// What of a tool that was calibrated nobody measured, and is still as its drawing has it: pivoting tells the
// tip alone, turning the line of the axis alone, and not where on it the guide ends.
struct NominalParts {
  bool tip = false, axis = false, end = false;  // end: how far along the axis its point lies
  [[nodiscard]] bool any() const { return tip || axis || end; }
  friend bool operator==(const NominalParts&, const NominalParts&) = default;
};

// A tool's frame is its marker's, or, where it has several, the one in which their places are said.
struct Tool {
  std::string name;
  int marker_id = 0;  // of several, the first: it names the body
  double size_mm = 4;
  std::optional<Eigen::Vector3d> tip_mm;  // in the tool's frame
  std::optional<ToolAxis> axis;
  // RMS of the calibration that tip or axis come from; empty: not known.
  std::optional<double> residual_mm = std::nullopt;
  ToolKind kind = ToolKind::Any;  // a Drill has a tip and an axis
  // How well tip and axis are known, in the tool's frame; empty: nobody said, see tip_error_mm2().
  std::optional<Eigen::Matrix3d> tip_covariance_mm2 = std::nullopt;
  std::optional<double> axis_point_sigma_mm = std::nullopt;       // of each coordinate across the axis
  std::optional<double> axis_direction_sigma_deg = std::nullopt;  // about each of two axes across it
  // Of tip and axis. A file that does not say means nominal.
  provenance::Provenance provenance = {};
  NominalParts nominal = {};  // in the file "nominal": some of "tip", "axis", "end"; see nominal_parts()
  // Empty: one marker. Else all of them, marker_id and size_mm those of the first.
  std::vector<BodyMarker> markers = {};
};

// All markers of the body; of one alone, that one at the frame's origin.
[[nodiscard]] std::vector<BodyMarker> markers_of(const Tool& tool);
[[nodiscard]] std::vector<BodyMarker> markers_of(const WorldMarker& world);

// Where the tool's first marker is in its frame: what stands for "at the handle" where a tool is drawn.
[[nodiscard]] geometry::RigidTransform first_marker_of(const Tool& tool);

// Of a tool whose origin is nominal, all that it has.
[[nodiscard]] NominalParts nominal_parts(const Tool& tool);

// What is taken for a part of a tool whose file does not say. Measured, that is with a residual: the limits
// that its calibration had to keep, 0.1 mm and 0.2 degrees. Nominal, taken from a drawing: 0.3 mm and 0.5
// degrees, what a marker that is glued or clamped by hand comes to. As the file says, else that of one sigma
// in each coordinate.
[[nodiscard]] Eigen::Matrix3d tip_error_mm2(const Tool& tool);

// How far the axis may be off, one sigma of each coordinate across it; errors of point and direction apart.
struct AxisError {
  double point_sigma_mm = 0, direction_sigma_rad = 0;
};
[[nodiscard]] AxisError axis_error(const Tool& tool);

// Of a tool with a tip, about: unit, in the tool's frame, from the tip towards the marker (of several, the
// first), which sits on the handle's side. Empty without a tip, or when it lies in the marker itself.
[[nodiscard]] std::optional<Eigen::Vector3d> shaft_direction(const Tool& tool);

struct ToolSet {
  std::vector<WorldMarker> world_markers;
  std::vector<Tool> tools;
  // Who sees them, where it is not the arthroscope. A marker's id only names its body then, and a body's
  // frame is the tracker's.
  std::optional<OutsideTracker> tracker = std::nullopt;

  [[nodiscard]] const Tool* find_tool(std::string_view name) const;
  [[nodiscard]] const WorldMarker* find_world_marker(bones::BoneKind bone) const;
  // Whether a body has more to it than one marker at its own frame.
  [[nodiscard]] bool has_bodies_of_several() const;
  // More than one drill with a marker of its own: which of them is meant has to be said.
  [[nodiscard]] bool has_several_drills() const;
};

// The standard ids: 0 femur, 1 tibia, 2 probe, 3 femoral guide, 4 tibial guide, with the built-in
// instruments' geometry.
[[nodiscard]] ToolSet standard_tools();

// What the guide of a bone's tunnel is called there, and wherever nobody says another name.
[[nodiscard]] std::string_view standard_guide_name(bones::BoneKind bone);

// Refuses a marker id used twice, ids outside DICT_4X4_50, sizes that are not above 0, a zero axis direction,
// a drill without tip or axis, an error below 0, a nominal part of another name; "markers" beside marker_id
// or size_mm, none or more than kMostMarkersOfBody of them, one without a place or whose rotation is none,
// two that lie on one another; a tracker's name for what is not declared. Throws IoError or InvalidInput.
[[nodiscard]] ToolSet read_tools_file(const std::filesystem::path& file);
void write_tools_file(const std::filesystem::path& file, const ToolSet& tools);

}  // namespace arthronaut::tools
