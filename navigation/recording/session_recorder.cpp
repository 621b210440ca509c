#include <atomic>
#include <chrono>
#include <exception>
#include <optional>
#include <thread>
#include <utility>
#include <variant>

#include "navigation/camera/camera_file.h"
#include "navigation/pipeline/bounded_queue.h"
#include "navigation/recording/frame_record.h"
#include "navigation/recording/picture_writer.h"
#include "navigation/recording/session.h"
#include "navigation/recording/session_files.h"
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

struct EncodedPicture {
  std::int64_t picture = 0, frame = 0;
};
// Files written by the same thread, so that a registration is on disk before the frame that used it.
struct RegistrationFile {
  std::string name;
  registration::RegistrationSummary registration;
  std::optional<registration::Provenance> of;
};
struct FrameDigests {
  std::int64_t frame = 0;
  SessionRecorder::StateDigests digests;
};
using Message = std::variant<pipeline::FrameResult, SessionEvent, EncodedPicture, RegistrationFile,
                             strokes::Curves, FrameDigests>;

// Carries out messages in the writer thread.
class DatabaseWriter {
 public:
  DatabaseWriter(SessionDatabase& database, std::filesystem::path folder)
      : database_(database),
        folder_(std::move(folder)),
        frames_(database),
        event_(database.prepare("INSERT INTO events(after_frame, timestamp_ns, kind, text) VALUES(?,?,?,?)")),
        picture_(database.prepare("INSERT INTO pictures VALUES(?,?)")),
        digests_(database.prepare("INSERT INTO digests VALUES(?,?,?)")) {}

  void write(const Message& message) {
    if (!in_transaction_) database_.execute("BEGIN");
    in_transaction_ = true;
    std::visit([this](const auto& m) { put(m); }, message);
  }

  void commit() {
    if (in_transaction_) database_.execute("COMMIT");
    in_transaction_ = false;
  }

 private:
  void put(const pipeline::FrameResult& result) { frames_.insert(result); }
  void put(const SessionEvent& event) {
    event_.bind(1, event.after_frame)
        .bind(2, event.timestamp_ns)
        .bind(3, event.kind)
        .bind(4, event.text)
        .run();
  }
  void put(const EncodedPicture& picture) { picture_.bind(1, picture.picture).bind(2, picture.frame).run(); }
  void put(const RegistrationFile& file) {
    const registration::Provenance* of = file.of ? &*file.of : nullptr;
    registration::write_registration_file(folder_ / file.name, file.registration, of);
    registration::write_registration_file(folder_ / "registration.json", file.registration, of);
  }
  void put(const FrameDigests& frame) {
    digests_.bind(1, frame.frame)
        .bind(2, static_cast<std::int64_t>(frame.digests.frame))
        .bind(3, static_cast<std::int64_t>(frame.digests.decisions))
        .run();
  }
  void put(const strokes::Curves& curves) { strokes::write_curves_file(folder_ / "curves.csv", curves); }

  SessionDatabase& database_;
  std::filesystem::path folder_;
  FrameInserter frames_;
  Statement event_, picture_, digests_;
  bool in_transaction_ = false;
};

}  // namespace

struct SessionRecorder::State {
  State(const std::filesystem::path& to, const SessionHeader& with,
        const pipeline::PipelineOptions& with_options)
      : folder(to),
        header(with),
        options(with_options),
        database(SessionDatabase::create(database_file(to))),
        queue(kWaitingMessages) {}

