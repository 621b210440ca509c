// A session on disk: what happened in theatre, so that a crash loses at most one second and everything can be
// run again.
//
//   session.json        format "arthronaut.session": bone, medium, tools' roles, source, versions
//   session.sqlite      WAL while it is written; frames, poses, marker states, tips, guidance, events
//   video.* video_2.*   the video: a file source is copied, a stream's packets are kept as they came, frames
//                       of a device or the simulator are encoded (kept_video.h).
//                       pictures/ holds copied stills; an absolute path stands in session.json when copying
//                       was declined
//   registration_N.json each registration at the moment it took effect
//   poses.csv curves.csv registration.json guidance.csv     the same in open formats; poses and guidance
//                       grow in *.csv.part while it goes on and get their names when the session ends
//   camera.json tools.json                                  what it was navigated with
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "navigation/pipeline/navigation_pipeline.h"
#include "navigation/recording/kept_video.h"
#include "navigation/registration/provenance.h"
#include "navigation/sources/frame_source.h"
#include "navigation/strokes/curves.h"
#include "navigation/strokes/poses_file.h"
#include "planning/files/free_space.h"

namespace arthronaut::recording {

struct SessionHeader {
  std::string id;           // the folder's name
  std::string started_utc;  // ISO 8601
  bones::BoneKind bone = bones::BoneKind::Femur;
  bones::Side side = bones::Side::Right;
  double refractive_index = 1;
  std::string probe_name, guide_name;
  std::string source;  // name of the frame source
  std::string video;   // path or pattern within the folder, or an absolute one; empty when no video was kept
  bool video_is_reencoded = false;  // by append_picture(), not the source's own file
  // Its luma is what was tracked, bit for bit: tracking it again gives the same poses. False for H.264 that
  // was made of pictures, which gives slightly other ones.
  bool video_has_exact_luma = false;
  // Of a video by append_picture(), in order; records of before have one, which they do not name.
  std::vector<VideoPart> video_parts;
  // Of the operation that this session is a part of; empty and 0 in records that are older than it.
  std::optional<sources::SourceKind> source_kind;
  std::string mesh_sha256;          // of the bone's mesh
  bool probe_drew_at_start = true;  // SourceSetup::draws
  bool time_out_first = false;    // SourceSetup::time_out_first; records of before there was this say nothing
  std::string continues;          // id of the session before it in the same operation
  double registers_after_mm = 0;  // OperationSetup::registers_after_mm; 0: somebody was at the pedal
  std::string program_version;
  std::string build;  // build_identity() of the program that recorded it

