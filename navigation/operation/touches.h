// Touches that verify a registration, and the control point that tells a bumped world marker. Judged by the
// registration that guidance uses, whatever it came from.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "navigation/registration/provenance.h"
#include "navigation/registration/registration.h"
#include "planning/geometry/surface.h"

namespace arthronaut::operation {

struct TouchLimits {
  double max_touch_error_mm = 1.5;    // a touch further off the bone is a violation
  double max_control_shift_mm = 1.0;  // of a control point touched again, in the world-marker frame
  int violations_to_alarm = 2;
  int touches_to_verify = 3;            // at different places, each nearer than
  double max_verified_mm = 1.0;         // ... this, and
  double max_verified_median_mm = 0.6;  // ... in the median than this
  // One touch that shows that a void registration holds all the same must lie nearer than this.
  double max_confirming_mm = 1.0;
  // Of a nominal guide's tip on the control point, where that is to guide: as far as a touch may be off.
  double max_guide_error_mm = 1.5;
  double apart_mm = 3;  // touches nearer to each other are of the same place
};

// When something was measured: in which of the sources that an operation had, and then. What is of another
// source is of another clock, and neither before nor after.
struct Moment {
  std::uint64_t source = 0;
  std::int64_t time_ns = 0;
  [[nodiscard]] bool is_after(const Moment& other) const {
    return source == other.source && time_ns > other.time_ns;
  }
};

// The tip at rest: a touch is where the tip stood for a moment, not where one frame saw it.
class SteadyTip {
 public:
  enum class Reason { None, TipUnknown, Moves };
  // nullopt: the tip is not known in this frame.
  void add(double time_s, const std::optional<Eigen::Vector3d>& tip_in_marker_mm);
  // The median of the last quarter of a second when the tip was seen at least three times in it, from the
  // first to the last at least 0.15 s, and kept within 1 mm; else nullopt.
  [[nodiscard]] std::optional<Eigen::Vector3d> position_mm() const;
  // Why there is none.
  [[nodiscard]] Reason why_not() const;
  void clear() { samples_.clear(); }

 private:
  [[nodiscard]] bool was_seen_for_long() const;
  struct Sample {
    double time_s;
    Eigen::Vector3d tip_in_marker_mm;
  };
  std::vector<Sample> samples_;  // a quarter of a second: no more than its memory, once it has it
};

// Why nothing is to be trusted.
struct TouchAlarm {
  enum class Kind { None, ControlPointMoved, TouchesOff, Both, SeenInPicture } kind = Kind::None;
  double control_shift_mm = 0;
  int touches_off = 0;
  double seen_drift_mm = 0;  // of the bone in the picture, without a touch
  // With it: the control point was set while the bone was still seen to lie where it lay, and touched again
  // says whether it has moved.
  bool control_point_decides = false;
  [[nodiscard]] explicit operator bool() const { return kind != Kind::None; }
};
[[nodiscard]] std::string in_words(const TouchAlarm& alarm);

// A touch outranks what the picture shows as far as it is finer than that: whether a control point that lies
// so far from where it was takes that alarm away.
[[nodiscard]] bool denies_drift(double control_shift_mm, double seen_drift_mm);

class Touches {
 public:
  struct Last {
    enum class Kind { None, Touch, ControlSet, ControlAgain } kind = Kind::None;
    int number = 0;                     // of the touch, from 1
    bool is_new_place = true;           // of a touch: away from those before
    std::optional<double> distance_mm;  // signed, to the bone; of the control point: how far it has wandered
    bool is_on_unknown_cartilage = false;  // of a touch: nobody knows how far off the bone it should lie
  };

  explicit Touches(const TouchLimits& limits = {}) : limits_(limits) {}

