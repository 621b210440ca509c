// Inner header: the operation of a record, run again from its commands, its frames and what the registration
// and the second looks found. For replay, which compares, and for resuming, which wants the last state.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "navigation/operation/operation.h"
#include "navigation/recording/session.h"

namespace arthronaut::recording {

// Where the registrations of the record come from.
enum class Registrations {
  FoundAgain,   // from the strokes, as they were found then; needs the bone
  AsRecorded,   // taken as the record says that they took effect: nothing is computed, none is judged anew
  NotFollowed,  // there are none
};

class Rerun {
 public:
  // bone: for FoundAgain; may be null else.
  Rerun(const operation::OperationSetup& setup, Registrations registrations,
        const operation::SurfaceIndexPtr& bone);

  // The sessions of an operation, oldest first. Each is started, then its frames in order, each after what
  // the record says came before it, then the rest. The session must live until the next start().
  void start(const RecordedSession& session);
  void play_before(std::int64_t frame);
  void play_rest();
  // The picture is that of the record; the state is that of the frame.
  operation::OperationStatePtr process(const camera::Frame& picture, const RecordedFrame& recorded);
  operation::OperationStatePtr process(const RecordedFrame& recorded);
  // All of it, from the record alone. `stops` is asked before every frame; false: it ended it.
  bool run(const RecordedSession& session, const std::function<bool()>& stops = {});

  [[nodiscard]] operation::OperationStatePtr state() { return operation_.state(); }
  [[nodiscard]] const operation::Operation& operation() const { return operation_; }
  // What the operation has said of itself since the session's start.
  [[nodiscard]] const std::vector<operation::JournalEntry>& journal() const { return journal_; }

 private:
  void play_before_source();
  void play(const SessionEvent& event);
  [[nodiscard]] std::int64_t number_of(const SessionEvent& event) const;
  void play_command(const operation::Command& command);
  void play_registration(const SessionEvent& event);
  void play_failed_look(const SessionEvent& event);
  void pass_on();

  Registrations registrations_;
  operation::Operation operation_;
  std::optional<operation::RegistrationWork> work_;
  operation::MediumLookWork look_work_;
  // All there ever were: the record says which was taken.
  std::map<std::int64_t, operation::OutcomePtr> outcomes_;
  std::map<std::int64_t, operation::MediumLookPtr> looks_;  // of this session, by frame
  const RecordedSession* session_ = nullptr;
  pipeline::PipelineOptions pipeline_;  // of the session
  std::size_t next_event_ = 0;
  bool has_journal_ = false;
  std::vector<operation::JournalEntry> journal_;
};

// The sessions before it in the same operation, oldest first. What goes on from one that was cut off holds
// all of it in its own journal: there is none before that. Without their frames (RecordedSession). `missing`
// is told the id of one that is not there.
[[nodiscard]] std::vector<RecordedSession> sessions_before(
    const RecordedSession& session, const std::function<void(const std::string& id)>& missing);
// The set-up of the operation that began with this session; without the bone's surface.
[[nodiscard]] operation::OperationSetup setup_of(const RecordedSession& first);
// What the session resumed before its first source; nullopt: nothing.
[[nodiscard]] std::optional<operation::ResumeOperation> resumed_by(const RecordedSession& session);

}  // namespace arthronaut::recording
