// One 1080p frame through the lens tracker, on one core: in track, from nothing, and in the frames that cost
// most: a scene too dark for the rim, where it is looked for in vain, and a mark that is gone from a clean
// rim.
#include <benchmark/benchmark.h>

#include "navigation/lens/lens_tracker.h"
#include "tests/navigation/lens/rim_picture.h"

namespace {

using namespace arthronaut::lens;

RimTruth full_hd_truth() {
  RimTruth truth;
  truth.width = 1920;
  truth.height = 1080;
  truth.center_px = {956.2, 542.0};
  truth.radius_px = 524;
  return truth;
}
RimPicture full_hd() { return draw(full_hd_truth()); }

// The tracker knows circle and mark from ten good frames; then every frame shows this.
void track_into(benchmark::State& state, const RimTruth& truth) {
  const RimPicture good = full_hd(), picture = draw(truth);
  LensTracker tracker;
  std::int64_t now_ns = 0;
  for (int frame = 0; frame < 10; ++frame) tracker.observe(good.view(), now_ns += 16'666'667);
  for (auto _ : state) benchmark::DoNotOptimize(tracker.observe(picture.view(), now_ns += 16'666'667));
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

void lose_rim_in_the_dark(benchmark::State& state) {
  RimTruth truth = full_hd_truth();
  truth.scene = [](double angle_deg, double) {
    return std::abs(turn_between_deg(angle_deg, 10)) < 30 ? 80.0 : 2.0;
  };
  track_into(state, truth);
}
BENCHMARK(lose_rim_in_the_dark)->Unit(benchmark::kMillisecond);

void lose_mark(benchmark::State& state) {
  RimTruth truth = full_hd_truth();
  truth.has_mark = false;
  track_into(state, truth);
}
BENCHMARK(lose_mark)->Unit(benchmark::kMillisecond);

}  // namespace
