#include "navigation/registration/search/curve_checks.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "planning/files/format.h"

namespace arthronaut::registration {

std::vector<std::string> objections_to(const strokes::Curves& curves, double bone_size_mm,
                                       const CurveCheckOptions& options) {
  if (curves.size() < options.min_point_count) {
    return {files::format("only %.0f points were touched: too few, draw at least 100 mm of strokes",
                          static_cast<double>(curves.size()))};
  }
  Eigen::Vector3d mean = Eigen::Vector3d::Zero(), low = curves.front().position_mm, high = low;
  for (const strokes::CurvePoint& point : curves) {
    if (!point.position_mm.allFinite()) return {"the curves hold a number that is not finite"};
    mean += point.position_mm / static_cast<double>(curves.size());
    low = low.cwiseMin(point.position_mm);
    high = high.cwiseMax(point.position_mm);
  }
  const double extent_mm = (high - low).norm();
  if (extent_mm < 1e-6) return {"all points are the same"};
  if (extent_mm > 2 * bone_size_mm + 100) {
    return {files::format("the points spread over %.0f mm, more than the bone is large: are they in mm?",
                          extent_mm)};
  }
  // A patch of one millimetre across is rather one of a metre's hundredth.
  if (extent_mm < 0.5)
    return {
        files::format("the points lie within %.2g mm of each other: draw on more of the bone (a file in "
                      "metres looks so, too)",
                      extent_mm)};

  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const strokes::CurvePoint& point : curves) {
    const Eigen::Vector3d away = point.position_mm - mean;
    scatter += away * away.transpose() / static_cast<double>(curves.size());
  }
  const Eigen::Vector3d squares = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvalues();
  std::vector<std::string> objections;
  // The extent of an even patch is about four times its root mean square; lifted samples don't count much
  // there.
  const double patch_mm = 4 * std::sqrt(std::max(0.0, squares[2]));
  if (patch_mm < options.min_extent_mm) {
    objections.push_back(
        files::format("the touched patch is only %.0f mm across, too small to tell how the bone lies: "
                      "touch more of the notch",
                      patch_mm));
  } else if (std::sqrt(std::max(0.0, squares[1])) < options.min_breadth_mm) {
    objections.push_back("all strokes lie on one straight line: draw across it");
  }
  return objections;
}

}  // namespace arthronaut::registration
