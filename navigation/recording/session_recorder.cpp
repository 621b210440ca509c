#include <atomic>
#include <chrono>
#include <cstdio>
#include <exception>
#include <optional>
#include <thread>
#include <utility>
#include <variant>

#include "navigation/camera/camera_file.h"
#include "navigation/pipeline/bounded_queue.h"
#include "navigation/recording/frame_record.h"
#include "navigation/recording/open_formats.h"
#include "navigation/recording/picture_writer.h"
#include "navigation/recording/session.h"
#include "navigation/recording/session_files.h"
#include "navigation/recording/session_hashes.h"
#include "navigation/recording/video_files.h"
#include "navigation/registration/registration_file.h"
#include "planning/geometry/error.h"

namespace arthronaut::recording {

namespace {

constexpr std::size_t kWaitingMessages = 4096;
constexpr auto kCommitEvery =
    std::chrono::milliseconds(400);  // below the half second that the header promises
constexpr const char* kEncodedVideo = "video.mkv";
constexpr double kEncodedFramesPerSecond = 60;
// Whatever the encoder writes again when the video ends (its size, its length) lies in its first bytes.
constexpr std::int64_t kVideoHead = 65536;

struct EncodedPicture {
  std::int64_t picture = 0, frame = 0;
};
// Files written by the same thread, so that a registration is on disk before the frame that used it.
struct RegistrationFile {
  std::string name;
  registration::RegistrationSummary registration;
  std::optional<registration::Provenance> of;
};
struct HeaderFile {
  SessionHeader header;
};
struct FrameLatency {
  std::int64_t frame = 0;
  SessionRecorder::Latency latency;
};
struct FrameDigests {
  std::int64_t frame = 0;
  SessionRecorder::StateDigests digests;
};
using Message = std::variant<pipeline::FrameResult, SessionEvent, EncodedPicture, RegistrationFile,
                             strokes::Curves, FrameDigests, FrameLatency, HeaderFile>;

std::string gib_text(std::uintmax_t bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f GiB", static_cast<double>(bytes) / static_cast<double>(1 << 30));
  return text;
}

// Carries out messages in the writer thread.
class DatabaseWriter {
 public:
  DatabaseWriter(SessionDatabase& database, OpenFormats& formats, SessionHashes& hashes,
                 std::filesystem::path folder, const pipeline::PipelineOptions& options)
      : database_(database),
        formats_(formats),
        hashes_(hashes),
        folder_(std::move(folder)),
        options_(options),
        frames_(database, options.tools),
        event_(database.prepare("INSERT INTO events(after_frame, timestamp_ns, kind, text) VALUES(?,?,?,?)")),
        picture_(database.prepare("INSERT INTO pictures VALUES(?,?)")),
        digests_(database.prepare("INSERT INTO digests VALUES(?,?,?)")),
        latency_(database.prepare("INSERT INTO latency VALUES(?,?,?,?,?,?,?)")) {}

  void write(const Message& message) {
    if (!in_transaction_) database_.execute("BEGIN");
    in_transaction_ = true;
    std::visit([this](const auto& m) { put(m); }, message);
  }

  void commit() {
    if (in_transaction_) database_.execute("COMMIT");
    in_transaction_ = false;
    formats_.flush();
    // More may still come to be known of the last frame: it waits for the next one.
    hashes_.cover_rows(database_, kFrameRows, last_frame_);
    for (const char* const rows : {kEventRows, kPictureRows})
      hashes_.cover_rows(database_, rows, rows_end(database_, rows));
    for (const char* const table : {"poses.csv", "guidance.csv"}) hashes_.cover_growth(table);
    if (has_pictures_) hashes_.cover_growth(kEncodedVideo, kVideoHead);
    hashes_.sync();
  }

  // An event of the writer's own, after the last frame that was written.
  void write_event(std::string_view kind, std::string text) {
    write(SessionEvent{last_timestamp_ns_, std::string(kind), std::move(text), last_frame_});
  }

 private:
  void put(const pipeline::FrameResult& result) {
    frames_.insert(result);
    formats_.append(result);
    last_frame_ = result.frame_index;
    last_timestamp_ns_ = result.timestamp_ns;
  }
  void put(const SessionEvent& event) {
    event_.bind(1, event.after_frame)
        .bind(2, event.timestamp_ns)
        .bind(3, event.kind)
        .bind(4, event.text)
        .run();
    if (event.kind == kDrilledEvent) hashes_.cover_file(event.text);
  }
  void put(const EncodedPicture& picture) {
    picture_.bind(1, picture.picture).bind(2, picture.frame).run();
    has_pictures_ = true;
  }
  void put(const RegistrationFile& file) {
    const registration::Provenance* of = file.of ? &*file.of : nullptr;
    for (const std::string& name : {file.name, std::string("registration.json")})
      hashes_.write_file(
          name, [&] { registration::write_registration_file(folder_ / name, file.registration, of); });
  }
  void put(const HeaderFile& file) {
    hashes_.write_file("session.json", [&] { write_session_header(folder_, file.header, options_); });
  }
  void put(const FrameDigests& frame) {
    digests_.bind(1, frame.frame)
        .bind(2, static_cast<std::int64_t>(frame.digests.frame))
        .bind(3, static_cast<std::int64_t>(frame.digests.decisions))
        .run();
  }
  void put(const FrameLatency& frame) {
    latency_.bind(1, frame.frame);
    int position = 2;
    const SessionRecorder::Latency& l = frame.latency;
    for (const double ms :
         {l.capture_ms, l.decode_ms, l.queue_ms, l.tracking_ms, l.operation_ms, l.guidance_ms}) {
      ms >= 0 ? latency_.bind(position, ms) : latency_.bind_null(position);
      ++position;
    }
    latency_.run();
  }
  void put(const strokes::Curves& curves) {
    hashes_.write_file("curves.csv", [&] { strokes::write_curves_file(folder_ / "curves.csv", curves); });
  }

