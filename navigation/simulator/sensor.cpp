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

struct Tone {
  float level = 0, noise_sigma = 0;  // grey levels
};

std::uint8_t to_byte(float level) {
  return static_cast<std::uint8_t>(static_cast<int>(std::clamp(level + 0.5f, 0.0f, 255.0f)));
}

// By the square root of the light, so that the dark end, where gamma is steep, is finely divided.
std::array<Tone, kTones + 1> make_tones(const SensorOptions& options) {
  std::array<Tone, kTones + 1> tones{};
  for (int i = 0; i <= kTones; ++i) {
    const double root = static_cast<double>(i) / kTones;
    const double level = 255 * std::pow(root * root, 1 / kGamma);
    const double variance =
        options.read_noise_levels * options.read_noise_levels + options.shot_noise_share * level;
    tones[static_cast<std::size_t>(i)] = {static_cast<float>(level), static_cast<float>(std::sqrt(variance))};
  }
  return tones;
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

void expose(cv::Mat& light, const PixelArea& area, const SensorOptions& options, std::uint64_t noise_seed,
            camera::Frame& frame) {
  if (options.blur_sigma_px > 0) {
    cv::GaussianBlur(light, light, {7, 7}, options.blur_sigma_px, options.blur_sigma_px,
                     cv::BORDER_REPLICATE);
  }
  static const std::array<float, kQuantiles>& quantiles = normal_quantiles();
  const auto tones = make_tones(options);
  const auto tone_of = [&](float value) -> const Tone& {
    const float root = std::sqrt(std::clamp(value, 0.0f, 1.0f)) * kTones;
    return tones[static_cast<std::size_t>(static_cast<int>(root + 0.5f))];
  };
  frame.bgr.resize(static_cast<std::size_t>(3) * static_cast<std::size_t>(frame.width * frame.height));
  parallel_rows(frame.height, [&](int first, int end) {
    for (int y = first; y < end; ++y) {
      std::uint64_t state = Random(noise_seed * 0x100000001B3ULL + static_cast<std::uint64_t>(y)).bits() | 1;
      const bool in_rows = y >= area.top && y < area.top + area.height;
      const float* lit_row = in_rows ? light.ptr<float>(y - area.top) : nullptr;
      std::uint8_t* out =
          frame.bgr.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(3 * frame.width);
      for (int x = 0; x < frame.width; ++x, out += 3) {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        const bool is_lit = lit_row && x >= area.left && x < area.left + area.width;
        for (int channel = 0; channel < 3; ++channel) {
          const float deviate = quantiles[(state >> (8 + 18 * channel)) & (kQuantiles - 1)];
          // Half of the picture is dark: its level is that of no light.
          const Tone& tone = is_lit ? tone_of(lit_row[3 * (x - area.left) + channel]) : tones[0];
          out[channel] = to_byte(tone.level + tone.noise_sigma * deviate);
        }
      }
    }
  });
}

}  // namespace arthronaut::simulator
