// Which registration guides, and whether it may: the ledger of all that were found, given or resumed, each
// with what it is of; the rules by which one takes effect; and everything that takes it out of effect again.
//
// A registration takes effect by itself the moment it is confirmed, and again when it has become clearly
// better (its predicted error a tenth smaller), unless the surgeon went back to an earlier one: a choice
// stands until the newest is chosen again. What may not guide, whoever chose it:
//   void      it is of another mesh, bone, marker, placement, camera, probe, medium or kind of source
//   alarm     touches lie off the bone, the control point has wandered, or the picture shows the bone
//             elsewhere
//   doubt     strokes drawn since miss the surface, or fit its mirror image as well; until confirmed anew
//
// Thread-free, deterministic.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "navigation/operation/registration_work.h"
#include "navigation/operation/touches.h"

namespace arthronaut::operation {

enum class RegistrationOrigin { WhileDrawing, AllStrokes, Given, Resumed };
[[nodiscard]] std::string_view to_text(RegistrationOrigin origin);

struct RegistrationEntry {
  RegistrationOrigin origin = RegistrationOrigin::WhileDrawing;
  RegistrationPtr registration;  // as it was found
  registration::Provenance of;
  bool is_verified = false;         // by touches, of which none lies off the bone and none was forgotten
  bool marker_has_moved = false;    // since: it can't be taken again
  bool is_of_wrong_medium = false;  // nor one that was found when it was before the lens
  Moment at = {};                   // when it was found, given, or confirmed by a touch
  std::optional<registration::Provenance> confirmed_from = std::nullopt;  // what it was of before that touch
  [[nodiscard]] bool is_gone() const { return marker_has_moved || is_of_wrong_medium; }
};

enum class Standing { None, Stands, NotReliable, Void, Alarm, InDoubt };
[[nodiscard]] std::string_view to_text(Standing standing);

// What is in force and how it stands.
struct RegistrationInForce {
  Standing standing = Standing::None;
  // As guidance takes it: reliable only while it stands, its reasons say why not. Null with None.
  RegistrationPtr registration;
  std::optional<registration::Mismatch> mismatch;  // with Void
  bool can_be_confirmed = false;                   // with Void: by one touch on the bone
  bool is_verified = false;
};

class RegistrationLedger {
 public:
  RegistrationLedger(std::shared_ptr<const geometry::Surface> surface,
                     std::optional<registration::CartilageRegion> cartilage, const TouchLimits& limits);

  // What the pictures of a source that begins are of. Whatever is in force is judged by it at once; of
  // another world the touches are forgotten.
  void set_now(const registration::Provenance& now);
  // Every frame of it: what comes until the next one is of then.
  void set_time(std::int64_t now_ns) { at_.time_ns = now_ns; }
  [[nodiscard]] const registration::Provenance& now() const { return now_; }

  // Found while the probe draws; `request_count` as in RegistrationOutcome. What was found with strokes that
  // are gone since must not be handed in.
  void take_online(const std::shared_ptr<const registration::OnlineResult>& online,
                   std::uint64_t request_count);
  // Of all strokes, asked for with the request of that count; length of the strokes that it was fitted to. It
  // takes effect even when it is not reliable, unless a reliable one was given from elsewhere and too little
  // was drawn to say anything against that.
  void take_fit(const RegistrationPtr& fit, std::uint64_t request_count, double length_mm);
  // From a file, or from before a crash: guides as far as `of` allows.
  void give(RegistrationOrigin origin, const RegistrationPtr& registration,
            const registration::Provenance& of);
  // Of an operation that was cut off, before anything else is known: what its pictures were of, and its
  // touches, which say nothing of the marker as it sits now. They are gone when the pictures turn out to be
  // of another world.
  void bring_back(const registration::Provenance& of, const std::vector<Eigen::Vector3d>& touches_mm,
                  const std::optional<Eigen::Vector3d>& control_point_mm);
  // Makes another entry the one in force; nothing happens when there is none, or the marker has moved since.
  void choose(std::size_t entry);