  // Whether its decisions were recorded: who says of what kind the source was records them, too.
  [[nodiscard]] bool has_journal() const { return source_kind.has_value(); }
};

// Whether it was recorded on another surface of the bone than the one of this hash (bones::mesh_sha256).
// Where either is not known, empty, nothing says so.
[[nodiscard]] inline bool is_of_another_surface(const SessionHeader& header, const std::string& mesh_sha256) {
  return !header.mesh_sha256.empty() && !mesh_sha256.empty() && header.mesh_sha256 != mesh_sha256;
}

// SHA-256 of the running program: the same build gives the same states to the last bit. Computed once.
[[nodiscard]] const std::string& build_identity();

struct SessionEvent {
  std::int64_t timestamp_ns = 0;
  std::string kind;  // "stroke begin", "registration", "tunnel drilled", "note", ...
  std::string text;  // free text or JSON
  std::int64_t after_frame =
      -1;  // index of the last frame before it, -1 before the first; the recorder fills it in
};

// Event kinds that the recorder itself writes and that replay obeys.
inline constexpr std::string_view kPlanEvent = "plan";                  // text: JSON; empty: no plan
inline constexpr std::string_view kRegistrationEvent = "registration";  // text: file name; found here
inline constexpr std::string_view kGivenRegistrationEvent =
    "registration given";                                      // text: file name; from elsewhere
inline constexpr std::string_view kCommandEvent = "command";   // text: operation::Command as JSON
inline constexpr std::string_view kOutcomeEvent = "outcome";   // text: request count of what was taken in
inline constexpr std::string_view kLookEvent = "second look";  // text: index of the frame that was seen again
inline constexpr std::string_view kLookFailedEvent =
    "second look failed";                                            // text: the same, then ": " and why
inline constexpr std::string_view kAlarmEvent = "alarm";             // text: what it says; empty: it is over
inline constexpr std::string_view kVoidEvent = "registration void";  // text: why
inline constexpr std::string_view kVerifiedEvent = "registration verified";
inline constexpr std::string_view kVerificationLostEvent = "verification lost";        // text: why
inline constexpr std::string_view kConfirmedEvent = "registration confirmed";          // text: by what
inline constexpr std::string_view kVerificationSkippedEvent = "verification skipped";  // text: how
inline constexpr std::string_view kTimeOutConfirmedEvent =
    "time-out confirmed";  // text: what was on the screen
inline constexpr std::string_view kBoneMovedEvent =
    "bone moved in the picture";                                         // text: operation::SeenDrift
inline constexpr std::string_view kBoneLooksEvent = "bone looks";        // text: operation::SeenLooks
inline constexpr std::string_view kMediumWrongEvent = "medium wrong";    // text: operation::SeenMedium
inline constexpr std::string_view kGuideCheckedEvent = "guide checked";  // text: how far its tip was off
inline constexpr std::string_view kDrilledEvent = "tunnel drilled";      // text: the file that holds it
inline constexpr std::string_view kDrilledByWordEvent =
    "tunnel drilled by word";  // no pose shows where; text: "femur AM: " and why
inline constexpr std::string_view kDrilledTakenBackEvent =
    "tunnel not drilled";  // text: the file that held it; of older records empty: by word alone
inline constexpr std::string_view kSaidTooEarlyEvent =
    "said too early";  // of a tunnel without a file of this record; text: "femur AM"
inline constexpr std::string_view kMarkerOutEvent =
    "world marker out";  // text: empty, or why it is not after all
inline constexpr std::string_view kSourceStartedEvent = "source started";  // what is before it came earlier
inline constexpr std::string_view kSourceEndedEvent = "source ended";
inline constexpr std::string_view kSourceTroubleEvent =
    "source trouble";  // text: theatre::to_record(); empty: it is over
inline constexpr std::string_view kCommandRefusedEvent = "command refused";     // text: which, and why
inline constexpr std::string_view kTrackerTroubleEvent = "tracker trouble";     // of an outside one; likewise
inline constexpr std::string_view kPicturesKeptEvent = "pictures recorded as";  // text: how, file, why so
inline constexpr std::string_view kLatencyEvent = "latency";  // text: capture to guidance, of all frames
inline constexpr std::string_view kDroppedPicturesEvent = "pictures dropped";    // text: how many
inline constexpr std::string_view kVideoStoppedEvent = "video stopped";          // text: why
inline constexpr std::string_view kRecordingStoppedEvent = "recording stopped";  // text: why

// A registration took effect: found here, or from elsewhere.
[[nodiscard]] inline bool is_registration(const SessionEvent& event) {
  return event.kind == kRegistrationEvent || event.kind == kGivenRegistrationEvent;
}

// How much must stay free on the disk. A video fills disks, the rest of a session takes a megabyte a minute:
// so the video stops first, and the record of poses and events goes on nearly to the end.
struct DiskLimits {
  std::uintmax_t video_stops_below_bytes = std::uintmax_t{2} << 30;
  std::uintmax_t all_stops_below_bytes = std::uintmax_t{128} << 20;
  // What is free where a folder lies; for tests another than the system's answer.
  std::function<std::uintmax_t(const std::filesystem::path& folder)> free_bytes = files::free_bytes_at;
};

// Writes while the operation goes on. Calls hand over to a writer thread by a bounded, lossless queue (half a
// minute of frames at 60 a second); a disk that hangs for longer makes a call wait, or ends the record, as
// never_wait() says; the writer commits at least twice a second. Pictures go through a queue and a thread of
// their own. An error of the disk reaches the next call, or finish(), as IoError; such a session is never
// finished. Where the video alone cannot be written the video ends, and nothing else: video_trouble() and the
// session say why (kVideoStoppedEvent), and no call throws.
//
// Free space is looked at with every commit. When it runs short the video ends likewise, and before the disk
// is full the whole record: what was made is committed, and the next call says so as IoError. finish() then
// still completes the session. Pictures that come after the end of the video are left out and counted.
//
// Threads: one thread at a time calls the recorder. States: writing -> finished.
class SessionRecorder {
 public:
  // The folder exists and is empty. Writes session.json, camera.json and tools.json at once. Throws IoError.
  SessionRecorder(const std::filesystem::path& folder, const SessionHeader& header,
                  const pipeline::PipelineOptions& options, const DiskLimits& limits = {});
  ~SessionRecorder();  // finish() unless it was called; errors are then lost
  SessionRecorder(const SessionRecorder&) = delete;
  SessionRecorder& operator=(const SessionRecorder&) = delete;

