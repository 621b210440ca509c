#include "navigation/simulator/sensor.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "navigation/simulator/random.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::simulator {
namespace {

constexpr double kToothHalfWidthDeg = 2.5, kToothDepthShare = 0.035;
constexpr int kQuantiles = 1024;

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

// Normal deviates in no order. A row takes its noise from a place drawn for it, which is as good as noise of
// its own and costs no random number a pixel.
const std::vector<float>& deviates() {
  static const auto drawn = [] {
    constexpr std::size_t kDeviates = 1 << 18;
    static_assert(kDeviates > 4 * 3 * Sensor::kWidestPx);
    const auto& quantiles = normal_quantiles();
    std::vector<float> deviates(kDeviates + kTogether);  // a row's last packet may read beyond it
    Random random(977);
    for (float& deviate : deviates) deviate = quantiles[random.bits() >> 54];
    return deviates;
  }();
  return drawn;
}

// The area's columns that light reaches in a row of the picture, with what the blur spreads of it.
std::array<int, 2> lit_columns(const PixelArea& area, const FieldStop* stop, int y) {
  if (y < area.top || y >= area.top + area.height) return {0, 0};
  if (stop == nullptr) return {0, area.width};
  // Of the rows within the blur's reach the widest.
  std::array<int, 2> lit{area.width, 0};
  for (const int other : {y - kBlurReach, y, y + kBlurReach}) {
    const auto open = stop->open_columns(area.left, other, area.width);
    if (open[0] == open[1]) continue;
    lit = {std::min(lit[0], open[0]), std::max(lit[1], open[1])};
  }
  if (lit[0] >= lit[1]) return {0, 0};
  return {std::max(0, lit[0] - kBlurReach), std::min(area.width, lit[1] + kBlurReach)};
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

std::array<int, 2> FieldStop::open_columns(double left_px, double y_px, int width) const {
  const double dy = y_px - boundary_.center_px.y(), radius = boundary_.radius_px + 1;
  if (std::abs(dy) >= radius) return {0, 0};
  const double reach = std::sqrt(radius * radius - dy * dy), center = boundary_.center_px.x() - left_px;
  const int first = std::clamp(static_cast<int>(std::floor(center - reach)), 0, width);
  return {first, std::clamp(static_cast<int>(std::ceil(center + reach)) + 1, first, width)};
}

void FieldStop::stop(double left_px, double y_px, int width, float* light) const {
  const auto dim = [light](int x, float share) {
    for (int c = 0; c < 3; ++c) light[3 * x + c] *= share;
  };
  const auto [first, end] = open_columns(left_px, y_px, width);
  std::fill(light, light + static_cast<std::ptrdiff_t>(3) * first, 0.0f);
  std::fill(light + static_cast<std::ptrdiff_t>(3) * end, light + static_cast<std::ptrdiff_t>(3) * width,
            0.0f);
  // Inside the circle that the tooth does not reach, which is nearly all of it, there is the vignette alone.
  const double dy = y_px - boundary_.center_px.y(), limit2 = boundary_.radius_px * boundary_.radius_px;
  const double plain_radius = boundary_.radius_px * (1 - kToothDepthShare) - 2;
  const double reach = std::sqrt(std::max(0.0, plain_radius * plain_radius - dy * dy));
  const double center = boundary_.center_px.x() - left_px;
  const int plain_from = std::clamp(static_cast<int>(std::ceil(center - reach)), first, end);
  const int plain_end = std::clamp(static_cast<int>(std::floor(center + reach)), plain_from, end);
  for (int x = first; x < plain_from; ++x) dim(x, share_passed(left_px + x, y_px));
  const auto scale = static_cast<float>(vignette_share_ / limit2);
  const auto along = static_cast<float>(center), across2 = static_cast<float>(dy * dy);
  for (int x = plain_from; x < plain_end; ++x) {
    const float dx = static_cast<float>(x) - along;
    dim(x, 1 - scale * (dx * dx + across2));
  }
  for (int x = plain_end; x < end; ++x) dim(x, share_passed(left_px + x, y_px));
}

Sensor::Sensor(const SensorOptions& options) {
  if (options.blur_sigma_px > 0) {
    double sum = 0;
    for (int k = 0; k <= kBlurReach; ++k) {
      const double weight = std::exp(-0.5 * k * k / (options.blur_sigma_px * options.blur_sigma_px));
      blur_[k] = static_cast<float>(weight);
      sum += k == 0 ? weight : 2 * weight;
    }
    for (float& weight : blur_) weight /= static_cast<float>(sum);
  }
  tone_.read_variance = static_cast<float>(options.read_noise_levels * options.read_noise_levels);
  tone_.shot_share = static_cast<float>(options.shot_noise_share);
  const std::vector<float> black(static_cast<std::size_t>(kTogether), 0.0f);
  dark_.resize(deviates().size());
  for (std::size_t i = 0; i < dark_.size(); i += kTogether)
    picture_kernel().expose(tone_, black.data(), deviates().data() + i, kTogether, dark_.data() + i);
}

// Some columns of a row of the area, with these deviates as their noise.
void Sensor::expose_row(const float* light, const PixelArea& area, int row, const std::array<int, 2>& columns,
                        const float* deviates, Memory& memory, std::uint8_t* out) const {
  constexpr int kMargin = 3 * kBlurReach;
  const int width = 3 * area.width, first = 3 * columns[0], count = 3 * (columns[1] - columns[0]);
  const int room = padded(count);
  // What the blur takes in from both sides; beyond its ends the row goes on as it ends.
  const int from = std::max(0, first - kMargin),
            wide = padded(std::min(width, first + count + kMargin) - from);
  memory.across.resize(static_cast<std::size_t>(wide + room + 2 * kMargin));
  memory.along.resize(static_cast<std::size_t>(room));
  memory.grey.resize(static_cast<std::size_t>(room));
  const auto row_at = [&](int y) {
    return light + static_cast<std::ptrdiff_t>(width) * std::clamp(y, 0, area.height - 1) + from;
  };
  const PictureKernel& kernel = picture_kernel();
  float* const across = memory.across.data() + kMargin - (first - from);  // where column `from` lies
  kernel.blur_across({row_at(row - 3), row_at(row - 2), row_at(row - 1), row_at(row), row_at(row + 1),
                      row_at(row + 2), row_at(row + 3)},
                     blur_, wide, across);
  float* const begin = memory.across.data() + kMargin;
  for (int k = first - from; k < kMargin; ++k) begin[-1 - k] = begin[2 - k % 3 - (first - from)];
  for (int k = std::min(width, first + count + kMargin) - first; k < count + kMargin; ++k)
    begin[k] = begin[k - 3];
  kernel.blur_along(begin, blur_, room, memory.along.data());
  kernel.expose(tone_, memory.along.data(), deviates, room, memory.grey.data());
  std::copy_n(memory.grey.data(), count, out);
}

void Sensor::expose(const std::vector<float>& light, const PixelArea& area, const FieldStop* stop,
                    std::uint64_t noise_seed, camera::Frame& frame) {
  const auto stride = static_cast<std::size_t>(3) * static_cast<std::size_t>(frame.width);
  frame.bgr.resize(stride * static_cast<std::size_t>(frame.height));
  const std::size_t places = deviates().size() - kTogether - stride;
  parallel_bands(frame.height, [&](int first, int end, int thread) {
    for (int y = first; y < end; ++y) {
      const std::uint64_t draw = Random(noise_seed * 0x100000001B3ULL + static_cast<std::uint64_t>(y)).bits();
      const std::size_t from = draw % places;
      std::uint8_t* const out = frame.bgr.data() + static_cast<std::size_t>(y) * stride;
      const auto copy_dark = [&](int begin_px, int end_px) {
        std::copy_n(dark_.data() + from + 3 * static_cast<std::size_t>(begin_px), 3 * (end_px - begin_px),
                    out + static_cast<std::ptrdiff_t>(3) * begin_px);
      };
      const std::array<int, 2> lit = lit_columns(area, stop, y);
      if (lit[0] == lit[1]) {
        copy_dark(0, frame.width);
        continue;
      }
      const int left = area.left + lit[0], right = area.left + lit[1];
      copy_dark(0, left);
      expose_row(light.data(), area, y - area.top, lit,
                 deviates().data() + from + 3 * static_cast<std::size_t>(left),
                 memory_[static_cast<std::size_t>(thread)], out + static_cast<std::ptrdiff_t>(3) * left);
      copy_dark(right, frame.width);
    }
  });
}

}  // namespace arthronaut::simulator
