#include <atomic>
#include <chrono>
#include <cstdio>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "navigation/camera/camera_file.h"
#include "navigation/pipeline/bounded_queue.h"
#include "navigation/recording/picture_writer.h"
#include "navigation/recording/record_writer.h"
#include "navigation/recording/recording_lock.h"
#include "navigation/recording/session.h"
#include "navigation/recording/session_files.h"
#include "navigation/recording/video_files.h"
#include "planning/files/within_folder.h"
#include "planning/geometry/error.h"

namespace arthronaut::recording {

namespace {

constexpr std::size_t kWaitingMessages = 8192;
constexpr auto kCommitEvery =
    std::chrono::milliseconds(400);  // below the half second that the header promises

std::string size_text(std::uintmax_t bytes) {
  char text[32];
  const double mib = static_cast<double>(bytes) / static_cast<double>(1 << 20);
  std::snprintf(text, sizeof text, mib < 1024 ? "%.0f MiB" : "%.1f GiB", mib < 1024 ? mib : mib / 1024);
  return text;
}

}  // namespace

struct SessionRecorder::State {
  State(const std::filesystem::path& to, const SessionHeader& with,
        const pipeline::PipelineOptions& with_options, const DiskLimits& with_limits)
      : folder(to),
        held(std::in_place, to),
        header(with),
        options(with_options),
        limits(with_limits),
        database(SessionDatabase::create(database_file(to))),
        formats(to, with_options.tools),
        hashes(to),
        queue(kWaitingMessages) {}

