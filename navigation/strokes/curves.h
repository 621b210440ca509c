// What the probe's tip drew on the bone: points in the world-marker frame, in drawing order.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "navigation/strokes/packed_optional.h"
#include "navigation/strokes/poses_file.h"
#include "navigation/tools/tool_set.h"

namespace arthronaut::strokes {

// 64 bytes, of which an operation may hold hundreds of thousands.
struct CurvePoint {
  int curve = 0;
  PackedOptional<double> time_s;
  Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();  // world-marker frame
  // Unit, from the tip towards the handle, world-marker frame: the way the probe came. Empty: not known.
  PackedOptional<Eigen::Vector3d> shaft_direction = std::nullopt;
};
using Curves = std::vector<CurvePoint>;

// How far the tip went, mm: from point to point, gaps between strokes left out.
[[nodiscard]] double length_mm(const Curves& curves);

// curves.csv. The columns shaft_x, shaft_y and shaft_z are read where they are there, and written when asked
// for; their cells are empty where the direction is not known. Throws IoError or InvalidInput.
enum class ShaftColumns { LeaveOut, Write };
[[nodiscard]] Curves read_curves_file(const std::filesystem::path& file);
void write_curves_file(const std::filesystem::path& file, const Curves& curves,
                       ShaftColumns shaft = ShaftColumns::LeaveOut);

struct StrokeOptions {
  double max_gap_s = 0.1;      // a stroke ends where tracking was gone for longer
  double max_hop_mm = 1.5;     // and where the tip jumps further between two frames
  double min_length_mm = 2.0;  // shorter strokes are left out
};

// The two rules by which a path is cut into strokes, while it is drawn and from a file alike.
// Whether the tip, here and now, goes on with the stroke whose newest point is `last`.
[[nodiscard]] bool goes_on(const CurvePoint& last, double time_s, const Eigen::Vector3d& tip_in_marker_mm,
                           const StrokeOptions& options);
// Whether a stroke is long enough to say anything, measured from point to point.
[[nodiscard]] bool counts(std::span<const CurvePoint> stroke, const StrokeOptions& options);

// Tip positions wherever world marker and tool are seen in the same frame, by the poses of their bodies where
// these carry several markers (body_rows.h). An empty result is not an error.
// Throws InvalidInput when the tools declare no such world marker or tool, or the tool has no tip.
[[nodiscard]] Curves digitise(const std::vector<PoseRow>& marker_poses, const tools::ToolSet& tools,
                              bones::BoneKind bone, std::string_view tool_name,
                              const StrokeOptions& options = {});

}  // namespace arthronaut::strokes
