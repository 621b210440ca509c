#include <cmath>

#include "navigation/simulator/script.h"
#include "planning/geometry/error.h"

namespace arthronaut::simulator {

namespace {

constexpr std::size_t kStepsPerFrame = 2;  // of 0.5 mm: 30 mm/s at 30 frames a second
constexpr int kLiftFrames = 5;
constexpr double kLiftMm = 4;

}  // namespace

Script scratch_script(const SimulationOptions& options, const Staging& staging) {
  if (staging.strokes.empty()) throw InvalidInput("simulator: there is no stroke to play");
  Script script;
  const auto add = [&](const geometry::RigidTransform& probe, bool touches) {
    const double frame = static_cast<double>(script.size());
    Moment moment;
    moment.mark_angle_deg =
        options.camera.reference_mark_angle_deg + 25 * std::sin(frame / 55) + 6 * std::sin(frame / 17);
    moment.bone_from_camera = staging.bone_from_camera_scratch * tremor(options.seed + 12, frame, 0.2, 0.4);
    moment.bone_from_probe = probe;
    moment.tip_touches_bone = touches;
    script.push_back(moment);
  };
  for (std::size_t s = 0; s < staging.strokes.size(); ++s) {
    const auto& stroke = staging.strokes[s];
    for (std::size_t i = 0; i < stroke.size(); i += kStepsPerFrame) add(stroke[i].bone_from_marker, true);
    if (s + 1 == staging.strokes.size()) break;
    // Off the bone towards the lens, over, and down again.
    const auto &from = stroke.back().bone_from_marker, &to = staging.strokes[s + 1].front().bone_from_marker;
    for (int k = 1; k < kLiftFrames; ++k) {
      const double share = k / static_cast<double>(kLiftFrames);
      auto probe = between(from, to, share);
      const Eigen::Vector3d to_lens = staging.bone_from_camera_scratch.translation_mm - stroke.back().tip_mm;
      probe.translation_mm += kLiftMm * std::sin(geometry::kPi * share) * to_lens.normalized();
      add(probe, false);
    }
  }
  return script;
}

}  // namespace arthronaut::simulator
