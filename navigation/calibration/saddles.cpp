#include "navigation/calibration/saddles.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace arthronaut::calibration {
namespace {

constexpr double kGradientNoise = 4.0;  // grey values per px, of a smoothed picture

// Weakest corner: a step of 6 grey values, smoothed by sigma and by the optics.
double least_strength(double sigma_px) {
  const double total = sigma_px * sigma_px + 1.0;
  const double ixy = 0.637 * 3.0 / total;
  return 0.4 * ixy * ixy;
}

void set_edges(Saddle& saddle) {
  // Along an edge the second derivative vanishes: ixx c^2 + 2 ixy c s + iyy s^2 = 0. In the axes of the
  // Hessian with eigenvalues a > 0 > b that is tan = +-sqrt(-a / b).
  const double mean = 0.5 * (saddle.ixx + saddle.iyy);
  const double half = std::hypot(0.5 * (saddle.ixx - saddle.iyy), saddle.ixy);
  const double a = mean + half, b = mean - half;
  const double axis = 0.5 * std::atan2(2 * saddle.ixy, saddle.ixx - saddle.iyy);
  const double open = std::atan(std::sqrt(std::max(1e-6, -a / b)));
  saddle.edge[0] = {std::cos(axis + open), std::sin(axis + open)};
  saddle.edge[1] = {std::cos(axis - open), std::sin(axis - open)};
}

void find_at_scale(const camera::GrayView& view, double sigma_px, double ring_px, const SmoothPicture& fine,
                   std::vector<Saddle>& found) {
  const SmoothPicture picture = smoothed(view, sigma_px);
  const int w = picture.width, h = picture.height;
  std::vector<float> strength(picture.value.size(), 0.0F);
  for (int y = 1; y < h - 1; ++y) {
    const float* up = &picture.value[static_cast<std::size_t>(y - 1) * w];
    const float *row = up + w, *down = row + w;
    float* out = &strength[static_cast<std::size_t>(y) * w];
    for (int x = 1; x < w - 1; ++x) {
      const float ixx = row[x - 1] - 2 * row[x] + row[x + 1];
      const float iyy = up[x] - 2 * row[x] + down[x];
      const float ixy = 0.25F * (down[x + 1] - down[x - 1] - up[x + 1] + up[x - 1]);
      out[x] = ixy * ixy - ixx * iyy;
    }
  }
  const auto threshold = static_cast<float>(least_strength(sigma_px));
  const int reach = 3, margin = static_cast<int>(ring_px) + 3;
  for (int y = margin; y < h - margin; ++y)
    for (int x = margin; x < w - margin; ++x) {
      const float s = strength[static_cast<std::size_t>(y) * w + x];
      if (s < threshold) continue;
      bool is_peak = true;
      for (int dy = -reach; dy <= reach && is_peak; ++dy)
        for (int dx = -reach; dx <= reach; ++dx) {
          const float other = strength[static_cast<std::size_t>(y + dy) * w + x + dx];
          if (other > s || (other == s && (dy < 0 || (dy == 0 && dx < 0)))) {
            is_peak = false;
            break;
          }
        }
      if (!is_peak) continue;
      Saddle saddle;
      saddle.ixx = picture.at(x - 1, y) - 2 * picture.at(x, y) + picture.at(x + 1, y);
      saddle.iyy = picture.at(x, y - 1) - 2 * picture.at(x, y) + picture.at(x, y + 1);
      saddle.ixy = 0.25 * (picture.at(x + 1, y + 1) - picture.at(x - 1, y + 1) - picture.at(x + 1, y - 1) +
                           picture.at(x - 1, y - 1));
      const double gx = 0.5 * (picture.at(x + 1, y) - picture.at(x - 1, y));
      const double gy = 0.5 * (picture.at(x, y + 1) - picture.at(x, y - 1));
      const double det = saddle.ixx * saddle.iyy - saddle.ixy * saddle.ixy;
      const Eigen::Vector2d shift((-saddle.iyy * gx + saddle.ixy * gy) / det,
                                  (saddle.ixy * gx - saddle.ixx * gy) / det);
      if (!(shift.norm() < 2.0)) continue;
      saddle.pixel = Eigen::Vector2d(x, y) + shift;
      saddle.strength = s * std::pow(sigma_px, 4);
      const bool is_known = std::any_of(found.begin(), found.end(), [&](const Saddle& k) {
        return (k.pixel - saddle.pixel).squaredNorm() < 16;
      });
      if (is_known || !looks_like_corner(fine, saddle.pixel, ring_px, 8)) continue;
      set_edges(saddle);
      found.push_back(saddle);
    }
}

}  // namespace

float SmoothPicture::bilinear(double x, double y) const {
  const int ix = static_cast<int>(x), iy = static_cast<int>(y);
  const auto fx = static_cast<float>(x - ix), fy = static_cast<float>(y - iy);
  const float* top = &value[static_cast<std::size_t>(iy) * width + ix];
  const float* bottom = top + width;
  return (1 - fy) * ((1 - fx) * top[0] + fx * top[1]) + fy * ((1 - fx) * bottom[0] + fx * bottom[1]);
}

