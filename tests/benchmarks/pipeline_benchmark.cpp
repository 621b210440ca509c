// What one 1080p frame costs from picture in to guidance out, and what recording adds. On the path-traced
// clip where it is there; its folder is named by ARTHRONAUT_TEST_DATA.
#include <benchmark/benchmark.h>

#include <filesystem>

#include "navigation/camera/camera_file.h"
#include "navigation/camera/medium.h"
#include "navigation/pipeline/navigation_pipeline.h"
#include "navigation/recording/video_encoder.h"
#include "navigation/sources/frame_source.h"
#include "tests/recorded_data.h"
#include "tests/temporary_folder.h"

namespace arthronaut {
namespace {

std::filesystem::path clip_folder() { return test::recorded_data() / "arthroscopy/guide_wet"; }

std::vector<camera::FramePtr> clip_frames() {
  std::vector<camera::FramePtr> frames;
  const auto video = sources::open_video(clip_folder() / "clip.mkv");
  while (camera::FramePtr frame = video->next()) frames.push_back(std::move(frame));
  return frames;
}

// Frames go round and round under new timestamps; the jump at the end of the clip is part of what is
// measured.
void process_frame(benchmark::State& state) {
  if (!std::filesystem::exists(clip_folder())) return state.SkipWithError("needs the recorded data");
  const auto frames = clip_frames();
  pipeline::PipelineOptions options;
  options.calibration = camera::read_camera_file(clip_folder() / "camera.json").calibration;
  options.refractive_index = camera::kSalineIndex;
  options.tools = tools::read_tools_file(clip_folder() / "tools.json");
  pipeline::NavigationPipeline pipeline(options);
  pipeline.set_plan(tunnels::Tunnel{}, 30);
  pipeline::FrameResult result;
  std::int64_t index = 0;
  for (auto _ : state) {
    state.PauseTiming();
    camera::Frame frame = *frames[static_cast<std::size_t>(index) % frames.size()];
    frame.index = index;
    frame.timestamp_ns = index * 1'000'000'000 / 60;
    ++index;
    state.ResumeTiming();
    pipeline.process(frame, result);
  }
}
BENCHMARK(process_frame)->Unit(benchmark::kMillisecond);

void encode_frame(benchmark::State& state) {
  if (!std::filesystem::exists(clip_folder())) return state.SkipWithError("needs the recorded data");
  const auto frames = clip_frames();
  const test::TemporaryFolder folder;
  const auto file = folder / "clip.mkv";
  recording::VideoEncoder encoder(file, frames.front()->width, frames.front()->height, 60);
  std::size_t index = 0;
  for (auto _ : state) encoder.encode(*frames[index++ % frames.size()]);
  encoder.finish();
  state.counters["MB_per_frame"] =
      static_cast<double>(std::filesystem::file_size(file)) / 1e6 / static_cast<double>(index);
}
BENCHMARK(encode_frame)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace arthronaut
