// A frame source whose frames are made (decoded, rendered, grabbed) in a thread of their own.
//
// Recordings and the simulator lose nothing: a few frames are made ahead of who asks for them. A live source
// must not be behind: a consumer that is held up for a moment, as by the screen on a machine with few cores,
// gets what waited meanwhile and catches up, but no picture that waited for more than 50 ms, nor one of more
// than four. Beyond that all but the newest are left out, and until the consumer has to wait for a picture
// again only the newest waits: one that is too slow for the source has a picture that is at most one frame
// interval older than the newest that the device gave, however long the work on the one before took.
#pragma once

#include <functional>
#include <memory>

#include "navigation/sources/frame_source.h"

namespace arthronaut::pipeline {

enum class Delivery { Lossless, CatchesUp };

// Catching up for what is live, lossless for all else.
[[nodiscard]] Delivery delivery_of(const sources::SourceInfo& info);

// What next_within() found.
struct NextFrame {
  camera::FramePtr frame;  // null when none came in time and at the end
  bool has_ended = false;  // there will be none any more
};

// Wraps any source; frames come in order, and next() throws what the wrapped source threw, after the frames
// before it. One thread at a time calls next() and next_within().
class PrefetchedSource : public sources::FrameSource {
 public:
  using Opener = std::function<std::unique_ptr<sources::FrameSource>()>;

  // `source` must outlive this and must not be used by anybody else meanwhile; the destructor waits for the
  // frame that is being made. Delivered as delivery_of() says.
  explicit PrefetchedSource(sources::FrameSource& source);
  PrefetchedSource(sources::FrameSource& source, Delivery delivery);
  // Opens the source in its own thread and keeps it. Opener, source and all they hold on to may hang (a
  // stalled disk, a device that is gone): nothing here waits longer than patience_s, the destructor not at
  // all. A thread that hangs is left behind with the source, which goes when it comes back. So the opener
  // must own all that it uses. Throws what the opener throws, and DeviceError when it does not return in
  // time.
  PrefetchedSource(Opener opener, double patience_s);
  ~PrefetchedSource() override;

  [[nodiscard]] const sources::SourceInfo& info() const override;
  // A source that was opened here and gives nothing for patience_s is a DeviceError; else it waits.
  [[nodiscard]] camera::FramePtr next() override;
  // Waits so long and no longer.
  [[nodiscard]] NextFrame next_within(double seconds);
  // Why a live source gives nothing now; empty: it does, or does not know.
  [[nodiscard]] std::string trouble() const;
  // The size of the pictures that it gets and does not give, since they are of another one than before.
  [[nodiscard]] std::optional<Eigen::Vector2i> changed_to_px() const;
  // What is wrong with the pictures that it gives; empty: nothing that it knows of.
  [[nodiscard]] std::string remark() const;

 private:
  struct State;
  std::shared_ptr<State> state_;  // shared with the thread
};

}  // namespace arthronaut::pipeline
