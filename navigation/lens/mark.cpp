#include "navigation/lens/mark.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "planning/geometry/quantile.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::lens {
namespace {

constexpr double kFlankDeg = 2.0;

int wrapped_ray(int i) { return ((i % kRayCount) + kRayCount) % kRayCount; }
double severity_of(MarkPolarity polarity) { return polarity == MarkPolarity::BrightOutward ? -1.0 : 1.0; }

// The dent's depth around one place, upright: angles relative to the first ray, dents positive.
struct Window {
  static constexpr int kMost = 96;
  std::array<double, kMost> angle_deg, depth_px;
  int seen = 0, rays = 0;
};

Window window_of(const DentProfile& dents, double sign, double center_deg, double half_deg) {
  Window window;
  const int first = static_cast<int>(std::ceil((center_deg - half_deg) / kRayStepDeg));
  const int last = static_cast<int>(std::floor((center_deg + half_deg) / kRayStepDeg));
  for (int i = first; i <= last && window.rays < Window::kMost; ++i) {
    ++window.rays;
    const auto ray = static_cast<std::size_t>(wrapped_ray(i));
    if (!dents.seen[ray]) continue;
    const auto k = static_cast<std::size_t>(window.seen++);
    window.angle_deg[k] = i * kRayStepDeg;
    window.depth_px[k] = sign * dents.depth_px[ray];
  }
  return window;
}

double triangle(double angle_deg, double tip_deg, double half_width_deg) {
  return std::max(0.0, 1.0 - std::abs(angle_deg - tip_deg) / half_width_deg);
}

// Tip, half width and height by Gauss-Newton with Huber weights; with `known`, the tip alone.
bool fit_triangle(const Window& window, const MarkShape* known, double radius_px, double& tip_deg,
                  MarkShape& shape) {
  double height_px = shape.height * radius_px;
  for (int pass = 0; pass < 12; ++pass) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (int k = 0; k < window.seen; ++k) {
      const double angle = window.angle_deg[static_cast<std::size_t>(k)];
      const double t = triangle(angle, tip_deg, shape.half_width_deg);
      const double e = window.depth_px[static_cast<std::size_t>(k)] - height_px * t;
      const double weight = std::min(1.0, 1.5 / std::max(1e-9, std::abs(e)));
      Eigen::Vector3d row(0, 0, t);
      if (t > 0) {
        row.x() = height_px * (angle > tip_deg ? 1 : -1) / shape.half_width_deg;
        row.y() = height_px * std::abs(angle - tip_deg) / (shape.half_width_deg * shape.half_width_deg);
      }
      if (known) row.tail<2>().setZero();
      normal += weight * row * row.transpose();
      right += weight * e * row;
    }
    normal.diagonal() *= 1.01;
    normal.diagonal().array() += 1e-9;
    const Eigen::Vector3d step = normal.ldlt().solve(right);
    if (!step.allFinite()) return false;
    tip_deg += std::clamp(step.x(), -0.7, 0.7);
    shape.half_width_deg = std::clamp(shape.half_width_deg + std::clamp(step.y(), -0.7, 0.7), 0.5, 9.0);
    height_px = std::max(0.5, height_px + step.z());
    if (step.head<2>().norm() < 1e-3) break;
  }
  shape.height = height_px / radius_px;
  return true;
}

// Correlation of the window with the triangle, and what the fit's residual means for the tip.
void judge_fit(const Window& window, double tip_deg, const MarkShape& shape, double radius_px,
               MarkCandidate& candidate) {
  double dd = 0, tt = 0, dt = 0, ee = 0, slope = 0;
  for (int k = 0; k < window.seen; ++k) {
    const double d = window.depth_px[static_cast<std::size_t>(k)];
    const double t = triangle(window.angle_deg[static_cast<std::size_t>(k)], tip_deg, shape.half_width_deg);
    const double height_px = shape.height * radius_px;
    dd += d * d;
    tt += t * t;
    dt += d * t;
    ee += (d - height_px * t) * (d - height_px * t);
    if (t > 0) slope += height_px * height_px / (shape.half_width_deg * shape.half_width_deg);
  }
  candidate.score = dd > 0 && tt > 0 ? dt / std::sqrt(dd * tt) : 0;
  candidate.seen_share = window.rays > 0 ? static_cast<double>(window.seen) / window.rays : 0;
  const double noise_px = std::sqrt(ee / std::max(1, window.seen - 3));
  candidate.sigma_deg = slope > 0 ? std::max(0.03, noise_px / std::sqrt(slope)) : 360;
}

}  // namespace

