#include "navigation/theatre/operation_run.h"

#include <utility>

#include "navigation/pipeline/prefetched_source.h"
#include "navigation/theatre/operation_log.h"
#include "planning/geometry/error.h"

namespace arthronaut::theatre {

using recording::KeepVideo;

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
  auto opened = std::make_unique<pipeline::PrefetchedSource>(source.open, source.patience_s);
  operation_.start_source(source.setup);
  theatre_source_ = source;
  source_ = std::move(opened);
  record_trouble_.clear();
  record_is_due_ = static_cast<bool>(make_session_folder_);
  begin_record();
}

void OperationRun::begin_record() {
  if (!record_is_due_) return;
  record_is_due_ = false;
  try {  // a disk that fails ends the record, never the operation
    const std::filesystem::path folder = make_session_folder_();
    record_ = std::make_unique<recording::OperationRecord>(folder, operation_.setup(), theatre_source_.setup,
                                                           source_->info(), continues_);
    session_folder_ = folder;
    continues_ = folder.filename().string();
    record_->add(std::exchange(early_, {}));
    // Where the video is costs nothing and makes the record one that can be run again.
    if (!source_->info().encoded_file.empty())
      record_->keep_video(KeepVideo::Refer, source_->info().encoded_file);
  } catch (const std::runtime_error& error) {
    record_trouble_ = error.what();
    record_.reset();
  }
}

void OperationRun::write(const std::function<void(recording::OperationRecord&)>& what) {
  if (record_ == nullptr) return;
  try {
    what(*record_);
  } catch (const std::runtime_error& error) {
    record_trouble_ = error.what();
    record_.reset();
  }
}

// What the operation asks for and what it has to tell.
void OperationRun::pass_on() {
  auto requests = operation_.take_requests();
  if (!requests.empty()) registration_->post(std::move(requests));
  auto journal = operation_.take_journal();
  if (journal.empty()) return;
  log_entries(journal);
  for (operation::JournalEntry& entry : journal)
    if (entry.achieved && theatre_source_.truth) entry.achieved->truth = theatre_source_.truth();
  if (record_ != nullptr) return write([&](recording::OperationRecord& record) { record.add(journal); });
  // Before the first source: it goes to the record of that one.
  if (make_session_folder_ && session_folder_.empty() && record_trouble_.empty())
    return void(early_.insert(early_.end(), journal.begin(), journal.end()));
  // After the end of a source: the decision belongs to its record.
  if (session_folder_.empty() || !record_trouble_.empty()) return;
  try {
    recording::append_entries(session_folder_, journal);
  } catch (const std::runtime_error& error) {
    record_trouble_ = error.what();
  }
}

bool OperationRun::follow_registration() {
  const operation::OutcomePtr before = operation_.outcome();
  operation_.take_outcome(registration_->latest());
  operation_.take_look(looks_->latest());
  pass_on();
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
  (void)follow_registration();
  if (next.frame == nullptr) return {nullptr, next.has_ended};
  operation_.process(*next.frame);
  frame_state_ = operation_.state();
  write([&](recording::OperationRecord& record) { record.add_frame(next.frame, *frame_state_, is_live); });
  if (auto look = operation_.take_look_request()) looks_->post(std::move(*look), next.frame);
  pass_on();
  return {next.frame, false};
}

void OperationRun::apply(const operation::Command& command) {
  // The record of what follows goes on with that one's.
  const auto* const resume = std::get_if<operation::ResumeOperation>(&command);
  const bool had_resumed = resume != nullptr && operation_.state()->resumed != nullptr;
  operation_.apply(command);
  if (resume != nullptr && !had_resumed && operation_.state()->resumed != nullptr)
    continues_ = resume->session;
  pass_on();
}

void OperationRun::end_source() {
  if (source_ == nullptr) return;
  operation_.end_source();
  pass_on();
  source_.reset();
  write([&](recording::OperationRecord& record) { record.finish(operation_.strokes_in_use()); });
  record_.reset();
}

KeepVideo OperationRun::way_to_keep() const {
  return source_->info().encoded_file.empty() ? KeepVideo::Encode : KeepVideo::Copy;
}

bool OperationRun::keeps_video() const {
  return record_ != nullptr && (record_->keeps() == KeepVideo::Copy || record_->keeps() == KeepVideo::Encode);
}

void OperationRun::keep_video(bool on) {
  if (source_ == nullptr) return;
  const std::filesystem::path& file = source_->info().encoded_file;
  const KeepVideo otherwise = file.empty() ? KeepVideo::No : KeepVideo::Refer;
  keep_video(on ? way_to_keep() : otherwise, file);
}

void OperationRun::keep_video(KeepVideo keep, const std::filesystem::path& video) {
  write([&](recording::OperationRecord& record) { record.keep_video(keep, video); });
}

const sources::SourceInfo& OperationRun::source_info() const { return source_->info(); }

}  // namespace arthronaut::theatre
