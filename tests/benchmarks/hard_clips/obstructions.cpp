#include "tests/benchmarks/hard_clips/obstructions.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace arthronaut::hard_clips {
namespace {

constexpr int kTile = 64;
const std::array<float, kTile* kTile> kLattice = [] {
  std::array<float, kTile * kTile> lattice{};
  Draw draw(42);
  for (float& value : lattice) value = static_cast<float>(draw.between(0, 1));
  return lattice;
}();

// std::floor is a call, and most of the time that a frame takes to draw.
int floor_of(float value) {
  const int whole = static_cast<int>(value);
  return whole - (static_cast<float>(whole) > value);
}

float lattice_noise(float x, float y) {
  const int column = floor_of(x), row = floor_of(y);
  float right = x - static_cast<float>(column), below = y - static_cast<float>(row);
  right *= right * (3 - 2 * right);
  below *= below * (3 - 2 * below);
  const auto at = [](int c, int r) { return kLattice[(r & (kTile - 1)) * kTile + (c & (kTile - 1))]; };
  const float upper = at(column, row) + right * (at(column + 1, row) - at(column, row));
  const float lower = at(column, row + 1) + right * (at(column + 1, row + 1) - at(column, row + 1));
  return upper + below * (lower - upper);
}

// Calls with each pixel of the box about a place, as far as it is in the picture.
template <typename Paint>
void each_pixel(const cv::Mat& light, const Eigen::Vector2d& middle, double reach, const Paint& paint) {
  const int left = std::max(0, static_cast<int>(middle.x() - reach)),
            top = std::max(0, static_cast<int>(middle.y() - reach));
  const int right = std::min(light.cols - 1, static_cast<int>(middle.x() + reach) + 1),
            bottom = std::min(light.rows - 1, static_cast<int>(middle.y() + reach) + 1);
  for (int y = top; y <= bottom; ++y) {
    for (int x = left; x <= right; ++x) paint(x, y);
  }
}

void blend(cv::Mat& light, cv::Mat& cover, int x, int y, float alpha, const cv::Vec3f& color) {
  if (alpha <= 0) return;
  cv::Vec3f& pixel = light.at<cv::Vec3f>(y, x);
  pixel += alpha * (color - pixel);
  std::uint8_t& covered = cover.at<std::uint8_t>(y, x);
  covered = std::max(covered, static_cast<std::uint8_t>(255 * alpha));
}

float smooth_step(double value) {
  const double v = std::clamp(value, 0.0, 1.0);
  return static_cast<float>(v * v * (3 - 2 * v));
}

}  // namespace

float noise_at(float x, float y) {
  return 0.6F * lattice_noise(x, y) + 0.27F * lattice_noise(2.1F * x + 7, 2.1F * y) +
         0.13F * lattice_noise(4.3F * x, 4.3F * y + 3);
}

Obstructions::Obstructions(const ClipRecipe& recipe) : recipe_(recipe) {
  Draw draw(recipe.seed * 31337 + 11 * static_cast<std::uint64_t>(recipe.hardness) + 3);
  const double scale = recipe.height / 1080.0;
  const auto part = [&](double size, double rate_low, double rate_high) {
    Part made;
    made.marker = draw.below(ClipMotion::kMarkers);
    made.size = size;
    made.rate = draw.between(rate_low, rate_high) * (draw.happens(0.5) ? 1 : -1);
    made.phase = draw.between(0, 2 * geometry::kPi);
    made.angle = draw.between(0, 2 * geometry::kPi);
    made.reach = draw.between(0.5, 1.3);
    made.level = draw.between(0, 1);
    return made;
  };
  if (recipe.has_cover) {
    for (int k = 0; k < ClipMotion::kMarkers; ++k) {
      const bool is_finger = draw.happens(0.5);
      Part capsule = part(is_finger ? draw.between(0.4, 0.8) : draw.between(0.12, 0.35), 2, 6);
      capsule.marker = k;
      const auto tone = static_cast<float>(draw.between(0.7, 1.2));
      capsule.color = is_finger ? tone * cv::Vec3f(0.22F, 0.27F, 0.45F) : tone * cv::Vec3f(0.2F, 0.2F, 0.2F);
      capsule.level = is_finger ? 0 : 1;  // steel has a streak of light along it
      capsules_.push_back(capsule);
    }
  }
  if (recipe.has_blood) {
    for (int k = 0; k < 6; ++k) {
      clouds_.push_back(part(draw.between(0.3, 0.9), 0.5, 2.5));
      clouds_.back().color = {0.008F, 0.01F, static_cast<float>(draw.between(0.06, 0.2))};
    }
  }
  if (recipe.has_debris) {
    const int count = 40 + draw.below(80);
    for (int k = 0; k < count; ++k) {
      flecks_.push_back(part(scale * draw.between(1.2, 7), 30, 500));
      const auto tone =
          static_cast<float>(draw.happens(0.6) ? draw.between(0.4, 0.9) : draw.between(0.02, 0.2));
      flecks_.back().color = {0.9F * tone, 0.95F * tone, tone};
    }
  }
  if (recipe.has_bubbles) {
    const int count = 4 + draw.below(8);
    for (int k = 0; k < count; ++k) bubbles_.push_back(part(draw.between(0.08, 0.45), 0.5, 2.5));
  }
  if (recipe.has_smoke) {
    veil_ = draw.between(0.25, 0.65);
    veil_rate_ = draw.between(0.5, 3);
  }
  if (recipe.has_glare) {
    for (int k = 0; k < ClipMotion::kMarkers; ++k) {
      // 5 to 30 % of the square's area, in one to three spots.
      const double share = draw.between(0.05, 0.3);
      const int count = 1 + draw.below(3);
      for (int i = 0; i < count; ++i) {
        Part spot = part(share / count, 0.7, 4);
        spot.marker = k;
        spot.reach = draw.between(0.1, 0.45);
        spot.level = draw.between(1, 2.5);  // longer than wide
        highlights_.push_back(spot);
      }
    }
  }
}

