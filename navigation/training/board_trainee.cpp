#include "navigation/training/board_trainee.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "navigation/simulator/script.h"

namespace arthronaut::training {

namespace {

using Eigen::Vector3d;
using simulator::HandInput;
using simulator::HandState;

constexpr double kBoardGain_1_s = 5;  // of speed over distance
constexpr double kThere_mm = 0.2, kThere_deg = 0.8, kBoardPatience_s = 6;
const simulator::HandLimits kBoardLimits;  // those of the source that it moves

// Goes to the places of the scripted surgeon, one after the other, and takes a picture at each.
class BoardTrainee {
 public:
  explicit BoardTrainee(const Skill& skill) : skill_(skill) {}

  std::optional<HandInput> push(const simulator::HandScene& scene, const HandState& state) {
    if (places_.empty()) plan(scene.start.mark_angle_deg);
    HandInput input;
    input.held = simulator::Held::Board;
    if (is_over_) return std::nullopt;
    if (at_ >= places_.size()) {
      is_over_ = true;
      input.press = simulator::Press::Finish;
      return input;
    }
    const simulator::Moment& place = places_[at_];
    const bool is_there = push_towards(place, state, input);
    if (!is_there && state.time_s - left_s_ < kBoardPatience_s) {
      arrived_s_ = state.time_s;
      return input;
    }
    if (state.time_s - arrived_s_ < skill_.rests_s) return input;
    input.press = simulator::Press::Picture;
    ++at_;
    left_s_ = arrived_s_ = state.time_s;
    return input;
  }

 private:
  void plan(double mark_angle_deg) {
    simulator::SimulationOptions options;
    options.camera.reference_mark_angle_deg = mark_angle_deg;
    options.seed = skill_.seed;
    const simulator::Script script = simulator::calibrate_script(options);
    for (int i = 0; i < skill_.pictures; ++i) {
      simulator::Moment place = script[static_cast<std::size_t>(i) % script.size()];
      place.mark_angle_deg = mark_angle_deg + (i - (skill_.pictures - 1) / 2.0) * skill_.turns_lens_deg;
      places_.push_back(place);
    }
  }

  // True: it is as near as it will come.
  bool push_towards(const simulator::Moment& place, const HandState& state, HandInput& input) const {
    const Vector3d way_mm = place.camera_from_board->translation_mm - state.camera_from_board.translation_mm;
    const Vector3d facing = state.camera_from_board.rotate(Vector3d::UnitZ());
    const Vector3d wanted = place.camera_from_board->rotate(Vector3d::UnitZ());
    const double turn_deg = std::remainder(place.mark_angle_deg - state.mark_angle_deg, 360.0);
    const auto limited = [&](const Vector3d& axis) {
      return axis.norm() > skill_.pace ? Vector3d(axis * (skill_.pace / axis.norm())) : axis;
    };
    input.move = limited(kBoardGain_1_s / kBoardLimits.tool_mm_s * way_mm);
    Vector3d tilt =
        kBoardGain_1_s / geometry::rad_from_deg(kBoardLimits.tool_deg_s) * Vector3d(wanted - facing);
    tilt.z() = 0;  // how it is turned in its plane is all the same
    input.tilt = limited(tilt);
    input.turn_lens =
        std::clamp(kBoardGain_1_s / kBoardLimits.lens_deg_s * turn_deg, -skill_.pace, skill_.pace);
    return way_mm.norm() < kThere_mm &&
           geometry::angle_between_rad(facing, wanted) < geometry::rad_from_deg(kThere_deg) &&
           std::abs(turn_deg) < kThere_deg;
  }

  Skill skill_;
  std::vector<simulator::Moment> places_;
  std::size_t at_ = 0;
  double left_s_ = 0, arrived_s_ = 0;
  bool is_over_ = false;
};

}  // namespace

simulator::Hand make_board_trainee(const Skill& skill) {
  return
      [trainee = std::make_shared<BoardTrainee>(skill)](
          const simulator::HandScene& scene, const HandState& state) { return trainee->push(scene, state); };
}

}  // namespace arthronaut::training
