#include "app/report/versions.h"

#include <CGAL/version.h>
#include <arthronaut/version.h>
#include <ceres/version.h>
#include <sqlite3.h>
#include <vtkVersionMacros.h>

#include <Eigen/Core>
#include <opencv2/core/version.hpp>

#include "navigation/recording/session.h"

namespace arthronaut::report {

std::vector<std::pair<std::string, std::string>> versions() {
  const std::string eigen = std::to_string(EIGEN_WORLD_VERSION) + "." + std::to_string(EIGEN_MAJOR_VERSION) +
                            "." + std::to_string(EIGEN_MINOR_VERSION);
  return {{"Arthronaut", kProgramVersion},
          {"Arthronaut build", recording::build_identity()},
          {"OpenCV", CV_VERSION},
          {"VTK", VTK_VERSION},
          {"CGAL", CGAL_VERSION_STR},
          {"Ceres", CERES_VERSION_STRING},
          {"Eigen", eigen},
          {"SQLite", sqlite3_libversion()}};
}

std::string program_in_words(const std::string& version, const std::string& build) {
  return "Arthronaut " + version + (build.empty() ? "" : ", build " + build.substr(0, 12));
}

std::string versions_in_words() {
  std::string words = program_in_words(kProgramVersion, recording::build_identity());
  for (const auto& [name, version] : versions())
    if (!name.starts_with("Arthronaut")) words += " \u00B7 " + name + " " + version;
  return words;
}

}  // namespace arthronaut::report
