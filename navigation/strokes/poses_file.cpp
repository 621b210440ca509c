#include "navigation/strokes/poses_file.h"

#include <cmath>
#include <cstdio>
#include <set>

#include "navigation/strokes/csv_place.h"
#include "planning/files/atomic_file.h"
#include "planning/files/csv_table.h"

namespace arthronaut::strokes {

namespace {

constexpr double kMaxNormError = 1e-3;
// No camera, and no tracker, sees a marker of the operation from further off.
constexpr double kFarthestPose_mm = 10000;

PoseRow read_row(const files::CsvTable& table, std::size_t row) {
  PoseRow pose;
  pose.frame = table.integer(row, "frame");
  if (pose.frame < 0) table.fail(row, "frame", "must not be negative");
  pose.time_s = table.number(row, "time_s");
  pose.marker_id = table.int32(row, "marker_id");
  if (pose.marker_id < 0) table.fail(row, "marker_id", "must not be negative");
  const Eigen::Quaterniond rotation(table.number(row, "qw"), table.number(row, "qx"), table.number(row, "qy"),
                                    table.number(row, "qz"));
  if (std::abs(rotation.norm() - 1.0) > kMaxNormError)
    table.fail(row, "qw", "the quaternion's norm is not 1");
  pose.camera_from_marker.rotation = rotation.normalized();
  pose.camera_from_marker.translation_mm =
      place_in(table, row, {"tx_mm", "ty_mm", "tz_mm"}, kFarthestPose_mm, "lies more than ten metres off");
  pose.rms_px = table.number(row, "rms_px");
  if (pose.rms_px < 0) table.fail(row, "rms_px", "must not be negative");
  pose.mark_angle_deg = table.optional_number(row, "mark_angle_deg");
  if (pose.mark_angle_deg && (*pose.mark_angle_deg < 0 || *pose.mark_angle_deg >= 360))
    table.fail(row, "mark_angle_deg", "is not within [0, 360)");
  if (table.has_column("size_mm")) pose.size_mm = table.optional_number(row, "size_mm");
  if (pose.size_mm && *pose.size_mm <= 0) table.fail(row, "size_mm", "is not above zero");
  return pose;
}

}  // namespace

std::vector<PoseRow> read_poses_file(const std::filesystem::path& file) {
  const auto table = files::CsvTable::read(file, {"frame", "time_s", "marker_id", "qw", "qx", "qy", "qz",
                                                  "tx_mm", "ty_mm", "tz_mm", "rms_px", "mark_angle_deg"});
  std::vector<PoseRow> rows;
  rows.reserve(table.row_count());
  std::set<int> ids_in_frame;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    rows.push_back(read_row(table, row));
    if (row > 0 && rows[row].frame != rows[row - 1].frame) ids_in_frame.clear();
    if (!ids_in_frame.insert(rows[row].marker_id).second)
      table.fail(row, "marker_id", "is the second pose of this marker in its frame");
    if (row == 0) continue;
    const PoseRow& before = rows[row - 1];
    if (rows[row].time_s < before.time_s) table.fail(row, "time_s", "runs backwards");
    if (rows[row].frame < before.frame) table.fail(row, "frame", "runs backwards");
  }
  return rows;
}

void append_pose_line(const PoseRow& row, std::string& text) {
  char line[320];
  const Eigen::Quaterniond& q = row.camera_from_marker.rotation;
  const Eigen::Vector3d& t = row.camera_from_marker.translation_mm;
  std::snprintf(line, sizeof line, "%lld,%.6f,%d,%.9f,%.9f,%.9f,%.9f,%.6f,%.6f,%.6f,%.4f,",
                static_cast<long long>(row.frame), row.time_s, row.marker_id, q.w(), q.x(), q.y(), q.z(),
                t.x(), t.y(), t.z(), row.rms_px);
  text += line;
  if (row.mark_angle_deg) {
    // What rounds to a whole turn is none.
    const double angle_deg = *row.mark_angle_deg < 360 - 5e-7 ? *row.mark_angle_deg : 0;
    std::snprintf(line, sizeof line, "%.6f", angle_deg);
    text += line;
  }
  text += ',';
  if (row.size_mm) {
    std::snprintf(line, sizeof line, "%.9g", *row.size_mm);
    text += line;
  }
  text += '\n';
}

std::string poses_to_text(const std::vector<PoseRow>& rows) {
  std::string text(kPosesHeader);
  for (const PoseRow& row : rows) append_pose_line(row, text);
  return text;
}

void write_poses_file(const std::filesystem::path& file, const std::vector<PoseRow>& rows) {
  files::write_atomically(file, poses_to_text(rows));
}

}  // namespace arthronaut::strokes
