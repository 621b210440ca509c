// An operation on the phantom's femur, frame by frame without a picture: the test says where tip and guide
// are, and truth is known. Its registration works at once.
#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "navigation/operation/operation.h"
#include "tests/navigation/pipeline/scripted_markers.h"
#include "tests/navigation/registration/phantom_bone.h"

namespace arthronaut::test {

inline operation::PlannedTunnel phantom_plan() {
  operation::PlannedTunnel plan;
  plan.tunnel.entry_mm = registration::phantom_bone().target_mm;
  plan.tunnel.direction = Eigen::Vector3d(-0.8, 0, 0.6);
  plan.length_mm = 30;
  return plan;
}

inline operation::OperationSetup phantom_setup() {
  operation::OperationSetup setup;
  setup.mesh_sha256 = "the phantom's";
  setup.surface = std::make_shared<geometry::Surface>(registration::phantom_bone().mesh);
  setup.plan = phantom_plan();
  return setup;
}

inline operation::SourceSetup scripted_source(sources::SourceKind kind = sources::SourceKind::Live) {
  operation::SourceSetup source;
  source.kind = kind;
  source.title = "script";
  source.pipeline = scripted_options();
  for (tools::Tool& tool : source.pipeline.tools.tools)
    tool.provenance.origin = provenance::Origin::Measured;  // a nominal guide is a case of its own
  return source;
}

class PhantomOperation {
 public:
  explicit PhantomOperation(const operation::OperationSetup& setup = phantom_setup())
      : operation_(setup),
        work_([] { return registration::phantom_bone().prepared; }, operation::work_options(setup)) {}

  void start(const operation::SourceSetup& source) {
    start_unconfirmed(source);
    apply(operation::ConfirmTimeOut{});
  }
  void start_unconfirmed(const operation::SourceSetup& source) {
    source_ = source;
    time_s_ = 0;
    index_ = 0;
    operation_.start_source(source);
    pass_on();
  }
  void apply(const operation::Command& command) {
    operation_.apply(command);
    pass_on();
  }

  // A frame whose world marker, tip and guide are seen as said.
  pipeline::FrameResult frame() const {
    pipeline::FrameResult frame;
    frame.frame_index = index_;
    frame.timestamp_ns = static_cast<std::int64_t>(time_s_ * 1e9);
    frame.intrinsics_are_known = true;
    frame.camera_from_world.is_valid = true;
    for (const tools::Tool& tool : source_.pipeline.tools.tools) frame.tools.push_back({tool.marker_id, {}});
    frame.guidance.state = guidance::GuidanceState::GuideLost;
    return frame;
  }
  void show(const pipeline::FrameResult& frame) {
    operation_.process_recorded(frame);
    if (on_frame) on_frame(*operation_.state());
    ++index_;
    time_s_ += 1.0 / 60;
    pass_on();
  }
  void show_tip(const Eigen::Vector3d& tip_in_marker_mm) {
    pipeline::FrameResult with_tip = frame();
    with_tip.tip_is_valid = true;
    with_tip.tip_in_world_mm = tip_in_marker_mm;
    show(with_tip);
  }
  // The guide on its plan, so deep; numbers are valid only while something stands, as in the pipeline.
  void show_guide(double depth_mm) {
    pipeline::FrameResult with_guide = frame();
    with_guide.tools.back().world_from_tool.is_valid = true;
    if (state()->registration->in_force.standing == operation::Standing::Stands && state()->plan) {
      guidance::GuidanceNumbers& numbers = with_guide.guidance;
      numbers.state = guidance::GuidanceState::Valid;
      numbers.guide_direction = state()->plan->tunnel.direction;
      numbers.guide_point_mm = state()->plan->tunnel.entry_mm + depth_mm * numbers.guide_direction;
      numbers.depth_mm = depth_mm;
      numbers.timestamp_ns = with_guide.timestamp_ns;
    }
    show(with_guide);
  }
  void wait(double seconds) { time_s_ += seconds; }
  void draw(const strokes::Curves& curves) {
    int curve = -1;
    for (const strokes::CurvePoint& point : curves) {
      if (point.curve != curve) wait(1);
      curve = point.curve;
      show_tip(point.position_mm);
    }
  }
  // The tip rests there for a moment and the pedal asks for a touch.
  void touch(const Eigen::Vector3d& tip_in_marker_mm, const operation::Command& as = operation::TakeTouch{}) {
    wait(1);
    for (int i = 0; i < 12; ++i) show_tip(tip_in_marker_mm);
    apply(as);
  }

  [[nodiscard]] operation::OperationStatePtr state() { return operation_.state(); }
  [[nodiscard]] const operation::RegistrationInForce& in_force() {
    kept_ = state();
    return kept_->registration->in_force;
  }
  [[nodiscard]] operation::Operation& operation() { return operation_; }
  [[nodiscard]] long count(operation::JournalKind kind) const {
    return std::count_if(journal.begin(), journal.end(),
                         [&](const auto& entry) { return entry.kind == kind; });
  }
  [[nodiscard]] std::string last_text(operation::JournalKind kind) const {
    std::string text;
    for (const operation::JournalEntry& entry : journal)
      if (entry.kind == kind) text = entry.text;
    return text;
  }

  std::vector<operation::JournalEntry> journal;
  // A record's way in: each frame, then what was journalled after it.
  std::function<void(const operation::OperationState&)> on_frame;
  std::function<void(const std::vector<operation::JournalEntry>&)> on_journal;

 private:
  void pass_on() {
    for (;;) {
      const auto requests = operation_.take_requests();
      auto entries = operation_.take_journal();
      if (on_journal) on_journal(entries);
      for (operation::JournalEntry& entry : entries) journal.push_back(std::move(entry));
      if (requests.empty()) return;
      for (const operation::RegistrationRequest& request : requests) (void)work_.work_in(request);
      operation_.take_outcome(work_.outcome());
    }
  }

  operation::Operation operation_;
  operation::RegistrationWork work_;
  operation::SourceSetup source_;
  operation::OperationStatePtr kept_;
  double time_s_ = 0;
  std::int64_t index_ = 0;
};

// A registration that is true of the trial, as a file would give it.
inline operation::GiveRegistration true_registration(const experiments::Trial& trial,
                                                     const registration::Provenance& of) {
  operation::GiveRegistration give;
  give.registration.has_pose = give.registration.reliable = true;
  give.registration.reasons.clear();
  give.registration.marker_from_bone = trial.marker_from_bone;
  give.registration.covariance = geometry::Matrix6d::Identity() * 1e-4;
  give.registration.predicted_tre_mm = 0.3;
  give.of = of;
  return give;
}

// A place on the bone's surface near the entry, seen from the trial's world marker; lifted off along its
// normal.
inline Eigen::Vector3d on_bone(const experiments::Trial& trial, double dx_mm, double lifted_mm = 0) {
  const auto& bone = registration::phantom_bone();
  const geometry::SurfacePoint place =
      bone.surface->closest_point(bone.target_mm + Eigen::Vector3d(dx_mm, dx_mm, 3));
  return trial.marker_from_bone * (place.point_mm + lifted_mm * place.normal);
}

}  // namespace arthronaut::test
