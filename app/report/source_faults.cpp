#include "app/report/source_faults.h"

#include <algorithm>
#include <utility>

#include "app/report/session_rows.h"
#include "planning/files/format.h"

namespace arthronaut::report {

using theatre::SourceTrouble;

bool SourceFault::is_loss() const { return theatre::shows_nothing(trouble); }

std::vector<SourceFault> source_faults(const recording::RecordedSession& session) {
  std::vector<SourceFault> faults;
  bool goes_on = false;
  const auto end_at = [&](double now_s) {
    if (std::exchange(goes_on, false)) faults.back().for_s = std::max(0.0, now_s - faults.back().from_s);
  };
  for (const recording::SessionEvent& event : session.events()) {
    const double now_s = time_s(session, event.timestamp_ns);
    if (event.kind == recording::kSourceEndedEvent) end_at(now_s);
    if (event.kind != recording::kSourceTroubleEvent) continue;
    const SourceTrouble trouble = theatre::trouble_in(event.text);
    if (goes_on && faults.back().trouble == trouble) continue;
    end_at(now_s);
    if (trouble == SourceTrouble::None) continue;
    faults.push_back({&event, trouble, now_s, 0});
    goes_on = true;
  }
  // Of a record that was cut off: until its last picture.
  if (!session.frames().empty()) end_at(time_s(session, session.frames().back().timestamp_ns));
  return faults;
}

std::string in_words(const std::vector<SourceFault>& faults) {
  struct Kind {
    SourceTrouble trouble;
    int count = 0;
    double all_s = 0;
  };
  std::vector<Kind> kinds;
  for (const SourceFault& fault : faults) {
    auto kind = std::ranges::find(kinds, fault.trouble, &Kind::trouble);
    if (kind == kinds.end()) kind = kinds.insert(kinds.end(), Kind{fault.trouble});
    ++kind->count;
    kind->all_s += fault.for_s;
  }
  std::string words;
  for (const Kind& kind : kinds)
    words += (words.empty() ? "" : "; ") + std::string(theatre::to_text(kind.trouble)) +
             (kind.count == 1 ? files::format(" once, %.1f s", kind.all_s)
                              : files::format(" %d times, %.1f s in all", kind.count, kind.all_s));
  return words.empty() ? "none" : words;
}

double without_picture_s(const recording::RecordedSession& session) {
  constexpr double kPause_s = 1e-9 * static_cast<double>(theatre::kSilence_ns);
  if (session.header().source_kind != sources::SourceKind::Live) return 0;
  std::vector<double> times_s;
  for (const recording::RecordedFrame& frame : session.frames())
    times_s.push_back(time_s(session, frame.timestamp_ns));
  for (const recording::SessionEvent& event : session.events())
    if (event.kind == recording::kSourceEndedEvent) times_s.push_back(time_s(session, event.timestamp_ns));
  double sum_s = 0;
  for (std::size_t i = 1; i < times_s.size(); ++i)
    if (const double gap_s = times_s[i] - times_s[i - 1]; gap_s > kPause_s) sum_s += gap_s;
  return sum_s;
}

}  // namespace arthronaut::report
