// What every single frame of a video costs, from picture in to guidance out, and its parts by themselves: a
// median hides the frame that comes too late.
//   frame_pace VIDEO CAMERA [--medium M] [--tools FILE] [--frames N]
// Prints processor time: median, 99 % and the longest. Without tools the standard ones are declared, more
// than a video shows.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "navigation/camera/medium.h"
#include "navigation/pipeline/frozen_picture.h"
#include "navigation/pipeline/navigation_pipeline.h"
#include "navigation/sources/frame_source.h"
#include "planning/geometry/quantile.h"
#include "tests/real_data/pose_error.h"

namespace arthronaut {
namespace {

using real_data::thread_cpu_ms;

// The pipeline's own tracker, and what it takes.
class TimedMarkers final : public markers::MarkerTracker {
 public:
  TimedMarkers(const tools::ToolSet& tools, std::vector<double>& ms)
      : tracker_(markers::make_tracker(markers::declared_markers(tools))), ms_(ms) {}
  std::span<const markers::MarkerObservation> track(const camera::GrayView& frame,
                                                    const camera::CameraModel& camera,
                                                    std::int64_t timestamp_ns) override {
    const double start = thread_cpu_ms();
    const auto seen = tracker_->track(frame, camera, timestamp_ns);
    ms_.push_back(thread_cpu_ms() - start);
    return seen;
  }
  [[nodiscard]] std::span<const markers::MarkerCandidate> candidates() const override {
    return tracker_->candidates();
  }
  void reset() override { tracker_->reset(); }

 private:
  std::unique_ptr<markers::MarkerTracker> tracker_;
  std::vector<double>& ms_;
};

void print(const char* what, const std::vector<double>& ms) {
  std::printf("| %s | %.2f | %.2f | %.2f |\n", what, geometry::quantile(ms, 0.5),
              geometry::quantile(ms, 0.99), *std::max_element(ms.begin(), ms.end()));
}

int run(const char* video, const pipeline::PipelineOptions& options, int frames) {
  const auto source = sources::open_video(video);
  std::vector<double> all, of_markers, of_lens, of_frozen;
  pipeline::NavigationPipeline pipeline(options, std::make_unique<TimedMarkers>(options.tools, of_markers));
  lens::LensTracker lens({.calibration = options.calibration});
  pipeline::FrozenPicture frozen(0.3);
  pipeline::FrameResult result;
  std::vector<std::uint8_t> gray;
  camera::Frame grey;  // as a live source gives it: with its luma
  long tracked = 0;
  for (camera::FramePtr frame; frames-- > 0 && (frame = source->next()) != nullptr;) {
    grey = *frame;
    camera::gray_from(*frame, grey.luma);
    double start = thread_cpu_ms();
    pipeline.process(grey, result);
    all.push_back(thread_cpu_ms() - start);
    for (const auto& marker : result.markers) tracked += result.stands_for(marker);
    const camera::GrayView picture = camera::luma_of(grey, gray);
    start = thread_cpu_ms();
    (void)frozen.observe(picture, grey.timestamp_ns);
    of_frozen.push_back(thread_cpu_ms() - start);
    start = thread_cpu_ms();
    (void)lens.observe(picture, grey.timestamp_ns);
    of_lens.push_back(thread_cpu_ms() - start);
  }
  if (all.empty()) return 1;
  std::printf(
      "%zu frames, %ld poses of markers\n| ms of processor time | median | 99 %% | longest "
      "|\n|---|---|---|---|\n",
      all.size(), tracked);
  print("a frame", all);
  print("its markers", of_markers);
  print("circle and lens mark", of_lens);
  print("frozen, torn", of_frozen);
  return 0;
}

}  // namespace
}  // namespace arthronaut

int main(int count, char** arguments) {
  using namespace arthronaut;
  if (count < 3) {
    std::puts("frame_pace VIDEO CAMERA [--medium M] [--tools FILE] [--frames N]");
    return 2;
  }
  pipeline::PipelineOptions options;
  options.calibration = camera::read_camera_file(arguments[2]).calibration;
  options.tools = tools::standard_tools();
  options.refractive_index = camera::kSalineIndex;
  int frames = 1 << 20;
  for (int i = 3; i + 1 < count; i += 2) {
    if (std::strcmp(arguments[i], "--medium") == 0)
      options.refractive_index = camera::refractive_index_from_text(arguments[i + 1]);
    if (std::strcmp(arguments[i], "--tools") == 0) options.tools = tools::read_tools_file(arguments[i + 1]);
    if (std::strcmp(arguments[i], "--frames") == 0) frames = std::atoi(arguments[i + 1]);
  }
  return run(arguments[1], options, frames);
}
