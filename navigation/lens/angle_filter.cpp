#include "navigation/lens/angle_filter.h"

#include <algorithm>
#include <cmath>

#include "navigation/lens/mark.h"

namespace arthronaut::lens {
namespace {
constexpr double kAcceleration = 1700;    // deg/s^2, of a hand that turns the lens
constexpr double kStartSpeedSigma = 200;  // deg/s
constexpr double kSpeedMemory_s = 0.25;   // a hand that is not seen is taken to stop
}  // namespace

double AngleFilter::sigma_deg() const { return running_ ? std::min(360.0, std::sqrt(var_angle_)) : 360.0; }

void AngleFilter::predict(double elapsed_s) {
  if (!running_ || elapsed_s <= 0) return;
  const double dt = std::min(elapsed_s, 2.0), q = kAcceleration * kAcceleration;
  angle_deg_ = wrapped_deg(angle_deg_ + speed_deg_s_ * std::min(dt, kSpeedMemory_s));
  speed_deg_s_ *= std::exp(-std::max(0.0, dt - 0.02) / kSpeedMemory_s);
  var_angle_ += dt * (2 * cov_ + dt * var_speed_) + q * dt * dt * dt * dt / 4;
  cov_ += dt * var_speed_ + q * dt * dt * dt / 2;
  var_speed_ += q * dt * dt;
}

void AngleFilter::update(double measured_deg, double sigma_deg) {
  const double r = sigma_deg * sigma_deg;
  if (!running_) {
    running_ = true;
    angle_deg_ = wrapped_deg(measured_deg);
    speed_deg_s_ = 0;
    var_angle_ = r;
    cov_ = 0;
    var_speed_ = kStartSpeedSigma * kStartSpeedSigma;
    return;
  }
  const double s = var_angle_ + r, gain = var_angle_ / s, speed_gain = cov_ / s;
  const double innovation = difference_deg(measured_deg, angle_deg_);
  angle_deg_ = wrapped_deg(angle_deg_ + gain * innovation);
  speed_deg_s_ += speed_gain * innovation;
  var_speed_ -= speed_gain * cov_;
  cov_ -= gain * cov_;
  var_angle_ -= gain * var_angle_;
}

}  // namespace arthronaut::lens