SmoothPicture smoothed(const camera::GrayView& picture, double sigma_px) {
  SmoothPicture result{picture.width, picture.height, {}};
  result.value.resize(static_cast<std::size_t>(picture.width) * picture.height);
  const cv::Mat source(picture.height, picture.width, CV_8U, const_cast<std::uint8_t*>(picture.data),
                       static_cast<std::size_t>(picture.stride));
  cv::Mat target(picture.height, picture.width, CV_32F, result.value.data());
  source.convertTo(target, CV_32F);
  cv::GaussianBlur(target, target, cv::Size(), sigma_px, sigma_px, cv::BORDER_REPLICATE);
  return result;
}

bool looks_like_corner(const SmoothPicture& picture, const Eigen::Vector2d& at, double radius_px,
                       double least_contrast) {
  constexpr int kSamples = 32;
  if (!picture.has(at.x(), at.y(), radius_px + 1)) return false;
  std::array<float, kSamples> ring;
  float low = 1e9F, high = -1e9F;
  for (int k = 0; k < kSamples; ++k) {
    const double a = 2 * M_PI * k / kSamples;
    const float v = picture.bilinear(at.x() + radius_px * std::cos(a), at.y() + radius_px * std::sin(a));
    ring[static_cast<std::size_t>(k)] = v;
    low = std::min(low, v);
    high = std::max(high, v);
  }
  if (high - low < least_contrast) return false;
  const float middle = 0.5F * (low + high);
  int changes = 0, alike = 0;
  for (int k = 0; k < kSamples; ++k) {
    const bool here = ring[static_cast<std::size_t>(k)] > middle;
    changes += here != (ring[static_cast<std::size_t>((k + 1) % kSamples)] > middle);
    alike += here == (ring[static_cast<std::size_t>((k + kSamples / 2) % kSamples)] > middle);
  }
  return changes == 4 && alike >= kSamples * 3 / 4;
}

std::vector<Saddle> find_saddles(const camera::GrayView& picture) {
  std::vector<Saddle> found;
  const SmoothPicture fine = smoothed(picture, 0.8);
  find_at_scale(picture, 1.5, 4.5, fine, found);
  find_at_scale(picture, 3.0, 7.0, fine, found);
  std::sort(found.begin(), found.end(),
            [](const Saddle& a, const Saddle& b) { return a.strength > b.strength; });
  if (found.size() > 4000) found.resize(4000);
  return found;
}

std::optional<RefinedCorner> refine_corner(const SmoothPicture& picture, const Eigen::Vector2d& start,
                                           double half_window_px, double least_likeness) {
  Eigen::Vector2d corner = start;
  const int half = std::max(2, static_cast<int>(std::lround(half_window_px)));
  const double fall = 2.0 / (half_window_px * half_window_px);
  double sigma_px = 0;
  for (int pass = 0; pass < 12; ++pass) {
    if (!picture.has(corner.x(), corner.y(), half + 2)) return std::nullopt;
    Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
    Eigen::Vector2d right = Eigen::Vector2d::Zero();
    Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
    for (int dy = -half; dy <= half; ++dy)
      for (int dx = -half; dx <= half; ++dx) {
        const double x = corner.x() + dx, y = corner.y() + dy;
        const Eigen::Vector2d gradient(picture.bilinear(x + 0.5, y) - picture.bilinear(x - 0.5, y),
                                       picture.bilinear(x, y + 0.5) - picture.bilinear(x, y - 0.5));
        const double weight = std::exp(-fall * (dx * dx + dy * dy));
        const Eigen::Matrix2d outer = weight * gradient * gradient.transpose();
        normal += outer;
        right += outer * Eigen::Vector2d(dx, dy);
        spread += weight * (dx * dx + dy * dy) * outer;
      }
    const double det = normal.determinant();
    if (!(det > 1e-3 * normal.trace() * normal.trace() * 0.25)) return std::nullopt;
    const Eigen::Matrix2d inverse = normal.inverse();
    const Eigen::Vector2d step = inverse * right;
    const Eigen::Matrix2d covariance = inverse * spread * inverse;
    sigma_px = kGradientNoise * std::sqrt(covariance.diagonal().maxCoeff());
    corner += step;
    if ((corner - start).norm() > half_window_px) return std::nullopt;
    if (step.norm() < 1e-3) break;
  }
  if (!picture.has(corner.x(), corner.y(), half + 2)) return std::nullopt;
  // Half a turn: correlation of the neighbourhood with itself upside down.
  double sum = 0, square = 0, cross = 0;
  int count = 0;
  for (int dy = -half; dy <= half; ++dy)
    for (int dx = -half; dx <= half; ++dx, ++count) {
      const double a = picture.bilinear(corner.x() + dx, corner.y() + dy);
      const double b = picture.bilinear(corner.x() - dx, corner.y() - dy);
      sum += a;
      square += a * a;
      cross += a * b;
    }
  const double mean = sum / count, variance = square / count - mean * mean;
  if (!(variance > 4) || (cross / count - mean * mean) / variance < least_likeness) return std::nullopt;
  return RefinedCorner{corner, std::clamp(sigma_px, 0.04, 1.0)};
}

}  // namespace arthronaut::calibration
