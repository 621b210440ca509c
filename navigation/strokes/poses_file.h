// poses.csv: one row for each marker seen in each frame.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "planning/geometry/rigid_transform.h"

namespace arthronaut::strokes {

struct PoseRow {
  std::int64_t frame = 0;
  double time_s = 0;
  int marker_id = 0;
  geometry::RigidTransform camera_from_marker;
  double rms_px = 0;
  std::optional<double> mark_angle_deg;  // empty while the lens mark is not found
  std::optional<double> size_mm;  // that the marker was taken to have; empty where the file does not say
};

// Throws IoError or InvalidInput (file, line, column, reason): missing column, a number that is not finite, a
// quaternion whose norm is off 1 by more than 1e-3, a marker more than ten metres off, a frame, marker or
// residual below zero, time that runs backwards, a marker twice in a frame. The column size_mm may be
// missing: other programs do not write it.
[[nodiscard]] std::vector<PoseRow> read_poses_file(const std::filesystem::path& file);
void write_poses_file(const std::filesystem::path& file, const std::vector<PoseRow>& rows);
[[nodiscard]] std::string poses_to_text(const std::vector<PoseRow>& rows);
// The same in parts, for a file that grows: the first line, then each row.
inline constexpr std::string_view kPosesHeader =
    "frame,time_s,marker_id,qw,qx,qy,qz,tx_mm,ty_mm,tz_mm,rms_px,mark_angle_deg,size_mm\n";
void append_pose_line(const PoseRow& row, std::string& text);

}  // namespace arthronaut::strokes
