// Which pictures are on the theatre screen, which come next, and what that is called.
#include "app/navigate/navigate_view.h"

namespace arthronaut::navigate {

using operation::NextAction;
using Phase = theatre::LiveState::Phase;

std::optional<sources::SourceKind> NavigateView::source_kind() const {
  if (live_->phase == Phase::NoSource) return std::nullopt;
  // Before its first picture, or where it gives none, the operation knows of the source before it alone.
  if (live_->picture == nullptr) return started_.kind_of(choices_.bone);
  return live_->operation->source->kind;
}

bool NavigateView::pictures_are_of_now() const { return is_live(live_.get(), judged_s_); }

bool NavigateView::can_simulate() const {
  if (model_ == nullptr) return false;
  const auto key = bones_.guided(choices_.bone);
  return key && missing_for_simulation(*model_, *key).empty();
}

void NavigateView::start_same_kind() {
  if (!started_.kind()) {
    // Nothing was chosen yet. The built-in knee has nothing but its simulation; a real case never starts one.
    if (simulates()) return start_simulation(SimulatedPart::Scratch);
    if (!choices_.videos.empty()) return start_video();
    return choose_camera();
  }
  switch (*started_.kind()) {
    case sources::SourceKind::Live:
      return choose_camera();
    case sources::SourceKind::Recording:
      return start_video();
    case sources::SourceKind::Simulation:
      return start_simulation(next_part(*live_->operation));
  }
}

bool NavigateView::simulates() const {
  return started_.kind() ? *started_.kind() == sources::SourceKind::Simulation
                         : can_simulate() && !choices_.has_real_scope;
}

bool NavigateView::holds_simulated_probe() const {
  return started_.is_simulated(SimulatedPart::Scratch) || started_.is_simulated(SimulatedPart::Touch);
}

std::string NavigateView::words_of_start() const {
  const bool stands = registration().in_force.standing == operation::Standing::Stands;
  if (simulates())
    return !stands                                                ? "start the simulated operation"
           : next_part(*live_->operation) == SimulatedPart::Drill ? "drill (simulation)"
                                                                  : "verify with the probe (simulation)";
  if (started_.kind() == sources::SourceKind::Live) return "open the camera again";
  return started_.kind() || !choices_.videos.empty() ? "open the next video" : "choose a camera";
}

}  // namespace arthronaut::navigate
