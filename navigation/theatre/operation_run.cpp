#include "navigation/theatre/operation_run.h"

#include <algorithm>
#include <utility>

#include "navigation/pipeline/prefetched_source.h"
#include "navigation/sources/capture_time.h"
#include "navigation/theatre/operation_log.h"
#include "planning/files/format.h"
#include "planning/geometry/error.h"
#include "planning/log/log.h"

namespace arthronaut::theatre {

using recording::KeepVideo;

namespace {

// A hand rests about as long before it presses, and pictures that come ten times a second are not as old.
constexpr double kHandRests_ms = 300;

bool begins_to_draw(const operation::Command& command) {
  const auto* const draw = std::get_if<operation::Draw>(&command);
  return draw != nullptr && draw->on;
}
bool is_touch(const operation::Command& command) {
  return std::holds_alternative<operation::TakeTouch>(command) ||
         std::holds_alternative<operation::TouchControlPoint>(command) ||
         std::holds_alternative<operation::CheckGuide>(command);
}
bool is_of_this_moment(const operation::Command& command) {
  return begins_to_draw(command) || is_touch(command);
}

// What ends an operation, or takes its end back.
bool is_of_the_end(const operation::JournalEntry& entry) {
  return entry.kind == operation::JournalKind::MarkerOut ||
         entry.kind == operation::JournalKind::SaidTooEarly;
}

}  // namespace

OperationRun::OperationRun(const operation::OperationSetup& setup,
                           std::unique_ptr<RegistrationService> registration,
                           MakeSessionFolder make_session_folder, std::unique_ptr<MediumLookService> looks)
    : operation_(setup),
      registration_(std::move(registration)),
      looks_(std::move(looks)),
      make_session_folder_(std::move(make_session_folder)) {}

OperationRun::~OperationRun() { end_source(); }

void OperationRun::start(const TheatreSource& source) {
  end_source();
  // Its poses are of now: what a file or a simulation shows is of another time.
  const bool is_live = source.setup.kind == sources::SourceKind::Live;
  if (source.setup.pipeline.tools.tracker && (!is_live || !source.tracker))
    throw InvalidInput(
        is_live ? "the tools are seen by an outside tracker, and nobody says where it is"
                : "the tools are seen by an outside tracker, which tells where they are now: only a live "
                  "source goes with it");
  // All that may throw comes first: a source that has begun for the operation must be one that ends.
  auto opened = std::make_unique<pipeline::PrefetchedSource>(source.open, source.patience_s);
  std::unique_ptr<tracker::PoseSource> tracker;
  if (source.setup.pipeline.tools.tracker) tracker = source.tracker();
  operation_.start_source(source.setup);
  theatre_source_ = source;
  source_ = std::move(opened);
  live_ = Live();
  live_.watch = SourceWatch(1000 * late_after_s_);
  frame_state_ = nullptr;  // what is told before its first frame has no time of the source before it
  refusal_.words.clear();
  outside_.tracker = std::move(tracker);
  record_trouble_.clear();
  video_trouble_.clear();
  record_is_due_ = static_cast<bool>(make_session_folder_);
  begin_record();
}

void OperationRun::begin_record() {
  if (!record_is_due_) return;
  record_is_due_ = false;
  try {  // a disk that fails ends the record, never the operation
    const std::filesystem::path folder = make_session_folder_();
    record_ = std::make_unique<recording::OperationRecord>(folder, operation_.setup(), theatre_source_.setup,
                                                           source_->info(), continues_, pictures_as_);
    if (theatre_source_.setup.kind == sources::SourceKind::Live) record_->never_wait();
    session_folder_ = folder;
    continues_ = folder.filename().string();
    record_->add(std::exchange(early_, {}));
    record_->keep_video(way_to_keep(), source_->info().encoded_file);
  } catch (const std::runtime_error& error) {
    record_trouble_ = error.what();
    record_.reset();
  }
}

template <typename What>
void OperationRun::write(const What& what) {
  if (record_ == nullptr) return;
  try {
    what(*record_);
    if (video_trouble_.empty()) video_trouble_ = record_->video_trouble();
  } catch (const std::runtime_error& error) {
    record_trouble_ = error.what();
    // Its end encodes, hashes and waits for a disk that is in trouble.
    ending_.take(std::move(record_));
  }
}

// What the operation asks for and what it has to tell.
void OperationRun::pass_on(std::int64_t since_picture_ns) {
  auto requests = operation_.take_requests();
  if (!requests.empty()) registration_->post(std::move(requests));
  auto journal = operation_.take_journal();
  if (journal.empty()) return;
  log_entries(journal);
  for (operation::JournalEntry& entry : journal) {
    if (entry.achieved && theatre_source_.truth) entry.achieved->truth = theatre_source_.truth();
    entry.timestamp_ns += since_picture_ns;
  }
  if (record_ != nullptr) return write([&](recording::OperationRecord& record) { record.add(journal); });
  // Before the first source: it goes to the record of that one.
  const bool is_early = session_folder_.empty();
  const std::filesystem::path& folder = is_early ? left_folder_ : session_folder_;
  if (make_session_folder_ && is_early && record_trouble_.empty()) {
    const auto early = std::ranges::stable_partition(
        journal, [&](const auto& entry) { return !folder.empty() && is_of_the_end(entry); });
    early_.insert(early_.end(), early.begin(), early.end());
    journal.erase(early.begin(), early.end());
  }
  // After the end of a source: the decision belongs to its record.
  if (folder.empty() || !record_trouble_.empty()) return;
  try {
    recording::append_entries(folder, journal);
  } catch (const std::runtime_error& error) {
    record_trouble_ = error.what();
  }
}

bool OperationRun::follow_registration() {
  const operation::OutcomePtr before = operation_.outcome();
  operation_.take_outcome(registration_->latest());
  operation_.take_look(looks_->latest());
  operation_.heed_pictures();
  pass_on(silence_ns());
  return operation_.outcome() != before;
}

OperationRun::Step OperationRun::step() {
  constexpr double kWait_s = 0.1;
  const bool is_live = theatre_source_.setup.kind == sources::SourceKind::Live;
  pipeline::NextFrame next;
  if (is_live) {
    next = source_->next_within(kWait_s);
  } else {
    next.frame = source_->next();
    next.has_ended = next.frame == nullptr;
  }
  const std::int64_t taken_ns = sources::steady_now_ns();
  (void)follow_registration();
  if (next.frame == nullptr) {
    if (is_live && !next.has_ended &&
        live_.watch.silence(source_->trouble(), taken_ns, source_->changed_to_px()))
      note_trouble(silence_ns());
    return {nullptr, next.has_ended};
  }
  live_.taken_ns = taken_ns;
  live_.is_news = false;
  const tracker::TrackerPoses* const outside = ask_tracker();
  if (is_live)
    operation_.process(*next.frame, outside,
                       [this, &frame = *next.frame](const auto& view) { return timing_of(frame, view); });
  else
    operation_.process(*next.frame, outside);
  frame_state_ = operation_.state();
  if (theatre_source_.watch) theatre_source_.watch(*frame_state_);
  measure(*next.frame, taken_ns);
  write([&](recording::OperationRecord& record) { record.add_frame(next.frame, *frame_state_, is_live); });
  if (is_live) {
    write([&](recording::OperationRecord& record) {
      const FrameLatency& l = live_.newest;
      record.add_latency(
          {l.capture_ms, l.decode_ms, l.queue_ms, l.tracking_ms, l.operation_ms, l.guidance_ms});
    });
    if (live_.is_news) note_trouble();
  }
  if (auto look = operation_.take_look_request()) looks_->post(std::move(*look), next.frame);
  pass_on();
  return {next.frame, false};
}

// As of now, which is as late as can be.
const tracker::TrackerPoses* OperationRun::ask_tracker() {
  if (outside_.tracker == nullptr) return nullptr;
  outside_.asked_ns = sources::steady_now_ns();
  outside_.tracker->poses_at(outside_.asked_ns, outside_.poses);
  note_tracker();
  return &outside_.poses;
}

double OperationRun::oldest_pose_s(double else_s) const {
  if (outside_.tracker == nullptr) return else_s;
  return static_cast<double>(outside_.asked_ns) * 1e-9 - outside_.poses.oldest_age_s();
}

double OperationRun::content_s(double captured_s) const {
  if (theatre_source_.setup.kind != sources::SourceKind::Live || frame_state_ == nullptr) return captured_s;
  return captured_s - static_cast<double>(frame_state_->frame.shown_for_ns) * 1e-9;
}

// In the record and the log, when it begins, changes and ends.
void OperationRun::note_tracker() {
  std::string trouble = outside_.tracker->trouble();
  if (trouble == outside_.trouble) return;
  outside_.trouble = std::move(trouble);
  const std::int64_t at_ns = frame_state_ != nullptr ? frame_state_->frame.timestamp_ns : 0;
  log::info("tracker: " + (outside_.trouble.empty() ? "all is well" : outside_.trouble));
  write([&](recording::OperationRecord& record) {
    record.add_event(recording::kTrackerTroubleEvent, outside_.trouble, at_ns);
  });
}

// Of a picture whose numbers are just known. What is shown is as old as the oldest thing in it.
operation::PictureTiming OperationRun::timing_of(const camera::Frame& frame,
                                                 const pipeline::PictureObservation& view) {
  const std::int64_t now_ns = sources::steady_now_ns();
  const bool is_dated = frame.captured_ns > 0 && now_ns >= frame.captured_ns;
  const double guidance_ms = is_dated ? static_cast<double>(now_ns - frame.captured_ns) * 1e-6 : -1;
  live_.watch.received(is_dated && frame.received_ns > 0
                           ? static_cast<double>(frame.received_ns - frame.captured_ns) * 1e-6
                           : -1);
  live_.is_news = live_.watch.picture(view, guidance_ms, live_.taken_ns, source_->remark());
  if (live_.watch.trouble() == SourceTrouble::Slow) return operation::PictureTiming::Slow;
  const double now_s = static_cast<double>(now_ns) * 1e-9;
  const double captured_s = is_dated ? static_cast<double>(frame.captured_ns) * 1e-9 : now_s;
  const double oldest_s =
      std::min(captured_s - static_cast<double>(view.shown_for_ns) * 1e-9, oldest_pose_s(captured_s));
  const bool is_late = now_s - oldest_s > late_after_s_ || guidance_ms > 1000 * late_after_s_;
  return is_late ? operation::PictureTiming::Late : operation::PictureTiming::InTime;
}

void OperationRun::measure(const camera::Frame& frame, std::int64_t taken_ns) {
  const std::int64_t ready_ns = sources::steady_now_ns();
  const auto between_ms = [](std::int64_t from_ns, std::int64_t to_ns) {
    return from_ns > 0 && to_ns >= from_ns ? static_cast<double>(to_ns - from_ns) * 1e-6 : -1;
  };
  FrameLatency& newest = live_.newest;
  newest.frame = frame.index;
  newest.capture_ms = between_ms(frame.captured_ns, frame.received_ns);
  newest.decode_ms = between_ms(frame.received_ns, frame.decoded_ns);
  newest.queue_ms = between_ms(frame.decoded_ns, taken_ns);
  newest.tracking_ms = frame_state_->frame.processing_ms;
  newest.operation_ms = between_ms(taken_ns, ready_ns) - newest.tracking_ms;
  newest.guidance_ms = between_ms(frame.captured_ns, ready_ns);
  live_.meter.add(newest);
  live_.captured_ns = frame.captured_ns;
  const pipeline::FrameResult& result = frame_state_->frame;
  if (!result.is_blank && !result.is_frozen)
    live_.showed_ns = frame.captured_ns > 0 ? frame.captured_ns : taken_ns;
}

// In the record and the log, when it begins, changes and ends.
void OperationRun::note_trouble(std::int64_t since_picture_ns) {
  const std::int64_t at_ns =
      frame_state_ != nullptr ? frame_state_->frame.timestamp_ns + since_picture_ns : 0;
  if (live_.watch.words().empty())
    log::info("source: all is well again");
  else
    log::warning("source: " + live_.watch.words());
  write([&](recording::OperationRecord& record) {
    record.add_event(recording::kSourceTroubleEvent, to_record(live_.watch.trouble(), live_.watch.words()),
                     at_ns);
  });
}

double OperationRun::picture_age_ms() const {
  const bool is_live = has_source() && theatre_source_.setup.kind == sources::SourceKind::Live;
  if (!is_live || live_.captured_ns <= 0) return -1;
  return static_cast<double>(sources::steady_now_ns() - live_.captured_ns) * 1e-6;
}

std::int64_t OperationRun::silence_ns() const {
  // A recording and a simulation tell the time by their pictures alone; once these have ended, a clock does.
  const bool is_live = theatre_source_.setup.kind == sources::SourceKind::Live;
  if (!is_live && live_.ended_ns > 0) return since_ns(live_.ended_ns);
  if (theatre_source_.setup.kind != sources::SourceKind::Live || live_.taken_ns <= 0) return 0;
  return since_ns(live_.captured_ns > 0 ? live_.captured_ns : live_.taken_ns);
}

std::int64_t OperationRun::unseen_ns() const {
  if (theatre_source_.setup.kind != sources::SourceKind::Live || live_.showed_ns <= 0) return silence_ns();
  return since_ns(live_.showed_ns);
}

std::int64_t OperationRun::since_ns(std::int64_t captured_ns) const {
  const std::int64_t since_ns = sources::steady_now_ns() - captured_ns;
  return since_ns > static_cast<std::int64_t>(1e6 * kHandRests_ms) ? since_ns : 0;
}

std::string OperationRun::wrong_with_picture() const {
  const SourceTrouble trouble = live_.watch.trouble();
  return shows_nothing(trouble) ? std::string(to_text(trouble)) : "";
}

void OperationRun::apply(const operation::Command& given) {
  const std::int64_t since_picture_ns = silence_ns();
  operation::Command command = given;
  // The pictures of one that has ended showed what they showed until they failed to come, or showed nothing.
  if (auto* const drilled = std::get_if<operation::TunnelDrilled>(&command))
    drilled->without_picture_s =
        static_cast<double>(has_source() ? unseen_ns() : live_.unseen_at_end_ns) * 1e-9;
  if (auto* const out = std::get_if<operation::MarkerOut>(&command); out && has_source())
    out->without_picture_s = static_cast<double>(unseen_ns()) * 1e-9;
  if (auto* const time_out = std::get_if<operation::ConfirmTimeOut>(&command); time_out && has_source())
    time_out->beside = wrong_with_picture();
  if (const double age_ms = picture_age_ms(); age_ms > kHandRests_ms && is_of_this_moment(command)) {
    const std::string text = files::format("%s: the newest picture is %.0f ms old",
                                           std::string(operation::name_of(command)).c_str(), age_ms);
    log::warning("refused: " + text);
    write([&](recording::OperationRecord& record) {
      record.add_event(recording::kCommandRefusedEvent, text,
                       frame_state_->frame.timestamp_ns + since_picture_ns);
    });
    ++refusal_.count;
    const bool is_of_guide = std::holds_alternative<operation::CheckGuide>(command);
    refusal_.words = files::format("%s: picture %.1f s old",
                                   begins_to_draw(command) ? "not drawing"
                                   : is_of_guide           ? "guide not checked"
                                                           : "no touch",
                                   age_ms / 1000);
    return;
  }
  // The record of what follows goes on with that one's.
  const auto* const resume = std::get_if<operation::ResumeOperation>(&command);
  const bool had_resumed = resume != nullptr && operation_.state()->resumed != nullptr;
  operation_.apply(command);
  if (is_of_this_moment(command)) refusal_.words.clear();
  const bool may_be_refused = is_touch(command) || std::holds_alternative<operation::MarkerOut>(command);
  if (may_be_refused && operation_.state()->touch_refusal != operation::TouchRefusal::None) ++refusal_.count;
  if (resume != nullptr && !had_resumed && operation_.state()->resumed != nullptr)
    continues_ = resume->session;
  pass_on(since_picture_ns);
}

void OperationRun::end_source() {
  if (source_ == nullptr) return;
  live_.unseen_at_end_ns = unseen_ns();
  const std::int64_t silent_at_end_ns = silence_ns();
  operation_.end_source();
  pass_on(silent_at_end_ns);
  live_.ended_ns = sources::steady_now_ns();
  const bool was_live = theatre_source_.setup.kind == sources::SourceKind::Live;
  source_.reset();
  outside_ = {};
  if (const StageLatency all = of(live_.meter.report(), Stage::ToGuidance); was_live && all.count > 0) {
    const std::string text = files::format(
        "%.1f ms from capture to guidance in the median, 99 %% within %.1f ms, at worst %.1f ms; %llu "
        "pictures",
        all.median_ms, all.p99_ms, all.worst_ms, static_cast<unsigned long long>(all.count));
    log::info("latency: " + text);
    write([&](recording::OperationRecord& record) { record.add_event(recording::kLatencyEvent, text, 0); });
  }
  write([&](recording::OperationRecord& record) { record.finish(operation_.strokes_in_use()); });
  record_.reset();
}

// Where the video is costs nothing and makes the record one that can be run again.
KeepVideo OperationRun::way_to_keep() const {
  const bool is_file = !source_->info().encoded_file.empty();
  if (video_is_wanted_) return is_file ? KeepVideo::Copy : KeepVideo::Encode;
  return is_file ? KeepVideo::Refer : KeepVideo::No;
}

bool OperationRun::keeps_video() const {
  return record_ != nullptr && (record_->keeps() == KeepVideo::Copy || record_->keeps() == KeepVideo::Encode);
}

void OperationRun::keep_video(bool on) {
  video_is_wanted_ = on;
  if (source_ != nullptr) keep_video(way_to_keep(), source_->info().encoded_file);
}

void OperationRun::keep_video(KeepVideo keep, const std::filesystem::path& video) {
  write([&](recording::OperationRecord& record) { record.keep_video(keep, video); });
}

}  // namespace arthronaut::theatre
