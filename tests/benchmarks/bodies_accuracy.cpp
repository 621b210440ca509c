// Bodies of several markers against the truth of rendered pictures: one marker alone, the mean of the single
// poses, the product's one pose; and the places of the markers by `rig` and by the mean of relative poses.
#include <Eigen/Cholesky>
#include <cstdio>
#include <cstdlib>

#include "navigation/tools/rig_calibration.h"
#include "tests/navigation/markers/waved_body.h"
#include "tests/navigation/tools/mean_relative_poses.h"

namespace arthronaut {
namespace {

using geometry::RigidTransform;

struct Error {
  double squares_mm2 = 0, squares_deg2 = 0, normalised = 0;
  long count = 0;
  void add(const RigidTransform& found, const RigidTransform& truth) {
    squares_mm2 += (found.translation_mm - truth.translation_mm).squaredNorm();
    squares_deg2 += std::pow(
        geometry::deg_from_rad(geometry::rotation_angle_rad(found.rotation.conjugate() * truth.rotation)), 2);
    ++count;
  }
  void print(const char* what) const {
    const auto n = static_cast<double>(std::max(1L, count));
    std::printf("%-34s %6ld %9.4f %9.3f", what, count, std::sqrt(squares_mm2 / n),
                std::sqrt(squares_deg2 / n));
    if (normalised > 0) std::printf(" %11.2f", normalised / n);
    std::printf("\n");
  }
};

// Of poses that count alike.
RigidTransform mean_of(const std::vector<RigidTransform>& poses) {
  RigidTransform mean = poses.front();
  for (int round = 0; round < 10; ++round) {
    geometry::Vector6d step = geometry::Vector6d::Zero();
    for (const RigidTransform& pose : poses) step += geometry::log(mean.inverse() * pose);
    mean = mean * geometry::exp(step / static_cast<double>(poses.size()));
  }
  return mean;
}

void print_fusion(const markers::Body& body, const std::vector<markers::WavedFrame>& wave) {
  std::printf("%-34s %6s %9s %9s %11s\n", "pose of the body", "frames", "rms mm", "rms deg", "normalised");
  const camera::CameraModel camera = markers::small_scope();
  Error mean, joint;
  std::vector<Error> alone(body.markers.size());
  long disagreeing = 0;
  for (const markers::WavedFrame& frame : wave) {
    std::vector<RigidTransform> single;
    for (std::size_t i = 0; i < body.markers.size(); ++i) {
      if (!frame.observations[i].is_tracked()) continue;
      single.push_back(frame.observations[i].camera_from_marker * body.markers[i].body_from_marker.inverse());
      alone[i].add(single.back(), frame.camera_from_body);
    }
    if (single.empty()) continue;
    mean.add(mean_of(single), frame.camera_from_body);
    const markers::BodyObservation found = markers::observe_body(body, frame.observations, camera);
    disagreeing += found.state == markers::MarkerState::Disagreeing || found.odd_marker >= 0 ? 1 : 0;
    if (!found.is_tracked()) continue;
    joint.add(found.camera_from_body, frame.camera_from_body);
    const geometry::Vector6d error = geometry::log(found.camera_from_body.inverse() * frame.camera_from_body);
    joint.normalised += error.dot(found.covariance.ldlt().solve(error)) / 6;
  }
  for (std::size_t i = 0; i < alone.size(); ++i)
    alone[i].print(("marker " + std::to_string(body.markers[i].marker_id) + " alone").c_str());
  mean.print("mean of the markers' poses");
  joint.print("one pose of all");
  std::printf("frames in which a marker disagreed: %ld\n\n", disagreeing);
}

void print_rig(const markers::Body& body, const std::vector<markers::WavedFrame>& wave) {
  tools::RigOptions options;
  for (const tools::BodyMarker& marker : body.markers)
    options.markers.emplace_back(marker.marker_id, marker.size_mm);
  std::vector<tools::RigSighting> sightings;
  for (std::size_t i = 0; i < wave.size(); ++i)
    for (const markers::MarkerObservation& seen : wave[i].observations)
      if (seen.is_tracked())
        sightings.push_back(
            {static_cast<std::int64_t>(i), static_cast<double>(i) / 30, seen.id, seen.camera_from_marker});
  const tools::RigSummary rig = tools::calibrate_rig(sightings, options);
  const auto means = test::mean_relative_poses(sightings, options);
  std::printf("%-34s %6s %9s %9s\n", "places of the markers", "", "mm", "deg");
  for (std::size_t i = 1; i < body.markers.size(); ++i) {
    const RigidTransform& truth = body.markers[i].body_from_marker;
    const std::string name = "marker " + std::to_string(body.markers[i].marker_id);
    Error by_rig, by_mean;
    if (rig.has_places()) by_rig.add(rig.places[i].reference_from_marker, truth);
    if (means[i]) by_mean.add(*means[i], truth);
    by_mean.print((name + ", mean of relative poses").c_str());
    by_rig.print((name + ", rig").c_str());
    if (rig.has_places())
      std::printf("%-34s %6s %9.4f %9.3f\n", "  as predicted, one sigma", "", rig.places[i].sigma_mm,
                  rig.places[i].sigma_deg);
  }
  std::printf("%d frames, %d distinct views within %.0f degrees, corners to %.4f mm; %s\n", rig.frame_count,
              rig.distinct_views, rig.cone_deg, rig.rms_mm, rig.is_usable() ? "usable" : rig.message.c_str());
}

}  // namespace
}  // namespace arthronaut

// bodies_accuracy [FRAMES]
int main(int argc, char** argv) {
  const int frames = argc > 1 ? std::atoi(argv[1]) : 300;
  const arthronaut::markers::Body body = arthronaut::markers::waved_body();
  const auto wave = arthronaut::markers::tracked_wave(body, frames, 7);
  arthronaut::print_fusion(body, wave);
  arthronaut::print_rig(body, wave);
  return 0;
}
