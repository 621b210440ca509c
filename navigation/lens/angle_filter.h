// Smooths the mark's angle and predicts it: constant angular speed, kicked by the hand's acceleration.
#pragma once

namespace arthronaut::lens {

class AngleFilter {
 public:
  void predict(double elapsed_s);
  // Starts the filter when it is not running.
  void update(double measured_deg, double sigma_deg);

  [[nodiscard]] bool is_running() const { return running_; }
  [[nodiscard]] double angle_deg() const { return angle_deg_; }  // [0, 360)
  [[nodiscard]] double sigma_deg() const;                        // at most 360

 private:
  bool running_ = false;
  double angle_deg_ = 0, speed_deg_s_ = 0;
  double var_angle_ = 0, cov_ = 0, var_speed_ = 0;  // deg^2, deg^2/s, deg^2/s^2
};

}  // namespace arthronaut::lens
