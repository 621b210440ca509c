// The pictures of one source for a worker that may be slower than they come.
//
// Threads: one thread of its own opens and reads the source at the source's pace; one worker calls next() and
// advance(). States: starting -> running -> ended | failed. The destructor waits for the picture that is
// being made.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>

#include "navigation/sources/frame_source.h"

namespace arthronaut::setup {

struct FeedSource {
  std::string name;                                             // "Simulated arthroscope", for the screen
  std::function<std::unique_ptr<sources::FrameSource>()> open;  // called on the feed's thread
  std::filesystem::path path;                                   // of a file or folder; empty else
  bool is_simulated = false;
  // Single pictures: each stands, and is given again and again, until advance() asks for the next one.
  bool is_stills = false;
  // Only the newest picture counts. Else none is left out, and a slow worker sees the source in slow motion.
  bool newest_wins = true;
};

class FrameFeed {
 public:
  explicit FrameFeed(FeedSource source);
  ~FrameFeed();
  FrameFeed(const FrameFeed&) = delete;
  FrameFeed& operator=(const FrameFeed&) = delete;

  // Waits a moment (50 ms at most) for a picture. Null: none came. Throws what the source threw, once.
  [[nodiscard]] camera::FramePtr next();
  void advance();  // of stills: the next one, please; otherwise nothing
  [[nodiscard]] bool has_started() const;
  [[nodiscard]] bool awaits_still() const;  // the one before is done with, the next is not there yet
  [[nodiscard]] bool has_ended() const;     // no picture will come any more

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace arthronaut::setup
