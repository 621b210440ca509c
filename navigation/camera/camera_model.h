// The one camera model of the program: division-model distortion, a lens that turns in the camera head, and a
// flat port in any medium. Everything that projects or looks through the arthroscope uses this class, on raw
// pixels.
//
// Pixels follow OpenCV: x right, y down, the centre of the top-left pixel is (0, 0). The camera frame is x
// right, y down, z out of the lens, aligned with the image (not with the lens), in mm.
//
// Equations (n = refractive index of the working medium / index of the medium of the calibration):
//   c(alpha) = q + Rot(alpha) (c0 - q),   f, xi constant                         (lens rotation)
//   x_d = (u - c) / (f, f * aspect),   x_u = x_d / (1 + xi |x_d|^2)               (division model, Fitzgibbon
//   2001) sin(theta_calibration) = n sin(theta_working)                                 (flat port, entrance
//   pupil at the window)
// The composition has the closed form u = c + 2 n f (X, Y) / (W + D) with
//   W = sqrt(Z^2 - (n^2 - 1) R^2),  D = sqrt(Z^2 - (n^2 - 1 + 4 n^2 xi) R^2),  R^2 = X^2 + Y^2.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace arthronaut::camera {

// Errors of a calibration, in this order: focal_px, distortion_xi, principal point x and y, rotation centre x
// and y (px).
using CameraCovariance = Eigen::Matrix<double, 6, 6>;

// The circular image border of the arthroscope.
struct Boundary {
  Eigen::Vector2d center_px = Eigen::Vector2d::Zero();
  double radius_px = 0;
};

// What a calibration finds: camera.json. Valid for one scope in one head, at any lens angle.
struct Calibration {
  Eigen::Vector2i image_size_px{0, 0};
  double focal_px = 0;                                           // in the medium of the calibration
  double aspect_ratio = 1;                                       // focal length along y / along x
  Eigen::Vector2d principal_point_px = Eigen::Vector2d::Zero();  // at lens angle 0
  double distortion_xi = 0;  // division model on normalised coordinates; negative for barrel
  Eigen::Vector2d rotation_center_px = Eigen::Vector2d::Zero();
  double reference_mark_angle_deg = 0;  // the mark angle at which the lens angle is 0
  Boundary boundary;                    // at lens angle 0
  double refractive_index = 1;          // of the medium of the calibration
  // How well it is known; empty where nobody said.
  std::optional<CameraCovariance> covariance = std::nullopt;

  // Where principal point and boundary stand when the mark is seen at this angle (image axes, degrees).
  [[nodiscard]] double lens_angle_rad(double mark_angle_deg) const;
  [[nodiscard]] Eigen::Vector2d turned(const Eigen::Vector2d& point_at_angle_0_px,
                                       double lens_angle_rad) const;
};

// What is taken for a calibration that does not say how well it is known: one sigma of 0.5 % of the focal
// length, 0.02 of xi, and 0.2 % of the image's width for each coordinate of principal point and rotation
// centre. That is a careless calibration; what the adjustment of a good one says is a tenth of it.
[[nodiscard]] CameraCovariance nominal_covariance(const Calibration& calibration);
// Its own, else the nominal one.
[[nodiscard]] CameraCovariance covariance_of(const Calibration& calibration);

// How the working medium changes the camera.
enum class FluidModel {
  FlatPort,   // exact refraction at a flat window
  FocalRule,  // the paper's rule: focal length times the ratio of the indices, xi kept; for comparison only
};

class CameraModel {
 public:
  CameraModel() = default;
  // refractive_index is that of the working medium. Throws InvalidInput when the calibration is not usable
  // (focal_px <= 0, image without size, index outside [0.9, 2], xi outside [-2, 1]).
  CameraModel(const Calibration& calibration, double lens_angle_rad, double refractive_index,
              FluidModel fluid_model = FluidModel::FlatPort);

  // Pixel of a point in the camera frame; nullopt when no ray through the port reaches it (behind the lens,
  // beyond the critical angle, or where a pincushion lens folds). The result may lie outside the image or the
  // boundary.
  [[nodiscard]] std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& point_in_camera_mm) const;
  // The same with the Jacobian d pixel / d point.
  [[nodiscard]] std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& point_in_camera_mm,
                                                       Eigen::Matrix<double, 2, 3>& d_pixel_d_point) const;
  // d pixel / d (focal_px, distortion_xi, principal point x, y) for a point in the camera frame; nullopt as
  // project.
  [[nodiscard]] std::optional<Eigen::Matrix<double, 2, 4>> d_pixel_d_lens(
      const Eigen::Vector3d& point_in_camera_mm) const;
  // Unit ray in the camera frame and working medium; nullopt where the model has no ray (total reflection, xi
  // fold).
  [[nodiscard]] std::optional<Eigen::Vector3d> ray(const Eigen::Vector2d& pixel) const;
  // Tangent-plane coordinates (X/Z, Y/Z) of the pixel's ray: straight lines in space are straight here.
  // nullopt as ray, and for rays at 90 degrees or more.
  [[nodiscard]] std::optional<Eigen::Vector2d> undistort(const Eigen::Vector2d& pixel) const;
  // The same with d tangent / d pixel.
  [[nodiscard]] std::optional<Eigen::Vector2d> undistort(const Eigen::Vector2d& pixel,
                                                         Eigen::Matrix2d& d_tangent_d_pixel) const;

  [[nodiscard]] double focal_px() const { return focal_; }  // of the calibration's medium
  // d pixel / d angle at the axis, in the working medium.
  [[nodiscard]] double central_focal_px() const;
  [[nodiscard]] double lens_angle_rad() const { return lens_angle_rad_; }
  [[nodiscard]] const Eigen::Vector2d& principal_point_px() const { return center_; }
  [[nodiscard]] double distortion_xi() const { return xi_; }
  [[nodiscard]] double aspect_ratio() const { return aspect_; }
  // Index of the working medium over that of the calibration.
  [[nodiscard]] double index_ratio() const { return index_ratio_; }
  [[nodiscard]] FluidModel fluid_model() const { return fluid_model_; }
  // The same lens at the same angle in another medium. Throws InvalidInput unless the ratio of the indices
  // (as index_ratio()) lies in [0.45, 2.3], which is what two indices in [0.9, 2] can make.
  [[nodiscard]] CameraModel in_medium(double index_ratio) const;
  [[nodiscard]] const Boundary& boundary() const { return boundary_; }  // at this lens angle
  [[nodiscard]] const Eigen::Vector2i& image_size_px() const { return image_size_; }
  [[nodiscard]] bool is_inside_view(
      const Eigen::Vector2d& pixel) const;  // of the boundary circle and the image

 private:
  Eigen::Vector2i image_size_{0, 0};
  double lens_angle_rad_ = 0;
  Eigen::Vector2d center_ = Eigen::Vector2d::Zero();
  Boundary boundary_;
  double focal_ = 1, aspect_ = 1, xi_ = 0, index_ratio_ = 1;
  FluidModel fluid_model_ = FluidModel::FlatPort;
};

}  // namespace arthronaut::camera
