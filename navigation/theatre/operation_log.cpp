#include "navigation/theatre/operation_log.h"

#include "planning/files/format.h"
#include "planning/log/log.h"

namespace arthronaut::theatre {

namespace {

using operation::JournalEntry;
using operation::JournalKind;

std::string start_of(const std::string& hash) { return hash.empty() ? "not known" : hash.substr(0, 12); }

std::string registration_in_words(const JournalEntry& entry) {
  const registration::RegistrationSummary& found = *entry.registration;
  std::string text = found.has_pose ? found.reliable ? "reliable" : "not reliable" : "none";
  if (found.has_pose) text += files::format(", +- %.2f mm", found.predicted_tre_mm);
  if (!found.reasons.empty()) text += ", " + found.reasons.front();
  text += files::format("; %s, marker %d, medium %.4f", std::string(bones::to_text(entry.of.bone)).c_str(),
                        entry.of.world_marker_id, entry.of.refractive_index);
  return text + ", " + std::string(sources::to_text(entry.of.source)) + ", mesh " +
         start_of(entry.of.mesh_sha256) + ", camera " + start_of(entry.of.camera) + ", tools " +
         start_of(entry.of.tools);
}

// Empty: not worth a line.
std::string what_of(const JournalEntry& entry) {
  switch (entry.kind) {
    case JournalKind::CommandGiven:
    case JournalKind::OutcomeTaken:
    case JournalKind::LookTaken:
      return "";  // the journal has them all
    case JournalKind::LookFailed:
      return "the medium could not be looked at again";
    case JournalKind::BoneMoved:
      return "bone moved in the picture, mm";
    case JournalKind::BoneLooks:
      return "bone looks";
    case JournalKind::MediumWrong:
      return "medium wrong, what was measured since is gone";
    case JournalKind::SourceStarted:
      return "source started";
    case JournalKind::SourceEnded:
      return "source ended";
    case JournalKind::RegistrationInForce:
      return "registration in force";
    case JournalKind::Alarm:
      return entry.text.empty() ? "alarm over" : "alarm";
    case JournalKind::Void:
      return "registration void";
    case JournalKind::Confirmed:
      return "registration confirmed";
    case JournalKind::Verified:
      return "registration verified";
    case JournalKind::VerificationLost:
      return "verification lost";
    case JournalKind::VerificationSkipped:
      return "verification skipped";
    case JournalKind::TimeOutConfirmed:
      return "time-out confirmed";
    case JournalKind::GuideChecked:
      return "nominal guide checked";
    case JournalKind::Plan:
      return entry.plan ? "plan in force" : "no plan in force";
    case JournalKind::Drilled:
      return "tunnel drilled";
    case JournalKind::DrilledByWord:
      return "tunnel drilled, by the surgeon's word alone";
    case JournalKind::DrilledTakenBack:
      return "tunnel not drilled after all";
    case JournalKind::SaidTooEarly:
      return "said too early: not drilled";
    case JournalKind::MarkerOut:
      return entry.text.empty() ? "world marker out" : "world marker not out";
    case JournalKind::Note:
      return "note";
  }
  return "";
}

}  // namespace

std::string line_of(const JournalEntry& entry) {
  std::string line = what_of(entry);
  if (line.empty()) return line;
  if (entry.after_frame >= 0) line += " after frame " + std::to_string(entry.after_frame);
  if (entry.registration != nullptr) return line + ": " + registration_in_words(entry);
  if (entry.plan) {
    const tunnels::TunnelKey key = entry.plan->tunnel.key();
    if (key.bundle != norms::Bundle::Whole) line += ": " + tunnels::name_of(key);
    line +=
        files::format(": %.1f mm wide, %.1f mm long", entry.plan->tunnel.diameter_mm, entry.plan->length_mm);
  }
  return entry.text.empty() ? line : line + ": " + entry.text;
}

void log_entries(const std::vector<JournalEntry>& entries) {
  if (!log::takes(log::Level::Info)) return;
  for (const JournalEntry& entry : entries)
    if (const std::string line = line_of(entry); !line.empty())
      log::write(entry.kind == JournalKind::Alarm || entry.kind == JournalKind::Void ? log::Level::Warning
                                                                                     : log::Level::Info,
                 line);
}

}  // namespace arthronaut::theatre