void Obstructions::paint(double time_s, const MarkerPlaces& places, cv::Mat& light, cv::Mat& cover) const {
  for (const Part& part : clouds_) paint_cloud(part, time_s, places, light, cover);
  for (const Part& part : highlights_) paint_glare(part, time_s, places, light);
  for (const Part& part : capsules_) paint_capsule(part, time_s, places, light, cover);
  for (const Part& part : bubbles_) paint_bubble(part, time_s, places, light, cover);
  for (const Part& part : flecks_) paint_fleck(part, time_s, light, cover);
  if (veil_ > 0) paint_veil(time_s, light);
}

// A rod with a round end that comes over the marker from one side and goes again.
void Obstructions::paint_capsule(const Part& part, double time_s, const MarkerPlaces& places, cv::Mat& light,
                                 cv::Mat& cover) const {
  const double side = places.side_px[part.marker], radius = part.size * side;
  const Eigen::Vector2d along(std::cos(part.angle), std::sin(part.angle)), across(-along.y(), along.x());
  const double way = std::sin(part.rate * time_s + part.phase);
  // Its end stops somewhere in the marker; its axis lies beside the middle.
  const Eigen::Vector2d end = places.center_px[part.marker] +
                              side * (0.75 + 0.55 * way * part.reach + radius / side) * along +
                              0.5 * side * std::cos(0.6 * part.rate * time_s + 2 * part.phase) * across;
  const double softness = 1.5 * recipe_.height / 1080;
  const double far = recipe_.height;
  each_pixel(light, end + 0.5 * far * along, 0.75 * far, [&](int x, int y) {
    const Eigen::Vector2d from_end = Eigen::Vector2d(x, y) - end;
    const double behind = from_end.dot(along), beside = from_end.dot(across);
    const double away = behind > 0 ? std::abs(beside) : from_end.norm();
    if (away > radius + softness) return;
    const float alpha = smooth_step(0.5 + 0.5 * (radius - away) / softness);
    const double round = std::sqrt(std::max(0.0, 1 - std::pow(away / (radius + softness), 2)));
    cv::Vec3f color = static_cast<float>(0.35 + 0.65 * round) * part.color;
    if (part.level > 0 && std::abs(beside / radius + 0.3) < 0.12) color = {1.5F, 1.5F, 1.5F};
    blend(light, cover, x, y, alpha, color);
  });
}

void Obstructions::paint_cloud(const Part& part, double time_s, const MarkerPlaces& places, cv::Mat& light,
                               cv::Mat& cover) const {
  const double side = places.side_px[part.marker], radius = part.size * side;
  const double turned = part.rate * time_s + part.phase;
  const Eigen::Vector2d middle =
      places.center_px[part.marker] + side * part.reach * Eigen::Vector2d(std::cos(turned), std::sin(turned));
  const auto grain = static_cast<float>(3.5 / side);
  const auto drift = static_cast<float>(0.4 * time_s);
  each_pixel(light, middle, 1.5 * radius, [&](int x, int y) {
    const double away = std::hypot(x - middle.x(), y - middle.y()) / radius;
    const float rough = noise_at(grain * static_cast<float>(x) + drift, grain * static_cast<float>(y));
    blend(light, cover, x, y, 0.95F * smooth_step(3 * (1.1 * rough + 0.5 - away)), part.color);
  });
}

