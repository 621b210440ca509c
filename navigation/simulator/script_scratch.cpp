#include <algorithm>
#include <cmath>

#include "navigation/simulator/script.h"
#include "planning/geometry/error.h"

namespace arthronaut::simulator {

namespace {

constexpr std::size_t kStepsPerFrame = 2;  // of 0.5 mm: 30 mm/s at 30 frames a second
constexpr int kLiftFrames = 5;
constexpr double kLiftMm = 4;
constexpr int kRestFrames = 120;  // a learner reads that it rests, and presses a pedal meanwhile

// Stops of the strokes, `count` of them, each as far from those before as can be.
std::vector<ProbePose> places_to_rest(const Staging& staging, int count) {
  std::vector<ProbePose> places;
  const auto distance_to_places = [&](const ProbePose& stop) {
    double nearest_mm = 1e9;
    for (const ProbePose& place : places)
      nearest_mm = std::min(nearest_mm, (stop.tip_mm - place.tip_mm).norm());
    return nearest_mm;
  };
  while (std::ssize(places) < count) {
    const auto& first = staging.strokes.front();
    ProbePose furthest = first[first.size() / 2];
    for (const auto& stroke : staging.strokes)
      for (const ProbePose& stop : stroke)
        if (!places.empty() && distance_to_places(stop) > distance_to_places(furthest)) furthest = stop;
    places.push_back(furthest);
  }
  return places;
}

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
  // Off the bone towards the lens, over, and down again.
  const auto lift = [&](const ProbePose& from, const ProbePose& to) {
    for (int k = 1; k < kLiftFrames; ++k) {
      const double share = k / static_cast<double>(kLiftFrames);
      auto probe = between(from.bone_from_marker, to.bone_from_marker, share);
      const Eigen::Vector3d to_lens = staging.bone_from_camera_scratch.translation_mm - from.tip_mm;
      probe.translation_mm += kLiftMm * std::sin(geometry::kPi * share) * to_lens.normalized();
      add(probe, false);
    }
  };
  for (std::size_t s = 0; options.draws && s < staging.strokes.size(); ++s) {
    const auto& stroke = staging.strokes[s];
    for (std::size_t i = 0; i < stroke.size(); i += kStepsPerFrame) add(stroke[i].bone_from_marker, true);
    if (s + 1 < staging.strokes.size()) lift(stroke.back(), staging.strokes[s + 1].front());
  }
  if (options.rest_count == 0) return script;
  std::vector<ProbePose> places = places_to_rest(staging, options.rest_count);
  places.push_back(places.front());
  ProbePose at = options.draws ? staging.strokes.back().back() : places.front();
  for (const ProbePose& place : places) {
    lift(at, place);
    for (int i = 0; i < kRestFrames; ++i) add(place.bone_from_marker, true);
    at = place;
  }
  return script;
}

}  // namespace arthronaut::simulator
