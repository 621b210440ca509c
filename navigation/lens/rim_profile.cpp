#include <algorithm>
#include <cmath>

#include "navigation/lens/rim.h"
#include "planning/geometry/quantile.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::lens {
namespace {

struct Directions {
  std::array<float, kRayCount> cosine{}, sine{};
  Directions() {
    for (int i = 0; i < kRayCount; ++i) {
      const double angle = geometry::rad_from_deg(i * kRayStepDeg);
      cosine[i] = static_cast<float>(std::cos(angle));
      sine[i] = static_cast<float>(std::sin(angle));
    }
  }
};
const Directions& directions() {
  static const Directions table;
  return table;
}

struct LinearLight {
  std::array<float, 256> value{};
  LinearLight() {
    for (int i = 0; i < 256; ++i) value[i] = static_cast<float>(std::pow(i / 255.0, 2.2));
  }
};
const LinearLight& linear_light() {
  static const LinearLight table;
  return table;
}

float light_at(const camera::GrayView& picture, float x, float y) {
  const int ix = static_cast<int>(x), iy = static_cast<int>(y);
  const float fx = x - static_cast<float>(ix), fy = y - static_cast<float>(iy);
  const std::uint8_t* top = picture.row(iy) + ix;
  const std::uint8_t* bottom = top + picture.stride;
  const auto& light = linear_light().value;
  return (1 - fy) * ((1 - fx) * light[top[0]] + fx * light[top[1]]) +
         fy * ((1 - fx) * light[bottom[0]] + fx * light[bottom[1]]);
}

// One ray. A noisy picture is averaged across it, over about as much of the rim as lies between two rays: the
// mark keeps its shape, the noise does not.
struct Ray {
  const camera::GrayView& picture;
  Eigen::Vector2f center;
  float dx, dy;
  int half_width = 0;  // pixels to each side

  // The last radius at which all of the ray, with a pixel to spare for interpolation, is still in the
  // picture; -1 where not even the centre is.
  [[nodiscard]] float reach() const {
    const float spare = static_cast<float>(1 + half_width);
    const float right = static_cast<float>(picture.width - 1) - spare;
    const float bottom = static_cast<float>(picture.height - 1) - spare;
    if (!(center.x() >= spare && center.x() <= right && center.y() >= spare && center.y() <= bottom))
      return -1;
    float most = 1e9F;
    if (dx > 1e-6F) most = std::min(most, (right - center.x()) / dx);
    if (dx < -1e-6F) most = std::min(most, (spare - center.x()) / dx);
    if (dy > 1e-6F) most = std::min(most, (bottom - center.y()) / dy);
    if (dy < -1e-6F) most = std::min(most, (spare - center.y()) / dy);
    return most;
  }

  [[nodiscard]] int grey(float r) const {
    int sum = 0;
    for (int k = -half_width; k <= half_width; ++k) {
      const Eigen::Vector2f at = point(r, k);
      sum += picture.row(static_cast<int>(at.y() + 0.5F))[static_cast<int>(at.x() + 0.5F)];
    }
    return sum / (2 * half_width + 1);
  }
  [[nodiscard]] float light(float r) const {
    float sum = 0;
    for (int k = -half_width; k <= half_width; ++k) {
      const Eigen::Vector2f at = point(r, k);
      sum += light_at(picture, at.x(), at.y());
    }
    return sum / static_cast<float>(2 * half_width + 1);
  }

