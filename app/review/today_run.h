// What today's program makes of a recorded session's own pictures and commands, beside the screen: the same
// that `arthronaut replay` computes, with the numbers of every frame.
//
// Threads: made and asked on the window's thread; one worker computes. It ends within a frame after stop(),
// and within seconds while the bone is made ready or a registration is found: the window does not wait for
// it, see let_go() in review_view.h.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "navigation/recording/replay.h"
#include "navigation/worker/worker.h"

namespace arthronaut::review {

// The guide's numbers in one frame, as they come out today.
struct TodayFrame {
  std::int64_t index = 0;
  guidance::GuidanceState state = guidance::GuidanceState::NoPlan;
  float offset_mm = 0, angle_deg = 0;  // meaningful where the state is Valid
};

struct TodayResult {
  recording::ReplaySummary summary;
  std::vector<TodayFrame> frames;              // whose picture was tracked again, rising
  std::vector<std::int64_t> differing_frames;  // with a difference above tolerance, rising, each once
  // Null when that frame was not tracked again.
  [[nodiscard]] const TodayFrame* find(std::int64_t frame_index) const;
};

// Where it stands. result: null until it has ended, and when it failed.
struct TodayProgress {
  long done = 0, total = 0;  // frames; total 0: still being made ready
  std::shared_ptr<const TodayResult> result;
};

// Without a thread: for tests, and what the worker does. Throws what reading case, record and video throws.
[[nodiscard]] TodayResult compute_today(const std::filesystem::path& case_folder,
                                        const std::filesystem::path& session_folder,
                                        const std::function<void(long done, long total)>& progress = {},
                                        const std::function<bool()>& stops = {});

class TodayRun {
 public:
  TodayRun(const std::filesystem::path& case_folder, const std::filesystem::path& session_folder,
           std::function<void()> on_news);
  // The same of anything that computes, as compute_today() does, on the worker.
  using Compute = std::function<TodayResult(const std::function<void(long done, long total)>& progress,
                                            const std::function<bool()>& stops)>;
  TodayRun(Compute compute, std::function<void()> on_news);
  [[nodiscard]] TodayProgress progress() const;
  [[nodiscard]] bool has_ended() const { return worker_.has_ended(); }
  [[nodiscard]] std::string error() const { return worker_.failure(); }  // empty: none
  void stop() { worker_.request_stop(); }  // what was compared so far is then the result
  [[nodiscard]] bool is_stopping() const { return worker_.is_stopping(); }

 private:
  worker::Worker<int, TodayProgress> worker_;
};

// "312 of 312 frames the same to the last bit", "3 differences; the largest: guidance offset 0.412 mm in
// frame 17": for the panel.
[[nodiscard]] std::string today_words(const TodayResult& result);

}  // namespace arthronaut::review
