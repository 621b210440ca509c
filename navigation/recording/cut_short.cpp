#include "navigation/recording/cut_short.h"

namespace arthronaut::recording {

std::string cut_short_in_words(bool was_finished, const std::vector<SessionEvent>& events,
                               bool is_being_recorded) {
  std::string words;
  const auto add = [&words](const std::string& what) { words += (words.empty() ? "" : "; ") + what; };
  for (const SessionEvent& event : events) {
    if (event.kind == kVideoStoppedEvent) add("the video stopped: " + event.text);
    if (event.kind == kRecordingStoppedEvent) add("the recording stopped: " + event.text);
  }
  if (!was_finished && is_being_recorded)
    add("it is being recorded now");
  else if (!was_finished)
    add(words.empty() ? "the program ended before the session did" : "the record was never finished");
  return words;
}

}  // namespace arthronaut::recording