  // Keeps the video of a file source: copies it (or every still of a printf pattern) as it is. Waits for the
  // disk; where it takes no copy, or has no room beside what DiskLimits keep free of a video, that is
  // video_trouble(), and what was said of the video before stands.
  void copy_video(const std::filesystem::path& video_or_pattern);
  // Keeps only where the video is.
  void refer_to_video(const std::filesystem::path& video_or_pattern);
  // From now on no call but finish() and the destructor waits for the disk: the one that finds the queue full
  // throws IoError, and the record has ended. For live sources, whose guidance waits for nothing.
  void never_wait();
  // So it has ended: the disk has taken nothing for long, and finish() and the destructor wait until it does.
  [[nodiscard]] bool is_stuck() const;
  // How append_picture() keeps them: without a call, Lossless. Of the source its packets count, and how many
  // pictures a second encoded files say they have, for players. Before the first.
  void keep_pictures(PicturesAs as, const sources::SourceInfo& source = {});
  // The frame's picture, for sources that are not files (see picture_writer.h).
  // Waits while half a second of pictures is waiting: for sources that can wait.
  void append_picture(const camera::FramePtr& frame);
  // The same for a live source: never waits; false when the encoder cannot keep up and the picture is left
  // out. How many were left out is an event of the session.
  bool try_append_picture(const camera::FramePtr& frame);
  // Whether pictures are not taken any more, and why: the disk is nearly full, or they could not be written.
  // Empty: they are.
  [[nodiscard]] bool has_stopped_video() const;
  [[nodiscard]] std::string video_trouble() const;
  // Of what comes between the last picture and the next one nothing is kept, also where a stream is kept as
  // it came.
  void interrupt_pictures();

  void append(const pipeline::FrameResult& result);
  // What the operation had come to after the frame that was appended last: see operation::digest_of_frame().
  struct StateDigests {
    std::uint64_t frame = 0, decisions = 0;
  };
  void append_digests(const StateDigests& digests);
  // How long the frame that was appended last had taken to each of these, ms; below 0: not known.
  struct Latency {
    double capture_ms = -1, decode_ms = -1, queue_ms = -1, tracking_ms = -1, operation_ms = -1,
           guidance_ms = -1;
  };
  void append_latency(const Latency& latency);
  void add_event(const SessionEvent& event);
  // A file of the record, written by `write` in the writer's thread, before whatever is told after it.
  void add_file(std::function<void()> write);
  // What guidance is computed from, from the next frame on. at_ns: when, on the pictures' clock; nullopt:
  // with the newest frame.
  void set_plan(const std::optional<tunnels::Tunnel>& plan, double planned_length_mm,
                std::optional<std::int64_t> at_ns = std::nullopt);
  void set_registration(const registration::RegistrationSummary& registration,
                        bool found_in_this_session = true, const registration::Provenance* of = nullptr,
                        std::optional<std::int64_t> at_ns = std::nullopt);
  // Replaces the curves. Kept on disk at once.
  void set_curves(const strokes::Curves& curves);
  // Commits and closes. The open formats are written as frames come, so that this takes the same short time
  // after a minute and after hours, pictures that still wait for the encoder aside. Throws IoError.
  void finish();