  void run() {
    try {
      RecordWriter writer(database, formats, hashes, folder, options);
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
  bool watch_disk(RecordWriter& writer) {
    const std::uintmax_t free = limits.free_bytes(folder);
    const std::string few = "only " + size_text(free) + " are free on the disk";
    if (free < limits.video_stops_below_bytes && stop_video(few)) writer.write_event(kVideoStoppedEvent, few);
    if (free >= limits.all_stops_below_bytes) return true;
    writer.write_event(kRecordingStoppedEvent, few);
    error =
        std::make_exception_ptr(IoError(folder, "recording stopped: " + few + "; what was recorded is kept"));
    out_of_space = true;
    queue.close();
    return false;
  }

  // Of the video alone, in any thread. False when it had stopped before: the first reason counts.
  bool stop_video(const std::string& why) {
    const std::lock_guard lock(trouble_mutex);
    if (video_stopped) return false;
    video_trouble = why;
    video_stopped = true;
    return true;
  }

  // A video that cannot be written ends, and nothing else does: that is in the record, since whoever reads it
  // would take the rest for all there was.
  template <typename What>
  void with_video(const What& what) {
    try {
      what();
    } catch (const std::runtime_error& failure) {
      const std::string why = files::within_folder(folder, failure.what());
      if (!stop_video(why)) return;
      SessionEvent event{last_timestamp_ns, std::string(kVideoStoppedEvent), why, last_frame};
      (void)(waits ? queue.push(std::move(event)) : queue.push_at_once(std::move(event)));
    }
  }

  // Whether pictures are still taken; counts those that are not.
  bool takes_pictures() {
    if (video_stopped) ++dropped_count;
    return !video_stopped;
  }

  void send(Message message) {
    if (finished) throw InvalidInput(folder, "", "the session is finished: nothing more can be recorded");
    if (waits) {
      if (!queue.push(std::move(message))) join_and_report();
      return;
    }
    if (queue.try_push(std::move(message))) return;
    if (!is_stuck && queue.is_closed()) join_and_report();  // the writer has ended by itself
    is_stuck = true;
    queue.close();
    throw IoError(folder, "recording stopped: the disk has taken nothing for too long");
  }

  void join_and_report() {
    queue.close();
    if (worker.joinable()) worker.join();
    if (error) std::rethrow_exception(error);
  }

  void send_event(std::string_view kind, std::string text, std::optional<std::int64_t> at_ns = std::nullopt) {
    send(SessionEvent{at_ns.value_or(last_timestamp_ns), std::string(kind), std::move(text), last_frame});
  }

  // The header as it is to be from now on; pictures have a thread of their own.
  template <typename Change>
  void rewrite_header(const Change& change) {
    const std::lock_guard lock(header_mutex);
    change(header);
    (void)queue.push(HeaderFile{header});
  }

  // After the writer's thread has ended: what had to wait until now, and the video as it came.
  void cover_to_end() {
    for (const char* const rows : {kFrameRows, kEventRows, kPictureRows})
      hashes.cover_rows(database, rows, rows_end(database, rows));
    for (const char* const table : {"poses.csv", "guidance.csv"}) hashes.cover_to_end(table);
    for (const std::string& file : copied) hashes.cover_to_end(file);
    hashes.announce_file(kDatabaseFile);
    hashes.close();
  }

  PictureWriter& picture_writer() {
    if (!pictures) {
      PictureNews news;
      news.begun = [this](const VideoPart& part, const camera::Frame& first, const std::string& why) {
        tell_part(part, first, why);
      };
      news.kept = [this](const KeptPicture& picture) { (void)queue.push(picture); };
      news.ended = [this](const VideoPart& part) { (void)queue.push(PartEnded{part.file}); };
      pictures.emplace(folder, keeping, news);
    }
    return *pictures;
  }

  // In the pictures' thread.
  void tell_part(const VideoPart& part, const camera::Frame& first, const std::string& why) {
    rewrite_header([&](SessionHeader& of) {
      const bool is_exact = part.as != PicturesAs::H264;
      of.video_has_exact_luma = is_exact && (of.video_parts.empty() || of.video_has_exact_luma);
      if (of.video_parts.empty()) of.video = part.file;
      of.video_is_reencoded = true;
      of.video_parts.push_back(part);
    });
    (void)queue.push(PartBegun{part.file});
    std::string text = std::string(to_text(part.as)) + " (" + part.codec + "), " + part.file;
    if (!why.empty()) text += ", since " + why;
    (void)queue.push(
        SessionEvent{first.timestamp_ns, std::string(kPicturesKeptEvent), std::move(text), first.index});
  }

  std::filesystem::path folder;
  std::optional<RecordingLock> held;  // until it is finished
  std::mutex header_mutex;
  SessionHeader header;
  pipeline::PipelineOptions options;
  DiskLimits limits;
  SessionDatabase database;  // the writer thread's until it has ended
  OpenFormats formats;       // the same
  SessionHashes hashes;      // the same
  pipeline::BoundedQueue<Message> queue;
  std::thread worker;
  std::exception_ptr error;
  std::mutex trouble_mutex;
  std::string video_trouble;  // why video_stopped
  std::atomic<bool> video_stopped = false;
  bool waits = true, is_stuck = false;  // for the disk
  bool out_of_space = false;  // why there is an error: all was kept; the writer thread's until it has ended
  PictureWriterOptions keeping;
  std::optional<PictureWriter> pictures;
  std::vector<std::string> copied;  // files of a video that was copied
  std::int64_t dropped_count = 0;
  std::int64_t last_frame = -1, last_timestamp_ns = 0;
  int registration_count = 0;
  bool finished = false;
};

SessionRecorder::SessionRecorder(const std::filesystem::path& folder, const SessionHeader& header,
                                 const pipeline::PipelineOptions& options, const DiskLimits& limits)
    : state_(std::make_unique<State>(folder, header, options, limits)) {
  SessionHashes& hashes = state_->hashes;
  hashes.write_file("session.json", [&] { write_session_header(folder, header, options); });
  camera::CalibrationRecord camera;
  if (options.calibrated != nullptr) camera = *options.calibrated;
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
  state_->with_video([&] {
    const std::uintmax_t bytes = video_bytes(video_or_pattern),
                         free = state_->limits.free_bytes(state_->folder),
                         stays_free = state_->limits.video_stops_below_bytes;
    if (free < stays_free || free - stays_free < bytes)
      throw IoError(state_->folder, "not copied: it takes " + size_text(bytes) + ", and of the " +
                                        size_text(free) + " that are free on the disk " +
                                        size_text(stays_free) + " stay free");
    const std::string name = copy_video_into(state_->folder, video_or_pattern);
    state_->copied = video_files(state_->folder, name);
    state_->rewrite_header([&](SessionHeader& header) { header.video = name; });
  });
}

void SessionRecorder::refer_to_video(const std::filesystem::path& video_or_pattern) {
  const std::string name = std::filesystem::absolute(video_or_pattern).string();
  state_->rewrite_header([&](SessionHeader& header) { header.video = name; });
}

void SessionRecorder::never_wait() { state_->waits = false; }

bool SessionRecorder::is_stuck() const { return state_->is_stuck; }

void SessionRecorder::add_file(std::function<void()> write) { state_->send(OtherFile{std::move(write)}); }

void SessionRecorder::keep_pictures(PicturesAs as, const sources::SourceInfo& source) {
  state_->keeping = {.as = as, .packets = source.packets, .frames_per_second = source.frames_per_second};
}

void SessionRecorder::append_picture(const camera::FramePtr& frame) {
  if (!state_->takes_pictures()) return;
  state_->with_video([&] { state_->picture_writer().write(frame); });
}

bool SessionRecorder::try_append_picture(const camera::FramePtr& frame) {
  if (!state_->takes_pictures()) return false;
  bool is_taken = false;
  state_->with_video([&] { is_taken = state_->picture_writer().try_write(frame); });
  state_->dropped_count += is_taken ? 0 : 1;
  return is_taken;
}

bool SessionRecorder::has_stopped_video() const { return state_->video_stopped; }

std::string SessionRecorder::video_trouble() const {
  const std::lock_guard lock(state_->trouble_mutex);
  return state_->video_trouble;
}

void SessionRecorder::interrupt_pictures() {
  if (!state_->pictures) return;
  state_->with_video([this] { state_->pictures->end_part(); });
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

void SessionRecorder::set_plan(const std::optional<tunnels::Tunnel>& plan, double planned_length_mm,
                               std::optional<std::int64_t> at_ns) {
  state_->send_event(kPlanEvent, plan_to_text(plan, planned_length_mm), at_ns);
}

void SessionRecorder::set_registration(const registration::RegistrationSummary& registration,
                                       bool found_in_this_session, const registration::Provenance* of,
                                       std::optional<std::int64_t> at_ns) {
  const std::string name = registration_name(++state_->registration_count);
  state_->send(RegistrationFile{name, registration, of != nullptr ? std::optional(*of) : std::nullopt});
  state_->send_event(found_in_this_session ? kRegistrationEvent : kGivenRegistrationEvent, name, at_ns);
}

void SessionRecorder::set_curves(const strokes::Curves& curves) { state_->send(curves); }

void SessionRecorder::finish() {
  State& s = *state_;
  if (s.finished) return;
  s.waits = true;
  // What pictures still wait is told to the writer of the record, which ends after them.
  if (s.pictures) s.with_video([&s] { s.pictures->finish(); });
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
  if (s.is_stuck) return;  // said at the call that met it; such a record is not finished
  s.cover_to_end();
  s.database.execute("INSERT INTO ending VALUES(1)");
  // Whoever looks at the session must not keep it from ending: its rows are in the chain already.
  if (s.database.seal()) s.hashes.cover_file(kDatabaseFile);
  s.hashes.sync();
  s.held.reset();
}

std::filesystem::path SessionRecorder::folder() const { return state_->folder; }

}  // namespace arthronaut::recording
