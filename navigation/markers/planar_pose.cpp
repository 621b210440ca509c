#include "navigation/markers/planar_pose.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace arthronaut::markers {
namespace {

using geometry::Matrix6d;
using geometry::RigidTransform;
using geometry::Vector6d;

constexpr int kMaxIterations = 12;
constexpr double kSettledMm = 1e-7, kSettledRad = 1e-8;
// Two refined poses nearer to each other than this are the same minimum.
constexpr double kSamePoseRad = 0.5 * geometry::kPi / 180;

struct Linearised {
  double cost = 0;  // sum of squared pixel distances
  Matrix6d normal = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
};

bool linearise(const camera::CameraModel& camera, const Corners& corners_px,
               const std::array<Eigen::Vector3d, 4>& corners_mm, const RigidTransform& pose,
               Linearised& result) {
  result = Linearised();
  const Eigen::Matrix3d rotation = pose.matrix();
  for (int i = 0; i < 4; ++i) {
    Eigen::Matrix<double, 2, 3> d_pixel;
    const auto pixel = camera.project(pose * corners_mm[i], d_pixel);
    if (!pixel) return false;
    Eigen::Matrix<double, 2, 6> jacobian;
    const Eigen::Matrix<double, 2, 3> d_rotated = d_pixel * rotation;
    jacobian.leftCols<3>() = d_rotated;
    jacobian.rightCols<3>() = -d_rotated * geometry::cross_matrix(corners_mm[i]);
    const Eigen::Vector2d residual = *pixel - corners_px[i];
    result.cost += residual.squaredNorm();
    result.normal.noalias() += jacobian.transpose() * jacobian;
    result.gradient.noalias() += jacobian.transpose() * residual;
  }
  return true;
}

// The translation that fits a rotation best, linear least squares on the tangent plane with H's own image of
// the plane: the columns of H are proportional to R's and to t.
Eigen::Vector3d translation_for(const Eigen::Matrix3d& homography, const Eigen::Matrix3d& rotation) {
  const double scale = (homography.col(0).dot(rotation.col(0)) + homography.col(1).dot(rotation.col(1))) /
                       (homography.col(0).squaredNorm() + homography.col(1).squaredNorm());
  return scale * homography.col(2);
}

double misfit(const Eigen::Matrix3d& homography, const Eigen::Matrix3d& rotation) {
  const double scale = (homography.col(0).dot(rotation.col(0)) + homography.col(1).dot(rotation.col(1))) /
                       (homography.col(0).squaredNorm() + homography.col(1).squaredNorm());
  return (scale * homography.leftCols<2>() - rotation.leftCols<2>()).squaredNorm();
}

}  // namespace

std::array<Eigen::Vector3d, 4> square_corners_mm(double size_mm) {
  const double h = 0.5 * size_mm;
  return {Eigen::Vector3d(-h, h, 0), Eigen::Vector3d(h, h, 0), Eigen::Vector3d(h, -h, 0),
          Eigen::Vector3d(-h, -h, 0)};
}

std::optional<Eigen::Matrix3d> square_homography(const Corners& tangent, double size_mm) {
  const double h = 0.5 * size_mm;
  const double x[4] = {-h, h, h, -h}, y[4] = {h, h, -h, -h};
  Eigen::Matrix<double, 8, 8> system;
  Eigen::Matrix<double, 8, 1> right;
  for (int i = 0; i < 4; ++i) {
    const double u = tangent[i].x(), v = tangent[i].y();
    system.row(2 * i) << x[i], y[i], 1, 0, 0, 0, -u * x[i], -u * y[i];
    system.row(2 * i + 1) << 0, 0, 0, x[i], y[i], 1, -v * x[i], -v * y[i];
    right[2 * i] = u;
    right[2 * i + 1] = v;
  }
  const Eigen::Matrix<double, 8, 1> solution = system.partialPivLu().solve(right);
  if (!solution.allFinite()) return std::nullopt;
  Eigen::Matrix3d homography;
  homography << solution[0], solution[1], solution[2], solution[3], solution[4], solution[5], solution[6],
      solution[7], 1;
  const double size = homography.leftCols<2>().norm();
  // Collinear corners give a homography that folds the plane to a line.
  if (!(homography.leftCols<2>().colwise().norm().minCoeff() > 1e-6 * size)) return std::nullopt;
  if (std::abs(homography.determinant()) < 1e-9 * size * size) return std::nullopt;
  return homography;
}

