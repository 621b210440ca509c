#include "navigation/simulator/sensor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "navigation/simulator/parallel_rows.h"
#include "navigation/simulator/random.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::simulator {
namespace {

constexpr double kToothHalfWidthDeg = 2.5, kToothDepthShare = 0.035;
constexpr double kGamma = 2.2;
constexpr int kQuantiles = 1024;
constexpr int kTones = 4096;

// Quantiles of the normal distribution: a uniform index gives a normal deviate.
const std::array<float, kQuantiles>& normal_quantiles() {
  static const auto table = [] {
    std::array<float, kQuantiles> quantiles{};
    for (int i = 0; i < kQuantiles; ++i) {
      const double target = (i + 0.5) / kQuantiles;
      double low = -6, high = 6;
      for (int step = 0; step < 50; ++step) {
        const double middle = 0.5 * (low + high);
        (0.5 * std::erfc(-middle / std::sqrt(2.0)) < target ? low : high) = middle;
      }
      quantiles[static_cast<std::size_t>(i)] = static_cast<float>(low);
    }
    return quantiles;
  }();
  return table;
}

std::uint8_t to_byte(float level) {
  return static_cast<std::uint8_t>(std::clamp(static_cast<int>(level + 0.5f), 0, 255));
}

// Normal deviates in no order. A row takes its noise from a place drawn for it, which is as good as noise of
// its own and costs no random number a pixel.
const std::vector<float>& deviates() {
  static const auto drawn = [] {
    constexpr std::size_t kDeviates = 1 << 18;
    static_assert(kDeviates > 4 * 3 * Sensor::kWidestPx);
    const auto& quantiles = normal_quantiles();
    std::vector<float> deviates(kDeviates);
    Random random(977);
    for (float& deviate : deviates) deviate = quantiles[random.bits() >> 54];
    return deviates;
  }();
  return drawn;
}

}  // namespace

FieldStop::FieldStop(const camera::Boundary& boundary, double mark_angle_deg, double vignette_share)
    : boundary_(boundary), vignette_share_(vignette_share) {
  const double angle = geometry::rad_from_deg(mark_angle_deg);
  mark_ = {std::cos(angle), std::sin(angle)};
}

bool FieldStop::is_open(double dx, double dy) const {
  const double radius = std::hypot(dx, dy);
  if (radius >= boundary_.radius_px) return false;
  const double depth = kToothDepthShare * boundary_.radius_px;
  const double inside_by = radius - (boundary_.radius_px - depth);
  if (inside_by <= 0) return true;
  const double along = mark_.x() * dx + mark_.y() * dy, across = mark_.x() * dy - mark_.y() * dx;
  if (along <= 0) return true;
  const double half_width =
      boundary_.radius_px * std::tan(geometry::rad_from_deg(kToothHalfWidthDeg)) * inside_by / depth;
  return std::abs(across) > half_width;
}

float FieldStop::share_passed(double x_px, double y_px) const {
  const double dx = x_px - boundary_.center_px.x(), dy = y_px - boundary_.center_px.y();
  const double radius2 = dx * dx + dy * dy, limit = boundary_.radius_px;
  if (radius2 > (limit + 1) * (limit + 1)) return 0;
  const double vignette = 1 - vignette_share_ * radius2 / (limit * limit);
  const double tooth_from = limit * (1 - kToothDepthShare) - 1;
  if (radius2 < tooth_from * tooth_from) return static_cast<float>(vignette);
  const double along = mark_.x() * dx + mark_.y() * dy;
  // cos 4 degrees: beyond the tooth the rim is a plain circle.
  if (along * along < 0.995 * radius2 || along < 0) {
    return static_cast<float>(vignette * std::clamp(limit - std::sqrt(radius2) + 0.5, 0.0, 1.0));
  }
  int open = 0;
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 8; ++j) open += is_open(dx + (i - 3.5) / 8, dy + (j - 3.5) / 8);
  }
  return static_cast<float>(vignette * open / 64.0);
}

