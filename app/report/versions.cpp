#include "app/report/versions.h"

#include <CGAL/version.h>
#include <arthronaut/version.h>
#include <ceres/version.h>
#include <sqlite3.h>
#include <vtkVersionMacros.h>

#include <Eigen/Core>
#include <opencv2/core/version.hpp>

namespace arthronaut::report {

std::vector<std::pair<std::string, std::string>> versions() {
  const std::string eigen = std::to_string(EIGEN_WORLD_VERSION) + "." + std::to_string(EIGEN_MAJOR_VERSION) +
                            "." + std::to_string(EIGEN_MINOR_VERSION);
  return {{"Arthronaut", kProgramVersion}, {"OpenCV", CV_VERSION},          {"VTK", VTK_VERSION},
          {"CGAL", CGAL_VERSION_STR},      {"Ceres", CERES_VERSION_STRING}, {"Eigen", eigen},
          {"SQLite", sqlite3_libversion()}};
}

std::string versions_in_words() {
  std::string words;
  for (const auto& [name, version] : versions())
    words += (words.empty() ? "" : " \u00B7 ") + name + " " + version;
  return words;
}

}  // namespace arthronaut::report