 private:
  [[nodiscard]] Eigen::Vector2f point(float r, int across) const {
    const float k = static_cast<float>(across);
    return {center.x() + r * dx - k * dy, center.y() + r * dy + k * dx};
  }
};

// Median grey value at the outer end of the rays, and how far it scatters.
void measure_mask(const camera::GrayView& picture, const Eigen::Vector2f& center, float outer_px,
                  int half_width, double& level, double& scatter) {
  std::array<int, 256> histogram{};
  int count = 0;
  for (int i = 0; i < kRayCount; i += 2) {
    const Ray ray{picture, center, directions().cosine[i], directions().sine[i], half_width};
    if (ray.reach() < outer_px) continue;
    ++histogram[static_cast<std::size_t>(ray.grey(outer_px))];
    ++count;
  }
  const auto quantile = [&](double share) {
    int sum = 0, value = 0;
    while (value < 255 && (sum += histogram[value]) < share * count) ++value;
    return value;
  };
  level = count > 0 ? quantile(0.5) : 0;
  scatter = count > 0 ? std::max(0.0, quantile(0.84) - level) : 0;
}

// Radius at which the light has risen half way, near a first lit sample at `first_px`.
float locate_edge(const Ray& ray, float first_px, float reach_px, float dark_light, float& inside) {
  constexpr int kOutside = 4, kInside = 6;
  std::array<float, kOutside + kInside + 1> light;
  const float start = std::min(first_px + kOutside, reach_px);
  for (std::size_t k = 0; k < light.size(); ++k) light[k] = ray.light(start - static_cast<float>(k));
  const std::size_t n = light.size();
  inside = (light[n - 1] + light[n - 2] + light[n - 3]) / 3;
  const float half = 0.5F * (dark_light + inside);
  for (std::size_t k = 1; k < n; ++k)
    if (light[k] >= half && light[k - 1] < half) {
      const float share = (half - light[k - 1]) / (light[k] - light[k - 1]);
      return start - (static_cast<float>(k - 1) + share);
    }
  return first_px;
}

// From the first light of a ray to its edge is as far as the picture is blurred, and alike all round. Where
// it is much further, a dark strip of the scene lies beside the rim (a black square of a board, a shadow):
// its light begins where the mask ends. A dent in the mask itself, such as the mark, has no light before its
// edge.
void mend_dark_strips(const std::array<float, kRayCount>& first_px, RimProfile& profile) {
  constexpr float kMostFurther_px = 1.5F;
  std::array<float, kRayCount> gaps;
  int count = 0;
  for (int i = 0; i < kRayCount; ++i)
    if (profile.state[i] == RayState::Edge)
      gaps[static_cast<std::size_t>(count++)] = first_px[i] - profile.radius_px[i];
  if (count == 0) return;
  const float usual = geometry::median_in_place(std::span(gaps).first(static_cast<std::size_t>(count)));
  for (int i = 0; i < kRayCount; ++i)
    if (profile.state[i] == RayState::Edge && first_px[i] - profile.radius_px[i] > usual + kMostFurther_px)
      profile.radius_px[i] = first_px[i] - usual;
}

}  // namespace

void measure_rim(const camera::GrayView& picture, const camera::Boundary& expected, double inner,
                 double outer, RimProfile& profile) {
  profile.about = expected;
  const Eigen::Vector2f center = expected.center_px.cast<float>();
  const float outer_px = static_cast<float>(expected.radius_px * outer);
  // Room for telling an edge from the end of the ray, whatever the size of the circle.
  const float inner_px = std::max(0.0F, static_cast<float>(expected.radius_px * inner) - 8);
  constexpr double kQuietScatter = 2;  // grey levels
  constexpr int kNoisyHalfWidth = 3;
  double scatter = 0;
  int half_width = 0;
  measure_mask(picture, center, outer_px, half_width, profile.dark_level, scatter);
  if (scatter > kQuietScatter) {
    half_width = kNoisyHalfWidth;
    measure_mask(picture, center, outer_px, half_width, profile.dark_level, scatter);
  }
  // A lit scene stands clear of the mask's own noise and of compression's ringing.
  const int lit = static_cast<int>(profile.dark_level + std::clamp(4.0 * scatter, 7.0, 30.0));
  const float dark_light = linear_light().value[static_cast<std::size_t>(profile.dark_level)];

  // Averaged samples tell in twos what single ones tell in threes.
  const float step_px = half_width > 0 ? 2 : 1;
  const int lit_run = half_width > 0 ? 2 : 3;
  int dark = 0, clipped = 0;
  std::array<float, kRayCount> first_px{};
  for (int i = 0; i < kRayCount; ++i) {
    const Ray ray{picture, center, directions().cosine[i], directions().sine[i], half_width};
    const float reach = ray.reach();
    const float start = std::min(outer_px, reach);
    int run = 0;
    float first = -1;
    for (float r = start; r >= inner_px; r -= step_px) {
      if (ray.grey(r) <= lit) {
        run = 0;
      } else if (++run == lit_run) {
        first = r + 2;
        break;
      }
    }
    if (start < inner_px + 8 || first > start - 1.5F) {
      profile.state[i] = RayState::Clipped;
      ++clipped;
    } else if (first < inner_px + 7) {
      profile.state[i] = RayState::Dark;
      ++dark;
    } else {
      profile.state[i] = RayState::Edge;
      first_px[i] = first;
      profile.radius_px[i] = locate_edge(ray, first, reach, dark_light, profile.inside_light[i]);
    }
  }
  mend_dark_strips(first_px, profile);
  profile.dark_share = static_cast<double>(dark) / kRayCount;
  profile.clipped_share = static_cast<double>(clipped) / kRayCount;
}