void FieldStop::stop(double left_px, double y_px, int width, Eigen::Vector3f* light) const {
  // Inside the circle that the tooth does not reach, which is nearly all of it, there is the vignette alone.
  const double dy = y_px - boundary_.center_px.y(), limit2 = boundary_.radius_px * boundary_.radius_px;
  const double plain_radius = boundary_.radius_px * (1 - kToothDepthShare) - 2;
  const double reach = std::sqrt(std::max(0.0, plain_radius * plain_radius - dy * dy));
  const double center = boundary_.center_px.x() - left_px;
  const int plain_from = std::clamp(static_cast<int>(std::ceil(center - reach)), 0, width);
  const int plain_end = std::clamp(static_cast<int>(std::floor(center + reach)), plain_from, width);
  for (int x = 0; x < plain_from; ++x) light[x] *= share_passed(left_px + x, y_px);
  const auto scale = static_cast<float>(vignette_share_ / limit2);
  const auto along = static_cast<float>(center), across2 = static_cast<float>(dy * dy);
  for (int x = plain_from; x < plain_end; ++x) {
    const float dx = static_cast<float>(x) - along;
    light[x] *= 1 - scale * (dx * dx + across2);
  }
  for (int x = plain_end; x < width; ++x) light[x] *= share_passed(left_px + x, y_px);
}

Sensor::Sensor(const SensorOptions& options) : blur_sigma_px_(options.blur_sigma_px), tones_(kTones + 1) {
  // Divided by the square root of the light, so that the dark end, where gamma is steep, is finely divided.
  for (int i = 0; i <= kTones; ++i) {
    const double root = static_cast<double>(i) / kTones;
    const double level = 255 * std::pow(root * root, 1 / kGamma);
    const double variance =
        options.read_noise_levels * options.read_noise_levels + options.shot_noise_share * level;
    tones_[static_cast<std::size_t>(i)] = {static_cast<float>(level),
                                           static_cast<float>(std::sqrt(variance))};
  }
  dark_.reserve(deviates().size());
  for (const float deviate : deviates()) {
    dark_.push_back(to_byte(tones_[0].level + tones_[0].noise_sigma * deviate));
  }
}

void Sensor::expose_row(float* light, const PixelArea& area, std::size_t noise_from, int width,
                        std::uint8_t* out) const {
  const auto copy_dark = [&](int first, int end) {
    std::copy_n(dark_.data() + noise_from + 3 * static_cast<std::size_t>(first), 3 * (end - first),
                out + 3 * first);
  };
  if (!light) return copy_dark(0, width);
  copy_dark(0, area.left);
  copy_dark(area.left + area.width, width);
  const int count = 3 * area.width;
  cv::Mat row(1, count, CV_32F, light);
  cv::sqrt(row, row);
  const float* deviate = deviates().data() + noise_from + 3 * static_cast<std::size_t>(area.left);
  std::uint8_t* lit = out + 3 * area.left;
  for (int i = 0; i < count; ++i) {
    const int at = std::min(static_cast<int>(light[i] * kTones + 0.5f), kTones);
    const Tone& tone = tones_[static_cast<std::size_t>(at)];
    lit[i] = to_byte(tone.level + tone.noise_sigma * deviate[i]);
  }
}

void Sensor::expose(cv::Mat& light, const PixelArea& area, std::uint64_t noise_seed,
                    camera::Frame& frame) const {
  if (blur_sigma_px_ > 0) {
    cv::GaussianBlur(light, light, {7, 7}, blur_sigma_px_, blur_sigma_px_, cv::BORDER_REPLICATE);
  }
  frame.bgr.resize(static_cast<std::size_t>(3) * static_cast<std::size_t>(frame.width * frame.height));
  const std::size_t places = deviates().size() - 3 * static_cast<std::size_t>(frame.width);
  parallel_rows(frame.height, [&](int first, int end) {
    for (int y = first; y < end; ++y) {
      const std::uint64_t draw = Random(noise_seed * 0x100000001B3ULL + static_cast<std::uint64_t>(y)).bits();
      const bool in_rows = y >= area.top && y < area.top + area.height;
      expose_row(in_rows ? light.ptr<float>(y - area.top) : nullptr, area, draw % places, frame.width,
                 frame.bgr.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(3 * frame.width));
    }
  });
}

}  // namespace arthronaut::simulator
