// What is known of where one bone lies under its world marker: the strokes drawn so far, the registration
// that runs along, the one that guidance uses, those before it, and the touches that verify it. Outlives the
// sources: a video that ends takes nothing of it away.
//
// A registration takes effect by itself the moment it is confirmed, and again when it has become clearly
// better (its predicted error a tenth smaller), unless the surgeon went back to an earlier one: a choice
// stands until the newest is chosen again. Strokes drawn since that bring the bone in doubt (they miss its
// surface, or fit its mirror image as well) take it back, whoever chose it, until it is confirmed anew. A
// bumped world marker (alarm) makes what is in force unreliable at once.
//
// Threads: every function may be called from any thread; none waits for a computation but register_all().
#pragma once

#include <cstdint>
#include <functional>
#include <future>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "app/navigate/drawn_strokes.h"
#include "app/navigate/touch_check.h"
#include "navigation/registration/online/online_registration.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::navigate {

using SurfaceIndexPtr = std::shared_ptr<const registration::SurfaceIndex>;
using RegistrationPtr = std::shared_ptr<const registration::RegistrationSummary>;

// A registration that took effect, or would have.
struct RegistrationEntry {
  std::string origin;  // "while drawing", "all points"
  registration::OnlineState state = registration::OnlineState::Candidate;
  RegistrationPtr registration;
  bool is_void = false;  // the world marker has moved since: it can't be taken again
};

struct RegistrationStatus {
  std::shared_ptr<const strokes::Curves> drawn =
      std::make_shared<strokes::Curves>();  // never null; all strokes
  std::set<int> left_out;                   // strokes that are not used
  std::shared_ptr<const registration::OnlineResult>
      online;                      // null until the bone is ready and what was drawn by then is judged
  RegistrationPtr in_force;        // null: none yet. Unreliable while there is an alarm
  std::uint64_t change_count = 0;  // of in_force
  std::shared_ptr<const std::vector<RegistrationEntry>> history =
      std::make_shared<std::vector<RegistrationEntry>>();
  std::optional<std::size_t> entry_in_force;  // of history
  bool is_chosen = false;                     // by the surgeon: newer ones wait
  std::string alarm;                          // why nothing is to be trusted; empty else
  TouchCheck touches;
  std::string bone_trouble;  // why the bone could not be made ready: nothing can be registered; empty else
};

class BoneRegistration {
 public:
  // `bone` may still be in the making; one that throws leaves its reason in the status. plan and surface may
  // be absent: then the target is the middle of what was touched, and touches are not judged.
  BoneRegistration(std::shared_future<SurfaceIndexPtr> bone, const std::optional<tunnels::Tunnel>& plan,
                   std::shared_ptr<const geometry::Surface> surface,
                   std::optional<registration::CartilageRegion> covered = std::nullopt);

  // shaft_direction: see strokes::CurvePoint.
  void add_tip(double time_s, const Eigen::Vector3d& tip_in_marker_mm,
               const std::optional<Eigen::Vector3d>& shaft_direction = std::nullopt);
  void take_back_stroke();
  void leave_out(int curve, bool is_left_out);
  // Forgets strokes and touches. While there is an alarm the registration in force goes too: the marker has
  // moved.
  void clear();
  void add_touch(const Eigen::Vector3d& tip_in_marker_mm);
  void touch_control_point(const Eigen::Vector3d& tip_in_marker_mm);
  // The touches were wrong and not the marker: takes an alarm away.
  void forget_touches();
  // Makes another entry of the history the one in force: earlier < 0, later > 0; nothing happens at either
  // end.
  void step_history(int by);

  // Fits all strokes in use, from nothing; takes up to half a second, more while the bone is being made
  // ready. Takes effect unless is_wanted, called afterwards, says no, or strokes were cleared, taken back or
  // left out meanwhile: then it would be of strokes that nobody sees any more.
  void register_all(const std::function<bool()>& is_wanted);

  [[nodiscard]] strokes::Curves strokes_in_use() const;
  // Takes in what the registration that runs along has found meanwhile, and says all. Starts it once the bone
  // is ready, with all that was drawn and touched before, which is judged at once though nothing more is
  // drawn. The same object as long as nothing has changed; never null.
  [[nodiscard]] std::shared_ptr<const RegistrationStatus> status();
  // Waits until all strokes and touches are worked in; for tests.
  void finish();

 private:
  void start_worker();
  void take_in(const std::shared_ptr<const registration::OnlineResult>& online);
  void add_entry(const RegistrationEntry& entry);
  void put_in_force(std::size_t entry);
  void judge();
  void publish_strokes(bool always);

  const std::shared_future<SurfaceIndexPtr> bone_;
  const std::optional<tunnels::Tunnel> plan_;
  const std::shared_ptr<const geometry::Surface> surface_;
  const std::optional<registration::CartilageRegion> covered_;
  mutable std::mutex mutex_;  // guards the rest
  DrawnStrokes strokes_;
  RegistrationPtr chosen_;  // in force but for an alarm
  RegistrationStatus status_;
  std::shared_ptr<const RegistrationStatus> published_;  // a copy of status_; null: it has changed since
  int removals_ = 0;  // how often strokes were cleared, taken back, left out or in
  double best_tre_mm_ = std::numeric_limits<double>::infinity();  // of those that took effect since
  std::unique_ptr<registration::RegistrationWorker> worker_;
};

}  // namespace arthronaut::navigate
