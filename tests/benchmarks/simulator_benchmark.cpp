// What one simulated 1080p frame costs, by phase: whether the whole operation can be rehearsed in real time
// (30 frames a second are 33 ms on the clock). Two threads draw; both times are given.
#include <benchmark/benchmark.h>

#include "navigation/simulator/simulated_operation.h"
#include "tests/navigation/simulator/phantom_options.h"

namespace arthronaut::simulator {
namespace {

// Moments of the phase, evenly through it, round and round.
void draw_frame(benchmark::State& state, Phase phase, bool is_surrounded = false) {
  SimulationOptions options = phantom_options();
  options.frame_count = 200;
  if (is_surrounded) options.surroundings = {.soft_tissue = true, .motes = true, .other_hand = true};
  auto operation = std::make_unique<SimulatedOperation>(options, phase);
  for (auto _ : state) {
    auto frame = operation->next();
    if (!frame) {
      state.PauseTiming();
      operation = std::make_unique<SimulatedOperation>(options, phase);
      state.ResumeTiming();
      frame = operation->next();
    }
    benchmark::DoNotOptimize(frame->bgr.data());
  }
}
BENCHMARK_CAPTURE(draw_frame, calibrate, Phase::Calibrate)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Iterations(40);
BENCHMARK_CAPTURE(draw_frame, pivot, Phase::Pivot)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Iterations(100);
BENCHMARK_CAPTURE(draw_frame, scratch, Phase::Scratch)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Iterations(100);
BENCHMARK_CAPTURE(draw_frame, drill, Phase::Drill)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Iterations(100);

BENCHMARK_CAPTURE(draw_frame, drill_surrounded, Phase::Drill, true)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Iterations(100);

}  // namespace
}  // namespace arthronaut::simulator