std::array<RigidTransform, 2> poses_from_homography(const Eigen::Matrix3d& h) {
  // The derivative of the homography at the marker's centre, and the ray through it.
  const Eigen::Vector2d centre = h.block<2, 1>(0, 2);
  Eigen::Matrix2d jacobian;
  jacobian << h(0, 0) - h(2, 0) * centre.x(), h(0, 1) - h(2, 1) * centre.x(), h(1, 0) - h(2, 0) * centre.y(),
      h(1, 1) - h(2, 1) * centre.y();

  // The rotation that takes the optical axis to that ray.
  Eigen::Matrix3d to_ray = Eigen::Matrix3d::Identity();
  const double length = centre.norm();
  if (length > 1e-12) {
    const Eigen::Vector3d axis(-centre.y() / length, centre.x() / length, 0);
    to_ray = Eigen::AngleAxisd(std::atan(length), axis).toRotationMatrix();
  }
  Eigen::Matrix<double, 2, 3> slope;
  slope << 1, 0, -centre.x(), 0, 1, -centre.y();
  const Eigen::Matrix2d a = (slope * to_ray.leftCols<2>()).inverse() * jacobian;

  // Its largest singular value is 1 / depth; what is left of the unit columns is out of the plane, with
  // either sign.
  const Eigen::Matrix2d aa = a.transpose() * a;
  const double half_trace = 0.5 * aa.trace();
  const double gap = std::sqrt(std::max(0.0, half_trace * half_trace - aa.determinant()));
  const Eigen::Matrix2d r22 = a / std::sqrt(std::max(half_trace + gap, 1e-300));
  const Eigen::Matrix2d rest = Eigen::Matrix2d::Identity() - r22.transpose() * r22;
  const double b1 = std::sqrt(std::max(0.0, rest(0, 0)));
  const double b2 = std::copysign(std::sqrt(std::max(0.0, rest(1, 1))), rest(0, 1));

  std::array<RigidTransform, 2> poses;
  std::array<double, 2> misfits{};
  for (int i = 0; i < 2; ++i) {
    const double sign = i == 0 ? 1 : -1;
    Eigen::Matrix3d local;
    local.col(0) << r22.col(0), sign * b1;
    local.col(1) << r22.col(1), sign * b2;
    local.col(2) = local.col(0).cross(local.col(1));
    const Eigen::Matrix3d rotation = to_ray * local;
    poses[i].rotation = Eigen::Quaterniond(rotation).normalized();
    poses[i].translation_mm = translation_for(h, rotation);
    misfits[i] = misfit(h, rotation);
  }
  if (misfits[1] < misfits[0]) std::swap(poses[0], poses[1]);
  return poses;
}

std::array<RigidTransform, 2> poses_of_square(const Corners& tangent, int turn, double size_mm) {
  Corners turned;
  for (int i = 0; i < 4; ++i) turned[i] = tangent[(turn + i) % 4];
  const auto homography = square_homography(turned, size_mm);
  return homography ? poses_from_homography(*homography) : std::array<RigidTransform, 2>();
}

RigidTransform tilted_back(const RigidTransform& camera_from_marker) {
  const Eigen::Vector3d normal = camera_from_marker.rotate(Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d to_eye = -camera_from_marker.translation_mm.normalized();
  const Eigen::Vector3d axis = normal.cross(to_eye);
  if (axis.norm() < 1e-9) return camera_from_marker;
  const Eigen::AngleAxisd turn(2 * geometry::angle_between_rad(normal, to_eye), axis.normalized());
  return {(Eigen::Quaterniond(turn) * camera_from_marker.rotation).normalized(),
          camera_from_marker.translation_mm};
}

std::optional<SquarePose> refine_square_pose(const camera::CameraModel& camera, const Corners& corners_px,
                                             double size_mm, const RigidTransform& start) {
  const auto corners_mm = square_corners_mm(size_mm);
  RigidTransform pose = start;
  Linearised here;
  if (!(pose.translation_mm.z() > 0) || !linearise(camera, corners_px, corners_mm, pose, here))
    return std::nullopt;
  double damping = 1e-4;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    Matrix6d damped = here.normal;
    damped.diagonal() *= 1 + damping;
    const Vector6d step = -damped.ldlt().solve(here.gradient);
    if (!step.allFinite()) return std::nullopt;
    const RigidTransform next = pose * geometry::exp(step);
    Linearised there;
    if (linearise(camera, corners_px, corners_mm, next, there) && there.cost <= here.cost) {
      pose = next;
      here = there;
      damping = std::max(1e-9, damping * 0.1);
      if (step.head<3>().norm() < kSettledMm && step.tail<3>().norm() < kSettledRad) break;
    } else {
      damping *= 10;
      if (damping > 1e6) break;
    }
  }
  SquarePose result;
  result.camera_from_marker = pose;
  result.information = here.normal;
  result.rms_px = std::sqrt(here.cost / 4);
  return result;
}

std::optional<SquarePoses> solve_square(const camera::CameraModel& camera, const Corners& corners_px,
                                        double size_mm) {
  Corners tangent;
  for (int i = 0; i < 4; ++i) {
    const auto point = camera.undistort(corners_px[i]);
    if (!point) return std::nullopt;
    tangent[i] = *point;
  }
  const auto homography = square_homography(tangent, size_mm);
  if (!homography) return std::nullopt;
  std::optional<SquarePose> first, second;
  for (const RigidTransform& start : poses_from_homography(*homography)) {
    (first ? second : first) = refine_square_pose(camera, corners_px, size_mm, start);
  }
  if (!first) return std::nullopt;
  if (second && second->rms_px < first->rms_px) std::swap(first, second);
  SquarePoses result;
  result.best = *first;
  result.ambiguity_ratio = kNoOtherPose;
  if (second && geometry::rotation_angle_rad(first->camera_from_marker.rotation.conjugate() *
                                             second->camera_from_marker.rotation) > kSamePoseRad) {
    result.other = second;
    result.ambiguity_ratio = std::min(kNoOtherPose, second->rms_px / std::max(first->rms_px, 1e-9));
  }
  return result;
}

Matrix6d square_covariance(const SquarePose& pose, double sigma_px) {
  return sigma_px * sigma_px * pose.information.ldlt().solve(Matrix6d::Identity());
}

}  // namespace arthronaut::markers
