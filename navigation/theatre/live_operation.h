// An operation in theatre: one thread that takes frames, carries out what is asked and publishes what may be
// shown; another one registers. The screen reads latest() and posts; it never waits.
//
// States of the source: none -> starting -> running -> ended | failed, and from any of them to starting
// again. The operation itself, its strokes and registrations, outlives them all. No failure starts another
// source.
//
// Threads: every member may be called from any thread and none waits, but the destructor, which joins:
// request_stop() first and destroy it elsewhere where that would freeze a screen.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "navigation/theatre/operation_run.h"

namespace arthronaut::theatre {

// What the screen wants to have made of a frame beside the frames, such as the lines that are drawn over it.
class Decoration {
 public:
  virtual ~Decoration() = default;
};
using Decorate = std::function<std::shared_ptr<const Decoration>(const operation::OperationState&)>;

// Everything that may be shown. Immutable, whole.
struct LiveState {
  enum class Phase { NoSource, Starting, Running, Ended, Failed } phase = Phase::NoSource;
  std::string message;                           // why it failed
  operation::OperationStatePtr operation;        // now, never null once published
  camera::FramePtr picture;                      // the newest; null before the first of this source
  std::shared_ptr<const Decoration> decoration;  // of that picture; may be null
  // When what the picture shows was so: for a live source when it was captured, else when it was published.
  double captured_s = 0;  // on the clock of now_s()
  // How long before it what it shows was shown first: it repeats the pictures before, or may be about to.
  double shown_for_s = 0;
  // Of what is shown.
  [[nodiscard]] double age_s(double now_s) const { return now_s - captured_s + shown_for_s; }
  double stale_after_s = 2;      // older than that it is no picture of now
  double frames_per_second = 0;  // that were navigated, lately
  double published_s = 0;        // when that picture's state could be shown, on the same clock
  // Of a live source: what is wrong with it, in words for the screen (None and empty: nothing), and how long
  // its pictures take from stage to stage, as of the last second that was counted.
  SourceTrouble trouble = SourceTrouble::None;
  std::string trouble_words;
  std::optional<Eigen::Vector2i> changed_to_px{};  // with NoPicture: see SourceWatch
  LatencyReport latency{};
  OperationRun::Refusal refusal;  // of what was asked for last
  double refused_s = 0;           // when refusal.count changed last, on the same clock
  std::string tracker_trouble;  // why the outside tracker gives nothing; empty while it does, and without one
  std::filesystem::path session_folder;  // of the record that is written, or was written last
  bool keeps_video = false;
  std::string record_trouble;   // why nothing is recorded; empty while all is well
  std::string video_trouble{};  // why the video is not recorded any more, where the rest is
};
using LiveStatePtr = std::shared_ptr<const LiveState>;

struct LiveOptions {
  operation::OperationSetup operation;
  BoneMaker bone;
  OperationRun::MakeSessionFolder make_session_folder;  // empty: no record
  Decorate decorate;                                    // called on the operation's thread; may be empty
  // Likewise, with everything that is published, right after it; must not wait.
  std::function<void(const LiveState&)> tell;
  double live_stale_after_s = kLateAfter_s;  // guidance from older pictures of a live source is hidden
};

class LiveOperation {
 public:
  // on_news is called from the operation's thread whenever latest() has changed; it must not call back.
  LiveOperation(LiveOptions options, std::function<void()> on_news);
  ~LiveOperation();
  LiveOperation(const LiveOperation&) = delete;
  LiveOperation& operator=(const LiveOperation&) = delete;

  void start(TheatreSource source);
  void end_source();
  void apply(operation::Command command);
  // See OperationRun.
  void keep_video(bool on);
  void keep_pictures_as(recording::PicturesAs as);
  void goes_on_after(const std::filesystem::path& session_folder);
  void request_stop();
  // The screen shows this state from now on, as it was at drawn_s, on the clock of now_s(): after each time
  // that it was drawn. For the latency to the screen, and to know pictures that come too slowly.
  void shown(const LiveState& live, double drawn_s);

  // Never null.
  [[nodiscard]] LiveStatePtr latest() const;
  // What it was made with.
  [[nodiscard]] const operation::OperationSetup& setup() const;
  // Why the thread has ended; empty while it runs. That is a fault of the program.
  [[nodiscard]] std::string failure() const;
  // Waits until all that was posted is carried out and no source runs; for tests.
  void finish() const;
  [[nodiscard]] static double now_s();  // steady clock

 private:
  struct Thread;
  std::unique_ptr<Thread> thread_;
};

}  // namespace arthronaut::theatre