void Obstructions::paint_fleck(const Part& part, double time_s, cv::Mat& light, cv::Mat& cover) const {
  const double scale = recipe_.height / 1080.0;
  const auto wrapped = [](double value, double range) { return value - range * std::floor(value / range); };
  const double way = scale * std::abs(part.rate) * (time_s + 10 * part.level);
  const Eigen::Vector2d middle(wrapped(1e4 * part.phase + way * std::cos(part.angle), recipe_.width),
                               wrapped(1e4 * part.reach + way * std::sin(part.angle), recipe_.height));
  const double stretch = 1 + part.level;
  each_pixel(light, middle, stretch * part.size + 2, [&](int x, int y) {
    const Eigen::Vector2d from = Eigen::Vector2d(x, y) - middle;
    const double along = from.dot(Eigen::Vector2d(std::cos(part.phase), std::sin(part.phase)));
    const double beside = std::sqrt(std::max(0.0, from.squaredNorm() - along * along));
    const double away = std::hypot(along / stretch, beside);
    blend(light, cover, x, y, 0.9F * smooth_step(0.5 + (part.size - away) / 2), part.color);
  });
}

void Obstructions::paint_bubble(const Part& part, double time_s, const MarkerPlaces& places, cv::Mat& light,
                                cv::Mat& cover) const {
  const double side = places.side_px[part.marker], radius = std::max(4.0, part.size * side);
  const double turned = part.rate * time_s + part.phase;
  const Eigen::Vector2d middle =
      places.center_px[part.marker] +
      side * part.reach * Eigen::Vector2d(std::cos(turned), std::sin(1.3 * turned));
  const cv::Mat before = light.clone();
  each_pixel(light, middle, radius + 1, [&](int x, int y) {
    const Eigen::Vector2d inside = (Eigen::Vector2d(x, y) - middle) / radius;
    const double away = inside.norm();
    if (away > 1) return;
    // It shows what is behind it upside down, as air in water does towards its rim; the rim itself is dark.
    const Eigen::Vector2d seen = middle + radius * inside * (0.4 + 0.9 * away * away);
    const int column = std::clamp(static_cast<int>(std::lround(seen.x())), 0, before.cols - 1),
              row = std::clamp(static_cast<int>(std::lround(seen.y())), 0, before.rows - 1);
    cv::Vec3f color = before.at<cv::Vec3f>(row, column);
    color *= static_cast<float>(away > 0.8 ? 0.35 : 0.9);
    if ((inside - Eigen::Vector2d(-0.35, -0.4)).norm() < 0.14) color = {2, 2, 2};
    blend(light, cover, x, y, smooth_step((1 - away) * radius / 2), color);
  });
}

void Obstructions::paint_veil(double time_s, cv::Mat& light) const {
  const auto grain = static_cast<float>(4.0 / recipe_.height);
  const auto drift = static_cast<float>(veil_rate_ * time_s);
  for (int y = 0; y < light.rows; ++y) {
    auto* row = light.ptr<cv::Vec3f>(y);
    for (int x = 0; x < light.cols; ++x) {
      if (row[x][2] <= 0) continue;  // outside the view
      const float density =
          noise_at(grain * static_cast<float>(x) + drift, grain * static_cast<float>(y) + 0.3F * drift);
      const float alpha = static_cast<float>(veil_) * std::clamp(1.6F * density - 0.3F, 0.0F, 1.0F);
      row[x] += alpha * (cv::Vec3f(0.36F, 0.38F, 0.4F) - row[x]);
    }
  }
}

void Obstructions::paint_glare(const Part& part, double time_s, const MarkerPlaces& places,
                               cv::Mat& light) const {
  const double side = places.side_px[part.marker];
  const double turned = part.rate * time_s + part.phase;
  const Eigen::Vector2d middle =
      places.center_px[part.marker] + side * part.reach * Eigen::Vector2d(std::cos(turned), std::sin(turned));
  // The light falls off as a bell, and saturates what is dark up to this radius.
  constexpr double kPeak = 8;
  const double radius = side * std::sqrt(part.size / geometry::kPi);
  const double sigma = radius / std::sqrt(2 * std::log(kPeak));
  const Eigen::Vector2d along(std::cos(part.angle), std::sin(part.angle));
  const double longer = std::sqrt(part.level);
  each_pixel(light, middle, 5 * sigma * longer, [&](int x, int y) {
    const Eigen::Vector2d from = Eigen::Vector2d(x, y) - middle;
    const double far = from.dot(along);
    const double square = far * far / (longer * longer) + (from.squaredNorm() - far * far) * longer * longer;
    const auto added = static_cast<float>(kPeak * std::exp(-0.5 * square / (sigma * sigma)));
    if (added > 1e-3F) light.at<cv::Vec3f>(y, x) += cv::Vec3f(added, added, added);
  });
}

}  // namespace arthronaut::hard_clips
