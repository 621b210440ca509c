#include <algorithm>
#include <cmath>

#include "navigation/registration/confidence.h"
#include "navigation/registration/global_search.h"
#include "navigation/registration/pose_pool.h"
#include "navigation/registration/registration.h"
#include "navigation/strokes/stroke_tangents.h"

namespace arthronaut::registration {

RegistrationSummary register_curves(const PreparedBone& prepared, const strokes::Curves& curves,
                                    const RegistrationOptions& options) {
  constexpr std::size_t kPointCount = 800;
  constexpr int kIterations = 15;
  const PreparedBone::Data& bone = prepared.data();
  const TouchedPoints points = choose_points(curves, kPointCount);
  MarkerPrior prior;
  prior.use = options.use_marker_prior;

  PosePool pool(bone, prior);
  pool.add(search_globally(bone, strokes::oriented_points(curves), points, {options.seed, options.use_marker_prior}),
           points, options.seed);
  pool.refine_all(points, kIterations);
  if (!pool.empty()) pool.polish(points);
  return summarise(bone, pool, points, curves, options);
}

double predicted_error_mm(const RegistrationSummary& registration, const Eigen::Vector3d& point_in_bone_mm) {
  Eigen::Matrix<double, 3, 6> move;
  move << Eigen::Matrix3d::Identity(), -geometry::cross_matrix(point_in_bone_mm);
  return std::sqrt(std::max(0.0, (move * registration.covariance * move.transpose()).trace()));
}

}  // namespace arthronaut::registration
