#include "tests/benchmarks/contour_obstructions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace arthronaut::contour_clips {

namespace {

constexpr double kPeriod_s = 8, kLasts_s = 4;

struct Painter {
  std::mt19937_64 random;  // of this bout: the same in all its pictures
  double time_s;           // in the bout
  double strength;         // 0 to 1
  Eigen::Vector2i size;
  std::vector<std::uint8_t>& luma;

  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1.0p-53;
  }
  std::uint8_t& at(int x, int y) {
    return luma[static_cast<std::size_t>(y) * static_cast<std::size_t>(size.x()) +
                static_cast<std::size_t>(x)];
  }
  // A place that wanders: from somewhere in the view, by some of its width a second.
  Eigen::Vector2d wanders(double widths_s) {
    const double w = size.x(), h = size.y();
    const Eigen::Vector2d from(between(0.25 * w, 0.75 * w), between(0.15 * h, 0.85 * h));
    const double way = between(0, 2 * M_PI);
    return from + widths_s * w * (time_s - kLasts_s / 2) * Eigen::Vector2d(std::cos(way), std::sin(way));
  }
  // Towards `level`, by at most `cover`, fading over the outer `soft` share of the radius.
  void blot(const Eigen::Vector2d& middle, double radius, double level, double cover, double soft) {
    const int left = std::max(0, static_cast<int>(middle.x() - radius)),
              right = std::min(size.x() - 1, static_cast<int>(middle.x() + radius)),
              top = std::max(0, static_cast<int>(middle.y() - radius)),
              bottom = std::min(size.y() - 1, static_cast<int>(middle.y() + radius));
    for (int y = top; y <= bottom; ++y)
      for (int x = left; x <= right; ++x) {
        const double off = (Eigen::Vector2d(x, y) - middle).norm() / radius;
        const double share = cover * std::clamp((1 - off) / soft, 0.0, 1.0);
        std::uint8_t& pixel = at(x, y);
        pixel = static_cast<std::uint8_t>(std::clamp(pixel + share * (level - pixel), 0.0, 255.0));
      }
  }
  void blood() {
    for (int i = 0; i < 9; ++i) {
      const Eigen::Vector2d middle = wanders(0.06);
      blot(middle, between(0.08, 0.25) * size.x() * (0.3 + 0.7 * strength), between(25, 60), 0.95 * strength,
           between(0.3, 0.9));
    }
  }
  void glare() {
    for (int i = 0; i < 14; ++i) blot(wanders(0.1), between(0.01, 0.06) * size.x(), 255, strength, 0.4);
  }
  // A shaft that nobody tracks, as wide as a fifth of the picture, with stripes along it.
  void tool() {
    const double way = between(0, M_PI), width = between(0.08, 0.2) * size.x();
    const Eigen::Vector2d across(-std::sin(way), std::cos(way)), through = wanders(0.12);
    for (int y = 0; y < size.y(); ++y)
      for (int x = 0; x < size.x(); ++x) {
        const double off = (Eigen::Vector2d(x, y) - through).dot(across);
        if (std::abs(off) < 0.5 * width * strength)
          at(x, y) =
              static_cast<std::uint8_t>(110 + 60 * std::cos(off * 12 / width) + 10 * std::cos(0.05 * x));
      }
  }
  void debris() {
    const int count = static_cast<int>(120 * strength);
    for (int i = 0; i < count; ++i) {
      const double level = between(90, 220);
      blot(wanders(0.15), between(0.004, 0.02) * size.x(), level, 0.9, 0.3);
    }
  }
  void smear() {
    const double way = between(0, M_PI), length = 0.04 * size.x() * strength;
    const int taps = 1 + static_cast<int>(length);
    const std::vector<std::uint8_t> before = luma;
    for (int y = 0; y < size.y(); ++y)
      for (int x = 0; x < size.x(); ++x) {
        int sum = 0;
        for (int k = 0; k < taps; ++k) {
          const double along = k - 0.5 * (taps - 1);
          const int sx =
                        std::clamp(x + static_cast<int>(std::lround(along * std::cos(way))), 0, size.x() - 1),
                    sy =
                        std::clamp(y + static_cast<int>(std::lround(along * std::sin(way))), 0, size.y() - 1);
          sum += before[static_cast<std::size_t>(sy) * static_cast<std::size_t>(size.x()) +
                        static_cast<std::size_t>(sx)];
        }
        at(x, y) = static_cast<std::uint8_t>(sum / taps);
      }
  }
  void dim_light() {
    std::minstd_rand grain(
        static_cast<std::uint32_t>(random() % 1'000'003 + 1 + 977 * static_cast<int>(60 * time_s)));
    const double left = 1 - 0.85 * strength;
    for (std::uint8_t& pixel : luma) {
      const int noise = static_cast<int>(grain() % 7) - 3;
      pixel = static_cast<std::uint8_t>(std::clamp(static_cast<int>(left * pixel) + noise, 0, 255));
    }
  }
};

}  // namespace

std::string_view to_text(Obstruction kind) {
  static constexpr std::array<std::string_view, kObstructionKinds> kNames{
      "none", "blood", "glare", "a tool", "debris", "smear", "dim light"};
  return kNames[static_cast<std::size_t>(kind)];
}

void obstruct(Obstruction kind, std::uint64_t seed, double time_s, const Eigen::Vector2i& size_px,
              const std::vector<std::uint8_t>& luma, std::vector<std::uint8_t>& obstructed) {
  obstructed = luma;
  const auto bout = static_cast<std::uint64_t>(time_s / kPeriod_s);
  const double in_bout_s = time_s - kPeriod_s * static_cast<double>(bout) - (kPeriod_s - kLasts_s);
  if (kind == Obstruction::None || in_bout_s <= 0) return;
  // There within a second, and gone within one.
  const double strength = std::clamp(2 - std::abs(in_bout_s - kLasts_s / 2), 0.0, 1.0);
  Painter painter{std::mt19937_64(seed * 7919 + bout * 31 + static_cast<std::uint64_t>(kind)), in_bout_s,
                  strength, size_px, obstructed};
  switch (kind) {
    case Obstruction::None:
      return;
    case Obstruction::Blood:
      return painter.blood();
    case Obstruction::Glare:
      return painter.glare();
    case Obstruction::Tool:
      return painter.tool();
    case Obstruction::Debris:
      return painter.debris();
    case Obstruction::Smear:
      return painter.smear();
    case Obstruction::DimLight:
      return painter.dim_light();
  }
}

}  // namespace arthronaut::contour_clips