  // A touch verifies, tells an alarm, or confirms what is void.
  void add_touch(const Eigen::Vector3d& tip_in_marker_mm);
  void touch_control_point(const Eigen::Vector3d& tip_in_marker_mm);
  // The picture shows the bone so far from where it lay (contour/contour_check.h). As a control point that
  // has wandered, it means that the marker sits elsewhere on the bone: an alarm until the marker is placed
  // anew, the surgeon says that it did not move, or the control point, set before (it can't be set now) and
  // touched again, lies nearer to where it was than half of what the picture says. One that was set when the
  // bone may have moved already (control_point_is_older is false) says nothing, as if there were none. The
  // first alarm stays; nothing without a registration that stands.
  void bone_moved_in_picture(double drift_mm, bool control_point_is_older);
  // The touches were wrong and not the marker: takes an alarm away, and what they verified.
  void forget_touches();
  // What was measured in this source after that time was measured wrongly: touches, what they verified and
  // confirmed, and what was found by strokes. What was there before is in force again. Which kinds of touches
  // there were of that.
  Touches::Gone forget_since(std::int64_t time_ns);
  // The marker was out of sight, and no control point can tell whether it sits where it sat: what touches
  // have verified until then has to be verified by others.
  void verify_anew();
  // Another plan is in force: what was found is known there as well as its covariance says, and no longer
  // reliable where that is worse than registration::kMaxError_mm. Empty: as it was found.
  void aim_at(const std::optional<Eigen::Vector3d>& target_in_bone_mm);
  // What was drawn is gone: the next registration has to earn its place anew. Touches stay.
  void forget_strokes();
  // The world marker sits elsewhere: nothing found before holds, for good.
  void marker_placed_anew();

  [[nodiscard]] const RegistrationInForce& in_force() const { return in_force_; }
  [[nodiscard]] std::uint64_t change_count() const { return change_count_; }  // of in_force().registration
  [[nodiscard]] const std::shared_ptr<const std::vector<RegistrationEntry>>& entries() const {
    return entries_;  // never null
  }
  [[nodiscard]] std::optional<std::size_t> entry_in_force() const { return entry_in_force_; }
  [[nodiscard]] bool is_chosen() const { return is_chosen_; }  // by the surgeon: newer ones wait
  [[nodiscard]] const Touches& touches() const { return touches_; }
  [[nodiscard]] TouchAlarm alarm() const;

 private:
  void add(RegistrationEntry entry);
  void change_entry(std::size_t entry, const std::function<void(RegistrationEntry&)>& change);
  void take_verification_back();  // of every entry
  void judge();
  [[nodiscard]] RegistrationInForce judged() const;

  const std::shared_ptr<const geometry::Surface> surface_;
  const std::optional<registration::CartilageRegion> cartilage_;
  registration::Provenance now_;
  Moment at_;  // of the newest frame of this source
  Touches touches_;
  std::shared_ptr<const std::vector<RegistrationEntry>> entries_ =
      std::make_shared<const std::vector<RegistrationEntry>>();
  std::optional<std::size_t> entry_in_force_;
  bool is_chosen_ = false;
  // Doubt told by strokes drawn after the newest fit of all strokes; its reasons.
  std::optional<std::vector<std::string>> doubt_;
  std::optional<Eigen::Vector3d> target_in_bone_mm_;  // of another plan than it was begun with
  std::optional<double> seen_drift_mm_;               // in the picture; empty: none
  bool control_point_is_older_ = false;               // than that drift
  std::uint64_t fitted_after_ = 0;                    // requests, at the newest fit
  // Of those that took effect by themselves, at the target of now.
  double best_tre_mm_ = std::numeric_limits<double>::infinity();
  RegistrationInForce in_force_;
  std::uint64_t change_count_ = 0;
};

}  // namespace arthronaut::operation
