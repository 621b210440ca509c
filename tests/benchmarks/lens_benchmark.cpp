// One 1080p frame through the lens tracker, on one core: in track, and from nothing.
#include <benchmark/benchmark.h>

#include "navigation/lens/lens_tracker.h"
#include "tests/navigation/lens/rim_picture.h"

namespace {

using namespace arthronaut::lens;

RimPicture full_hd() {
  RimTruth truth;
  truth.width = 1920;
  truth.height = 1080;
  truth.center_px = {956.2, 542.0};
  truth.radius_px = 524;
  return draw(truth);
}

void track_lens(benchmark::State& state) {
  const RimPicture picture = full_hd();
  LensTracker tracker;
  std::int64_t now_ns = 0;
  for (int frame = 0; frame < 10; ++frame) tracker.observe(picture.view(), now_ns += 16'666'667);
  for (auto _ : state) benchmark::DoNotOptimize(tracker.observe(picture.view(), now_ns += 16'666'667));
}
BENCHMARK(track_lens)->Unit(benchmark::kMillisecond);

void find_lens_from_nothing(benchmark::State& state) {
  const RimPicture picture = full_hd();
  for (auto _ : state) benchmark::DoNotOptimize(observe_still(picture.view()));
}
BENCHMARK(find_lens_from_nothing)->Unit(benchmark::kMillisecond);

}  // namespace
