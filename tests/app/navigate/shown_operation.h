// What the theatre's screen reads, to be changed by a test.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/navigate/navigate_display.h"

namespace arthronaut::navigate {

inline constexpr double kNow_s = 100;

// A running operation whose newest frame is 20 ms old and fully valid, with a registration that stands.
struct Shown {
  theatre::LiveState live;
  operation::OperationState operation;
  operation::SourceSetup source;
  operation::RegistrationState registration;

  Shown() {
    live.phase = theatre::LiveState::Phase::Running;
    live.picture = std::make_shared<camera::Frame>();
    live.captured_s = kNow_s - 0.02;
    live.stale_after_s = 0.1;
    source.kind = sources::SourceKind::Live;
    source.pipeline.tools = tools::standard_tools();
    operation.has_source = true;
    operation.frame_count = 1;
    operation.frame.intrinsics_are_known = true;
    operation.frame.camera_from_world.is_valid = true;
    operation.frame.guidance.state = guidance::GuidanceState::Valid;
    operation.frame.guidance.angle_deg = 1.5;
    stand(operation::Standing::Stands, {});
  }
  void stand(operation::Standing standing, std::vector<std::string> reasons) {
    auto summary = std::make_shared<registration::RegistrationSummary>();
    summary->has_pose = true;
    summary->reliable = standing == operation::Standing::Stands;
    summary->reasons = std::move(reasons);
    registration.in_force.standing = standing;
    registration.in_force.registration = standing == operation::Standing::None ? nullptr : std::move(summary);
  }
  [[nodiscard]] theatre::LiveState whole() const {
    operation::OperationState state = operation;
    state.source = std::make_shared<const operation::SourceSetup>(source);
    state.registration = std::make_shared<const operation::RegistrationState>(registration);
    theatre::LiveState whole = live;
    whole.operation = std::make_shared<const operation::OperationState>(state);
    return whole;
  }
  [[nodiscard]] NavigateDisplay display() const {
    const theatre::LiveState state = whole();
    return display_of(&state, kNow_s);
  }
};

template <typename Change>
NavigateDisplay display_after(const Change& change) {
  Shown shown;
  change(shown);
  return shown.display();
}

}  // namespace arthronaut::navigate
