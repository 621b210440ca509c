#include "tests/navigation/tools/mean_relative_poses.h"

#include <Eigen/SVD>
#include <map>
#include <utility>

namespace arthronaut::test {

using geometry::RigidTransform;

std::vector<std::optional<RigidTransform>> mean_relative_poses(std::span<const tools::RigSighting> sightings,
                                                               const tools::RigOptions& options) {
  std::map<std::pair<std::int64_t, int>, const RigidTransform*> poses;  // by frame and marker
  for (const tools::RigSighting& seen : sightings)
    poses.emplace(std::pair(seen.frame, seen.marker_id), &seen.camera_from_marker);
  const int reference_id = options.reference_id.value_or(options.markers.front().first);
  std::vector<std::optional<RigidTransform>> means;
  for (const auto& [id, size_mm] : options.markers) {
    Eigen::Matrix3d rotations = Eigen::Matrix3d::Zero();
    Eigen::Vector3d sum_mm = Eigen::Vector3d::Zero();
    long count = 0;
    for (const auto& [seen, pose] : poses) {
      const auto reference = poses.find({seen.first, reference_id});
      if (seen.second != id || reference == poses.end()) continue;
      const RigidTransform between = reference->second->inverse() * *pose;
      rotations += between.matrix();
      sum_mm += between.translation_mm;
      ++count;
    }
    std::optional<RigidTransform>& mean = means.emplace_back();
    if (count == 0) continue;
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(rotations, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Matrix3d flip = Eigen::Matrix3d::Identity();
    flip(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
    mean.emplace();
    mean->rotation = Eigen::Quaterniond(svd.matrixU() * flip * svd.matrixV().transpose()).normalized();
    mean->translation_mm = sum_mm / static_cast<double>(count);
  }
  return means;
}

}  // namespace arthronaut::test
