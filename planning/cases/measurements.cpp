#include "planning/cases/measurements.h"

#include <nlohmann/json.hpp>

#include "planning/files/format.h"
#include "planning/files/json_document.h"
#include "planning/files/remove_file.h"
#include "planning/geometry/error.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::cases {

namespace {

namespace fs = std::filesystem;
constexpr std::string_view kMeasurementsFormat = "arthronaut.measurements";
constexpr int kMeasurementsVersion = 1;

}  // namespace

double Measurement::distance_mm() const { return (points_mm[1] - points_mm[0]).norm(); }

double Measurement::angle_deg() const {
  const Eigen::Vector3d a = points_mm[0] - points_mm[1], b = points_mm[2] - points_mm[1];
  if (!(a.norm() > 0) || !(b.norm() > 0)) return 0;
  return geometry::deg_from_rad(geometry::angle_between_rad(a, b));
}

std::string Measurement::in_words() const {
  return is_angle() ? files::format("%.1f\u00B0", angle_deg()) : files::format("%.1f mm", distance_mm());
}

fs::path measurements_file(const fs::path& case_folder) { return case_folder / "measurements.json"; }

std::vector<Measurement> load_measurements(const fs::path& case_folder) {
  const fs::path file = measurements_file(case_folder);
  if (!fs::exists(file)) return {};
  return measurements_from(files::read_json(file, kMeasurementsFormat, kMeasurementsVersion));
}

std::vector<Measurement> measurements_from(const files::JsonObject& root) {
  std::vector<Measurement> measurements;
  for (const auto& node : root.objects("measurements")) {
    Measurement measurement;
    for (const auto& point : node.objects("points")) measurement.points_mm.push_back(point.vector3("mm"));
    if (measurement.points_mm.size() != 2 && measurement.points_mm.size() != 3)
      node.fail("points", "must be two for a distance or three for an angle");
    measurements.push_back(std::move(measurement));
  }
  return measurements;
}

nlohmann::ordered_json to_json(const std::vector<Measurement>& measurements) {
  auto nodes = nlohmann::ordered_json::array();
  for (const Measurement& measurement : measurements) {
    if (measurement.points_mm.size() != 2 && measurement.points_mm.size() != 3)
      throw InvalidInput("a measurement has two points or three");
    auto points = nlohmann::ordered_json::array();
    for (const Eigen::Vector3d& point : measurement.points_mm)
      points.push_back({{"mm", files::to_json(point)}});
    nlohmann::ordered_json node = {{"points", std::move(points)}};
    if (measurement.is_angle())
      node["angle_deg"] = measurement.angle_deg();
    else
      node["distance_mm"] = measurement.distance_mm();
    nodes.push_back(std::move(node));
  }
  return {{"measurements", std::move(nodes)}};
}

void save_measurements(const fs::path& case_folder, const std::vector<Measurement>& measurements) {
  const fs::path file = measurements_file(case_folder);
  if (measurements.empty()) return files::remove_file(file);
  nlohmann::ordered_json document = {{"format", kMeasurementsFormat}, {"version", kMeasurementsVersion}};
  document.update(to_json(measurements));
  files::write_json(file, document);
}

}  // namespace arthronaut::cases