double wrapped_deg(double angle_deg) {
  const double a = std::fmod(angle_deg, 360.0);
  return a < 0 ? a + 360.0 : a;
}

double difference_deg(double a, double b) {
  const double d = wrapped_deg(a - b);
  return d > 180.0 ? d - 360.0 : d;
}

// A point of the rim at ray angle a moves, about the shifted centre, by the shift across the ray over the
// radius.
double DentProfile::angle_correction_deg(double angle_deg) const {
  const double a = geometry::rad_from_deg(angle_deg);
  return geometry::deg_from_rad((shift_px.x() * std::sin(a) - shift_px.y() * std::cos(a)) / radius_px);
}

void dents_of(const RimProfile& profile, const camera::Boundary& circle, DentProfile& dents) {
  dents.radius_px = circle.radius_px;
  const Eigen::Vector2d shift = circle.center_px - profile.about.center_px;
  for (int i = 0; i < kRayCount; ++i) {
    const auto ray = static_cast<std::size_t>(i);
    dents.seen[ray] = profile.state[ray] == RayState::Edge;
    if (!dents.seen[ray]) continue;
    const double angle = geometry::rad_from_deg(i * kRayStepDeg);
    const double along = shift.x() * std::cos(angle) + shift.y() * std::sin(angle);
    dents.light[ray] = profile.inside_light[ray];
    dents.depth_px[ray] = static_cast<float>(circle.radius_px - (profile.radius_px[ray] - along));
  }
  dents.shift_px = shift;
}

namespace {

// A mark is cut out of the mask, so the scene inside it is as light as beside it, give or take its texture
// (print on paper is a thirtieth). A dark instrument or a dark place of the scene dents the rim too, but is
// itself what is dark there; and where one side can't be seen, a dent may be the end of the darkness.
bool is_lit_like_its_flanks(const DentProfile& dents, int begin, int end) {
  constexpr int kFlank = 8;
  const auto median_light = [&](int from, int to) {
    std::array<float, kRayCount> light;
    int count = 0;
    for (int i = from; i <= to; ++i) {
      const auto ray = static_cast<std::size_t>(wrapped_ray(i));
      if (dents.seen[ray]) light[static_cast<std::size_t>(count++)] = dents.light[ray];
    }
    if (count < 0.6 * (to - from + 1)) return -1.0F;
    return geometry::median_in_place(std::span(light).first(static_cast<std::size_t>(count)));
  };
  const float inside = median_light(begin, end);
  const float before = median_light(begin - kFlank, begin - 2), after = median_light(end + 2, end + kFlank);
  return before > 0 && after > 0 && inside > 0.02F * std::max(before, after);
}

// One dent may come in parts; the better description of it stays.
void add(MarkCandidates& found, const MarkCandidate& candidate) {
  for (int k = 0; k < found.count; ++k) {
    MarkCandidate& known = found.items[static_cast<std::size_t>(k)];
    if (known.polarity != candidate.polarity ||
        std::abs(difference_deg(known.angle_deg, candidate.angle_deg)) > 3)
      continue;
    if (candidate.score > known.score) known = candidate;
    return;
  }
  if (found.count < MarkCandidates::kMost) found.items[static_cast<std::size_t>(found.count++)] = candidate;
}

}  // namespace

