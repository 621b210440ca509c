#include "app/review/moments.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include "navigation/operation/command.h"
#include "navigation/operation/seen_drift.h"
#include "planning/files/format.h"
#include "planning/geometry/error.h"

namespace arthronaut::review {

namespace {

using recording::SessionEvent;

std::string capitalised(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

// A line that this program does not know (a newer one wrote it) is shown by its kind alone.
std::string command_words(const SessionEvent& event) {
  try {
    const operation::Command command = operation::command_from_text(event.text, "the record");
    std::string words(operation::name_of(command));
    if (const auto* draw = std::get_if<operation::Draw>(&command))
      words = draw->on ? "probe draws" : "probe stops drawing";
    if (const auto* stop = std::get_if<operation::ReadDepthStop>(&command))
      words += ", " + std::to_string(std::lround(stop->depth_mm)) + " mm";
    if (const auto* exclude = std::get_if<operation::ExcludeStroke>(&command))
      words += " " + std::to_string(exclude->curve) + (exclude->is_excluded ? "" : ", taken in again");
    return "Asked for: " + words;
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

MomentKind kind_of(recording::Gravity gravity) {
  switch (gravity) {
    case recording::Gravity::Step:
      return MomentKind::Step;
    case recording::Gravity::Alarm:
      return MomentKind::Alarm;
    case recording::Gravity::Note:
      return MomentKind::Note;
  }
  return MomentKind::Note;
}

Moment moment_of(const recording::ToldEvent& told) {
  const SessionEvent& event = *told.event;
  if (event.kind == recording::kCommandEvent) return {0, MomentKind::Command, command_words(event)};
  if (event.kind == recording::kBoneMovedEvent) return {0, MomentKind::Note, drift_words(event)};
  if (event.kind == recording::kPlanEvent)
    return {0, MomentKind::Note, event.text.empty() ? "No plan in force" : "Plan in force"};
  return {0, kind_of(told.gravity),
          capitalised(told.words) + (told.detail.empty() ? std::string() : ": " + told.detail)};
}

std::int64_t first_time_ns(const std::vector<SessionEvent>& events) {
  const auto timed = std::ranges::find_if(events, [](const auto& event) { return event.timestamp_ns != 0; });
  return timed == events.end() ? 0 : timed->timestamp_ns;
}

}  // namespace

std::vector<Moment> moments_of(const std::vector<SessionEvent>& events,
                               const recording::SessionTimeline& timeline,
                               const recording::ReadRegistration& read) {
  std::vector<Moment> moments;
  std::optional<std::string> plan;  // in force: an operation says it again when its source starts
  const bool has_frames = !timeline.frames().empty();
  const std::int64_t zero_ns = has_frames ? timeline.frames().front().timestamp_ns : first_time_ns(events);
  for (const recording::ToldEvent& told : recording::told_events(events, read)) {
    const SessionEvent& event = *told.event;
    if (event.kind == recording::kOutcomeEvent || event.kind == recording::kLookEvent) continue;
    if (event.kind == recording::kPlanEvent && std::exchange(plan, event.text) == event.text) continue;
    Moment moment = moment_of(told);
    moment.frame = has_frames ? timeline.at_index(event.after_frame) : 0;
    // What has no time of its own has its frame's.
    moment.time_s = std::max(has_frames ? timeline.time_s(moment.frame) : 0,
                             static_cast<double>(event.timestamp_ns - zero_ns) * 1e-9);
    moments.push_back(std::move(moment));
  }
  return moments;
}

std::string last_moment_in_words(const std::vector<Moment>& moments,
                                 const recording::SessionTimeline& timeline, std::size_t frame) {
  const auto after = std::ranges::upper_bound(moments, frame, {}, &Moment::frame);
  if (after == moments.begin()) return "";
  const Moment& last = *std::prev(after);
  const bool is_after_pictures =
      last.frame + 1 == timeline.frames().size() && last.time_s > timeline.time_s(last.frame);
  return (is_after_pictures ? recording::clock_text(last.time_s) + ", after the pictures: " : "") +
         last.words;
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
