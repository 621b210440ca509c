// Inner header: what an operation decided then (alarms, what verified or voided a registration, the plan in
// force, tunnels that were drilled) against what it decides when it is run again.
#pragma once

#include <vector>

#include "navigation/operation/journal_entry.h"
#include "navigation/recording/replay.h"

namespace arthronaut::recording {

// `now`: the journal of the session, run again. Adds to the summary's differences. Pictures that are lossy
// move numbers and now and then a frame: of such a session what was decided and how often is compared alone.
void compare_events(const RecordedSession& session, const std::vector<operation::JournalEntry>& now,
                    ReplaySummary& summary);

// The numbers of each tunnel that was drilled, as the session's achieved.json keeps them, against those that
// come now. Adds what differs by more, or is not there any more, to the summary's differences.
void compare_achieved(const RecordedSession& session, const std::vector<operation::JournalEntry>& now,
                      double tolerance_mm, double tolerance_deg, ReplaySummary& summary);

}  // namespace arthronaut::recording