  [[nodiscard]] std::filesystem::path folder() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

struct RecordedMarker {
  int id = 0;
  markers::MarkerState state = markers::MarkerState::NotSeen;
};

struct RecordedBody {
  int id = 0;
  geometry::RigidTransform camera_from_body;
};

struct RecordedFrame {
  std::int64_t index = 0, timestamp_ns = 0;
  lens::LensObservation lens;
  bool intrinsics_are_known = false, is_frozen = false;
  std::vector<strokes::PoseRow> poses;
  // Of bodies of several markers, named by their first, where they had a pose. The others' are in `poses`.
  std::vector<RecordedBody> bodies;
  tracker::TrackerPoses outside;        // without an outside tracker: none
  std::vector<RecordedMarker> markers;  // every declared marker: why one has no pose
  bool tip_is_valid = false;
  Eigen::Vector3d tip_in_world_mm = Eigen::Vector3d::Zero();
  guidance::GuidanceNumbers guidance;
  std::optional<SessionRecorder::StateDigests> digests;  // older records have none
};

// An event of an operation whose session is finished already: the surgeon decides after the source has ended,
// too. Throws IoError or InvalidInput.
void append_event(const std::filesystem::path& session_folder, const SessionEvent& event);

// Reads a session, also one that a crash cut off. Throws IoError or InvalidInput.
class RecordedSession {
 public:
  explicit RecordedSession(const std::filesystem::path& folder);
  // A damaged one as far as it is whole, for whoever tells of it and computes nothing with it: problems()
  // says what is missing. Of events and frames it has those before the damage. Throws IoError or InvalidInput
  // where nothing can be told: no folder, no session.json, a record of a newer version.
  [[nodiscard]] static RecordedSession as_far_as_whole(const std::filesystem::path& folder);
  // All but its frames, for whoever goes through them: two hours of them take the best part of a gigabyte.
  // They are read when for_each_frame() comes to them, and frames() throws std::logic_error.
  [[nodiscard]] static RecordedSession without_frames(const std::filesystem::path& folder);
  ~RecordedSession();
  RecordedSession(RecordedSession&&) noexcept;
  RecordedSession& operator=(RecordedSession&&) noexcept;
  // One sentence each, with the file's name; empty: all of it was read.
  [[nodiscard]] const std::vector<std::string>& problems() const;
  [[nodiscard]] bool events_are_whole() const;  // false: what was done after the last of them is not known
  [[nodiscard]] const SessionHeader& header() const;
  [[nodiscard]] bool was_finished() const;  // false: a crash cut it off, or its end cannot be read
  [[nodiscard]] const std::vector<RecordedFrame>& frames() const;
  // Each of them in its order, until `use` says false; then it is false. Without frames it throws IoError or
  // InvalidInput where one cannot be read, after those before it.
  bool for_each_frame(const std::function<bool(const RecordedFrame&)>& use) const;
  [[nodiscard]] std::optional<std::int64_t> first_frame_ns() const;  // nullopt: there is no frame
  [[nodiscard]] const std::vector<SessionEvent>& events() const;     // in the order they were added
  // The plan of a kPlanEvent and the registration of a registration event.
  struct PlanChange {
    std::optional<tunnels::Tunnel> plan;
    double planned_length_mm = 0;
  };
  [[nodiscard]] PlanChange plan_of(const SessionEvent& event) const;
  [[nodiscard]] registration::RegistrationSummary registration_of(const SessionEvent& event) const;
  // Of a video by append_picture(), rising by frames; empty when the video is the source's own: picture =
  // frame.
  [[nodiscard]] const std::vector<KeptPicture>& pictures() const;
  [[nodiscard]] const strokes::Curves& curves() const;
  // The newest; read when it is asked for. Throws IoError or InvalidInput where it cannot be read: the rest
  // can.
  [[nodiscard]] std::optional<registration::RegistrationSummary> registration() const;
  [[nodiscard]] pipeline::PipelineOptions pipeline_options() const;  // to run it again
  [[nodiscard]] std::filesystem::path video() const;                 // empty when none was kept
  [[nodiscard]] std::filesystem::path folder() const;

 private:
  struct State;
  explicit RecordedSession(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

// The recorded pictures with the frame indices and timestamps they had. Throws IoError or InvalidInput;
// InvalidInput when no video was kept. It ends with the last recorded frame, or where the video of a session
// cut off by a crash ends.
[[nodiscard]] std::unique_ptr<sources::FrameSource> open_recorded_video(const RecordedSession& session);

}  // namespace arthronaut::recording
