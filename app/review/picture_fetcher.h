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

#include "navigation/camera/frame.h"

namespace arthronaut::review {

class PictureFetcher {
 public:
  // on_news is called from the worker when a picture has come; it must not call back.
  PictureFetcher(const std::filesystem::path& session_folder, std::function<void()> on_news);
  ~PictureFetcher();
  PictureFetcher(const PictureFetcher&) = delete;
  PictureFetcher& operator=(const PictureFetcher&) = delete;

  // Wishes the picture of this frame; returns it when it is there already, else null: ask again after news.
  [[nodiscard]] camera::FramePtr picture(std::int64_t frame_index);
  [[nodiscard]] std::string error() const;

 private:
  class Worker;
  std::unique_ptr<Worker> worker_;
};

}  // namespace arthronaut::review
