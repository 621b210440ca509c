// The registration's share of the work, taken off the frames: requests go in, in order, and outcomes come
// out.
//
// RegistrationWork is thread-free and deterministic: what comes out depends on the order of the requests
// alone, never on when they came. An outcome names how many requests it rests on, so that a record which says
// after which frame which outcome was taken in can be run again to the same states. In theatre it runs behind
// a worker::Worker; the command line, replay and tests call it directly.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "navigation/registration/online/online_registration.h"

namespace arthronaut::operation {

using SurfaceIndexPtr = std::shared_ptr<const registration::SurfaceIndex>;
using RegistrationPtr = std::shared_ptr<const registration::RegistrationSummary>;

struct DrawnPoint {
  strokes::CurvePoint point;
};
struct StrokeExclusion {
  int curve = 0;
  bool is_excluded = true;
};
struct StrokesTakenBack {
  int count = 0;
};
struct StrokesCleared {};
// From the next solution on, and the next FitAll, the registration is judged at this place; nullopt: at the
// strokes' centroid.
struct AimAt {
  std::optional<Eigen::Vector3d> target_in_bone_mm, direction_in_bone;
};
// All that was drawn is judged, however little of it is new.
struct JudgeAll {};
// A registration of these strokes from nothing, as a whole.
struct FitAll {
  int number = 0;  // of the fit, from 1
  std::shared_ptr<const strokes::Curves> curves;
};
using RegistrationRequest =
    std::variant<DrawnPoint, StrokeExclusion, StrokesTakenBack, StrokesCleared, JudgeAll, FitAll, AimAt>;

// What is known after so many requests. Immutable; the newest one holds all that those before it hold.
struct RegistrationOutcome {
  std::uint64_t request_count = 0;
  bool bone_is_ready = false;
  std::shared_ptr<const registration::OnlineResult> online;  // null before the first
  int fit_number = 0;                                        // of the newest FitAll that is done; 0: none
  RegistrationPtr fit;                                       // that one
  std::string failure;  // why nothing can be registered to this bone; empty else
};
using OutcomePtr = std::shared_ptr<const RegistrationOutcome>;

struct RegistrationWorkOptions {
  registration::OnlineOptions online;     // target, direction, cartilage, seed
  registration::RegistrationOptions fit;  // of FitAll
};

class RegistrationWork {
 public:
  // `bone` is called here and may take seconds; what it throws becomes a failure.
  RegistrationWork(const std::function<SurfaceIndexPtr()>& bone, const RegistrationWorkOptions& options);

  // Works one request in. True when there is something new to say.
  bool work_in(const RegistrationRequest& request);
  // All that is known now; never null.
  [[nodiscard]] OutcomePtr outcome() const { return outcome_; }

 private:
  void publish(const std::function<void(RegistrationOutcome&)>& change);
  bool carry_out(const RegistrationRequest& request);
  void fit(const FitAll& request);
  void fail(const std::exception& error);

  RegistrationWorkOptions options_;
  SurfaceIndexPtr bone_;
  std::unique_ptr<registration::OnlineRegistration> online_;
  std::uint64_t request_count_ = 0;
  OutcomePtr outcome_;
};

}  // namespace arthronaut::operation
