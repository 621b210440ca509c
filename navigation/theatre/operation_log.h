// What of an operation goes into the log of `--log`: sources, registrations that take effect, what makes them
// void, alarms, decisions. A line a change, never one a frame.
#pragma once

#include <string>
#include <vector>

#include "navigation/operation/journal_entry.h"

namespace arthronaut::theatre {

// One line an entry that is worth one; a registration's mesh, camera and tools by the first digits of their
// hashes, and no patient.
void log_entries(const std::vector<operation::JournalEntry>& entries);
// "registration in force after frame 312: reliable, +- 0.42 mm, femur, medium 1.3345, ..."; empty for an
// entry that is not logged.
[[nodiscard]] std::string line_of(const operation::JournalEntry& entry);

}  // namespace arthronaut::theatre
