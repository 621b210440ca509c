// Everything that leaves the screen as a picture: screenshots, the screen as a file, the screen as a stream;
// each begun and ended by a key, and each on a thread of its own at the lowest priority, so that guidance
// never waits for it. Of pictures at most one waits for each: a machine that is busy leaves some out.
//
// A file is said to be in the case when it is there whole. One that is not, as on a full disk, stays as
// FILE.part, and why is said; it can be played as far as it goes.
//
// Screenshots and files lie in CASE/screens, named by the time (UTC). They show what the screen shows, the
// patient's name among it.
//
// Threads: the window's alone.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "app/screen_copy/screen_encoder.h"
#include "navigation/worker/recycler.h"
#include "navigation/worker/worker.h"

namespace arthronaut::screen_copy {

// Where a case's pictures of the screen lie.
[[nodiscard]] std::filesystem::path screens_folder(const std::filesystem::path& case_folder);

class ScreenCopies {
 public:
  // Pictures a second of a file or a stream, at most.
  static constexpr double kRate = 15;

  // stream_address: "udp://HOST:PORT"; empty: the settings name none. wake: called from other threads.
  ScreenCopies(std::string stream_address, std::function<void()> wake);
  ~ScreenCopies();
  ScreenCopies(const ScreenCopies&) = delete;
  ScreenCopies& operator=(const ScreenCopies&) = delete;

  // The next picture is kept. refusal: why nothing may be written into the case; empty where it may.
  void take_screenshot(const std::filesystem::path& case_folder, const std::string& refusal);
  void toggle_recording(const std::filesystem::path& case_folder, const std::string& refusal);
  void toggle_stream();
  [[nodiscard]] bool is_recording() const { return recording_.writer != nullptr; }
  [[nodiscard]] bool is_streaming() const { return stream_.writer != nullptr; }
  // The screen must go on being drawn.
  [[nodiscard]] bool is_busy() const { return is_recording() || is_streaming(); }

  // Where the picture of this frame is to be copied to; null: nobody wants it. Then take() it.
  [[nodiscard]] std::shared_ptr<widgets::ScreenPicture> wanted(double now_s);
  void take(const widgets::ScreenPicturePtr& picture);

  // For the screen: what goes on and what came of the last key; empty: nothing.
  [[nodiscard]] std::string words(double now_s);

 private:
  struct Written {};  // all of it; published at the end alone
  using Writer = worker::Worker<widgets::ScreenPicturePtr, Written>;
  struct Output {
    std::unique_ptr<Writer> writer;  // null: it does not run
    std::string target;
    double begun_s = -1;  // at its first picture
  };
  struct Said {
    std::string words;  // of what is being done, until it is done
  };
  using Shots = worker::Worker<std::pair<std::filesystem::path, widgets::ScreenPicturePtr>, Said>;

  void begin(Output& output, const std::string& target);
  // Its end is in work from now on: nobody waits for it.
  void end(Output& output);
  // Says what has become of those that have ended, asked to or not.
  void read_ended();
  [[nodiscard]] static std::string outcome_of(const Output& ended);
  void say(std::string words);

  const std::string stream_address_;
  const std::function<void()> wake_;
  worker::Recycler<widgets::ScreenPicture> pictures_;
  Output recording_, stream_;
  Shots shots_;
  std::shared_ptr<const Said> last_shot_;
  std::set<std::filesystem::path> given_;  // names of files that may not be there yet
  std::filesystem::path shot_file_;        // of the screenshot that waits for its picture; empty: none
  std::string said_;
  double said_until_s_ = 0, next_s_ = 0, now_s_ = 0;
  std::vector<Output> ending_;
};

}  // namespace arthronaut::screen_copy