CircleFit fit_circle(const RimProfile& profile, double gate_px) {
  // Offsets of centre and radius from the expected circle, by reweighted least squares of the radial
  // distance.
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  const auto residual = [&](int i) {
    const double c = directions().cosine[i], s = directions().sine[i], r = profile.radius_px[i];
    const double x = r * c - offset.x(), y = r * s - offset.y();
    return std::sqrt(x * x + y * y) - (profile.about.radius_px + offset.z());
  };
  std::array<float, kRayCount> magnitude;
  double scale = gate_px / 4.685;
  for (int pass = 0; pass < 8; ++pass) {
    int count = 0;
    for (int i = 0; i < kRayCount; ++i) {
      if (profile.state[i] != RayState::Edge) continue;
      const double e = std::abs(residual(i));
      if (e < gate_px) magnitude[static_cast<std::size_t>(count++)] = static_cast<float>(e);
    }
    if (count < 60) return {};
    const float middle =
        geometry::median_in_place(std::span(magnitude).first(static_cast<std::size_t>(count)));
    scale = std::clamp(1.4826 * middle, 0.2, scale);

    const double limit = 4.685 * scale;
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (int i = 0; i < kRayCount; ++i) {
      if (profile.state[i] != RayState::Edge) continue;
      const double e = residual(i);
      if (std::abs(e) >= limit) continue;
      const double u = e / limit, weight = (1 - u * u) * (1 - u * u);
      const Eigen::Vector3d row(directions().cosine[i], directions().sine[i], 1);
      normal += weight * row * row.transpose();
      right += weight * e * row;
    }
    // The smallest pivot tells whether the rim was seen on enough sides to fix the centre.
    const Eigen::Matrix3d inverse = normal.inverse();
    if (!inverse.allFinite() || inverse.diagonal().maxCoeff() > 1.0) return {};
    const Eigen::Vector3d step = inverse * right;
    offset += step;
    if (pass > 2 && step.norm() < 1e-3) break;
  }

  CircleFit fit;
  fit.circle.center_px = profile.about.center_px + offset.head<2>();
  fit.circle.radius_px = profile.about.radius_px + offset.z();
  double sum = 0;
  int close = 0;
  for (int i = 0; i < kRayCount; ++i) {
    if (profile.state[i] != RayState::Edge) continue;
    const double e = residual(i);
    if (std::abs(e) > 1.5) continue;
    sum += e * e;
    ++close;
  }
  fit.coverage_deg = close * kRayStepDeg;
  fit.rms_px = close > 0 ? std::sqrt(sum / close) : -1;
  fit.ok = fit.coverage_deg >= 90;
  return fit;
}

}  // namespace arthronaut::lens
