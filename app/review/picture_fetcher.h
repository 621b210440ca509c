// Fetches single pictures of a recorded session in a thread of its own: the newest wish wins, and ends the
// search for the one before; the last ones are kept. A picture takes as long as recorded_pictures.h says:
// until it is there, its small copy can be shown (quick_pictures.h), or the nearest one that came by, as what
// it is. Of a session of which pictures take longer than a tenth of a second copies are made, about the last
// wish first, by a thread that gives way to all others.
//
// Threads: the window asks; one worker reads. States: reading -> failed (error() says why).
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/review/session_review.h"
#include "navigation/camera/frame.h"
#include "navigation/sources/on_the_way.h"
#include "navigation/worker/worker.h"

namespace arthronaut::review {

struct PictureWish {
  std::int64_t frame = 0, timestamp_ns = 0;
};
// Null: there is no picture of this frame.
struct Fetched {
  std::int64_t frame = 0;
  camera::FramePtr picture;
  bool is_copy = false;  // half as wide; the picture itself is looked for
};
// How pictures are read. `read` as RecordedPictures::picture(), but that what is passed has index and
// timestamp; `read_before` as its read_before_remembered(). `copy`: of a picture that was made small before;
// null: none was. `was_slow`: after a picture that took long. All but `read` may be empty.
struct PictureReader {
  std::function<camera::FramePtr(const PictureWish& wish, const sources::OnTheWay& on_the_way)> read;
  std::function<void(const std::function<bool()>& goes_on)> read_before = {};
  std::function<camera::FramePtr(const PictureWish& wish)> copy = {};
  std::function<void(const PictureWish& wish)> was_slow = {};
};

class PictureFetcher {
 public:
  // on_news is called from the worker when a picture has come; it must not call back.
  PictureFetcher(const SessionReview& review, std::function<void()> on_news);
  // The same of anything: open is called once, and what it gives as often as there are wishes, on the worker.
  PictureFetcher(std::function<PictureReader()> open, std::function<void()> on_news);

  // Wishes the picture of this frame; returns it when it was read already: else ask again after news. A copy
  // is returned until then, too.
  [[nodiscard]] std::optional<Fetched> picture(const PictureWish& wish);
  // Of those that are there the one nearest in time; its index and timestamp say which one it is. Null: none.
  [[nodiscard]] camera::FramePtr nearest(const PictureWish& wish) const;
  [[nodiscard]] std::string error() const { return worker_.failure(); }

 private:
  using Pictures = std::vector<Fetched>;  // that were read last, oldest first
  using Worker = worker::Worker<PictureWish, Pictures>;

  static Worker::Body reading(std::function<PictureReader()> open);

  std::int64_t wish_ = -1;  // the last one posted
  Worker worker_;
};

// Which picture that is: "1.24 s earlier".
[[nodiscard]] std::string nearness_in_words(std::int64_t picture_ns, std::int64_t wanted_ns);

}  // namespace arthronaut::review
