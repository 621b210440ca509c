#include "navigation/recording/operation_record.h"

#include <arthronaut/version.h>

#include "navigation/recording/finished_session.h"
#include "navigation/recording/session_files.h"
#include "navigation/registration/registration_file.h"
#include "planning/cases/case.h"
#include "planning/files/utc_clock.h"

namespace arthronaut::recording {

namespace {

using operation::JournalEntry;
using operation::JournalKind;

SessionHeader header_of(const std::filesystem::path& folder, const operation::OperationSetup& setup,
                        const operation::SourceSetup& source, const sources::SourceInfo& info,
                        const std::string& continues) {
  SessionHeader header;
  header.id = folder.filename().string();
  header.started_utc = files::utc_now();
  header.bone = source.pipeline.bone;
  header.side = source.pipeline.side;
  header.refractive_index = source.pipeline.refractive_index;
  header.probe_name = source.pipeline.probe_name;
  header.guide_name = source.pipeline.guide_name;
  header.source = info.name;
  header.source_kind = source.kind;
  header.probe_drew_at_start = source.draws;
  header.time_out_first = source.time_out_first;
  header.mesh_sha256 = setup.mesh_sha256;
  header.continues = continues;
  header.registers_after_mm = setup.registers_after_mm.value_or(0);
  header.program_version = kProgramVersion;
  header.build = build_identity();
  return header;
}

std::string_view kind_of(JournalKind kind) {
  switch (kind) {
    case JournalKind::CommandGiven:
      return kCommandEvent;
    case JournalKind::OutcomeTaken:
      return kOutcomeEvent;
    case JournalKind::LookTaken:
      return kLookEvent;
    case JournalKind::LookFailed:
      return kLookFailedEvent;
    case JournalKind::BoneMoved:
      return kBoneMovedEvent;
    case JournalKind::BoneLooks:
      return kBoneLooksEvent;
    case JournalKind::MediumWrong:
      return kMediumWrongEvent;
    case JournalKind::SourceStarted:
      return kSourceStartedEvent;
    case JournalKind::SourceEnded:
      return kSourceEndedEvent;
    case JournalKind::RegistrationInForce:
      return kRegistrationEvent;
    case JournalKind::Alarm:
      return kAlarmEvent;
    case JournalKind::Void:
      return kVoidEvent;
    case JournalKind::Confirmed:
      return kConfirmedEvent;
    case JournalKind::Verified:
      return kVerifiedEvent;
    case JournalKind::VerificationLost:
      return kVerificationLostEvent;
    case JournalKind::VerificationSkipped:
      return kVerificationSkippedEvent;
    case JournalKind::TimeOutConfirmed:
      return kTimeOutConfirmedEvent;
    case JournalKind::GuideChecked:
      return kGuideCheckedEvent;
    case JournalKind::Plan:
      return kPlanEvent;
    case JournalKind::Drilled:
      return kDrilledEvent;
    case JournalKind::DrilledByWord:
      return kDrilledByWordEvent;
    case JournalKind::DrilledTakenBack:
      return kDrilledTakenBackEvent;
    case JournalKind::SaidTooEarly:
      return kSaidTooEarlyEvent;
    case JournalKind::MarkerOut:
      return kMarkerOutEvent;
    case JournalKind::Note:
      return "note";
  }
  return "note";
}

// The tunnel as drilled, or that it was taken back.
void write_achieved(const std::filesystem::path& folder, const JournalEntry& entry) {
  operation::AchievedTunnel achieved = *entry.achieved;
  achieved.is_taken_back = entry.kind == JournalKind::DrilledTakenBack;
  operation::write_achieved_file(folder / operation::achieved_file_name(achieved.planned.key()), achieved);
}

// The next file that no registration of the session has yet.
std::string next_registration_name(const std::filesystem::path& session_folder) {
  for (int number = 1;; ++number)
    if (const std::string name = registration_name(number); !std::filesystem::exists(session_folder / name))
      return name;
}

}  // namespace

std::optional<SessionEvent> event_of(const JournalEntry& entry) {
  if (entry.kind == JournalKind::RegistrationInForce || entry.kind == JournalKind::Plan) return std::nullopt;
  SessionEvent event{entry.timestamp_ns, std::string(kind_of(entry.kind)), entry.text, entry.after_frame};
  if (entry.achieved) event.text = operation::achieved_file_name(entry.achieved->planned.key());
  return event;
}

void append_entries(const std::filesystem::path& session_folder, const std::vector<JournalEntry>& entries) {
  FinishedSession session(session_folder);
  for (const JournalEntry& entry : entries) {
    SessionEvent event{entry.timestamp_ns, "", "", entry.after_frame};
    if (entry.kind == JournalKind::RegistrationInForce) {
      event.kind = entry.registration_was_given ? kGivenRegistrationEvent : kRegistrationEvent;
      event.text = next_registration_name(session_folder);
      for (const std::string& name : {event.text, std::string("registration.json")})
        session.rewrite_file(name, [&] {
          registration::write_registration_file(session_folder / name, *entry.registration, &entry.of);
        });
    } else if (entry.kind == JournalKind::Plan) {
      event.kind = kPlanEvent;
      event.text = entry.plan ? plan_to_text(entry.plan->tunnel, entry.plan->length_mm)
                              : plan_to_text(std::nullopt, 0);
    } else {
      event = *event_of(entry);
    }
    if (entry.achieved)
      session.rewrite_file(operation::achieved_file_name(entry.achieved->planned.key()),
                           [&] { write_achieved(session_folder, entry); });
    session.append_event(event);
  }
  if (!entries.empty()) session.close_database();
}

OperationRecord::OperationRecord(const std::filesystem::path& folder, const operation::OperationSetup& setup,
                                 const operation::SourceSetup& source, const sources::SourceInfo& info,
                                 const std::string& continues, PicturesAs pictures)
    : folder_(folder),
      recorder_(std::make_unique<SessionRecorder>(folder, header_of(folder, setup, source, info, continues),
                                                  source.pipeline)) {
  // A source without any encoding of its own has nothing that could be kept as it came.
  const bool has_none = pictures == PicturesAs::AsTheyCame && info.packets == nullptr;
  recorder_->keep_pictures(has_none ? PicturesAs::Lossless : pictures, info);
}

void OperationRecord::keep_video(KeepVideo keep, const std::filesystem::path& video) {
  if (keep_ == KeepVideo::Encode && keep != KeepVideo::Encode) recorder_->interrupt_pictures();
  keep_ = keep;
  copied_video_ = keep == KeepVideo::Copy ? video : std::filesystem::path();
  // A record that is cut off can be run again by where the video is.
  if (keep == KeepVideo::Refer || keep == KeepVideo::Copy) recorder_->refer_to_video(video);
}

void OperationRecord::add(const std::vector<JournalEntry>& entries) {
  for (const JournalEntry& entry : entries) {
    if (entry.kind == JournalKind::RegistrationInForce)
      recorder_->set_registration(*entry.registration, !entry.registration_was_given, &entry.of,
                                  entry.timestamp_ns);
    if (entry.kind == JournalKind::Plan)
      recorder_->set_plan(entry.plan ? std::optional(entry.plan->tunnel) : std::nullopt,
                          entry.plan ? entry.plan->length_mm : 0, entry.timestamp_ns);
    if (entry.achieved) recorder_->add_file([folder = folder_, entry] { write_achieved(folder, entry); });
    if (const auto event = event_of(entry)) recorder_->add_event(*event);
  }
}

void OperationRecord::add_frame(const camera::FramePtr& picture, const operation::OperationState& state,
                                bool is_live) {
  recorder_->append(state.frame);
  recorder_->append_digests({operation::digest_of_frame(state), operation::digest_of_decisions(state)});
  if (keep_ != KeepVideo::Encode) return;
  // Left out are pictures of a live source that the encoder can't keep up with; the record counts them.
  if (is_live)
    (void)recorder_->try_append_picture(picture);
  else
    recorder_->append_picture(picture);
  // Whoever asks whether video is kept must not be told that it is.
  if (recorder_->has_stopped_video()) keep_video(KeepVideo::No);
}

void OperationRecord::finish(const strokes::Curves& strokes) {
  if (!strokes.empty()) recorder_->set_curves(strokes);
  if (!copied_video_.empty()) recorder_->copy_video(copied_video_);
  recorder_->finish();
}

}  // namespace arthronaut::recording