  SessionDatabase& database_;
  OpenFormats& formats_;
  SessionHashes& hashes_;
  std::filesystem::path folder_;
  const pipeline::PipelineOptions& options_;
  FrameInserter frames_;
  Statement event_, picture_, digests_, latency_;
  std::int64_t last_frame_ = -1, last_timestamp_ns_ = 0;
  bool in_transaction_ = false, has_pictures_ = false;
};

}  // namespace

struct SessionRecorder::State {
  State(const std::filesystem::path& to, const SessionHeader& with,
        const pipeline::PipelineOptions& with_options, const DiskLimits& with_limits)
      : folder(to),
        header(with),
        options(with_options),
        limits(with_limits),
        database(SessionDatabase::create(database_file(to))),
        formats(to),
        hashes(to),
        queue(kWaitingMessages) {}

  void run() {
    try {
      DatabaseWriter writer(database, formats, hashes, folder, options);
      auto next_commit = std::chrono::steady_clock::now() + kCommitEvery;
      while (!queue.is_drained()) {
        if (const auto message = queue.pop_until(next_commit)) writer.write(*message);
        if (std::chrono::steady_clock::now() < next_commit) continue;
        if (!watch_disk(writer)) break;
        writer.commit();
        next_commit = std::chrono::steady_clock::now() + kCommitEvery;
      }
      writer.commit();
    } catch (...) {
      error = std::current_exception();  // read after the thread has ended
      queue.close();
    }
  }

  // In the writer's thread. False when nothing more may be written.
  bool watch_disk(DatabaseWriter& writer) {
    const std::uintmax_t free = limits.free_bytes(folder);
    if (free < limits.video_stops_below_bytes && !video_stopped.exchange(true))
      writer.write_event(kVideoStoppedEvent, "only " + gib_text(free) + " are free on the disk");
    if (free >= limits.all_stops_below_bytes) return true;
    writer.write_event(kRecordingStoppedEvent, "only " + gib_text(free) + " are free on the disk");
    error = std::make_exception_ptr(IoError(folder, "recording stopped: only " + gib_text(free) +
                                                        " are free on the disk; what was recorded is kept"));
    out_of_space = true;
    queue.close();
    return false;
  }

  // Whether pictures are still taken; counts those that are not.
  bool takes_pictures() {
    if (video_stopped) ++dropped_count;
    return !video_stopped;
  }

  void send(Message message) {
    if (finished) throw InvalidInput(folder, "", "the session is finished: nothing more can be recorded");
    if (!queue.push(std::move(message))) join_and_report();
  }

  void join_and_report() {
    queue.close();
    if (worker.joinable()) worker.join();
    if (error) std::rethrow_exception(error);
  }

  void send_event(std::string_view kind, std::string text) {
    send(SessionEvent{last_timestamp_ns, std::string(kind), std::move(text), last_frame});
  }

  void rewrite_header() { send(HeaderFile{header}); }

  // After the writer's thread has ended: what had to wait until now, and the video as it came.
  void cover_to_end() {
    for (const char* const rows : {kFrameRows, kEventRows, kPictureRows})
      hashes.cover_rows(database, rows, rows_end(database, rows));
    for (const char* const table : {"poses.csv", "guidance.csv"}) hashes.cover_to_end(table);
    if (pictures) hashes.cover_to_end(kEncodedVideo, kVideoHead);
    for (const std::string& file : copied) hashes.cover_to_end(file);
    hashes.close();
  }

  PictureWriter& picture_writer() {
    if (!pictures) {
      pictures.emplace(folder / kEncodedVideo, kEncodedFramesPerSecond);
      header.video = kEncodedVideo;
      header.video_is_reencoded = header.video_has_exact_luma = true;
      rewrite_header();
    }
    return *pictures;
  }

