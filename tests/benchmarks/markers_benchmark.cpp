#include <benchmark/benchmark.h>

#include "navigation/markers/marker_tracker.h"
#include "tests/benchmarks/aruco_tracker.h"
#include "tests/navigation/markers/rendered_marker.h"

namespace arthronaut::markers {
namespace {

struct Scene {
  camera::CameraModel camera = small_scope();
  std::vector<DeclaredMarker> declared = {{0, 4}, {2, 4}};
  RenderedPicture picture{camera,
                          {{codes_4x4_50()[0], 4, facing_pose(-4.5, 3, 17, 20, 10, 15)},
                           {codes_4x4_50()[2], 4, facing_pose(4, -2, 15, -15, 25, 120)}}};
};

void steady_tracking(benchmark::State& state) {
  const Scene scene;
  const auto tracker = make_tracker(scene.declared);
  std::int64_t time_ns = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(tracker->track(scene.picture.view(), scene.camera, time_ns));
    time_ns += 16'666'667;
  }
}
BENCHMARK(steady_tracking)->Unit(benchmark::kMillisecond);

void search_with_nothing_known(benchmark::State& state) {
  const Scene scene;
  const auto tracker = make_tracker(scene.declared);
  for (auto _ : state) {
    tracker->reset();
    benchmark::DoNotOptimize(tracker->track(scene.picture.view(), scene.camera, 0));
  }
}
BENCHMARK(search_with_nothing_known)->Unit(benchmark::kMillisecond);

void reference_tracker(benchmark::State& state) {
  const Scene scene;
  const auto tracker = make_aruco_tracker(scene.declared);
  for (auto _ : state) benchmark::DoNotOptimize(tracker->track(scene.picture.view(), scene.camera, 0));
}
BENCHMARK(reference_tracker)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace arthronaut::markers
