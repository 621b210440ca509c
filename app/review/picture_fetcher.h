// Fetches single pictures of a recorded session in a thread of its own: the newest wish wins, pictures near
// the last one are kept. Going back far means reading the video from its start again, so a picture may take
// seconds to come.
//
// Threads: the window asks; one worker reads. States: reading -> failed (error() says why).
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "navigation/sources/frame_source.h"
#include "navigation/worker/worker.h"

namespace arthronaut::review {

class PictureFetcher {
 public:
  // on_news is called from the worker when a picture has come; it must not call back.
  PictureFetcher(const std::filesystem::path& session_folder, std::function<void()> on_news);
  // The same of any source: open is called on the worker, anew whenever a wish lies behind.
  PictureFetcher(std::function<std::unique_ptr<sources::FrameSource>()> open, std::function<void()> on_news);

  // Wishes the picture of this frame; returns it when it is there already, else null: ask again after news.
  [[nodiscard]] camera::FramePtr picture(std::int64_t frame_index);
  [[nodiscard]] std::string error() const { return worker_.failure(); }

 private:
  using Pictures = std::vector<camera::FramePtr>;  // that were read last, oldest first
  using Worker = worker::Worker<std::int64_t, Pictures>;

  static Worker::Body reading(std::function<std::unique_ptr<sources::FrameSource>()> open);

  std::int64_t wish_ = -1;  // the last one posted
  Worker worker_;
};

}  // namespace arthronaut::review
