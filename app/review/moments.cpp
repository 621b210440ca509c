#include "app/review/moments.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "navigation/operation/command.h"
#include "navigation/operation/seen_drift.h"
#include "planning/files/format.h"
#include "planning/geometry/error.h"

namespace arthronaut::review {

namespace {

using recording::SessionEvent;

constexpr std::array<std::string_view, 6> kSteps{
    recording::kRegistrationEvent,     recording::kVerifiedEvent, recording::kConfirmedEvent,
    recording::kTimeOutConfirmedEvent, recording::kDrilledEvent,  recording::kDrilledTakenBackEvent};
constexpr std::array<std::string_view, 6> kAlarms{recording::kVoidEvent,
                                                  recording::kVerificationLostEvent,
                                                  recording::kVerificationSkippedEvent,
                                                  recording::kDroppedPicturesEvent,
                                                  recording::kVideoStoppedEvent,
                                                  recording::kRecordingStoppedEvent};

template <typename List>
bool holds(const List& list, std::string_view kind) {
  return std::find(list.begin(), list.end(), kind) != list.end();
}

std::string capitalised(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

// A line that this program does not know (a newer one wrote it) is shown by its kind alone.
std::string command_words(const SessionEvent& event) {
  try {
    const operation::Command command = operation::command_from_text(event.text, "the record");
    std::string words(operation::name_of(command));
    if (const auto* draw = std::get_if<operation::Draw>(&command)) words += draw->on ? ", on" : ", off";
    if (const auto* stop = std::get_if<operation::ReadDepthStop>(&command))
      words += ", " + std::to_string(std::lround(stop->depth_mm)) + " mm";
    if (const auto* exclude = std::get_if<operation::ExcludeStroke>(&command))
      words += " " + std::to_string(exclude->curve) + (exclude->is_excluded ? "" : ", taken in again");
    return "Command: " + words;
  } catch (const InvalidInput&) {
    return "Command that this version does not know";
  }
}

std::string drift_words(const SessionEvent& event) {
  try {
    const double drift_mm = operation::seen_drift_from_text(event.text, "the record").drift_mm;
    return capitalised(event.kind) + files::format(" by %.1f mm", drift_mm);
  } catch (const InvalidInput&) {
    return capitalised(event.kind);
  }
}

Moment moment_of(const SessionEvent& event) {
  if (event.kind == recording::kCommandEvent) return {0, MomentKind::Command, command_words(event)};
  if (event.kind == recording::kAlarmEvent) {
    return event.text.empty() ? Moment{0, MomentKind::Step, "Alarm is over"}
                              : Moment{0, MomentKind::Alarm, "Alarm: " + event.text};
  }
  if (event.kind == recording::kBoneMovedEvent) return {0, MomentKind::Note, drift_words(event)};
  if (event.kind == recording::kPlanEvent)
    return {0, MomentKind::Note, event.text.empty() ? "No plan in force" : "Plan in force"};
  const MomentKind kind = holds(kSteps, event.kind)    ? MomentKind::Step
                          : holds(kAlarms, event.kind) ? MomentKind::Alarm
                                                       : MomentKind::Note;
  // The texts of registrations and tunnels are names of files.
  const bool is_file =
      event.kind == recording::kRegistrationEvent || event.kind == recording::kGivenRegistrationEvent ||
      event.kind == recording::kDrilledEvent || event.kind == recording::kDrilledTakenBackEvent;
  return {0, kind,
          capitalised(event.kind) + (is_file || event.text.empty() ? std::string() : ": " + event.text)};
}

}  // namespace

std::vector<Moment> moments_of(const std::vector<SessionEvent>& events,
                               const recording::SessionTimeline& timeline) {
  std::vector<Moment> moments;
  std::optional<std::string> plan;  // in force: an operation says it again when its source starts
  for (const SessionEvent& event : events) {
    if (event.kind == recording::kOutcomeEvent || event.kind == recording::kLookEvent) continue;
    if (event.kind == recording::kPlanEvent && std::exchange(plan, event.text) == event.text) continue;
    Moment moment = moment_of(event);
    moment.frame = timeline.at_index(event.after_frame);
    moments.push_back(std::move(moment));
  }
  return moments;
}

std::vector<std::size_t> frames_to_jump_to(const std::vector<Moment>& moments,
                                           const recording::SessionMarks& marks,
                                           const recording::SessionTimeline& timeline) {
  std::vector<std::size_t> frames;
  for (const Moment& moment : moments) frames.push_back(moment.frame);
  for (const recording::SessionMark& mark : marks) frames.push_back(timeline.at_index(mark.frame));
  std::sort(frames.begin(), frames.end());
  frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
  return frames;
}

std::optional<std::size_t> moment_before(const std::vector<std::size_t>& frames, std::size_t frame) {
  const auto at = std::lower_bound(frames.begin(), frames.end(), frame);
  return at == frames.begin() ? std::nullopt : std::optional(*std::prev(at));
}

std::optional<std::size_t> moment_after(const std::vector<std::size_t>& frames, std::size_t frame) {
  const auto at = std::upper_bound(frames.begin(), frames.end(), frame);
  return at == frames.end() ? std::nullopt : std::optional(*at);
}

}  // namespace arthronaut::review
