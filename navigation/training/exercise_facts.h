// What happened in an exercise, as numbers: from the states of the operation, which its record keeps, and
// from the simulator's truth beside them. Nothing of a screen is in here.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "navigation/operation/operation_state.h"
#include "navigation/simulator/hand_operation.h"
#include "navigation/training/exercise.h"

namespace arthronaut::training {

// Empty: it never came to that.
struct ExerciseFacts {
  bool is_done = false;  // the trainee said so
  double time_s = 0;
  long frames = 0;
  std::optional<double> entry_offset_mm, angle_deg;  // true
  std::optional<double> depth_error_mm;              // signed: above 0 too deep
  std::optional<double> off_bone_mm;                 // true, of the guide's point; not of a tunnel
  std::optional<double> tunnel_error_mm;             // of the registration that stood at the end
  std::optional<double> tip_error_mm;
  std::string tip_trouble;  // why the pivot found no tip
  // Of a camera that the program would adopt; why there is none. See board_run.h.
  std::optional<double> camera_error_px;
  std::string camera_trouble;
  std::vector<double> coverage;  // of each picture taken: share of the view that has corners near
  int refused_pictures = 0;
  int verifying_touches_missing = 3;
  bool verification_was_skipped = false;
  int touches = 0, wasted_touches = 0;
  double drawn_mm = 0, drawn_in_air_mm = 0;
  double unseen_s = 0;
  int alarms = 0, alarms_ignored = 0;
  double bad_data_mm = 0;         // drilled, or aimed and ended, while what guides was gone or wrong
  double worst_bad_error_mm = 0;  // by how much it was wrong then
  bool marker_was_bumped = false;
};

class Examiner {
 public:
  // tip_in_probe_mm: the true one.
  Examiner(const Exercise& exercise, const tunnels::Tunnel& plan, double plan_length_mm,
           const Eigen::Vector3d& tip_in_probe_mm);
  // Frames in order, each with the truth of the same frame.
  void add(const operation::OperationState& state, const simulator::HandTruth& truth);
  // The trainee says that it is done.
  void finish();
  // As it stands. The pivot is computed in here, from the poses that were seen.
  [[nodiscard]] ExerciseFacts facts() const;

 private:
  void follow_touches(const operation::OperationState& state);
  void follow_drawing(const operation::OperationState& state, const simulator::HandTruth& truth);
  void follow_alarm(const operation::OperationState& state, double drilled_now_mm);
  void follow_guide(const operation::OperationState& state, const simulator::HandTruth& truth);
  [[nodiscard]] std::optional<double> error_at_entry_mm(const operation::OperationState& state,
                                                        const simulator::HandTruth& truth) const;

  Exercise exercise_;
  tunnels::Tunnel plan_;
  double plan_length_mm_ = 0;
  Eigen::Vector3d tip_in_probe_mm_;
  ExerciseFacts facts_;
  // Of the frame before.
  struct Before {
    bool is_known = false;
    double time_s = 0, drilled_mm = 0;
    Eigen::Vector3d tip_mm = Eigen::Vector3d::Zero();
    std::size_t touch_count = 0, point_count = 0;
    std::int64_t touch_asked_ns = 0;
    bool alarm = false, drilled_in_alarm = false;
    std::size_t registrations = 0;  // in the history
    std::optional<std::size_t> entry_in_force;
    bool guides_rightly = true;
    double guided_s = 0;  // when it last did
    double error_mm = 0;
  } before_;
  std::vector<geometry::RigidTransform> world_from_probe_;
};

}  // namespace arthronaut::training
