// Counts what operator new is asked for, on any thread, while frames go from a live source through queue,
// tracking, operation and publication. In a program of its own, since it replaces it.
#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "navigation/sources/capture_time.h"
#include "navigation/sources/recovering_source.h"
#include "navigation/theatre/live_operation.h"
#include "navigation/worker/recycler.h"
#include "planning/geometry/error.h"
#include "tests/counted_allocations.h"
#include "tests/live/marker_scene.h"

namespace arthronaut::test {
namespace {

// The marker scene, made before, in frames that are used again.
class SceneSource : public sources::FrameSource {
 public:
  explicit SceneSource(sources::LiveStamps& stamps) : stamps_(stamps) {
    info_.name = "scene";
    info_.image_size_px = {kSceneWidth, kSceneHeight};
    info_.kind = sources::SourceKind::Live;
    info_.ends = false;
  }
  const sources::SourceInfo& info() const override { return info_; }
  camera::FramePtr next() override {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    const auto frame = frames_.take();
    frame->width = kSceneWidth;
    frame->height = kSceneHeight;
    frame->luma = scene_.live(count_++);
    stamps_.put_on(*frame, sources::steady_now_ns(), camera::CaptureClock::Driver);
    frame->received_ns = frame->decoded_ns = sources::steady_now_ns();
    return frame;
  }

 private:
  sources::LiveStamps& stamps_;
  sources::SourceInfo info_;
  MarkerScene scene_;
  worker::Recycler<camera::Frame> frames_;
  long count_ = 0;
};

TEST(ChainAllocation, NothingPerFrameFromSourceToPublication) {
  theatre::LiveOptions options;
  options.operation.plan.emplace();
  options.operation.plan->tunnel.direction = {0, -1, 0};
  options.operation.plan->length_mm = 30;
  options.bone = []() -> operation::SurfaceIndexPtr { throw InvalidInput("no bone is needed here"); };
  options.live_stale_after_s = 10;
  std::atomic<bool> had_news = false;
  options.tell = [&, before = theatre::SourceTrouble::None](const theatre::LiveState& state) mutable {
    if (state.trouble != theatre::SourceTrouble::None || state.trouble != before) had_news = true;
    before = state.trouble;
  };
  theatre::LiveOperation live(options, [] {});
  theatre::TheatreSource source;
  source.setup.kind = sources::SourceKind::Live;
  source.setup.pipeline.calibration = scene_camera();
  source.setup.pipeline.tools = scene_tools();
  source.setup.pipeline.follow_lens = false;
  source.setup.draws = false;
  source.open = [] {
    return sources::recovering(
        [](const sources::Opening& opening) { return std::make_unique<SceneSource>(opening.stamps); });
  };
  live.start(source);
  operation::GiveRegistration give;
  give.registration.has_pose = give.registration.reliable = true;
  give.registration.reasons.clear();
  give.registration.covariance = geometry::Matrix6d::Identity() * 1e-4;
  give.of = operation::provenance_of(options.operation, source.setup);
  live.apply(give);
  live.apply(operation::ConfirmTimeOut{});

  const auto wait_for_frame = [&](std::int64_t frame) {
    for (int i = 0; i < 60'000 && live.latest()->operation->frame_count < frame; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return live.latest()->operation->frame_count >= frame;
  };
  // The buffers of frames, states and statistics get their size; then two seconds and more. There are as many
  // of them as were ever held at a time: here a screen that is slow holds more than a thread that is kept
  // waiting for a core will.
  std::vector<theatre::LiveStatePtr> held;
  for (std::int64_t frame = 100; frame < 110; ++frame) {
    ASSERT_TRUE(wait_for_frame(frame)) << live.latest()->message;
    held.push_back(live.latest());
  }
  held.clear();
  ASSERT_TRUE(wait_for_frame(150)) << live.latest()->message;
  ASSERT_TRUE(live.latest()->operation->frame.guidance.is_valid());
  // A machine that is kept from its work meanwhile says that its pictures are late. Those words are news, and
  // may take memory: frames without any are counted.
  for (int times = 0; times < 20; ++times) {
    had_news = false;
    const std::int64_t from = live.latest()->operation->frame_count;
    start_counting_allocations();
    ASSERT_TRUE(wait_for_frame(from + 200));
    const long asked_for = stop_counting_allocations();
    if (had_news) continue;
    EXPECT_EQ(asked_for, 0) << "in " << live.latest()->operation->frame_count - from << " frames";
    return;
  }
  FAIL() << "no 200 frames in time: " << live.latest()->trouble_words;
}

}  // namespace
}  // namespace arthronaut::test
