#include "planning/graft/flexion_axis.h"

#include <Eigen/Dense>
#include <vector>

namespace arthronaut::graft {

namespace {

using Eigen::Vector3d;

constexpr double kLeastSpan_mm = 20, kReach_mm = 12, kLeastRadius_mm = 10, kMostRadius_mm = 35;
constexpr std::size_t kLeastPoints = 30;

std::optional<Vector3d> find(const landmarks::Landmarks& landmarks, const char* name) {
  const auto found = landmarks.find(name);
  if (found == landmarks.end()) return std::nullopt;
  return found->second;
}

// The centre of the sphere through the surface about a point, by linear least squares:
// |p|^2 = 2 p . c + (r^2 - |c|^2).
std::optional<Vector3d> center_about(const Vector3d& at_mm, const geometry::TriangleMesh& mesh) {
  std::vector<Vector3d> points;
  for (const Vector3d& v : mesh.vertices_mm)
    if ((v - at_mm).norm() < kReach_mm) points.push_back(v - at_mm);
  if (points.size() < kLeastPoints) return std::nullopt;
  Eigen::MatrixX4d a(static_cast<Eigen::Index>(points.size()), 4);
  Eigen::VectorXd b(a.rows());
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    const Vector3d& p = points[static_cast<std::size_t>(i)];
    a.row(i) << 2 * p.transpose(), 1.0;
    b[i] = p.squaredNorm();
  }
  const Eigen::Vector4d solved = a.colPivHouseholderQr().solve(b);
  const Vector3d center = solved.head<3>();
  const double radius = std::sqrt(std::max(0.0, solved[3] + center.squaredNorm()));
  if (!(radius > kLeastRadius_mm && radius < kMostRadius_mm)) return std::nullopt;
  return Vector3d(at_mm + center);
}

std::optional<FlexionAxis> through(FlexionAxis::Origin origin, const std::optional<Vector3d>& lateral,
                                   const std::optional<Vector3d>& medial,
                                   const landmarks::AnatomicalAxes& axes) {
  if (!lateral || !medial || (*lateral - *medial).norm() < kLeastSpan_mm) return std::nullopt;
  FlexionAxis axis{origin, 0.5 * (*lateral + *medial), (*lateral - *medial).normalized()};
  if (origin != FlexionAxis::Origin::Epicondyles) axis.condyles_apart_mm = (*lateral - *medial).norm();
  // Flexing takes what is distal backwards.
  if (axis.direction.cross(Vector3d(-axes.proximal)).dot(axes.anterior) > 0) axis.direction = -axis.direction;
  return axis;
}

}  // namespace

std::string_view to_text(FlexionAxis::Origin origin) {
  switch (origin) {
    case FlexionAxis::Origin::CondyleCenters:
      return "the condyles' centres";
    case FlexionAxis::Origin::PosteriorCondyles:
      return "spheres through the posterior condyles";
    case FlexionAxis::Origin::Epicondyles:
      return "the epicondyles";
  }
  return "unknown";
}

std::optional<FlexionAxis> flexion_axis(const landmarks::Landmarks& femur_landmarks,
                                        const geometry::TriangleMesh& femur,
                                        const landmarks::AnatomicalAxes& axes) {
  using Origin = FlexionAxis::Origin;
  if (const auto axis = through(Origin::CondyleCenters, find(femur_landmarks, "lateral_condyle_center"),
                                find(femur_landmarks, "medial_condyle_center"), axes))
    return axis;
  const auto lateral = find(femur_landmarks, "lateral_condyle_posterior"),
             medial = find(femur_landmarks, "medial_condyle_posterior");
  if (lateral && medial) {
    if (const auto axis = through(Origin::PosteriorCondyles, center_about(*lateral, femur),
                                  center_about(*medial, femur), axes))
      return axis;
  }
  return through(Origin::Epicondyles, find(femur_landmarks, "lateral_epicondyle"),
                 find(femur_landmarks, "medial_epicondyle"), axes);
}

geometry::RigidTransform femur_from_tibia(const FlexionAxis& axis, double flexion_rad) {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(flexion_rad, axis.direction));
  return {turn, axis.point_mm - turn * axis.point_mm};
}

}  // namespace arthronaut::graft
