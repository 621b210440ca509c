// What was started last on the theatre screen, of either bone, and what of the simulation: what the pedal
// starts again, and whether its end was asked for. Of one case: another one begins with none. Pure.
#pragma once

#include <algorithm>
#include <map>
#include <optional>

#include "app/navigate/navigate_setup.h"
#include "navigation/sources/source_kind.h"
#include "planning/bones/bone.h"

namespace arthronaut::navigate {

// Which part of the simulated surgeon's script an operation goes on with: the probe, until what it registered
// is verified by touches, or that step was passed over; once something is registered it draws no more.
[[nodiscard]] inline SimulatedPart next_part(const operation::OperationState& state) {
  const bool stands = state.registration->in_force.standing == operation::Standing::Stands;
  if (!stands) return SimulatedPart::Scratch;
  return state.verification == operation::Verification::NotYet ? SimulatedPart::Touch : SimulatedPart::Drill;
}

class StartedSource {
 public:
  void on_start(bones::BoneKind bone, sources::SourceKind kind) {
    kind_ = of_bone_[bone] = kind;
    part_.reset();
    stops_once_open_ = end_was_asked_ = false;
  }
  // What was started is that part of the simulation.
  void simulates(SimulatedPart part) { part_ = part; }
  // is_opening: nothing cuts that short; it ends right after it, before its first picture.
  void on_end_asked(bool is_opening) {
    end_was_asked_ = true;
    stops_once_open_ = is_opening;
  }
  // Of the other bone nothing is simulated yet.
  void on_other_bone() { part_.reset(); }
  // One that was left is resumed by the kind of source that it ran with; empty: nobody knows.
  void goes_on_with(std::optional<sources::SourceKind> kind) { kind_ = kind; }

  // Of the source that was started last, or is to be resumed; empty: none yet.
  [[nodiscard]] const std::optional<sources::SourceKind>& kind() const { return kind_; }
  // The same of that bone; where none was started for it, as kind().
  [[nodiscard]] std::optional<sources::SourceKind> kind_of(bones::BoneKind bone) const {
    const auto started = of_bone_.find(bone);
    return started != of_bone_.end() ? std::optional(started->second) : kind_;
  }
  [[nodiscard]] bool is_simulated(SimulatedPart part) const { return part_ == part; }
  // Anything but a simulation was started in this case.
  [[nodiscard]] bool was_real() const {
    return std::any_of(of_bone_.begin(), of_bone_.end(),
                       [](const auto& one) { return one.second != sources::SourceKind::Simulation; });
  }
  // The source that is being opened is not wanted any more.
  [[nodiscard]] bool stops_once_open() const { return stops_once_open_; }
  [[nodiscard]] bool end_was_asked() const { return end_was_asked_; }

 private:
  std::optional<SimulatedPart> part_;
  std::optional<sources::SourceKind> kind_;
  std::map<bones::BoneKind, sources::SourceKind> of_bone_;
  bool stops_once_open_ = false, end_was_asked_ = false;
};

}  // namespace arthronaut::navigate