  // `of`: what the pictures were of when it was taken. A touch under another provenance is kept and says
  // nothing about a registration of this one.
  void add_touch(const Eigen::Vector3d& tip_in_marker_mm, const registration::Provenance& of,
                 const Moment& at = {});
  void touch_control_point(const Eigen::Vector3d& tip_in_marker_mm, const registration::Provenance& of,
                           const Moment& at = {});
  void clear();
  // Those after that moment were no touches; what was before them stands as it stood then. Which kinds there
  // were of them.
  struct Gone {
    bool touches = false, control_point = false;
  };
  Gone forget_since(const Moment& moment);
  // From now on others verify: the marker may sit elsewhere than where those so far were touched under it.
  // What of them lies off the bone stays a violation.
  void verify_anew() { first_to_verify_ = touches_.size(); }
  // Those of an operation that was cut off, in place of all there are.
  void bring_back(const std::vector<Eigen::Vector3d>& touches_mm,
                  const std::optional<Eigen::Vector3d>& control_point_mm, const registration::Provenance& of);
  // Distances anew, by another registration, of the touches that are of `now`; none without a pose. On
  // cartilage they are to what is touched there.
  void judge(const registration::RegistrationSummary* registration, const geometry::Surface* surface,
             const std::optional<registration::CartilageRegion>& cartilage,
             const registration::Provenance& now);

  [[nodiscard]] bool has_control_point() const { return !control_touches_.empty(); }
  // Touched last it was not where it was: that answers nothing yet, and is no alarm by itself.
  [[nodiscard]] bool control_point_lies_off() const { return control_violations_ > 0; }
  // Of those that were judged one lies so far off the bone that it is a violation.
  [[nodiscard]] bool lie_off_the_bone() const { return touches_off() > 0; }
  [[nodiscard]] std::size_t count() const { return touches_.size(); }
  // Where they were, world-marker frame; of the control point: as it was touched first.
  [[nodiscard]] std::vector<Eigen::Vector3d> places_mm() const;
  [[nodiscard]] std::optional<Eigen::Vector3d> control_point_mm() const;
  // As it was touched last with this camera, probe, medium, source and placement of the marker; empty: it was
  // not. The one before tells a bumped marker all the same.
  [[nodiscard]] std::optional<Eigen::Vector3d> control_point_mm(const registration::Provenance& now) const;
  // Signed, mm, in the order of the touches; empty while there is no registration to judge by, nullopt on
  // cartilage of unknown thickness and for touches of another provenance.
  [[nodiscard]] const std::vector<std::optional<double>>& residuals_mm() const { return residuals_mm_; }
  // None where the pictures are of something else by now.
  [[nodiscard]] Last last() const;
  [[nodiscard]] TouchAlarm alarm() const;
  // Enough of them lie on the bone, at different places.
  [[nodiscard]] bool verify() const;
  // So many different places are still to be touched before they can; 0: enough were, wherever they lie.
  [[nodiscard]] int places_to_verify() const;
  // Different places that were touched after the first so many touches, wherever they lie.
  [[nodiscard]] int places_since(std::size_t count) const;
  // The newest touch alone lies on the bone, so near that a void registration is confirmed by it.
  [[nodiscard]] bool last_confirms() const;
  [[nodiscard]] const TouchLimits& limits() const { return limits_; }

 private:
  struct Touch {
    Eigen::Vector3d tip_in_marker_mm;
    registration::Provenance of;
    bool is_new_place;
    Moment at;
  };
  // Of those that may verify, were judged and are at different places: how far off the bone they lie.
  [[nodiscard]] std::vector<double> misses_mm() const;
  [[nodiscard]] int touches_off() const;
  struct ControlTouch {
    Eigen::Vector3d tip_in_marker_mm;
    registration::Provenance of;
    Moment at;
  };
  void compare_control_point();
  TouchLimits limits_;
  std::vector<Touch> touches_;
  std::size_t first_to_verify_ = 0;
  std::vector<ControlTouch> control_touches_;
  std::vector<std::optional<double>> residuals_mm_;
  double control_shift_mm_ = 0;
  int control_violations_ = 0;
  Last::Kind last_ = Last::Kind::None;
  registration::Provenance last_of_;
  bool last_is_of_now_ = true;  // as it was judged last
};

// What ends an alarm.
enum class WayOut {
  None,             // there is no alarm
  ControlPoint,     // touched again it says whether the marker has moved
  StrokesAnew,      // the touches alone tell it: the marker may sit where it sat
  MarkerPlacedAnew  // no touch can take it away: what was found is of a place that nobody knows
};
[[nodiscard]] WayOut way_out_of(const TouchAlarm& alarm, const Touches& touches);

}  // namespace arthronaut::operation
