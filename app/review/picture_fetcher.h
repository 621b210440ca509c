// Fetches single pictures of a recorded session in a thread of its own: the newest wish wins, the last ones
// are kept. A picture takes as long as recorded_pictures.h says.
//
// Threads: the window asks; one worker reads. States: reading -> failed (error() says why).
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "navigation/camera/frame.h"
#include "navigation/worker/worker.h"

namespace arthronaut::review {

struct PictureWish {
  std::int64_t frame = 0, timestamp_ns = 0;
};
// Null: there is no picture of this frame.
struct Fetched {
  std::int64_t frame = 0;
  camera::FramePtr picture;
};
using ReadPicture = std::function<camera::FramePtr(const PictureWish& wish)>;

class PictureFetcher {
 public:
  // on_news is called from the worker when a picture has come; it must not call back.
  PictureFetcher(const std::filesystem::path& session_folder, std::function<void()> on_news);
  // The same of anything: open is called once, and what it gives as often as there are wishes, on the worker.
  PictureFetcher(std::function<ReadPicture()> open, std::function<void()> on_news);

  // Wishes the picture of this frame; returns it when it was read already: else ask again after news.
  [[nodiscard]] std::optional<Fetched> picture(const PictureWish& wish);
  [[nodiscard]] std::string error() const { return worker_.failure(); }

 private:
  using Pictures = std::vector<Fetched>;  // that were read last, oldest first
  using Worker = worker::Worker<PictureWish, Pictures>;

  static Worker::Body reading(std::function<ReadPicture()> open);

  std::int64_t wish_ = -1;  // the last one posted
  Worker worker_;
};

}  // namespace arthronaut::review
