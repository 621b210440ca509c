#include "app/review/check_run.h"

#include <utility>

#include "navigation/worker/freed_memory.h"

namespace arthronaut::review {

CheckRun::CheckRun(const std::filesystem::path& session_folder, std::function<void()> on_news)
    : worker_(
          worker::Backlog::Lossless,
          [session_folder](auto& inbox) {
            CheckProgress progress;
            auto result = recording::check_session(
                session_folder,
                [&](std::int64_t done, std::int64_t all) {
                  const int percent = static_cast<int>(100 * done / all);
                  if (std::exchange(progress.percent, percent) != percent) inbox.publish(progress);
                },
                [&] { return inbox.stops(); });
            progress.result = std::move(result);
            inbox.publish(progress);
            worker::give_freed_memory_back();
          },
          std::move(on_news)) {}

CheckProgress CheckRun::progress() const {
  const auto latest = worker_.latest();
  return latest != nullptr ? *latest : CheckProgress{};
}

}  // namespace arthronaut::review
