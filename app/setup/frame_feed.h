// The pictures of one source for somebody who may be slower than they come.
//
// Threads: a worker of its own opens and reads the source at the source's pace; all members are called by one
// other thread. States: starting -> running -> ended | failed. The destructor waits for the picture that is
// being made.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "navigation/sources/frame_source.h"
#include "navigation/worker/worker.h"

namespace arthronaut::setup {

struct FeedSource {
  std::string name;                                             // "Simulated arthroscope", for the screen
  std::function<std::unique_ptr<sources::FrameSource>()> open;  // called on the feed's thread
  std::filesystem::path path;  // of a file or folder; of a source that is asked for by a word, that word
  bool is_simulated = false;
  bool is_live = false;  // a camera that is connected
  // Single pictures: each stands, and is given again and again, until advance() asks for the next one.
  bool is_stills = false;
  // Only the newest picture counts. Else none is left out, and a slow worker sees the source in slow motion.
  bool newest_wins = true;
  // As open(), to be looked at while it is chosen: refuses what is in use. Empty: open().
  std::function<std::unique_ptr<sources::FrameSource>()> look = {};
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
  [[nodiscard]] std::string trouble() const;  // why a live source gives no picture now; empty else
  [[nodiscard]] bool awaits_still() const;    // the one before is done with, the next is not there yet
  [[nodiscard]] bool has_ended() const;       // no picture will come any more

 private:
  struct Picture {  // number 0 without a frame: the source is open
    camera::FramePtr frame;
    long number = 0;                                      // counted from 1
    std::shared_ptr<sources::SourceLine> line = nullptr;  // of a live source
  };
  // Messages: the number of the picture that is done with, where the reader waits for that.
  using Reader = worker::Worker<long, Picture>;

  static void read(const FeedSource& source, Reader::Inbox& inbox);
  [[nodiscard]] long newest_number() const;

  const FeedSource source_;
  std::shared_ptr<const Picture> seen_;  // that next() saw last
  long given_ = 0, passed_ = 0;          // numbers: given out last; of stills, done with last
  Reader::Clock::time_point given_at_;
  bool has_thrown_ = false;
  Reader reader_;  // last: ends before the rest goes
};

}  // namespace arthronaut::setup
