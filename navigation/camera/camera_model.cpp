#include "navigation/camera/camera_model.h"

#include <cmath>
#include <string>

#include "planning/geometry/error.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::camera {
namespace {

// W and D of the header's closed form, and what R^2 is taken by in them, for the square n2 of the ratio of
// the indices; nullopt where no ray reaches the point.
struct Roots {
  double a = 0, b = 0, w = 0, d = 0;
};
inline std::optional<Roots> roots_at(const Eigen::Vector3d& point, double n2, double xi) {
  const double z = point.z(), r2 = point.head<2>().squaredNorm();
  const double a = n2 - 1, b = a + 4 * n2 * xi, w2 = z * z - a * r2, d2 = z * z - b * r2;
  if (!(z > 0) || !(w2 > 0) || !(d2 > 0)) return std::nullopt;
  return Roots{a, b, std::sqrt(w2), std::sqrt(d2)};
}

double refracting_square(FluidModel fluid_model, double index_ratio) {
  return fluid_model == FluidModel::FlatPort ? index_ratio * index_ratio : 1.0;
}

}  // namespace

double Calibration::lens_angle_rad(double mark_angle_deg) const {
  return geometry::rad_from_deg(std::remainder(mark_angle_deg - reference_mark_angle_deg, 360.0));
}

Eigen::Vector2d Calibration::turned(const Eigen::Vector2d& point_at_angle_0_px, double lens_angle_rad) const {
  const double c = std::cos(lens_angle_rad), s = std::sin(lens_angle_rad);
  const Eigen::Vector2d arm = point_at_angle_0_px - rotation_center_px;
  return rotation_center_px + Eigen::Vector2d(c * arm.x() - s * arm.y(), s * arm.x() + c * arm.y());
}

CameraCovariance nominal_covariance(const Calibration& calibration) {
  constexpr double kFocalShare = 0.005, kXi = 0.02, kWidthShare = 0.002;
  const double point_px = kWidthShare * calibration.image_size_px.x();
  Eigen::Matrix<double, 6, 1> sigma;
  sigma << kFocalShare * calibration.focal_px, kXi, point_px, point_px, point_px, point_px;
  return sigma.cwiseAbs2().asDiagonal();
}

CameraCovariance covariance_of(const Calibration& calibration) {
  return calibration.covariance ? *calibration.covariance : nominal_covariance(calibration);
}

CameraModel::CameraModel(const Calibration& calibration, double lens_angle_rad, double refractive_index,
                         FluidModel fluid_model)
    : image_size_(calibration.image_size_px),
      lens_angle_rad_(lens_angle_rad),
      center_(calibration.turned(calibration.principal_point_px, lens_angle_rad)),
      boundary_{calibration.turned(calibration.boundary.center_px, lens_angle_rad),
                calibration.boundary.radius_px},
      focal_(calibration.focal_px),
      aspect_(calibration.aspect_ratio),
      xi_(calibration.distortion_xi),
      index_ratio_(refractive_index / calibration.refractive_index),
      fluid_model_(fluid_model) {
  // Written so that NaN fails too.
  const auto require = [](bool holds, const char* what) {
    if (!holds) throw InvalidInput(std::string("camera: ") + what);
  };
  require(focal_ > 0 && std::isfinite(focal_), "focal_px must be above 0");
  require(aspect_ > 0 && std::isfinite(aspect_), "aspect_ratio must be above 0");
  require(xi_ >= -2 && xi_ <= 1, "distortion_xi must lie in [-2, 1]");
  require(image_size_.x() > 0 && image_size_.y() > 0, "image_size_px must be above 0");
  require(refractive_index >= 0.9 && refractive_index <= 2,
          "the medium's refractive index must lie in [0.9, 2]");
  require(calibration.refractive_index >= 0.9 && calibration.refractive_index <= 2,
          "the calibration's refractive index must lie in [0.9, 2]");
  require(center_.allFinite() && std::isfinite(lens_angle_rad),
          "principal point and lens angle must be finite");
}

CameraModel CameraModel::in_medium(double index_ratio) const {
  if (!(index_ratio >= 0.45 && index_ratio <= 2.3))
    throw InvalidInput("camera: the ratio of the refractive indices must lie in [0.45, 2.3]");
  CameraModel other = *this;
  other.index_ratio_ = index_ratio;
  return other;
}

// Without the derivative, which most who ask for many points have no use for.
std::optional<Eigen::Vector2d> CameraModel::project(const Eigen::Vector3d& point_in_camera_mm) const {
  const auto roots = roots_at(point_in_camera_mm, refracting_square(fluid_model_, index_ratio_), xi_);
  if (!roots) return std::nullopt;
  const double k = 2 * index_ratio_ * focal_ / (roots->w + roots->d);
  return Eigen::Vector2d(center_.x() + k * point_in_camera_mm.x(),
                         center_.y() + k * (point_in_camera_mm.y() * aspect_));
}

