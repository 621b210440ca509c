// Registration while the surgeon scratches.
//
// Thread-free: points go in as they are drawn, update() does a bounded piece of work and returns all that is
// known. navigation/operation/registration_work.h runs it beside the frames.
//
// States:
//   Collecting  no pose stands out yet
//   Candidate   one pose is ahead, but something is missing (the coach says what)
//   Confirmed   reliable, and the last solutions agree with one another at the target
// Whether touches verify it is judged where they are known, of the registration that guides
// (navigation/operation/touches.h).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "navigation/registration/registration.h"

namespace arthronaut::registration {

enum class OnlineState { Collecting, Candidate, Confirmed };
[[nodiscard]] std::string_view to_text(OnlineState state);

struct OnlineOptions {
  std::uint64_t seed = 1;
  bool use_marker_prior = true;
  std::optional<Eigen::Vector3d> target_in_bone_mm;  // the tunnel's entry; else the centroid of the points
  std::optional<Eigen::Vector3d> direction_in_bone;  // the tunnel's, for the predicted error of its angle
  // Its thickness is solved with each update, or it is left out; registration.assumptions says which.
  std::optional<CartilageRegion> cartilage = std::nullopt;
  double refine_every_mm = 10;  // of new stroke
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

// Everything that is known at one moment. Immutable once published.
struct OnlineResult {
  std::uint64_t revision = 0;  // grows with every change
  OnlineState state = OnlineState::Collecting;
  RegistrationSummary registration;  // has_pose is false while collecting
  double predicted_angle_deg = 0;    // one sigma, of a direction of the bone: the tunnel's, or the worst one
  Coach coach;
  double length_mm = 0;  // of the strokes in use
  std::vector<StrokeInfo> strokes;
  // The strokes miss this bone's surface by more than their noise explains, are larger or smaller than it, or
  // fit its mirror image as well: what was confirmed with fewer of them is not to be trusted any more.
  bool bone_is_in_doubt = false;
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
  // From the next solution on, another target and direction, as in OnlineOptions; what was solved stays as it
  // is until then.
  void aim_at(const std::optional<Eigen::Vector3d>& target_in_bone_mm,
              const std::optional<Eigen::Vector3d>& direction_in_bone);
  // Takes a stroke out of the fit, or back in; false when there is no such stroke. What was solved and which
  // side's bone it is has to be found anew, as after undo_stroke().
  bool exclude_stroke(int curve, bool is_excluded = true);
  // Forgets the stroke drawn last; false when there is none.
  bool undo_stroke();
  // Forgets everything.
  void clear();

  // Solves again when enough was drawn or anything changed; otherwise returns what is known. About 5 ms once
  // a candidate is there, more while collecting, and some 100 ms when the side is checked: before the first
  // confirmation, again when half as much again was drawn, and with each update while the side is in doubt.
  // With cartilage about twice as long, and 30 to 60 ms when all thicknesses are tried: while
  // collecting, and when a quarter more was drawn.
  const OnlineResult& update();

  [[nodiscard]] const OnlineResult& result() const;
  [[nodiscard]] strokes::Curves curves_in_use() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace arthronaut::registration
