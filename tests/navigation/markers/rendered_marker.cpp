#include "tests/navigation/markers/rendered_marker.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>

namespace arthronaut::markers {
namespace {

constexpr int kSub = 3;
constexpr int kMoments = 16;  // of an exposure with motion
constexpr float kWhite = 0.75F, kBlack = 0.05F, kTissue = 0.18F;
constexpr double kMargin = 0.2;  // white beyond the square, as a share of its side

// Of one marker at one moment.
struct Shown {
  const PlacedMarker* marker;
  geometry::RigidTransform marker_from_camera;
};

float light_at(const std::vector<Shown>& shown, const Eigen::Vector3d& ray) {
  for (const auto& [shown_marker, marker_from_camera] : shown) {
    const PlacedMarker& marker = *shown_marker;
    const Eigen::Vector3d direction = marker_from_camera.rotate(ray);
    const double along = -marker_from_camera.translation_mm.z() / direction.z();
    if (!(along > 0) || direction.z() >= 0) continue;  // behind, or its back
    const Eigen::Vector3d place = marker_from_camera.translation_mm + along * direction;
    const double u = place.x() / marker.size_mm + 0.5, v = 0.5 - place.y() / marker.size_mm;
    if (u < -kMargin || v < -kMargin || u > 1 + kMargin || v > 1 + kMargin) continue;
    if (u < 0 || v < 0 || u >= 1 || v >= 1) return kWhite;
    const int cells = marker.code.cells;
    return marker.code.is_bright(static_cast<int>(v * cells), static_cast<int>(u * cells)) ? kWhite : kBlack;
  }
  return kTissue;
}

// Each marker as the row sees it over the exposure, as many moments as asked for.
void show(const camera::CameraModel& camera, const std::vector<PlacedMarker>& markers, int row,
          double readout, double delay, std::vector<std::vector<Shown>>& moments) {
  for (std::size_t k = 0; k < moments.size(); ++k) {
    moments[k].clear();
    const double t = (static_cast<double>(k) + 0.5) / static_cast<double>(moments.size()) - 0.5;
    for (const PlacedMarker& marker : markers) {
      const auto center = camera.project(marker.camera_from_marker.translation_mm);
      const double from_center = center ? (row - center->y()) / camera.image_size_px().y() : 0;
      const double at = t + delay + readout * from_center;
      const auto there =
          marker.camera_from_marker * geometry::exp(at * marker.velocity + 0.5 * at * at * marker.change);
      moments[k].push_back({&marker, there.inverse()});
    }
  }
}

void blur(std::vector<float>& light, int width, int height, double sigma) {
  const int reach = static_cast<int>(std::ceil(3.5 * sigma));
  std::vector<float> kernel(2 * reach + 1);
  float sum = 0;
  for (int i = -reach; i <= reach; ++i)
    sum += kernel[i + reach] = static_cast<float>(std::exp(-0.5 * i * i / (sigma * sigma)));
  for (float& k : kernel) k /= sum;
  std::vector<float> passed(light.size());
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      float value = 0;
      for (int i = -reach; i <= reach; ++i)
        value += kernel[i + reach] * light[y * width + std::clamp(x + i, 0, width - 1)];
      passed[y * width + x] = value;
    }
  }
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      float value = 0;
      for (int i = -reach; i <= reach; ++i)
        value += kernel[i + reach] * passed[std::clamp(y + i, 0, height - 1) * width + x];
      light[y * width + x] = value;
    }
  }
}

}  // namespace

