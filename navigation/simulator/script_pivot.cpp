#include <cmath>

#include "navigation/simulator/script.h"
#include "planning/geometry/error.h"

namespace arthronaut::simulator {

Script pivot_script(const SimulationOptions& options, const Staging& staging) {
  constexpr int kFramesBetweenStops = 3;
  if (staging.pivot.empty()) throw InvalidInput("simulator: the probe pivots on the femur, not on the tibia");
  const Eigen::Vector3d tip_in_probe = *probe_of(options.tools).tip_mm;
  Script script;
  for (std::size_t i = 0; i + 1 < staging.pivot.size(); ++i) {
    for (int k = 0; k < kFramesBetweenStops; ++k) {
      const double frame = static_cast<double>(script.size());
      Moment moment;
      moment.mark_angle_deg = options.camera.reference_mark_angle_deg + 12 * std::sin(frame / 40);
      moment.bone_from_camera = staging.bone_from_camera_pivot * tremor(options.seed + 11, frame, 0.2, 0.4);
      auto probe = between(staging.pivot[i].bone_from_marker, staging.pivot[i + 1].bone_from_marker,
                           k / static_cast<double>(kFramesBetweenStops));
      // The tip stays in the dimple, also between two stops.
      probe.translation_mm += staging.pivot[i].tip_mm - probe * tip_in_probe;
      moment.bone_from_probe = probe;
      moment.tip_touches_bone = true;
      script.push_back(moment);
    }
  }
  return script;
}

}  // namespace arthronaut::simulator
