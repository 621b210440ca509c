#include "navigation/calibration/conformal_map.h"

#include <Eigen/Dense>
#include <cmath>

namespace arthronaut::calibration {
namespace {

Eigen::Vector4d monomials(const Eigen::Vector2d& v) { return {v.squaredNorm(), v.x(), v.y(), 1}; }

// d m / d v
Eigen::Matrix<double, 4, 2> monomial_slopes(const Eigen::Vector2d& v) {
  Eigen::Matrix<double, 4, 2> slopes;
  slopes << 2 * v.x(), 2 * v.y(), 1, 0, 0, 1, 0, 0;
  return slopes;
}

struct Normaliser {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  double scale = 1;
  explicit Normaliser(std::span<const Eigen::Vector2d> points) {
    for (const auto& p : points) mean += p;
    mean /= static_cast<double>(points.size());
    double sum = 0;
    for (const auto& p : points) sum += (p - mean).norm();
    scale = std::sqrt(2.0) * static_cast<double>(points.size()) / sum;
  }
};

// Smallest singular vector of A as a 3 x 4 matrix, rows first.
Eigen::Matrix<double, 3, 4> null_map(const Eigen::Matrix<double, 12, 12>& normal) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 12, 12>> eigen(normal);
  return Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(eigen.eigenvectors().col(0).data());
}

}  // namespace

std::optional<Eigen::Vector2d> ConformalMap::pixel_from_plane(const Eigen::Vector2d& point,
                                                              const Eigen::Vector2d& start_px) const {
  Eigen::Vector2d v = (start_px - mean_px) * scale;
  for (int pass = 0; pass < 20; ++pass) {
    const Eigen::Vector3d h = b * monomials(v);
    const Eigen::Vector2d error = h.hnormalized() - point;
    const Eigen::Matrix<double, 3, 2> dh = b * monomial_slopes(v);
    const Eigen::Matrix2d slope = (dh.topRows<2>() - h.hnormalized() * dh.row(2)) / h.z();
    const Eigen::Vector2d step = slope.inverse() * error;
    if (!step.allFinite() || step.norm() > 2) return std::nullopt;
    v -= step;
    if (step.norm() < 1e-9) return v / scale + mean_px;
  }
  return std::nullopt;
}

std::optional<ConformalMap> fit_conformal_map(std::span<const Eigen::Vector2d> pixels,
                                              std::span<const Eigen::Vector2d> plane_points) {
  if (pixels.size() < 8 || pixels.size() != plane_points.size()) return std::nullopt;
  const Normaliser of_pixels(pixels), of_plane(plane_points);
  ConformalMap map;
  map.mean_px = of_pixels.mean;
  map.scale = of_pixels.scale;
  Eigen::Matrix<double, 3, 4> b;
  std::vector<double> weight(pixels.size(), 1.0);
  for (int pass = 0; pass < 4; ++pass) {
    Eigen::Matrix<double, 12, 12> normal = Eigen::Matrix<double, 12, 12>::Zero();
    for (std::size_t k = 0; k < pixels.size(); ++k) {
      const Eigen::Vector4d m = monomials((pixels[k] - map.mean_px) * map.scale);
      const Eigen::Vector2d p = (plane_points[k] - of_plane.mean) * of_plane.scale;
      Eigen::Matrix<double, 2, 12> rows = Eigen::Matrix<double, 2, 12>::Zero();
      rows.block<1, 4>(0, 0) = m.transpose();
      rows.block<1, 4>(0, 8) = -p.x() * m.transpose();
      rows.block<1, 4>(1, 4) = m.transpose();
      rows.block<1, 4>(1, 8) = -p.y() * m.transpose();
      normal += weight[k] * rows.transpose() * rows;
    }
    b = null_map(normal);
    // Algebraic error over the local magnification and the homogeneous scale is the error in (normalised)
    // pixels.
    for (std::size_t k = 0; k < pixels.size(); ++k) {
      const Eigen::Vector2d v = (pixels[k] - map.mean_px) * map.scale;
      const Eigen::Vector3d h = b * monomials(v);
      const Eigen::Matrix<double, 3, 2> dh = b * monomial_slopes(v);
      const Eigen::Matrix2d slope = (dh.topRows<2>() - h.hnormalized() * dh.row(2)) / h.z();
      weight[k] = 1.0 / std::max(1e-12, std::abs(slope.determinant()) * h.z() * h.z());
    }
  }
  Eigen::Matrix3d denormalise = Eigen::Matrix3d::Identity();
  denormalise.topLeftCorner<2, 2>() /= of_plane.scale;
  denormalise.topRightCorner<2, 1>() = of_plane.mean;
  map.b = denormalise * b;
  if (!map.b.allFinite()) return std::nullopt;
  return map;
}