MarkCandidates find_marks(const DentProfile& dents, MarkPolarity polarity, const MarkShape* known) {
  MarkCandidates found;
  const double threshold_px = std::max(2.0, 0.008 * dents.radius_px);
  for (const MarkPolarity side : {MarkPolarity::BrightOutward, MarkPolarity::DarkInward}) {
    if (polarity != MarkPolarity::Unknown && polarity != side) continue;
    const double sign = severity_of(side);
    const auto is_dent = [&](int i) {
      const auto ray = static_cast<std::size_t>(wrapped_ray(i));
      return dents.seen[ray] && sign * dents.depth_px[ray] > threshold_px;
    };
    // Begin where there is no dent, so that none is cut at ray 0.
    int origin = 0;
    while (origin < kRayCount && is_dent(origin)) ++origin;
    if (origin == kRayCount) continue;
    for (int i = origin; i < origin + kRayCount; ++i) {
      if (!is_dent(i)) continue;
      int end = i, gap = 0;
      double area = 0, moment = 0, peak = 0;
      for (int k = i; k < origin + kRayCount && gap <= 2; ++k) {
        if (!is_dent(k)) {
          ++gap;
          continue;
        }
        gap = 0;
        end = k;
        const double depth = sign * dents.depth_px[static_cast<std::size_t>(wrapped_ray(k))];
        area += depth;
        moment += depth * k;
        peak = std::max(peak, depth);
      }
      const double width_deg = (end - i + 1) * kRayStepDeg;
      const int begin = i;
      i = end;
      if (width_deg < 0.9 || width_deg > 14 || peak < 0.015 * dents.radius_px) continue;
      if (!is_lit_like_its_flanks(dents, begin, end)) continue;

      MarkCandidate candidate;
      candidate.polarity = side;
      double tip_deg = moment / area * kRayStepDeg;
      candidate.shape =
          known ? *known : MarkShape{std::max(0.8, area * kRayStepDeg / peak), peak / dents.radius_px};
      const double half_deg = std::max(0.5 * (end - begin + 1) * kRayStepDeg, candidate.shape.half_width_deg);
      const Window window = window_of(dents, sign, tip_deg, half_deg + kFlankDeg);
      if (window.seen < 0.6 * window.rays) continue;
      if (!fit_triangle(window, known, dents.radius_px, tip_deg, candidate.shape)) continue;
      judge_fit(window, tip_deg, candidate.shape, dents.radius_px, candidate);
      candidate.angle_deg = wrapped_deg(tip_deg + dents.angle_correction_deg(tip_deg));
      if (candidate.shape.height < 0.012 || candidate.shape.height > 0.12 ||
          candidate.shape.half_width_deg < 0.9)
        continue;
      add(found, candidate);
    }
  }
  std::sort(found.items.begin(), found.items.begin() + found.count,
            [](const MarkCandidate& a, const MarkCandidate& b) { return a.score > b.score; });
  return found;
}

MarkCandidate follow_mark(const DentProfile& dents, MarkPolarity polarity, const MarkShape& known,
                          double expected_deg, double search_deg) {
  const double sign = severity_of(polarity);
  const double center = expected_deg - dents.angle_correction_deg(expected_deg);
  const double height_px = known.height * dents.radius_px;
  // Least robust cost over the tip's place; a dark or covered ray costs as much as a bad one, no more.
  const double reach = known.half_width_deg + kFlankDeg;
  double best_cost = 1e300, best_tip = center;
  for (double tip = center - search_deg; tip <= center + search_deg; tip += 0.25) {
    const Window window = window_of(dents, sign, tip, reach);
    double cost = 0.3 * (window.rays - window.seen);
    for (int k = 0; k < window.seen; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const double e =
          (window.depth_px[at] - height_px * triangle(window.angle_deg[at], tip, known.half_width_deg)) / 2.0;
      cost += std::min(1.0, e * e);
    }
    if (cost < best_cost) {
      best_cost = cost;
      best_tip = tip;
    }
  }
  MarkCandidate candidate;
  candidate.polarity = polarity;
  candidate.shape = known;
  Window window = window_of(dents, sign, best_tip, reach);
  // What disagrees grossly with mark and rim alike (an instrument over one flank) says nothing about the tip.
  int kept = 0;
  for (int k = 0; k < window.seen; ++k) {
    const auto at = static_cast<std::size_t>(k), to = static_cast<std::size_t>(kept);
    const double e =
        window.depth_px[at] - height_px * triangle(window.angle_deg[at], best_tip, known.half_width_deg);
    if (std::abs(e) > 0.35 * height_px + 1.0) continue;
    window.angle_deg[to] = window.angle_deg[at];
    window.depth_px[to] = window.depth_px[at];
    ++kept;
  }
  window.seen = kept;
  int on_mark = 0;
  for (int k = 0; k < kept; ++k)
    on_mark += std::abs(window.angle_deg[static_cast<std::size_t>(k)] - best_tip) < known.half_width_deg;
  const int mark_rays = static_cast<int>(2 * known.half_width_deg / kRayStepDeg);
  if (kept < window.rays / 2 || on_mark < mark_rays / 2) return candidate;
  double tip = best_tip;
  if (!fit_triangle(window, &known, dents.radius_px, tip, candidate.shape)) return candidate;
  judge_fit(window, tip, candidate.shape, dents.radius_px, candidate);
  candidate.angle_deg = wrapped_deg(tip + dents.angle_correction_deg(tip));
  return candidate;
}

MarkState judge_place(const DentProfile& dents, double angle_deg, double half_width_deg) {
  const Window window = window_of(dents, 1.0, angle_deg, half_width_deg + kFlankDeg);
  if (window.seen < window.rays / 2) return MarkState::Dark;
  int off_rim = 0;
  for (int k = 0; k < window.seen; ++k)
    off_rim += std::abs(window.depth_px[static_cast<std::size_t>(k)]) > 2.5;
  return off_rim > window.seen / 3 ? MarkState::Covered : MarkState::NotSeen;
}

}  // namespace arthronaut::lens
