// Distances and angles that somebody measured in the images or on the bones of a case: measurements.json in
// its folder.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "planning/files/json_document.h"

namespace arthronaut::cases {

struct Measurement {
  // LPS, mm. Two: the distance between them. Three: the angle at the middle one.
  std::vector<Eigen::Vector3d> points_mm;

  [[nodiscard]] bool is_angle() const { return points_mm.size() == 3; }
  [[nodiscard]] double distance_mm() const;  // precondition: two points
  [[nodiscard]] double angle_deg()
      const;  // precondition: three points; 0 to 180, 0 where two of them are one
  [[nodiscard]] std::string in_words() const;  // "12.3 mm", "54.1\u00B0"
  bool operator==(const Measurement&) const = default;
};

[[nodiscard]] std::filesystem::path measurements_file(const std::filesystem::path& case_folder);
// In the order in which they were made; none where there is no file. Throws IoError or InvalidInput (file,
// place, reason).
[[nodiscard]] std::vector<Measurement> load_measurements(const std::filesystem::path& case_folder);
// Atomic; without any the file goes. Throws IoError; InvalidInput for a measurement of another number of
// points.
void save_measurements(const std::filesystem::path& case_folder,
                       const std::vector<Measurement>& measurements);
// The same in another file of the case: an object with "measurements". Throw as above.
[[nodiscard]] nlohmann::ordered_json to_json(const std::vector<Measurement>& measurements);
[[nodiscard]] std::vector<Measurement> measurements_from(const files::JsonObject& node);

}  // namespace arthronaut::cases
