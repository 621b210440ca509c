#include "app/review/today_run.h"

#include <algorithm>

#include "planning/files/format.h"

namespace arthronaut::review {

namespace {
constexpr long kTellEvery = 15;  // frames
}

const TodayFrame* TodayResult::find(std::int64_t frame_index) const {
  const auto found =
      std::lower_bound(frames.begin(), frames.end(), frame_index,
                       [](const TodayFrame& frame, std::int64_t index) { return frame.index < index; });
  return found != frames.end() && found->index == frame_index ? &*found : nullptr;
}

TodayResult compute_today(const std::filesystem::path& case_folder,
                          const std::filesystem::path& session_folder,
                          const std::function<void(long, long)>& progress,
                          const std::function<bool()>& stops) {
  TodayResult result;
  const recording::RecordedSession session(session_folder);
  const auto total = static_cast<long>(session.frames().size());
  recording::ReplayOptions options = recording::replay_options_of(case_folder, session, stops);
  options.on_frame = [&](const recording::RecordedFrame& then, const pipeline::FrameResult& now) {
    result.frames.push_back({then.index, now.guidance.state, static_cast<float>(now.guidance.offset_mm),
                             static_cast<float>(now.guidance.angle_deg)});
  };
  result.summary = recording::replay_session(session, options, [&](long done) {
    if (progress && done % kTellEvery == 0) progress(done, total);
  });
  for (const recording::Difference& difference : result.summary.differences)
    if (difference.frame >= 0) result.differing_frames.push_back(difference.frame);
  std::sort(result.differing_frames.begin(), result.differing_frames.end());
  result.differing_frames.erase(std::unique(result.differing_frames.begin(), result.differing_frames.end()),
                                result.differing_frames.end());
  return result;
}

TodayRun::TodayRun(const std::filesystem::path& case_folder, const std::filesystem::path& session_folder,
                   std::function<void()> on_news)
    : TodayRun([=](const auto& progress,
                   const auto& stops) { return compute_today(case_folder, session_folder, progress, stops); },
               std::move(on_news)) {}

TodayRun::TodayRun(Compute compute, std::function<void()> on_news)
    : worker_(
          worker::Backlog::Lossless,
          [compute = std::move(compute)](auto& inbox) {
            TodayProgress progress;
            auto result = compute(
                [&](long done, long total) {
                  progress.done = done;
                  progress.total = total;
                  inbox.publish(progress);
                },
                [&] { return inbox.stops(); });
            progress.result = std::make_shared<const TodayResult>(std::move(result));
            inbox.publish(progress);
          },
          std::move(on_news)) {}

TodayProgress TodayRun::progress() const {
  const auto latest = worker_.latest();
  return latest != nullptr ? *latest : TodayProgress{};
}

std::string today_words(const TodayResult& result) {
  const recording::ReplaySummary& summary = result.summary;
  if (summary.was_stopped && summary.replayed_frames + summary.frames_without_picture == 0)
    return "Stopped before the first frame was compared.";
  std::string words;
  if (summary.was_stopped)
    words = files::format("Stopped after %ld of %ld frames. ",
                          summary.replayed_frames + summary.frames_without_picture, summary.recorded_frames);
  if (summary.states_compared > 0)
    words +=
        files::format("%ld of %ld states the same to the last bit%s. ", summary.states_equal,
                      summary.states_compared, summary.is_same_build ? "" : " (recorded by another build)");
  if (summary.differences.empty()) return words + "No difference above tolerance.";
  const auto largest = std::max_element(
      summary.differences.begin(), summary.differences.end(),
      [](const recording::Difference& a, const recording::Difference& b) { return a.amount < b.amount; });
  words += std::to_string(summary.differences.size()) +
           (summary.differences.size() == 1 ? " difference" : " differences") + " above tolerance; ";
  if (const std::string cold = recording::cold_start_in_words(summary); !cold.empty()) words += cold + ". ";
  return words +
         (largest->unit.empty()
              ? "the first: " + summary.differences.front().what + " " + summary.differences.front().detail
              : files::format("the largest: %s %.3f %s in frame %lld", largest->what.c_str(), largest->amount,
                              largest->unit.c_str(), static_cast<long long>(largest->frame)));
}

}  // namespace arthronaut::review
