// One frame's rows in session.sqlite: written by the recorder's thread, read back by RecordedSession.
#pragma once

#include <vector>

#include "navigation/recording/session.h"
#include "navigation/recording/session_database.h"

namespace arthronaut::recording {

// Statements prepared once for many frames.
class FrameInserter {
 public:
  explicit FrameInserter(SessionDatabase& database);
  void insert(const pipeline::FrameResult& result);

 private:
  Statement frame_, marker_, guidance_;
};

// All frames in the order of their indices.
[[nodiscard]] std::vector<RecordedFrame> read_frames(SessionDatabase& database);

}  // namespace arthronaut::recording