std::optional<ConformalCamera> camera_of(const ConformalMap& map) {
  const Eigen::JacobiSVD<Eigen::Matrix<double, 3, 4>> svd(map.b, Eigen::ComputeFullV);
  const Eigen::Vector4d null = svd.matrixV().col(3);
  if (std::abs(null(3)) < 1e-9 * null.norm()) return std::nullopt;
  const Eigen::Vector4d nu = null / null(3);
  const Eigen::Vector2d c(nu(1), nu(2));
  const double inverse_lambda = c.squaredNorm() - nu(0);
  if (!(std::abs(inverse_lambda) > 1e-6)) return std::nullopt;
  const double lambda = 1.0 / inverse_lambda;
  Eigen::Matrix<double, 3, 4> lift;
  lift << 0, 1, 0, -c.x(), 0, 0, 1, -c.y(), lambda, -2 * lambda * c.x(), -2 * lambda * c.y(),
      1 + lambda * c.squaredNorm();
  const Eigen::Matrix3d plane_from_undistorted =
      map.b * lift.transpose() * (lift * lift.transpose()).inverse();
  ConformalCamera camera;
  camera.principal_point_px = c / map.scale + map.mean_px;
  camera.lambda_px = lambda * map.scale * map.scale;
  // From normalised to true pixels: x_px = x / scale.
  camera.homography =
      Eigen::Vector3d(1 / map.scale, 1 / map.scale, 1).asDiagonal() * plane_from_undistorted.inverse();
  if (!camera.homography.allFinite()) return std::nullopt;
  return camera;
}

std::optional<ConformalCamera> camera_without_distortion(std::span<const Eigen::Vector2d> pixels,
                                                         std::span<const Eigen::Vector2d> plane_points,
                                                         const Eigen::Vector2d& principal_point_px) {
  if (pixels.size() < 4) return std::nullopt;
  const Normaliser of_pixels(pixels), of_plane(plane_points);
  Eigen::Matrix<double, 9, 9> normal = Eigen::Matrix<double, 9, 9>::Zero();
  for (std::size_t k = 0; k < pixels.size(); ++k) {
    const Eigen::Vector2d u = (pixels[k] - of_pixels.mean) * of_pixels.scale;
    const Eigen::Vector3d p = ((plane_points[k] - of_plane.mean) * of_plane.scale).homogeneous();
    Eigen::Matrix<double, 2, 9> rows = Eigen::Matrix<double, 2, 9>::Zero();
    rows.block<1, 3>(0, 0) = p.transpose();
    rows.block<1, 3>(0, 6) = -u.x() * p.transpose();
    rows.block<1, 3>(1, 3) = p.transpose();
    rows.block<1, 3>(1, 6) = -u.y() * p.transpose();
    normal += rows.transpose() * rows;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> eigen(normal);
  const Eigen::Matrix3d h =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(eigen.eigenvectors().col(0).data());
  Eigen::Matrix3d pixel_from_normalised = Eigen::Matrix3d::Identity(),
                  normalised_from_plane = pixel_from_normalised;
  pixel_from_normalised.topLeftCorner<2, 2>() /= of_pixels.scale;
  pixel_from_normalised.topRightCorner<2, 1>() = of_pixels.mean - principal_point_px;
  normalised_from_plane.topLeftCorner<2, 2>() *= of_plane.scale;
  normalised_from_plane.topRightCorner<2, 1>() = -of_plane.scale * of_plane.mean;
  ConformalCamera camera;
  camera.principal_point_px = principal_point_px;
  camera.homography = pixel_from_normalised * h * normalised_from_plane;
  if (!camera.homography.allFinite()) return std::nullopt;
  return camera;
}

std::optional<double> focal_from_homographies(std::span<const Eigen::Matrix3d> homographies) {
  // With y = 1 / f^2: y (h1.h2)_xy = -h31 h32 and y (|h1|^2 - |h2|^2)_xy = -(h31^2 - h32^2), by least
  // squares.
  double top = 0, bottom = 0;
  for (Eigen::Matrix3d h : homographies) {
    h /= std::sqrt(h.leftCols<2>().topRows<2>().squaredNorm() + 1e-300);
    const double a1 = h(0, 0) * h(0, 1) + h(1, 0) * h(1, 1), b1 = -h(2, 0) * h(2, 1);
    const double a2 = h.block<2, 1>(0, 0).squaredNorm() - h.block<2, 1>(0, 1).squaredNorm();
    const double b2 = -(h(2, 0) * h(2, 0) - h(2, 1) * h(2, 1));
    top += a1 * b1 + a2 * b2;
    bottom += a1 * a1 + a2 * a2;
  }
  if (!(bottom > 0) || !(top > 0)) return std::nullopt;
  return std::sqrt(bottom / top);
}

geometry::RigidTransform pose_from_homography(const Eigen::Matrix3d& homography, double focal_px) {
  Eigen::Matrix3d m = Eigen::Vector3d(1 / focal_px, 1 / focal_px, 1).asDiagonal() * homography;
  m /= std::sqrt(m.col(0).norm() * m.col(1).norm());
  if (m(2, 2) < 0) m = -m;
  Eigen::Matrix3d axes;
  axes << m.col(0), m.col(1), m.col(0).cross(m.col(1));
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(axes, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d rotation = svd.matrixU() * svd.matrixV().transpose();
  if (rotation.determinant() < 0)
    rotation = svd.matrixU() * Eigen::Vector3d(1, 1, -1).asDiagonal() * svd.matrixV().transpose();
  return {Eigen::Quaterniond(rotation).normalized(), m.col(2)};
}

}  // namespace arthronaut::calibration
