// An operation with its source, its registration and its record: one step a frame. Thread-free: the window
// runs it on a worker (live_operation.h), `arthronaut navigate` and the demo in a loop (navigate_source.h).
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "navigation/operation/operation.h"
#include "navigation/pipeline/prefetched_source.h"
#include "navigation/recording/operation_record.h"
#include "navigation/sources/frame_source.h"
#include "navigation/theatre/latency.h"
#include "navigation/theatre/medium_look_service.h"
#include "navigation/theatre/registration_service.h"
#include "navigation/theatre/source_watch.h"
#include "navigation/tracker/pose_source.h"
#include "navigation/worker/letting_go.h"

namespace arthronaut::theatre {

// A source to be started: what the operation must know of it, and how it is opened.
struct TheatreSource {
  operation::SourceSetup setup;
  std::function<std::unique_ptr<sources::FrameSource>()>
      open;  // called where the frames are taken; may throw
  // How long opening it may take, and a picture of what is not live: a simulation has to find its place
  // first.
  double patience_s = 300;
  // Where the tunnel truly goes; the simulated source alone knows, once it is open.
  std::function<std::optional<tunnels::Tunnel>()> truth = {};
  // Told of the state after each frame, where the frames are taken; it must not wait. An exercise is scored
  // by it.
  std::function<void(const operation::OperationState&)> watch = {};
  // Begins to listen to the outside tracker that the tools name; empty where they name none. Called when the
  // source is started, and does not wait for the tracker.
  std::function<std::unique_ptr<tracker::PoseSource>()> tracker = {};
};

class OperationRun {
 public:
  // Makes an empty folder for a session's record and returns it; may throw IoError. Empty function: no
  // record.
  using MakeSessionFolder = std::function<std::filesystem::path()>;

  OperationRun(const operation::OperationSetup& setup, std::unique_ptr<RegistrationService> registration,
               MakeSessionFolder make_session_folder,
               std::unique_ptr<MediumLookService> looks = looks_at_once());
  ~OperationRun();

  // Ends the source before it and opens this one; its record begins with the first frame. Throws what opening
  // throws and what Operation::start_source throws; there is no source then.
  void start(const TheatreSource& source);
  struct Step {
    camera::FramePtr picture;  // worked in; null when none came
    bool has_ended = false;    // the source gives no more; end_source() is the caller's
  };
  // The next frame, worked in. A live source that gives none for a tenth of a second gives a step without a
  // picture, so that whoever calls can do something else. Throws what the source or Operation::process
  // throws: there is nothing to be done then but end_source().
  // Precondition: has_source().
  [[nodiscard]] Step step();
  // A live picture older than that when its numbers are known guides nobody; from the next source on.
  void late_after(double age_s) { late_after_s_ = age_s; }
  // Ends the source and its record. A disk that fails is told by record_trouble().
  void end_source();

  // What is of this moment (a stroke begins, a tip rests) is not done where the newest picture of a live
  // source is older than a hand rests before it presses: it would be taken where the probe was, not where it
  // is. That is recorded, and told by refusal(). What is given while no picture of a live source comes, or
  // after it, is recorded with its own time, on the pictures' clock.
  void apply(const operation::Command& command);
  // The record of the operation on this bone that another program left. What is said here of its end, that
  // the marker is out or that a tunnel is not drilled after all, is written there until a source begins.
  void goes_on_after(const std::filesystem::path& session_folder) { left_folder_ = session_folder; }
  // Takes in what the registration has found and what was seen of the medium meanwhile; true when the first
  // is something new. step() does it too.
  bool follow_registration();
  // How pictures of sources without a file are kept, from the next source on. Without a call, as they came.
  void keep_pictures_as(recording::PicturesAs as) { pictures_as_ = as; }
  // Video from now on, or no more, also of every source that begins later: who asked for it once has not
  // asked for the end of it by a source that broke off or was changed. The journal goes on in any case.
  void keep_video(bool on);
  void keep_video(recording::KeepVideo keep, const std::filesystem::path& video);  // see OperationRecord

