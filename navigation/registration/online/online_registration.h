// Registration while the surgeon scratches.
//
// OnlineRegistration is the thread-free core: points go in as they are drawn, update() does a bounded piece
// of work and returns all that is known. RegistrationWorker runs one on its own thread: the frame thread
// hands points over and reads the newest result, and never waits for a computation.
//
// States:
//   Collecting  no pose stands out yet
//   Candidate   one pose is ahead, but something is missing (the coach says what)
//   Confirmed   reliable, and the last solutions agree with one another at the target
//   Verified    confirmed, and touches that were not used in the fit lie on the bone
// A touch that lies off the bone twice (OnlineOptions::max_touch_error_mm), or a control point that has
// wandered, takes Confirmed and Verified back to Candidate: the world marker may have moved.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "navigation/registration/registration.h"

namespace arthronaut::registration {

enum class OnlineState { Collecting, Candidate, Confirmed, Verified };
[[nodiscard]] std::string_view to_text(OnlineState state);

struct OnlineOptions {
  std::uint64_t seed = 1;
  bool use_marker_prior = true;
  std::optional<Eigen::Vector3d> target_in_bone_mm;  // the tunnel's entry; else the centroid of the points
  std::optional<Eigen::Vector3d> direction_in_bone;  // the tunnel's, for the predicted error of its angle
  // Its thickness is solved with each update, or it is left out; registration.assumptions says which.
  std::optional<CartilageRegion> covered = std::nullopt;
  double refine_every_mm = 10;        // of new stroke
  double max_touch_error_mm = 1.5;    // a touch further off the bone is a violation
  double max_control_shift_mm = 1.0;  // of a control point touched again, in the world-marker frame
};

// One part of the bone near the touched area, for colouring it.
struct BonePatch {
  Eigen::Vector3d point_in_bone_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  bool is_touched = false;
  double gain = 0;  // in [0, 1]: by how much a stroke here would reduce the predicted error, as a share of it
};

struct Coach {
  std::string message = "Draw strokes on the bone with the probe.";  // one sentence: what to do next
  double progress = 0;                                               // in [0, 1]; 1 when confirmed
  std::vector<std::string> missing;  // what keeps it from being confirmed, in words, nearest first
  std::optional<Eigen::Vector3d> next_patch_in_bone_mm;  // where the next stroke helps most
  std::vector<BonePatch> patches;                        // empty while collecting
};

struct StrokeInfo {
  int curve = 0;
  int point_count = 0;
  double length_mm = 0;
  bool is_excluded = false;
  double median_residual_mm = 0;  // of |signed distance|; 0 while there is no pose
};

struct Touch {
  Eigen::Vector3d point_in_marker_mm = Eigen::Vector3d::Zero();
  // Signed distance to what is to be touched there (see RegistrationSummary::point_residuals_mm), by the
  // registration in force; kept up to date.
  double residual_mm = 0;
  bool tells = true;  // false: on a covered region of unknown thickness; it neither verifies nor alarms
};

// Everything that is known at one moment. Immutable once published.
struct OnlineResult {
  std::uint64_t revision = 0;  // grows with every change
  OnlineState state = OnlineState::Collecting;
  RegistrationSummary registration;  // has_pose is false while collecting
  double predicted_angle_deg = 0;    // one sigma, of a direction of the bone: the tunnel's, or the worst one
  Coach coach;
  double length_mm = 0;  // of the strokes in use
  std::vector<StrokeInfo> strokes;
  std::vector<Touch> touches;
  std::string alarm;  // empty, or why the state was taken back: "the world marker may have moved: ..."
  // The strokes miss this bone's surface by more than their noise explains, or fit its mirror image as well:
  // what was confirmed with fewer of them is not to be trusted any more.
  bool bone_is_in_doubt = false;
  std::string failure;  // of a worker: why it has ended and works in nothing any more; empty else
};

// What a registration said when it was replaced or taken back.
struct HistoryEntry {
  std::uint64_t revision = 0;
  OnlineState state = OnlineState::Collecting;
  double length_mm = 0, rms_mm = 0, predicted_tre_mm = 0;
  geometry::RigidTransform marker_from_bone;
};

// Deterministic: the results depend on the order of calls alone, never on time. Not thread-safe.
class OnlineRegistration {
 public:
  OnlineRegistration(std::shared_ptr<const SurfaceIndex> bone, const OnlineOptions& options);
  ~OnlineRegistration();

  // In drawing order; a new curve number starts a new stroke, which is in use or excluded. Cheap.
  void add_points(std::span<const strokes::CurvePoint> points, bool is_excluded = false);
  // The next update solves with all that was drawn, however little of it is new, and asks again which side's
  // bone it is: when nothing more may come.
  void judge_all();
  // Takes a stroke out of the fit, or back in; false when there is no such stroke.
  bool exclude_stroke(int curve, bool is_excluded = true);
  // Forgets the stroke drawn last; false when there is none.
  bool undo_stroke();
  // A touch that is not used in the fit, to verify. Judged at once, by the registration in force.
  void add_touch(const Eigen::Vector3d& tip_in_marker_mm);
  // The control point: the first call keeps it, later ones compare.
  void touch_control_point(const Eigen::Vector3d& tip_in_marker_mm);
  // Forgets touches and control point, and with them an alarm; strokes and pose stay.
  void clear_touches();
  // Forgets everything but the history.
  void clear();

  // Solves again when enough was drawn or anything changed; otherwise returns what is known. About 6 ms once
  // a candidate is there, more while collecting, and some 200 ms when the side is checked: before the first
  // confirmation, again when half as much again was drawn, and with each update while the side is in doubt.
  // With a covered region about twice as long, and 30 to 60 ms when all thicknesses are tried: while
  // collecting, and when a quarter more was drawn.
  const OnlineResult& update();

  [[nodiscard]] const OnlineResult& result() const;
  [[nodiscard]] const std::vector<HistoryEntry>& history() const;
  [[nodiscard]] strokes::Curves curves_in_use() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// The same on a thread of its own, which also makes the core. Every member may be called from any thread and
// returns at once.
class RegistrationWorker {
 public:
  RegistrationWorker(std::shared_ptr<const SurfaceIndex> bone, const OnlineOptions& options);
  ~RegistrationWorker();  // stops after the piece of work in hand

  void add_points(std::span<const strokes::CurvePoint> points);
  // What was drawn before there was a worker. Worked in point by point, as if it were drawn now, and then all
  // of it is judged (judge_all()): only that is published.
  void take_up(std::span<const strokes::CurvePoint> points, const std::set<int>& excluded_curves);
  void exclude_stroke(int curve, bool is_excluded = true);
  void undo_stroke();
  void add_touch(const Eigen::Vector3d& tip_in_marker_mm);
  void touch_control_point(const Eigen::Vector3d& tip_in_marker_mm);
  void clear_touches();
  void clear();

  // The newest result, whole; never null.
  [[nodiscard]] std::shared_ptr<const OnlineResult> latest() const;
  // Waits until all that was handed over so far has been worked in; for tests and for the end of a session.
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace arthronaut::registration
