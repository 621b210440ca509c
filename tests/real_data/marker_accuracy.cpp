#include "tests/real_data/marker_accuracy.h"

#include <Eigen/LU>
#include <optional>

namespace arthronaut::real_data {

namespace {

struct Pair {
  geometry::RigidTransform measured, truth;
};

void add_marker(const markers::MarkerObservation& seen, const TrueMarker& truth, ClipAccuracy& accuracy,
                double& squares) {
  const PoseError error = pose_error(seen.camera_from_marker, truth.camera_from_marker);
  accuracy.rotation_deg.push_back(error.rotation_deg);
  accuracy.translation_mm.push_back(error.translation_mm);
  accuracy.depth_mm.push_back(seen.camera_from_marker.translation_mm.z() -
                              truth.camera_from_marker.translation_mm.z());
  accuracy.wrong_count += error.is_wrong();
  const geometry::Vector6d twist =
      geometry::log(seen.camera_from_marker.inverse() * truth.camera_from_marker);
  squares += twist.dot(seen.covariance.inverse() * twist) / 6;
}

void add_relative(const MarkerClip& clip, int tool_id, const Pair& world, const Pair& tool,
                  ClipAccuracy& accuracy) {
  const auto measured = world.measured.inverse() * tool.measured, truth = world.truth.inverse() * tool.truth;
  const PoseError error = pose_error(measured, truth);
  accuracy.relative_rotation_deg.push_back(error.rotation_deg);
  accuracy.relative_translation_mm.push_back(error.translation_mm);
  for (const tools::Tool& declared : clip.tools().tools) {
    if (declared.marker_id != tool_id || !declared.tip_mm) continue;
    accuracy.tip_mm.push_back((measured * *declared.tip_mm - truth * *declared.tip_mm).norm());
  }
}

}  // namespace

ClipAccuracy measure_accuracy(MarkerClip& clip, markers::MarkerTracker& tracker) {
  return measure_accuracy(clip, tracker, clip.calibration());
}

ClipAccuracy measure_accuracy(MarkerClip& clip, markers::MarkerTracker& tracker,
                              const camera::Calibration& calibration) {
  ClipAccuracy accuracy;
  double squares = 0;
  const int world_id = clip.tools().world_markers.front().marker_id;
  for (camera::GrayView picture = clip.next_picture(); picture.data; picture = clip.next_picture()) {
    const double start_ms = thread_cpu_ms();
    const auto seen = tracker.track(picture, clip.camera(calibration), clip.timestamp_ns());
    accuracy.cpu_ms.push_back(thread_cpu_ms() - start_ms);
    std::optional<Pair> world;
    for (const markers::MarkerObservation& marker : seen) {
      const auto truth = clip.truth().markers.find(marker.id);
      if (truth == clip.truth().markers.end()) {
        accuracy.wrong_count += marker.is_tracked();
        continue;
      }
      (truth->second.is_whole ? accuracy.whole_count : accuracy.partial_count) += truth->second.in_view;
      if (!marker.is_tracked()) continue;
      (truth->second.is_whole ? accuracy.whole_tracked : accuracy.partial_tracked) += truth->second.in_view;
      add_marker(marker, truth->second, accuracy, squares);
      const Pair pair{marker.camera_from_marker, truth->second.camera_from_marker};
      if (marker.id == world_id) {
        world = pair;
      } else if (world) {
        add_relative(clip, marker.id, *world, pair, accuracy);
      }
    }
  }
  accuracy.normalised_error =
      squares / static_cast<double>(std::max<std::size_t>(1, accuracy.rotation_deg.size()));
  return accuracy;
}

}  // namespace arthronaut::real_data
