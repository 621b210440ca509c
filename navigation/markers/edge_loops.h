// What edge_kernel.h declares, to be compiled once for each kind of processor: of no use to anyone else. Only
// what lanes.h says may stand here.
#pragma once

#include "navigation/markers/edge_kernel.h"
#include "navigation/markers/lanes.h"

namespace arthronaut::markers {
namespace {

constexpr int kLanes = 8;
constexpr int kBlocks = (2 * EdgeProfile::kMostWindow + kLanes) / kLanes;  // of a window
constexpr float kMinContrast = 3;  // in light of 255: what noise and compression leave
constexpr int kMatchPasses = 3;
constexpr float kMostShift = 1.5F, kMostWay = 2.5F, kSettledShift = 0.01F;

// Of the window: what the cells across the edge look like, dark 0 and bright 1, its slope, and how it changes
// with sigma and with the box.
struct WindowModel {
  Floats level[kBlocks], slope[kBlocks], by_sigma[kBlocks], by_box[kBlocks];
};

struct Step {
  float box, scale, by_box, by_both;
};

inline float absolute(float value) { return value < 0 ? -value : value; }
inline float root(float value) { return value > 0 ? __builtin_sqrtf(value) : 0; }

inline float sum_of(const Floats& lanes) {
  return ((lanes[0] + lanes[4]) + (lanes[1] + lanes[5])) + ((lanes[2] + lanes[6]) + (lanes[3] + lanes[7]));
}

// A sharp step of light at these distances from it, bright on the positive side, smeared by a box and a
// Gaussian: the difference of two integrals of the normal distribution.
struct SmearedStep {
  Floats level, slope, by_sigma, by_box;
};

inline void smear_step(const Floats& distance, const Step& step, SmearedStep& smeared) {
  const Floats upper = (distance + 0.5F * step.box) * step.scale;
  const Floats lower = (distance - 0.5F * step.box) * step.scale;
  Floats upper_density, upper_cumulative, lower_density, lower_cumulative;
  normal_along(upper, upper_density, upper_cumulative);
  normal_along(lower, lower_density, lower_cumulative);
  smeared.level =
      (upper * upper_cumulative + upper_density - lower * lower_cumulative - lower_density) * step.by_both;
  smeared.slope = (upper_cumulative - lower_cumulative) * step.by_box;
  smeared.by_sigma = (upper_density - lower_density) * step.by_box;
  smeared.by_box = (0.5F * (upper_cumulative + lower_cumulative) - smeared.level) * step.by_box;
}

inline void places_from(float first, Floats& places) { places = Floats{0, 1, 2, 3, 4, 5, 6, 7} + first; }

inline void model_window(const EdgeProfile& profile, const Step& step, int blocks, float offset,
                         WindowModel& model) {
  for (int block = 0; block < blocks; ++block) {
    model.level[block] = Floats{} + profile.cells[0];
    model.slope[block] = model.by_sigma[block] = model.by_box[block] = Floats{};
  }
  for (int edge = 0; edge < 3; ++edge) {
    const float rise = profile.cells[edge + 1] - profile.cells[edge];
    if (rise == 0) continue;
    const float first =
        static_cast<float>(-profile.reach) - offset - static_cast<float>(edge - 1) * profile.cell_px;
    for (int block = 0; block < blocks; ++block) {
      Floats distance;
      SmearedStep smeared;
      places_from(first + static_cast<float>(kLanes * block), distance);
      smear_step(distance, step, smeared);
      model.level[block] += rise * smeared.level;
      model.slope[block] += rise * smeared.slope;
      model.by_sigma[block] += rise * smeared.by_sigma;
      model.by_box[block] += rise * smeared.by_box;
    }
  }
}

// What a correlation is made of, over the samples that are known.
struct Sums {
  float n = 0, light = 0, model = 0, light_square = 0, model_square = 0, product = 0;
  [[nodiscard]] float likeness() const {
    if (n < 4) return -1;
    const float spread = (light_square - light * light / n) * (model_square - model * model / n);
    return spread > 1e-6F ? (product - light * model / n) / root(spread) : -1;
  }
};

// Of the model with the window shifted to either side: of two alike, the nearer.
inline int best_shift(const EdgeProfile& profile, const WindowModel& model) {
  float levels[kBlocks * kLanes];
  const int window = 2 * profile.reach + 1;
  for (int block = 0; block * kLanes < window; ++block) store(model.level[block], levels + kLanes * block);
  float best = -2;
  int at = 0;
  for (int first = 0; first <= 2 * profile.search; first += kLanes) {
    Floats n{}, light{}, levels_sum{}, light_square{}, level_square{}, product{};
    for (int i = 0; i < window; ++i) {
      Floats seen;
      load(profile.light + first + i, seen);
      const Ints is_known = seen >= 0.0F;
      const Floats value = is_known ? seen : Floats{};
      const Floats level = is_known ? Floats{} + levels[i] : Floats{};
      n += is_known ? Floats{} + 1.0F : Floats{};
      light += value;
      levels_sum += level;
      light_square += value * value;
      level_square += level * level;
      product += value * level;
    }
    for (int k = 0; k < kLanes && first + k <= 2 * profile.search; ++k) {
      const Sums sums{n[k], light[k], levels_sum[k], light_square[k], level_square[k], product[k]};
      const float likeness = sums.likeness();
      const int shift = first + k - profile.search;
      const bool is_nearer = (shift < 0 ? -shift : shift) <= (at < 0 ? -at : at);
      if (likeness > best + 0.02F || (likeness > best && is_nearer)) {
        best = likeness;
        at = shift;
      }
    }
  }
  return at;
}

// The light of the window at a shift; what is saturated or beyond it is 0 and not known (0, else 1).
struct Window {
  Floats light[kBlocks], known[kBlocks];
  float count = 0;
};

inline void cut_window(const EdgeProfile& profile, int shift, int blocks, Window& window) {
  const auto last = static_cast<float>(2 * profile.reach);
  Floats count{};
  for (int block = 0; block < blocks; ++block) {
    Floats light, place;
    load(profile.light + profile.search + shift + kLanes * block, light);
    places_from(static_cast<float>(kLanes * block), place);
    const Ints is_known = (light >= 0.0F) & (place <= last);
    window.light[block] = is_known ? light : Floats{};
    window.known[block] = is_known ? Floats{} + 1.0F : Floats{};
    count += window.known[block];
  }
  window.count = sum_of(count);
}

// Least squares of light = gain * level + bias - gain * slope * shift. False: not to be solved.
struct Solution {
  float gain = 0, bias = 0, shift = 0;
  float shift_weight = 0;  // of the shift, in units of gain * shift
};

inline bool solve(const Window& window, const WindowModel& model, int blocks, Solution& solution) {
  Floats level{}, slope{}, level_square{}, mixed{}, slope_square{}, light{}, by_level{}, by_slope{};
  for (int block = 0; block < blocks; ++block) {
    const Floats m = window.known[block] * model.level[block],
                 s = -(window.known[block] * model.slope[block]);
    level += m;
    slope += s;
    level_square += m * m;
    mixed += m * s;
    slope_square += s * s;
    light += window.light[block];
    by_level += m * window.light[block];
    by_slope += s * window.light[block];
  }
  // Symmetric: level, one, slope.
  const double a = sum_of(level_square), b = sum_of(level), c = sum_of(mixed), d = window.count,
               e = sum_of(slope), f = sum_of(slope_square);
  const double right[3] = {sum_of(by_level), sum_of(light), sum_of(by_slope)};
  const double minor_a = d * f - e * e, minor_b = c * e - b * f, minor_c = b * e - c * d;
  const double determinant = a * minor_a + b * minor_b + c * minor_c;
  if (!(determinant > 1e-30)) return false;
  const double minor_d = a * f - c * c, minor_e = b * c - a * e, minor_f = a * d - b * b;
  const double gain = (minor_a * right[0] + minor_b * right[1] + minor_c * right[2]) / determinant;
  solution.gain = static_cast<float>(gain);
  solution.bias =
      static_cast<float>((minor_b * right[0] + minor_d * right[1] + minor_e * right[2]) / determinant);
  const double shifted = (minor_c * right[0] + minor_e * right[1] + minor_f * right[2]) / determinant;
  solution.shift = gain > kMinContrast ? static_cast<float>(shifted / gain) : 0;
  const double inverse = minor_f / determinant;
  solution.shift_weight = static_cast<float>(1 / (inverse > 1e-9 ? inverse : 1e-9));
  return true;
}

// Gain, bias and offset by Gauss-Newton, from the model at offset 0.
inline void match_finely(const EdgeProfile& profile, const Step& step, const Window& window, int blocks,
                         WindowModel& model, EdgeMatch& match) {
  Solution solution;
  float offset = 0;
  match.outcome = EdgeMatch::Outcome::Flat;
  for (int pass = 0;; ++pass) {
    if (pass > 0) model_window(profile, step, blocks, offset, model);
    if (window.count < 5 || !solve(window, model, blocks, solution)) {
      if (match.gain > kMinContrast) match.outcome = EdgeMatch::Outcome::Different;
      return;
    }
    match.gain = solution.gain;
    if (!(match.gain > kMinContrast)) {
      if (match.gain < -kMinContrast) match.outcome = EdgeMatch::Outcome::Different;
      return;
    }
    const float shift = solution.shift < -kMostShift  ? -kMostShift
                        : solution.shift > kMostShift ? kMostShift
                                                      : solution.shift;
    offset += shift;
    if (absolute(offset) > kMostWay) {
      match.outcome = EdgeMatch::Outcome::Different;
      return;
    }
    if (absolute(shift) < kSettledShift || pass + 1 == kMatchPasses) break;
  }
  match.outcome = EdgeMatch::Outcome::Matched;
  match.offset += offset;
  Floats light{}, level{}, light_square{}, level_square{}, product{}, residuals{};
  for (int block = 0; block < blocks; ++block) {
    const Floats m = window.known[block] * model.level[block], value = window.light[block];
    const Floats residual = value - solution.gain * m - solution.bias * window.known[block];
    residuals += residual * residual;
    light += value;
    level += m;
    light_square += value * value;
    level_square += m * m;
    product += value * m;
  }
  const float left = window.count - 3;
  const float variance = sum_of(residuals) / (left > 0 ? left : 1);
  match.sigma = root(variance / solution.shift_weight) / match.gain;
  match.likeness = Sums{window.count,         sum_of(light),        sum_of(level),
                        sum_of(light_square), sum_of(level_square), sum_of(product)}
                       .likeness();

  // What the residuals say of the smear.
  Floats sigma_gain{}, sigma_weight{}, box_gain{}, box_weight{};
  const float by_gain = 1 / solution.gain;
  for (int block = 0; block < blocks; ++block) {
    const Floats residual =
        window.known[block] * ((window.light[block] - solution.bias) * by_gain - model.level[block]);
    const Floats s = window.known[block] * model.by_sigma[block],
                 b = window.known[block] * model.by_box[block];
    sigma_gain += residual * s;
    sigma_weight += s * s;
    box_gain += residual * b;
    box_weight += b * b;
  }
  match.sigma_gain = sum_of(sigma_gain);
  match.sigma_weight = sum_of(sigma_weight);
  match.box_gain = sum_of(box_gain);
  match.box_weight = sum_of(box_weight);
}

inline void match_profile(const EdgeProfile& profile, EdgeMatch& match) {
  Step step;
  step.box = profile.box_px;
  step.scale = 1 / profile.sigma_px;
  step.by_box = 1 / step.box;
  step.by_both = step.by_box * profile.sigma_px;
  const int blocks = (2 * profile.reach + kLanes) / kLanes;
  WindowModel model;
  model_window(profile, step, blocks, 0, model);
  int shift = 0;
  if (profile.search > 0) {
    shift = best_shift(profile, model);
    if (shift == profile.search || shift == -profile.search) {
      match.outcome = EdgeMatch::Outcome::AtTheEnd;
      return;
    }
  }
  Window window;
  cut_window(profile, shift, blocks, window);
  match.offset = static_cast<float>(shift);
  match_finely(profile, step, window, blocks, model, match);
}

}  // namespace
}  // namespace arthronaut::markers