  void run() {
    try {
      DatabaseWriter writer(database, folder);
      auto next_commit = std::chrono::steady_clock::now() + kCommitEvery;
      while (!queue.is_drained()) {
        if (const auto message = queue.pop_until(next_commit)) writer.write(*message);
        if (std::chrono::steady_clock::now() < next_commit) continue;
        writer.commit();
        next_commit = std::chrono::steady_clock::now() + kCommitEvery;
      }
      writer.commit();
    } catch (...) {
      error = std::current_exception();  // read after the thread has ended
      queue.close();
    }
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

  void rewrite_header() { write_session_header(folder, header, options); }

  PictureWriter& picture_writer() {
    if (!pictures) {
      pictures.emplace(folder / kEncodedVideo, kEncodedFramesPerSecond);
      header.video = kEncodedVideo;
      header.video_is_reencoded = true;
      rewrite_header();
    }
    return *pictures;
  }

  void write_open_formats() {
    const std::vector<RecordedFrame> frames = read_frames(database);
    std::vector<strokes::PoseRow> rows;
    for (const RecordedFrame& frame : frames) rows.insert(rows.end(), frame.poses.begin(), frame.poses.end());
    strokes::write_poses_file(folder / "poses.csv", rows);
    write_guidance_file(folder / "guidance.csv", frames);
  }

  std::filesystem::path folder;
  SessionHeader header;
  pipeline::PipelineOptions options;
  SessionDatabase database;  // the writer thread's until it has ended
  pipeline::BoundedQueue<Message> queue;
  std::thread worker;
  std::exception_ptr error;
  std::optional<PictureWriter> pictures;
  std::int64_t picture_count = 0, dropped_count = 0;
  std::int64_t last_frame = -1, last_timestamp_ns = 0;
  int registration_count = 0;
  bool finished = false;
};

SessionRecorder::SessionRecorder(const std::filesystem::path& folder, const SessionHeader& header,
                                 const pipeline::PipelineOptions& options)
    : state_(std::make_unique<State>(folder, header, options)) {
  state_->rewrite_header();
  camera::CalibrationRecord camera;
  camera.calibration = options.calibration;
  camera::write_camera_file(folder / "camera.json", camera);
  tools::write_tools_file(folder / "tools.json", options.tools);
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
  state_->rewrite_header();
}

void SessionRecorder::refer_to_video(const std::filesystem::path& video_or_pattern) {
  state_->header.video = std::filesystem::absolute(video_or_pattern).string();
  state_->rewrite_header();
}

void SessionRecorder::append_picture(const camera::FramePtr& frame) {
  state_->picture_writer().write(frame);
  state_->send(EncodedPicture{state_->picture_count++, frame->index});
}

bool SessionRecorder::try_append_picture(const camera::FramePtr& frame) {
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
  const std::string name = "registration_" + std::to_string(++state_->registration_count) + ".json";
  state_->send(RegistrationFile{name, registration, of != nullptr ? std::optional(*of) : std::nullopt});
  state_->send_event(found_in_this_session ? kRegistrationEvent : kGivenRegistrationEvent, name);
}

void SessionRecorder::set_curves(const strokes::Curves& curves) { state_->send(curves); }

void SessionRecorder::finish() {
  if (state_->finished) return;
  if (state_->dropped_count > 0)
    state_->send_event(kDroppedPicturesEvent, std::to_string(state_->dropped_count));
  state_->finished = true;
  state_->join_and_report();
  if (state_->pictures) state_->pictures->finish();
  state_->write_open_formats();
  state_->database.execute("INSERT INTO ending VALUES(1)");
  state_->database.seal();
}

void append_event(const std::filesystem::path& session_folder, const SessionEvent& event) {
  SessionDatabase database = SessionDatabase::open(database_file(session_folder));
  Statement last = database.prepare("SELECT MAX(frame) FROM frames");
  const std::int64_t after = last.step() && !last.is_null(0) ? last.integer(0) : -1;
  Statement insert =
      database.prepare("INSERT INTO events(after_frame, timestamp_ns, kind, text) VALUES(?,?,?,?)");
  insert.bind(1, after).bind(2, event.timestamp_ns).bind(3, event.kind).bind(4, event.text).run();
}

std::filesystem::path SessionRecorder::folder() const { return state_->folder; }

}  // namespace arthronaut::recording
