// What it takes to move about in a session whose pictures were kept as they came, by the fetcher that Review
// uses: until there is a picture to look at, until it is the right one, and how far off the former is; then
// what the small copies take to be made, and what they bring.
//   scrubbing CLIP SECONDS     CLIP: 1080p60 H.264 in Matroska, sent by RTSP over the loopback at its own
//   rate
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <thread>

#include "app/review/picture_fetcher.h"
#include "app/review/session_review.h"
#include "navigation/recording/session.h"
#include "tests/navigation/recording/recorded_frames.h"
#include "tests/navigation/recording/streams.h"
#include "tests/temporary_folder.h"

namespace arthronaut::review {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

double processor_ms() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  const auto ms = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_usec) * 1e-3;
  };
  return ms(usage.ru_utime) + ms(usage.ru_stime);
}

void print(const char* what, std::vector<double> values, const char* unit) {
  if (values.empty()) return;
  std::sort(values.begin(), values.end());
  std::printf("  %-34s median %7.1f, 90 %% %7.1f, worst %7.1f %s of %zu\n", what, values[values.size() / 2],
              values[values.size() * 9 / 10], values.back(), unit, values.size());
}

void record(const std::string& clip, double seconds, const std::filesystem::path& folder) {
  const std::string port = test::stream_port(0);
  const auto sender = test::send_by_rtsp(port, test::h264_clip_launch(clip));
  const auto source = test::open_when_there(test::rtsp_address(port));
  recording::SessionRecorder recorder(folder, test::session_header(), test::scripted_options());
  recorder.keep_pictures(recording::PicturesAs::AsTheyCame, source->info());
  const auto begin = Clock::now();
  while (ms_since(begin) < 1000 * seconds) {
    const camera::FramePtr frame = source->next();
    if (frame == nullptr) break;
    recorder.append(test::frame_result(frame->index));
    recorder.append_picture(frame);
  }
  source->info().line->end();
  recorder.finish();
}

class Screen {
 public:
  explicit Screen(const std::filesystem::path& folder)
      : review_(read_review(folder)), fetcher_(review_, [] {}) {}

  [[nodiscard]] std::size_t size() const { return review_.timeline->frames().size(); }

  // As the window asks, until it is the right one or the time is over.
  void look(std::size_t at, double at_most_ms = 1e5) {
    const recording::FrameGlance& frame = review_.timeline->frames()[at];
    const PictureWish wish{frame.index, frame.timestamp_ns};
    const auto begin = Clock::now();
    bool has_come = false;
    double off_ms = -1;
    while (ms_since(begin) < at_most_ms) {
      const auto fetched = fetcher_.picture(wish);
      if (fetched && fetched->is_copy && off_ms != 0) {
        copy_ms.push_back(ms_since(begin));
        if (!has_come) come_ms.push_back(copy_ms.back());
        has_come = true;
        off_ms = 0;
      }
      if (fetched && !fetched->is_copy) {
        if (!has_come) come_ms.push_back(ms_since(begin));
        right_ms.push_back(ms_since(begin));
        off_ms = 0;
        break;
      }
      if (const camera::FramePtr near = off_ms == 0 ? nullptr : fetcher_.nearest(wish)) {
        const double near_ms = static_cast<double>(std::abs(near->timestamp_ns - wish.timestamp_ns)) * 1e-6;
        // Within what a key frame can be away: not what was looked at before.
        if (!has_come && near_ms < kGroup_ms) come_ms.push_back(ms_since(begin));
        has_come = has_come || near_ms < kGroup_ms;
        off_ms = near_ms;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    if (off_ms >= 0) left_off_ms.push_back(off_ms);
  }

  std::vector<double> come_ms, copy_ms, right_ms, left_off_ms;

 private:
  static constexpr double kGroup_ms = 250 / 60.0 * 1000;
  SessionReview review_;
  PictureFetcher fetcher_;
};

template <typename Go>
void measure(const char* what, const std::filesystem::path& folder, const Go& go) {
  Screen screen(folder);
  const double before_ms = processor_ms();
  const auto begin = Clock::now();
  go(screen);
  std::printf("%s: %.0f ms, of processor time %.0f ms\n", what, ms_since(begin), processor_ms() - before_ms);
  print("a picture that says which it is", screen.come_ms, "ms");
  print("its small copy", screen.copy_ms, "ms");
  print("the right one", screen.right_ms, "ms");
  print("what is shown at last is off by", screen.left_off_ms, "ms");
}

void look_at_random(Screen& screen) {
  std::mt19937 random(1);
  for (int i = 0; i < 40; ++i)
    screen.look(std::uniform_int_distribution<std::size_t>(0, screen.size() - 1)(random));
}

// Until no more are made: asked for by looking at what takes long.
void make_copies(const std::filesystem::path& folder) {
  Screen screen(folder);
  look_at_random(screen);
  const double before_ms = processor_ms();
  const auto begin = Clock::now();
  std::size_t files = 0;
  double bytes = 0;
  for (auto last = begin; ms_since(last) < 20'000;) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    std::size_t now = 0;
    double size = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "quick")) {
      ++now;
      size += static_cast<double>(entry.file_size());
    }
    if (now != files || size != bytes) last = Clock::now();
    files = now, bytes = size;
  }
  std::printf("copies of %zu pictures: %zu files, %.1f MB, %.0f ms, of processor time %.0f ms\n",
              screen.size(), files, bytes * 1e-6, ms_since(begin) - 20'000, processor_ms() - before_ms);
}

}  // namespace
}  // namespace arthronaut::review

int main(int count, char** arguments) {
  using namespace arthronaut;
  using namespace arthronaut::review;
  if (count < 3) return std::puts("scrubbing CLIP SECONDS"), 2;
  const test::TemporaryFolder folder;
  record(arguments[1], std::atof(arguments[2]), folder.path());
  measure("40 frames at random, each until it is right", folder.path(), look_at_random);
  measure("300 back from the last, 20 a second", folder.path(), [](Screen& screen) {
    screen.look(screen.size() - 1);
    screen.come_ms.clear(), screen.right_ms.clear(), screen.left_off_ms.clear();
    auto next = Clock::now();
    for (std::size_t back = 2; back <= std::min<std::size_t>(300, screen.size()); ++back) {
      std::this_thread::sleep_until(next += std::chrono::milliseconds(50));
      screen.look(screen.size() - back);
    }
  });
  measure("dragged over all of it in 3 s, and back", folder.path(), [](Screen& screen) {
    constexpr int kWishes = 180;
    for (int i = -kWishes; i <= kWishes; ++i)
      screen.look((screen.size() - 1) * static_cast<std::size_t>(kWishes - std::abs(i)) / kWishes,
                  1000 / 60.0);
  });
  make_copies(folder.path());
  measure("40 frames at random, with copies", folder.path(), look_at_random);
  return 0;
}