  [[nodiscard]] bool has_source() const { return source_ != nullptr; }
  [[nodiscard]] operation::OperationStatePtr state() { return operation_.state(); }
  [[nodiscard]] operation::OperationStatePtr state_of_frame() const { return frame_state_; }
  [[nodiscard]] operation::Operation& operation() { return operation_; }
  // Of the record that is being written, or was written last; empty before the first.
  [[nodiscard]] const std::filesystem::path& session_folder() const { return session_folder_; }
  [[nodiscard]] bool keeps_video() const;
  // Why the outside tracker gives nothing; empty while it does, or there is none.
  [[nodiscard]] const std::string& tracker_trouble() const { return outside_.trouble; }
  // When the oldest of the outside tracker's poses in the newest frame was taken, on the steady clock;
  // `else_s` without any.
  [[nodiscard]] double oldest_pose_s(double else_s) const;
  // When the first picture was captured that shows what the newest one shows, which was captured then.
  [[nodiscard]] double content_s(double captured_s) const;
  // What is wrong with the live source that runs; of no other.
  [[nodiscard]] const SourceWatch& watch() const { return live_.watch; }
  // What was asked for of this moment and not done.
  struct Refusal {
    int count = 0;  // of all; grows with each
    // "no touch: picture 0.6 s old"; empty once something of this moment was taken again, and
    // where the operation's state says why (touch_refusal).
    std::string words;
  };
  [[nodiscard]] const Refusal& refusal() const { return refusal_; }
  // See SourceWatch.
  void shown_until(double age_ms, std::int64_t now_ns) { live_.watch.shown_until(age_ms, now_ns); }
  // How long the pictures of the source that runs, or ran last, took. Whoever takes them further adds to it.
  [[nodiscard]] LatencyMeter& latency() { return live_.meter; }
  // Why nothing is recorded any more; empty while all is well.
  [[nodiscard]] const std::string& record_trouble() const { return record_trouble_; }
  // Why the video that was to be kept ended before its source, though the rest is recorded; else empty.
  [[nodiscard]] const std::string& video_trouble() const { return video_trouble_; }

 private:
  void begin_record();
  [[nodiscard]] const tracker::TrackerPoses* ask_tracker();
  void note_tracker();
  [[nodiscard]] operation::PictureTiming timing_of(const camera::Frame& frame,
                                                   const pipeline::PictureObservation& view);
  void measure(const camera::Frame& frame, std::int64_t taken_ns);
  [[nodiscard]] double picture_age_ms() const;  // below 0 where nobody knows, or no live source runs
  // Since the newest picture of the live source that runs, or ran last, for as long as none comes; of another
  // one since it ended, and 0 while it runs.
  [[nodiscard]] std::int64_t silence_ns() const;
  // The same since the newest one that showed anything: neither a plain picture nor a frozen one does.
  [[nodiscard]] std::int64_t unseen_ns() const;
  [[nodiscard]] std::int64_t since_ns(std::int64_t captured_ns) const;
  // "no picture", "plain picture", "frozen picture"; empty: it shows what there is.
  [[nodiscard]] std::string wrong_with_picture() const;
  void note_trouble(std::int64_t since_picture_ns = 0);
  template <typename What>
  void write(const What& what);  // what(record), while there is one; its failure is told and ends it
  void pass_on(std::int64_t since_picture_ns = 0);
  [[nodiscard]] recording::KeepVideo way_to_keep() const;

  operation::Operation operation_;
  bool video_is_wanted_ = false;
  std::unique_ptr<RegistrationService> registration_;
  std::unique_ptr<MediumLookService> looks_;
  MakeSessionFolder make_session_folder_;
  TheatreSource theatre_source_;
  std::unique_ptr<pipeline::PrefetchedSource> source_;
  worker::LettingGo ending_;  // records that failed: guidance does not wait for their end
  std::unique_ptr<recording::OperationRecord> record_;
  std::filesystem::path session_folder_;
  std::filesystem::path left_folder_;           // by another program; empty: nothing was
  std::vector<operation::JournalEntry> early_;  // from before the first source
  std::string continues_, record_trouble_, video_trouble_;
  recording::PicturesAs pictures_as_ = recording::PicturesAs::AsTheyCame;
  bool record_is_due_ = false;
  operation::OperationStatePtr frame_state_;  // after the newest frame
  struct Outside {
    std::unique_ptr<tracker::PoseSource> tracker;  // null: there is none
    tracker::TrackerPoses poses;                   // at the newest frame
    std::int64_t asked_ns = 0;
    std::string trouble;
  } outside_;
  Refusal refusal_;
  struct Live {
    SourceWatch watch;
    LatencyMeter meter;
    FrameLatency newest;
    std::int64_t captured_ns = 0;       // of the newest picture, on the steady clock; 0: nobody knows
    std::int64_t taken_ns = 0;          // when that was taken up
    bool is_news = false;               // what is wrong with the source has changed with it
    std::int64_t showed_ns = 0;         // when the newest that showed anything was captured, or taken up
    std::int64_t unseen_at_end_ns = 0;  // for how long none had come that did when the source ended
    std::int64_t ended_ns = 0;          // when that was, of steady_now_ns(); 0: it runs
  } live_;
  double late_after_s_ = kLateAfter_s;
};

}  // namespace arthronaut::theatre