  std::filesystem::path folder;
  SessionHeader header;
  pipeline::PipelineOptions options;
  DiskLimits limits;
  SessionDatabase database;  // the writer thread's until it has ended
  OpenFormats formats;       // the same
  SessionHashes hashes;      // the same
  pipeline::BoundedQueue<Message> queue;
  std::thread worker;
  std::exception_ptr error;
  std::atomic<bool> video_stopped = false;
  bool out_of_space = false;  // why there is an error: all was kept; the writer thread's until it has ended
  std::optional<PictureWriter> pictures;
  std::vector<std::string> copied;  // files of a video that was copied
  std::int64_t picture_count = 0, dropped_count = 0;
  std::int64_t last_frame = -1, last_timestamp_ns = 0;
  int registration_count = 0;
  bool finished = false;
};

std::uintmax_t free_bytes_at(const std::filesystem::path& folder) {
  std::error_code error;
  const std::filesystem::space_info space = std::filesystem::space(folder, error);
  if (error) throw IoError(folder, "cannot tell how much room its disk has: " + error.message());
  return space.available;
}

SessionRecorder::SessionRecorder(const std::filesystem::path& folder, const SessionHeader& header,
                                 const pipeline::PipelineOptions& options, const DiskLimits& limits)
    : state_(std::make_unique<State>(folder, header, options, limits)) {
  SessionHashes& hashes = state_->hashes;
  hashes.write_file("session.json", [&] { write_session_header(folder, header, options); });
  camera::CalibrationRecord camera;
  camera.calibration = options.calibration;
  camera::write_camera_file(folder / "camera.json", camera);
  tools::write_tools_file(folder / "tools.json", options.tools);
  for (const char* const file : {"camera.json", "tools.json"}) hashes.cover_file(file);
  state_->worker = std::thread([state = state_.get()] { state->run(); });
}

SessionRecorder::~SessionRecorder() {
  try {
    finish();
  } catch (const std::exception&) {
    // Said in the header: who wants to know calls finish().
  }
}

void SessionRecorder::copy_video(const std::filesystem::path& video_or_pattern) {
  state_->header.video = copy_video_into(state_->folder, video_or_pattern);
  state_->copied = video_files(state_->folder, state_->header.video);
  state_->rewrite_header();
}

void SessionRecorder::refer_to_video(const std::filesystem::path& video_or_pattern) {
  state_->header.video = std::filesystem::absolute(video_or_pattern).string();
  state_->rewrite_header();
}

void SessionRecorder::append_picture(const camera::FramePtr& frame) {
  if (!state_->takes_pictures()) return;
  state_->picture_writer().write(frame);
  state_->send(EncodedPicture{state_->picture_count++, frame->index});
}

bool SessionRecorder::try_append_picture(const camera::FramePtr& frame) {
  if (!state_->takes_pictures()) return false;
  if (!state_->picture_writer().try_write(frame)) {
    ++state_->dropped_count;
    return false;
  }
  state_->send(EncodedPicture{state_->picture_count++, frame->index});
  return true;
}

void SessionRecorder::append(const pipeline::FrameResult& result) {
  state_->last_frame = result.frame_index;
  state_->last_timestamp_ns = result.timestamp_ns;
  state_->send(result);
}

void SessionRecorder::append_digests(const StateDigests& digests) {
  state_->send(FrameDigests{state_->last_frame, digests});
}

void SessionRecorder::append_latency(const Latency& latency) {
  state_->send(FrameLatency{state_->last_frame, latency});
}

void SessionRecorder::add_event(const SessionEvent& event) {
  SessionEvent placed = event;
  placed.after_frame = state_->last_frame;
  state_->send(std::move(placed));
}

void SessionRecorder::set_plan(const std::optional<tunnels::Tunnel>& plan, double planned_length_mm) {
  state_->send_event(kPlanEvent, plan_to_text(plan, planned_length_mm));
}

void SessionRecorder::set_registration(const registration::RegistrationSummary& registration,
                                       bool found_in_this_session, const registration::Provenance* of) {
  const std::string name = registration_name(++state_->registration_count);
  state_->send(RegistrationFile{name, registration, of != nullptr ? std::optional(*of) : std::nullopt});
  state_->send_event(found_in_this_session ? kRegistrationEvent : kGivenRegistrationEvent, name);
}

void SessionRecorder::set_curves(const strokes::Curves& curves) { state_->send(curves); }

void SessionRecorder::finish() {
  State& s = *state_;
  if (s.finished) return;
  try {
    if (s.dropped_count > 0) s.send_event(kDroppedPicturesEvent, std::to_string(s.dropped_count));
    s.join_and_report();
  } catch (const IoError&) {
    // Said at the call before, where it is the room on the disk: what is there is finished all the same.
    if (!s.out_of_space) {
      s.finished = true;
      throw;
    }
  }
  s.finished = true;
  // A file that was moved or deleted while it is open takes everything without a word.
  if (!std::filesystem::exists(database_file(s.folder)))
    throw IoError(s.folder,
                  "was moved or deleted while it was being recorded; the end of the record is missing");
  s.formats.finish();
  if (s.pictures) s.pictures->finish();
  s.cover_to_end();
  s.database.execute("INSERT INTO ending VALUES(1)");
  s.database.seal();
}

std::filesystem::path SessionRecorder::folder() const { return state_->folder; }

}  // namespace arthronaut::recording
