#include "navigation/camera/camera_file.h"
#include "navigation/strokes/curves.h"
#include "navigation/strokes/poses_file.h"
#include "navigation/tools/tool_set.h"
#include "tests/fuzzing/reader.h"

namespace arthronaut::fuzzing {
namespace {

namespace fs = std::filesystem;
using Seeds = std::map<std::string, std::string>;

camera::CalibrationRecord example_camera() {
  camera::CalibrationRecord record;
  record.calibration.image_size_px = {1920, 1080};
  record.calibration.focal_px = 590;
  record.calibration.principal_point_px = {962, 541.5};
  record.calibration.distortion_xi = -0.3;
  record.calibration.rotation_center_px = {958, 538};
  record.calibration.reference_mark_angle_deg = 271.3;
  record.calibration.boundary = {{960.5, 540.2}, 531};
  record.calibration.covariance = camera::nominal_covariance(record.calibration);
  record.rms_px = 0.2;
  record.date_utc = "2026-01-31T12:00:00Z";
  record.scope_name = "Scope";
  return record;
}

}  // namespace

std::vector<Reader> navigation_readers() {
  return {
      {"camera", "camera.json",
       [](const fs::path& folder) {
         camera::write_camera_file(folder / "camera.json", example_camera());
         return Seeds{{"seed", taken(folder / "camera.json")}};
       },
       [](const fs::path& folder, std::string_view bytes) {
         const auto read = camera::read_camera_file(put(folder, "camera.json", bytes)).calibration;
         return std::string(read.focal_px > 0 ? "" : "a camera without focal length");
       }},
      {"tools", "tools.json",
       [](const fs::path& folder) {
         tools::ToolSet set = tools::standard_tools();
         tools::write_tools_file(folder / "tools.json", set);
         const std::string plain = taken(folder / "tools.json");
         set.tracker = tools::OutsideTracker{"igtl://tracker", 0.2, 0.1, {{"probe", "Stylus"}}, true};
         tools::write_tools_file(folder / "tools.json", set);
         return Seeds{{"seed", plain}, {"tracker", taken(folder / "tools.json")}};
       },
       [](const fs::path& folder, std::string_view bytes) {
         const auto set = tools::read_tools_file(put(folder, "tools.json", bytes));
         for (const auto& tool : set.tools) {
           if (!tools::tip_error_mm2(tool).allFinite()) return std::string("an error that is not finite");
         }
         return std::string();
       }},
      {"poses", "poses.csv",
       [](const fs::path& folder) {
         strokes::PoseRow row;
         row.camera_from_marker.rotation = Eigen::Quaterniond(0.5, -0.5, 0.5, 0.5);
         row.camera_from_marker.translation_mm = {1.25, -2.5, 30.123456};
         auto second = row;
         second.frame = 1;
         second.time_s = 0.04;
         second.mark_angle_deg = 271.3;
         strokes::write_poses_file(folder / "poses.csv", {row, second});
         return Seeds{{"seed", taken(folder / "poses.csv")}};
       },
       [](const fs::path& folder, std::string_view bytes) {
         for (const auto& row : strokes::read_poses_file(put(folder, "poses.csv", bytes))) {
           if (!row.camera_from_marker.translation_mm.allFinite())
             return std::string("a pose that is not finite");
         }
         return std::string();
       }},
      {"curves", "curves.csv",
       [](const fs::path& folder) {
         const strokes::CurvePoint first{.curve = 0, .time_s = 0.5, .position_mm = {1, 2, 3}};
         strokes::write_curves_file(folder / "curves.csv", {first, {.curve = 1, .position_mm = {4, 5, 6}}});
         return Seeds{{"seed", taken(folder / "curves.csv")}};
       },
       [](const fs::path& folder, std::string_view bytes) {
         const auto curves = strokes::read_curves_file(put(folder, "curves.csv", bytes));
         return std::string(strokes::length_mm(curves) >= 0 ? "" : "strokes without a length");
       }}};
}

}  // namespace arthronaut::fuzzing
