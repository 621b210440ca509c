// The image of a sharp step of light: smeared by a box (the pixel, or the motion during the exposure) and a
// Gaussian (the optics). Tables once, so that a profile is modelled at a few look-ups a sample.
#pragma once

#include <cmath>
#include <vector>

namespace arthronaut::markers {

class BlurredStep {
 public:
  // Lengths in pixels; box_px > 0, sigma_px > 0.
  BlurredStep(double box_px, double sigma_px)
      : box_(static_cast<float>(box_px)), scale_(static_cast<float>(1 / sigma_px)) {}

  struct Value {
    float level;  // 0 to 1
    float slope;  // d level / d distance
  };
  struct Trend {
    float d_sigma;  // d level / d sigma
    float d_box;    // d level / d box
  };
  // At this distance from the step, bright on the positive side.
  [[nodiscard]] Value at(float distance) const {
    const Entry upper = look_up((distance + 0.5F * box_) * scale_);
    const Entry lower = look_up((distance - 0.5F * box_) * scale_);
    Value value;
    value.level = (upper.integral - lower.integral) / (scale_ * box_);
    value.slope = (upper.cumulative - lower.cumulative) / box_;
    return value;
  }
  [[nodiscard]] Trend trend_at(float distance) const {
    const Entry upper = look_up((distance + 0.5F * box_) * scale_);
    const Entry lower = look_up((distance - 0.5F * box_) * scale_);
    const float level = (upper.integral - lower.integral) / (scale_ * box_);
    return {(upper.density - lower.density) / box_,
            (0.5F * (upper.cumulative + lower.cumulative) - level) / box_};
  }

 private:
  // Of the normal distribution: density, cumulative, and the integral of the cumulative.
  struct Entry {
    float density, cumulative, integral;
  };
  static constexpr float kReach = 5;
  static constexpr int kSteps = 64;  // to a sigma

  static const std::vector<Entry>& table() {
    static const std::vector<Entry> entries = [] {
      std::vector<Entry> list;
      for (int i = 0; i <= static_cast<int>(2 * kReach * kSteps) + 1; ++i) {
        const double x = -kReach + static_cast<double>(i) / kSteps;
        const double density = std::exp(-0.5 * x * x) / std::sqrt(2 * 3.14159265358979323846);
        const double cumulative = 0.5 * std::erfc(-x / std::sqrt(2.0));
        list.push_back({static_cast<float>(density), static_cast<float>(cumulative),
                        static_cast<float>(x * cumulative + density)});
      }
      return list;
    }();
    return entries;
  }
  [[nodiscard]] Entry look_up(float x) const {
    if (x <= -kReach) return {0, 0, 0};
    if (x >= kReach) return {0, 1, x};
    const float place = (x + kReach) * kSteps;
    const int below = static_cast<int>(place);
    const float share = place - static_cast<float>(below);
    const Entry& a = entries_[below];
    const Entry& b = entries_[below + 1];
    return {a.density + share * (b.density - a.density), a.cumulative + share * (b.cumulative - a.cumulative),
            a.integral + share * (b.integral - a.integral)};
  }

  const Entry* entries_ = table().data();
  float box_, scale_;
};

}  // namespace arthronaut::markers
