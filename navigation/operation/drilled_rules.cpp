// The surgeon's word that a tunnel is drilled, and that it is not.
#include "navigation/operation/operation_parts.h"

namespace arthronaut::operation {

// That a tunnel was drilled is the surgeon's word; where it runs is what was seen meanwhile, or not known.
void Operation::Parts::apply(const TunnelDrilled&) {
  const guidance::DrillEvidenceSummary seen =
      drilling.evidence ? drilling.evidence->summary() : guidance::DrillEvidenceSummary();
  // Said once more, with nothing new seen: the tunnel that is recorded stays as it is.
  if (drilling.drilled.tunnel && !seen.is_usable()) return;
  drilling.drilled = {};
  drilling.drilled.outcome = DrilledState::Outcome::NoEvidence;
  if (!drilling.evidence) return;
  drilling.drilled.evidence = seen.outcome;
  if (!seen.is_usable())
    return note(JournalKind::Note,
                "drilled, by the surgeon's word; " + std::string(guidance::to_text(seen.outcome)));
  AchievedTunnel tunnel;
  tunnel.planned = plan->tunnel;
  tunnel.measured = plan->tunnel;  // bone and diameter: the drill is the planned one
  tunnel.measured.entry_mm = seen.entry_mm;
  tunnel.measured.direction = seen.direction;
  // Where its axis goes into the bone, which is seldom in the plane that the poses were compared in.
  if (setup.surface != nullptr)
    if (const auto geometry = tunnels::measure(tunnel.measured, *setup.surface); geometry.enters_bone)
      tunnel.measured.entry_mm = geometry.entry_on_surface_mm;
  // A guide's end stays on the bone while the drill runs through it.
  tunnel.depth_mm = seen.is_of_drill ? std::optional(seen.depth_mm) : drilling.depth_stop_mm;
  drilling.depth_stop_mm.reset();  // of this hole
  tunnel.timestamp_ns = seen.timestamp_ns;
  tunnel.pose_count = seen.pose_count;
  tunnel.sigma_offset_mm = seen.sigma_offset_mm;
  tunnel.sigma_angle_deg = seen.sigma_angle_deg;
  drilling.drilled.outcome = DrilledState::Outcome::Recorded;
  drilling.drilled.tunnel = tunnel;
  drilling.evidence->clear();
  drilling.evidence_is_seen = false;
  JournalEntry entry = entry_of(JournalKind::Drilled, "");
  entry.achieved = tunnel;
  note(std::move(entry));
}

// The poses that it rested on went with the word: what is seen from now on is of the tunnel that is drilled
// now.
void Operation::Parts::apply(const TakeBackDrilled&) {
  if (drilling.drilled.outcome == DrilledState::Outcome::NotSaid) {
    // Said while another source ran: the record of that one is closed, and this one says that it is not so.
    if (drilling.drilled.was_taken_back || !plan) return;
    note(JournalKind::Note, "not drilled: what an earlier record says of this tunnel was said too early");
  } else {
    JournalEntry entry = entry_of(JournalKind::DrilledTakenBack, "");
    entry.achieved = drilling.drilled.tunnel;
    note(std::move(entry));
  }
  drilling.drilled = {};
  drilling.drilled.was_taken_back = true;
  if (drilling.evidence) drilling.evidence->clear();
  drilling.evidence_is_seen = false;
}

}  // namespace arthronaut::operation
