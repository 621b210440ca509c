// What looking at a recording costs: a session of two hours at 60 frames a second opened, its memory, and any
// of its pictures and frames; and any picture of a session at 1080p. Made once, some minutes.
#include <benchmark/benchmark.h>

#include <fstream>
#include <random>

#include "app/review/session_review.h"
#include "navigation/recording/recorded_pictures.h"
#include "navigation/recording/session_check.h"
#include "tests/navigation/recording/recorded_frames.h"
#include "tests/temporary_folder.h"

namespace arthronaut::review {
namespace {

constexpr int kTwoHours = 2 * 3600 * 60;

double resident_mb() {
  std::ifstream statm("/proc/self/statm");
  long all = 0, resident = 0;
  statm >> all >> resident;
  return static_cast<double>(resident) * 4096e-6;
}

// Noise on a grey that differs from picture to picture: a codec's middling day.
camera::FramePtr picture_of(int number, int width, int height) {
  static std::mt19937 random(1);
  auto frame = std::make_shared<camera::Frame>();
  frame->index = number;
  frame->width = width;
  frame->height = height;
  frame->bgr.resize(static_cast<std::size_t>(3) * static_cast<std::size_t>(width) *
                    static_cast<std::size_t>(height));
  for (std::uint8_t& value : frame->bgr)
    value = static_cast<std::uint8_t>(60 + number % 100 + static_cast<int>(random() % 8));
  return frame;
}

class Made {
 public:
  Made(int frames, int width, int height) : frames_(frames) {
    recording::SessionRecorder recorder(folder_.path(), test::session_header(), test::scripted_options());
    std::vector<camera::FramePtr> pictures;
    for (int i = 0; i < 8; ++i) pictures.push_back(picture_of(i, width, height));
    for (int i = 0; i < frames; ++i) {
      auto picture = std::make_shared<camera::Frame>(*pictures[static_cast<std::size_t>(i % 8)]);
      picture->index = i;
      recorder.append_picture(picture);
      recorder.append(test::frame_result(i));
    }
    recorder.finish();
  }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_.path(); }
  [[nodiscard]] int frames() const { return frames_; }

 private:
  const test::TemporaryFolder folder_;
  int frames_;
};

const Made& two_hours() {
  static const Made made(kTwoHours, 64, 48);
  return made;
}
const Made& full_hd() {
  static const Made made(300, 1920, 1080);
  return made;
}

void open_two_hours(benchmark::State& state) {
  const std::filesystem::path& folder = two_hours().folder();
  double grown_mb = 0;
  for (auto _ : state) {
    const double before_mb = resident_mb();
    const SessionReview review = read_review(folder);
    const recording::FrameGlance& last = review.timeline->frames().back();
    if (review.pictures == nullptr || review.pictures->picture(last.index, last.timestamp_ns) == nullptr)
      state.SkipWithError("no picture");
    grown_mb = std::max(grown_mb, resident_mb() - before_mb);
  }
  state.counters["memory_mb"] = grown_mb;
}
BENCHMARK(open_two_hours)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->Iterations(3);

// As Review has them, opened with the session.
void any_picture(benchmark::State& state, const Made& made) {
  const SessionReview review = read_review(made.folder());
  recording::RecordedPictures& pictures = *review.pictures;
  std::mt19937 random(2);
  double worst_ms = 0;
  for (auto _ : state) {
    const int i = std::uniform_int_distribution(0, made.frames() - 1)(random);
    const auto begin = std::chrono::steady_clock::now();
    benchmark::DoNotOptimize(pictures.picture(i, test::frame_result(i).timestamp_ns));
    worst_ms =
        std::max(worst_ms,
                 std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
  }
  state.counters["worst_ms"] = worst_ms;
  state.counters["resident_mb"] = resident_mb();
}
void any_picture_of_two_hours(benchmark::State& state) { any_picture(state, two_hours()); }
void any_picture_at_1080p(benchmark::State& state) { any_picture(state, full_hd()); }
BENCHMARK(any_picture_of_two_hours)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->Iterations(200);
BENCHMARK(any_picture_at_1080p)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->Iterations(200);

void any_frame_of_two_hours(benchmark::State& state) {
  const recording::SessionTimeline timeline(two_hours().folder());
  std::mt19937 random(3);
  for (auto _ : state)
    benchmark::DoNotOptimize(timeline.frame(std::uniform_int_distribution(0, kTwoHours - 1)(random)));
}
BENCHMARK(any_frame_of_two_hours)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->Iterations(500);

// Whether it is as it was recorded: beside the screen, of everything that was recorded.
void check_record(benchmark::State& state, const Made& made) {
  double bytes = 0;
  for (auto _ : state) {
    const recording::SessionCheck check = recording::check_session(made.folder());
    if (!check.is_unbroken()) state.SkipWithError("broken");
    bytes = static_cast<double>(check.covered_bytes);
    state.counters["hashes"] = static_cast<double>(check.record_count);
  }
  state.counters["covered_mb"] = bytes / 1e6;
  state.counters["chain_mb"] =
      static_cast<double>(std::filesystem::file_size(made.folder() / "chain.csv")) / 1e6;
  state.counters["resident_mb"] = resident_mb();
}
void check_two_hours(benchmark::State& state) { check_record(state, two_hours()); }
void check_video_at_1080p(benchmark::State& state) { check_record(state, full_hd()); }
BENCHMARK(check_two_hours)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->Iterations(1);
BENCHMARK(check_video_at_1080p)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->Iterations(3);

}  // namespace
}  // namespace arthronaut::review
