#include "navigation/camera/camera_file.h"

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

#include "navigation/camera/doubted_camera_file.h"
#include "navigation/camera/medium.h"
#include "planning/files/format.h"
#include "planning/files/json_covariance.h"
#include "planning/files/json_document.h"
#include "planning/geometry/error.h"

namespace arthronaut::camera {

namespace {

constexpr std::string_view kFormat = "arthronaut.camera";
constexpr int kVersion = 1;

nlohmann::ordered_json medium_to_json(double index) {
  const std::string text = medium_to_text(index);
  if (text == "air" || text == "water" || text == "saline") return text;
  return index;
}

bool is_simulated_scope(const std::string& name) {
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  return std::equal(name.begin(), name.end(), kSimulatedScope.begin(), kSimulatedScope.end(),
                    [&](char a, char b) { return lower(a) == lower(b); });
}

// A word or a number: a number in quotes was never written here, and no other program need take it for one.
double read_medium(const files::JsonObject& root) {
  const double index = refractive_index_from(root, "medium");
  if (root.is_number("medium")) return index;
  const std::string text = root.text("medium");
  if (text != "air" && text != "water" && text != "saline")
    root.fail("medium", "must be air, water, saline or a number: \"" + text + "\" stands in quotes");
  return index;
}

// Far wider than any endoscope's, so that what lies beyond is a slip: a decimal point, another unit. It would
// otherwise show as markers that are never found.
void check_plausible(const files::JsonObject& root, const Calibration& c) {
  const double largest_px = c.image_size_px.maxCoeff();
  if (c.focal_px < largest_px / 20 || c.focal_px > largest_px * 20)
    root.fail("focal_px",
              files::format("must lie between a twentieth of the picture's longer side and twenty "
                            "times it: %g px of a picture of %g px",
                            c.focal_px, largest_px));
  if (c.aspect_ratio < 0.5 || c.aspect_ratio > 2) root.fail("aspect_ratio", "must lie in [0.5, 2]");
  const auto require_near_picture = [&](const char* key, const Eigen::Vector2d& point_px) {
    if (point_px.minCoeff() < -largest_px || point_px.maxCoeff() > 2 * largest_px)
      root.fail(key, "must lie no further from the picture than that is wide");
  };
  require_near_picture("principal_point_px", c.principal_point_px);
  require_near_picture("rotation_center_px", c.rotation_center_px);
}

}  // namespace

CalibrationRecord read_camera_file(const std::filesystem::path& file) {
  const auto root = files::read_json(file, kFormat, kVersion);
  CalibrationRecord record;
  Calibration& c = record.calibration;
  const auto size = root.vector2("image_size_px");
  if (size.minCoeff() < 1 || size.maxCoeff() > 16384 || size.array().floor().matrix() != size)
    root.fail("image_size_px", "must hold two whole numbers from 1 to 16384");
  c.image_size_px = size.cast<int>();
  c.focal_px = root.positive_number("focal_px");
  c.aspect_ratio = root.positive_number("aspect_ratio");
  c.principal_point_px = root.vector2("principal_point_px");
  c.distortion_xi = root.number("distortion_xi");
  if (c.distortion_xi < -2 || c.distortion_xi > 1) root.fail("distortion_xi", "must lie in [-2, 1]");
  c.rotation_center_px = root.vector2("rotation_center_px");
  check_plausible(root, c);
  c.reference_mark_angle_deg = root.number("reference_mark_angle_deg");
  const auto boundary = root.object("boundary");
  c.boundary.center_px = boundary.vector2("center_px");
  if (c.boundary.center_px.minCoeff() < 0 ||
      ((size - Eigen::Vector2d::Ones()) - c.boundary.center_px).minCoeff() < 0)
    boundary.fail("center_px", "must lie in the image");
  c.boundary.radius_px = boundary.positive_number("radius_px");
  c.refractive_index = read_medium(root);
  if (root.has("covariance")) c.covariance = files::read_covariance(root, "covariance", 6);
  if (root.has("rms_px")) record.rms_px = root.number("rms_px");
  if (root.has("date_utc")) record.date_utc = root.text("date_utc");
  if (root.has("scope")) record.scope_name = root.text("scope");
  if (root.has("head")) record.head_name = root.text("head");
  record.provenance = provenance::read_provenance(root, provenance::Origin::Measured);
  if (record.provenance.calibrated_utc.empty()) record.provenance.calibrated_utc = record.date_utc;
  if (is_simulated_scope(record.scope_name)) record.provenance.origin = provenance::Origin::Simulated;
  return record;
}

std::vector<std::string> read_camera_doubts(const std::filesystem::path& file) {
  const auto root = files::read_json(file, kFormat, kVersion);
  if (!root.has("reliable") || root.boolean("reliable")) return {};
  std::vector<std::string> reasons;
  if (root.has("reasons")) reasons = root.texts("reasons");
  if (reasons.empty()) reasons.emplace_back("no reason given");
  return reasons;
}

void write_camera_file(const std::filesystem::path& file, const CalibrationRecord& record) {
  write_doubted_camera_file(file, record, {});
}

void write_doubted_camera_file(const std::filesystem::path& file, const CalibrationRecord& record,
                               const std::vector<std::string>& reasons) {
  const Calibration& c = record.calibration;
  nlohmann::ordered_json json = {
      {"format", kFormat},
      {"version", kVersion},
      {"image_size_px", {c.image_size_px.x(), c.image_size_px.y()}},
      {"focal_px", c.focal_px},
      {"aspect_ratio", c.aspect_ratio},
      {"principal_point_px", files::to_json(c.principal_point_px)},
      {"distortion_xi", c.distortion_xi},
      {"rotation_center_px", files::to_json(c.rotation_center_px)},
      {"reference_mark_angle_deg", c.reference_mark_angle_deg},
      {"boundary",
       {{"center_px", files::to_json(c.boundary.center_px)}, {"radius_px", c.boundary.radius_px}}},
      {"medium", medium_to_json(c.refractive_index)},
  };
  if (c.covariance) json["covariance"] = files::covariance_to_json(*c.covariance);
  if (record.rms_px >= 0) json["rms_px"] = record.rms_px;
  if (!record.date_utc.empty()) json["date_utc"] = record.date_utc;
  if (!record.scope_name.empty()) json["scope"] = record.scope_name;
  if (!record.head_name.empty()) json["head"] = record.head_name;
  json["origin"] = provenance::to_text(record.provenance.origin);
  const std::string& calibrated_utc =
      record.provenance.calibrated_utc.empty() ? record.date_utc : record.provenance.calibrated_utc;
  if (!calibrated_utc.empty()) json["calibrated_utc"] = calibrated_utc;
  if (!reasons.empty()) {
    json["reliable"] = false;
    json["reasons"] = reasons;
  }
  files::write_json(file, json);
}

}  // namespace arthronaut::camera
