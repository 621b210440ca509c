// Touches that verify a registration, and the control point that tells a bumped world marker. Judged by the
// registration that guidance uses, whatever it came from; thresholds are those of
// registration::OnlineOptions.
#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "navigation/registration/registration.h"
#include "planning/geometry/surface.h"

namespace arthronaut::navigate {

// The tip at rest: a touch is where the tip stood for a moment, not where one frame saw it.
class SteadyTip {
 public:
  // nullopt: the tip is not known in this frame.
  void add(double time_s, const std::optional<Eigen::Vector3d>& tip_in_marker_mm);
  // The median of the last quarter of a second when the tip was seen at least three times and kept within 1
  // mm; else nullopt.
  [[nodiscard]] std::optional<Eigen::Vector3d> position_mm() const;
  // Why there is none, for the screen.
  [[nodiscard]] std::string why_not() const;

 private:
  struct Sample {
    double time_s;
    Eigen::Vector3d tip_in_marker_mm;
  };
  std::deque<Sample> samples_;
};

class TouchCheck {
 public:
  struct Last {
    enum class Kind { None, Touch, ControlSet, ControlAgain } kind = Kind::None;
    int number = 0;                     // of the touch, from 1
    bool is_new_place = true;           // of a touch: away from those before
    std::optional<double> distance_mm;  // signed, to the bone; of the control point: how far it has wandered
    bool is_on_unknown_cover = false;   // of a touch: nobody knows how far off the bone it should lie
  };

  void add_touch(const Eigen::Vector3d& tip_in_marker_mm);
  void touch_control_point(const Eigen::Vector3d& tip_in_marker_mm);
  void clear();
  // Whether a touch here says more than those before it: none of them lies within 3 mm.
  [[nodiscard]] bool is_new_place(const Eigen::Vector3d& tip_in_marker_mm) const;
  // Distances anew, by another registration; none without a pose. On a covered region they are to what is
  // touched there.
  void judge(const registration::RegistrationSummary* registration, const geometry::Surface* surface,
             const std::optional<registration::CartilageRegion>& covered = std::nullopt);

  [[nodiscard]] bool has_control_point() const { return !control_touches_mm_.empty(); }
  // In the order they came, in the marker's frame; the first one of the control point is the one kept.
  [[nodiscard]] const std::vector<Eigen::Vector3d>& touches_mm() const { return touches_mm_; }
  [[nodiscard]] const std::vector<Eigen::Vector3d>& control_touches_mm() const { return control_touches_mm_; }
  // Signed, mm, in the order of the touches; empty while there is no registration to judge by, nullopt on a
  // cover of unknown thickness.
  [[nodiscard]] const std::vector<std::optional<double>>& residuals_mm() const { return residuals_mm_; }
  [[nodiscard]] Last last() const;
  // "The control point has moved by 2.1 mm", "3 touches lie off the bone": two violations; empty else.
  [[nodiscard]] std::string alarm() const;

 private:
  std::vector<Eigen::Vector3d> touches_mm_, control_touches_mm_;
  std::vector<std::optional<double>> residuals_mm_;
  bool last_is_new_place_ = true;
  double control_shift_mm_ = 0;
  int control_violations_ = 0;
  Last::Kind last_ = Last::Kind::None;
};

}  // namespace arthronaut::navigate
