// A frame source whose frames are made (decoded, rendered) in a thread of their own, a few ahead of who asks
// for them.
#pragma once

#include <memory>

#include "navigation/sources/frame_source.h"

namespace arthronaut::pipeline {

// Wraps any source; gives the same frames in the same order, and throws at next() what the wrapped source
// threw, after the frames before it. One thread at a time calls next(). The destructor waits for the frame
// that is being made.
class PrefetchedSource : public sources::FrameSource {
 public:
  // `source` must outlive this and must not be used by anybody else meanwhile.
  explicit PrefetchedSource(sources::FrameSource& source);
  ~PrefetchedSource() override;
  [[nodiscard]] const sources::SourceInfo& info() const override;
  [[nodiscard]] camera::FramePtr next() override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace arthronaut::pipeline