// The closed form of the header, and its derivative: with S = W + D, a = n^2 - 1, b = a + 4 n^2 xi, v = (X,
// Y)
//   du/dv = 2nf (I / S + (a / W + b / D) v v^T / S^2),   du/dZ = -2nf Z (1 / W + 1 / D) v / S^2.
// The focal rule is the same with no refraction and n f in place of f.
std::optional<Eigen::Vector2d> CameraModel::project(const Eigen::Vector3d& point_in_camera_mm,
                                                    Eigen::Matrix<double, 2, 3>& d_pixel_d_point) const {
  const Eigen::Vector2d v = point_in_camera_mm.head<2>();
  const double z = point_in_camera_mm.z();
  const auto roots = roots_at(point_in_camera_mm, refracting_square(fluid_model_, index_ratio_), xi_);
  if (!roots) return std::nullopt;
  const auto [a, b, w, d] = *roots;
  // Number by number: most of what follows a marker asks for hundreds of these a frame.
  const double s = w + d, k = 2 * index_ratio_ * focal_ / s;
  const double x = v.x(), y = v.y(), bend = (a / w + b / d) / s;
  const double by_z = -k * (z / s) * (1 / w + 1 / d);
  d_pixel_d_point(0, 0) = k * (1 + bend * x * x);
  d_pixel_d_point(0, 1) = k * (bend * x * y);
  d_pixel_d_point(0, 2) = by_z * x;
  d_pixel_d_point(1, 0) = k * (bend * y * x) * aspect_;
  d_pixel_d_point(1, 1) = k * (1 + bend * y * y) * aspect_;
  d_pixel_d_point(1, 2) = by_z * y * aspect_;
  return Eigen::Vector2d(center_.x() + k * x, center_.y() + k * (y * aspect_));
}

// With u = c + k v, k = 2 n f / S: xi moves S alone, by dD/dxi = -2 n^2 R^2 / D.
std::optional<Eigen::Matrix<double, 2, 4>> CameraModel::d_pixel_d_lens(
    const Eigen::Vector3d& point_in_camera_mm) const {
  Eigen::Matrix<double, 2, 3> ignored;
  const auto pixel = project(point_in_camera_mm, ignored);
  if (!pixel) return std::nullopt;
  const bool refracts = fluid_model_ == FluidModel::FlatPort;
  const double n2 = refracts ? index_ratio_ * index_ratio_ : 1.0;
  const double a = n2 - 1, r2 = point_in_camera_mm.head<2>().squaredNorm();
  const double z2 = point_in_camera_mm.z() * point_in_camera_mm.z();
  const double w = std::sqrt(z2 - a * r2), d = std::sqrt(z2 - (a + 4 * n2 * xi_) * r2);
  const Eigen::Vector2d arm = *pixel - center_;
  Eigen::Matrix<double, 2, 4> jacobian;
  jacobian << arm / focal_, arm * (2 * n2 * r2 / (d * (w + d))), Eigen::Matrix2d::Identity();
  return jacobian;
}

std::optional<Eigen::Vector2d> CameraModel::undistort(const Eigen::Vector2d& pixel) const {
  const bool refracts = fluid_model_ == FluidModel::FlatPort;
  const double f = refracts ? focal_ : focal_ * index_ratio_;
  const Eigen::Vector2d distorted = (pixel - center_).cwiseProduct(Eigen::Vector2d(1 / f, 1 / (f * aspect_)));
  const double bend = xi_ * distorted.squaredNorm();
  if (!(std::abs(bend) < 1)) return std::nullopt;
  const double g = 1 / (1 + bend);
  const Eigen::Vector2d m = g * distorted;
  if (!refracts) return m;
  const double n2 = index_ratio_ * index_ratio_;
  const double e = n2 + (n2 - 1) * m.squaredNorm();
  if (!(e > 0)) return std::nullopt;  // total reflection
  return m / std::sqrt(e);
}

// With m the tangent coordinates in the calibration's medium, Snell's law gives t = m / sqrt(n^2 + (n^2 - 1)
// |m|^2).
std::optional<Eigen::Vector2d> CameraModel::undistort(const Eigen::Vector2d& pixel,
                                                      Eigen::Matrix2d& d_tangent_d_pixel) const {
  const bool refracts = fluid_model_ == FluidModel::FlatPort;
  const double f = refracts ? focal_ : focal_ * index_ratio_;
  const Eigen::Vector2d scale(1 / f, 1 / (f * aspect_));
  const Eigen::Vector2d distorted = (pixel - center_).cwiseProduct(scale);
  const double bend = xi_ * distorted.squaredNorm();
  // At -1 a barrel's ray reaches 90 degrees; at 1 a pincushion folds, and what lies beyond comes back inside.
  if (!(std::abs(bend) < 1)) return std::nullopt;
  const double g = 1 / (1 + bend);
  const Eigen::Vector2d m = g * distorted;
  Eigen::Matrix2d jacobian =
      g * Eigen::Matrix2d::Identity() - (2 * xi_ * g * g) * distorted * distorted.transpose();
  Eigen::Vector2d tangent = m;
  if (refracts) {
    const double n2 = index_ratio_ * index_ratio_;
    const double e = n2 + (n2 - 1) * m.squaredNorm();
    if (!(e > 0)) return std::nullopt;  // total reflection
    const double root = std::sqrt(e);
    tangent = m / root;
    jacobian = (Eigen::Matrix2d::Identity() / root - ((n2 - 1) / (e * root)) * m * m.transpose()) * jacobian;
  }
  d_tangent_d_pixel = jacobian * scale.asDiagonal();
  return tangent;
}

std::optional<Eigen::Vector3d> CameraModel::ray(const Eigen::Vector2d& pixel) const {
  const auto tangent = undistort(pixel);
  if (!tangent) return std::nullopt;
  return tangent->homogeneous().normalized();
}

double CameraModel::central_focal_px() const { return focal_ * index_ratio_; }

bool CameraModel::is_inside_view(const Eigen::Vector2d& pixel) const {
  return pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() <= image_size_.x() - 1 &&
         pixel.y() <= image_size_.y() - 1 &&
         (boundary_.radius_px <= 0 ||
          (pixel - boundary_.center_px).squaredNorm() <= boundary_.radius_px * boundary_.radius_px);
}

}  // namespace arthronaut::camera
