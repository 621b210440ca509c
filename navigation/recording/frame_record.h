// One frame's rows in session.sqlite: written by the recorder's thread, read back by RecordedSession.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "navigation/recording/session.h"
#include "navigation/recording/session_database.h"

namespace arthronaut::recording {

// Statements prepared once for many frames.
class FrameInserter {
 public:
  // The bodies of several markers among these tools are recorded by their own poses, too.
  FrameInserter(SessionDatabase& database, const tools::ToolSet& tools);
  void insert(const pipeline::FrameResult& result);

 private:
  void insert_outside(const pipeline::FrameResult& result);

  Statement frame_, marker_, body_, outside_, guidance_;
  std::vector<int> bodies_of_several_;  // their ids
};

// Frames from first to last, both included, in the order of their indices; all of them where nothing else is
// said. One frame takes a tenth of a millisecond.
[[nodiscard]] std::vector<RecordedFrame> read_frames(
    SessionDatabase& database, std::int64_t first = std::numeric_limits<std::int64_t>::min(),
    std::int64_t last = std::numeric_limits<std::int64_t>::max());

// Each of them in its order, with some hundreds in memory, until `use` says false; then it is false. Where
// one cannot be read it throws, after those before the damage.
bool for_each_frame(SessionDatabase& database, const std::function<bool(RecordedFrame&)>& use);

}  // namespace arthronaut::recording