RenderedPicture::RenderedPicture(const camera::CameraModel& camera, const std::vector<PlacedMarker>& markers,
                                 const PictureOptions& options)
    : width_(camera.image_size_px().x()), height_(camera.image_size_px().y()) {
  // Only near a marker is there anything to sample finely.
  const auto is_near_marker = [&](const Eigen::Vector3d& ray) {
    return std::any_of(markers.begin(), markers.end(), [&](const PlacedMarker& marker) {
      const Eigen::Vector3d& center = marker.camera_from_marker.translation_mm;
      return (ray * (center.norm() / ray.norm()) - center).norm() < 1.2 * marker.size_mm;
    });
  };
  const bool is_moving = std::any_of(markers.begin(), markers.end(),
                                     [](const PlacedMarker& marker) { return !marker.velocity.isZero(); });
  std::vector<std::vector<Shown>> shown(is_moving ? kMoments : 1);
  // All rows as they would be if exposed with those of one field.
  const auto light_of_field = [&](double delay) {
    std::vector<float> light(static_cast<std::size_t>(width_) * height_, 0.0F);
    for (int y = 0; y < height_; ++y) {
      if (y == 0 || options.readout != 0) show(camera, markers, y, options.readout, delay, shown);
      for (int x = 0; x < width_; ++x) {
        if (!camera.is_inside_view(Eigen::Vector2d(x, y))) continue;
        light[y * width_ + x] = kTissue;
        const auto middle = camera.ray(Eigen::Vector2d(x, y));
        if (!middle || !is_near_marker(*middle)) continue;
        float sum = 0;
        for (int k = 0; k < kSub * kSub; ++k) {
          const Eigen::Vector2d pixel(x + (k % kSub + 0.5) / kSub - 0.5, y + (k / kSub + 0.5) / kSub - 0.5);
          const auto ray = camera.ray(pixel);
          for (std::size_t moment = 0; ray && moment < shown.size(); ++moment)
            sum += light_at(shown[moment], *ray) / static_cast<float>(shown.size());
        }
        light[y * width_ + x] = sum / (kSub * kSub);
      }
    }
    blur(light, width_, height_, options.blur_px);
    return light;
  };
  std::vector<float> light = light_of_field(-0.5 * options.fields);
  if (options.fields != 0) {
    const std::vector<float> second = light_of_field(0.5 * options.fields);
    for (int y = 1; y < height_; y += 2)
      std::copy_n(second.begin() + y * width_, width_, light.begin() + y * width_);
  }
  std::mt19937 random(options.seed);
  std::normal_distribution<double> noise(0, options.noise_grey);
  grey_.resize(light.size());
  for (std::size_t i = 0; i < light.size(); ++i) {
    const double grey = 255 * std::pow(std::max(0.0F, light[i]), 1 / options.gamma) + noise(random);
    grey_[i] = static_cast<std::uint8_t>(std::clamp(std::lround(grey), 0L, 255L));
  }
}

void RenderedPicture::cover(int left, int top, int right, int bottom, std::uint8_t grey) {
  for (int y = std::max(0, top); y < std::min(height_, bottom); ++y) {
    for (int x = std::max(0, left); x < std::min(width_, right); ++x) grey_[y * width_ + x] = grey;
  }
}

void RenderedPicture::veil(int left, int top, int right, int bottom, double share, double grey) {
  for (int y = std::max(0, top); y < std::min(height_, bottom); ++y) {
    for (int x = std::max(0, left); x < std::min(width_, right); ++x) {
      std::uint8_t& pixel =
          grey_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
      pixel = static_cast<std::uint8_t>(std::clamp(std::lround(share * pixel + grey), 0L, 255L));
    }
  }
}

void RenderedPicture::shine(double x, double y, double sigma_px, double grey) {
  for (int row = 0; row < height_; ++row) {
    for (int column = 0; column < width_; ++column) {
      const double away = std::hypot(column - x, row - y) / sigma_px;
      std::uint8_t& pixel = grey_[row * width_ + column];
      pixel = static_cast<std::uint8_t>(std::min(255.0, pixel + grey * std::exp(-0.5 * away * away)));
    }
  }
}

geometry::Vector6d motion_of(const camera::CameraModel& camera,
                             const geometry::RigidTransform& camera_from_marker,
                             const Eigen::Vector2d& motion_px) {
  Eigen::Matrix<double, 2, 3> d_pixel;
  (void)camera.project(camera_from_marker.translation_mm, d_pixel);
  const Eigen::Matrix2d warp = (d_pixel * camera_from_marker.matrix()).leftCols<2>();
  geometry::Vector6d twist = geometry::Vector6d::Zero();
  twist.head<2>() = warp.inverse() * motion_px;
  return twist;
}

camera::CameraModel small_scope() {
  camera::Calibration calibration;
  calibration.image_size_px = {800, 600};
  calibration.focal_px = 330;
  calibration.principal_point_px = {402, 296};
  calibration.distortion_xi = -0.3;
  calibration.rotation_center_px = {398, 301};
  calibration.boundary = {{400, 300}, 290};
  return {calibration, geometry::rad_from_deg(30), 1.3345};
}

geometry::RigidTransform facing_pose(double x_mm, double y_mm, double z_mm, double tilt_x_deg,
                                     double tilt_y_deg, double turn_deg) {
  const auto turn = [](double deg, const Eigen::Vector3d& axis) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(geometry::rad_from_deg(deg), axis));
  };
  // Half a turn about x shows the face: y up, z to the camera.
  const Eigen::Quaterniond rotation = turn(180 + tilt_x_deg, Eigen::Vector3d::UnitX()) *
                                      turn(tilt_y_deg, Eigen::Vector3d::UnitY()) *
                                      turn(turn_deg, Eigen::Vector3d::UnitZ());
  return {rotation.normalized(), {x_mm, y_mm, z_mm}};
}

}  // namespace arthronaut::markers
