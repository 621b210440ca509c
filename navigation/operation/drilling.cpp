#include "navigation/operation/drilling.h"

#include "planning/tunnels/tunnel.h"

namespace arthronaut::operation {

namespace {

std::optional<guidance::DrillEvidence> evidence_of(const std::optional<PlannedTunnel>& plan) {
  return plan ? std::optional<guidance::DrillEvidence>(plan->tunnel) : std::nullopt;
}

}  // namespace

void Drilling::on_plan(const std::optional<PlannedTunnel>& plan) {
  on_source(plan);
  depth_stop_mm_.reset();
}

void Drilling::on_source(const std::optional<PlannedTunnel>& plan) {
  evidence_ = evidence_of(plan);
  is_seen_ = false;
  said_ = {};
}

void Drilling::on_marker_placed_anew() {
  said_ = {};
  depth_stop_mm_.reset();
}

void Drilling::forget_seen() {
  if (evidence_) evidence_->clear();
  is_seen_ = false;
}

void Drilling::forget_guide() {
  if (evidence_) evidence_->forget_guide();
  is_seen_ = evidence_ && evidence_->summary().is_usable();
}

void Drilling::add(const guidance::GuidanceNumbers& guidance, std::int64_t now_ns) {
  if (evidence_) evidence_->add(guidance);
  if (guidance.state == guidance::GuidanceState::WrongMedium) forget_seen();
  if (sums_up_.is_time(now_ns)) is_seen_ = evidence_ && evidence_->summary().is_usable();
}

// That a tunnel was drilled is the surgeon's word; where it runs is what was seen meanwhile, or not known.
std::optional<JournalEntry> Drilling::say_drilled(const std::optional<PlannedTunnel>& plan,
                                                  const geometry::Surface* surface,
                                                  double without_picture_s) {
  constexpr double kNoPicture_s = 1;  // less is a pause of a source, and no hand drills in it
  guidance::DrillEvidenceSummary seen = evidence_ ? evidence_->summary() : guidance::DrillEvidenceSummary();
  if (without_picture_s > kNoPicture_s) seen.outcome = guidance::EvidenceOutcome::NoPicture;
  if (said_.tunnel && !seen.is_usable()) return std::nullopt;
  said_ = {};
  said_.outcome = DrilledState::Outcome::NoEvidence;
  if (!evidence_) return std::nullopt;
  said_.evidence = seen.outcome;
  if (!seen.is_usable())
    return entry_of(JournalKind::DrilledByWord, tunnels::name_of(plan->tunnel.key()) + ": " +
                                                    std::string(guidance::to_text(seen.outcome)));
  AchievedTunnel tunnel;
  tunnel.planned = plan->tunnel;
  tunnel.measured = plan->tunnel;  // bone and diameter: the drill is the planned one
  tunnel.measured.entry_mm = seen.entry_mm;
  tunnel.measured.direction = seen.direction;
  // Where its axis goes into the bone, which is seldom in the plane that the poses were compared in.
  if (surface != nullptr)
    if (const auto geometry = tunnels::measure(tunnel.measured, *surface); geometry.enters_bone)
      tunnel.measured.entry_mm = geometry.entry_on_surface_mm;
  // A guide's end stays on the bone while the drill runs through it.
  tunnel.depth_mm = seen.is_of_drill ? std::optional(seen.depth_mm) : depth_stop_mm_;
  depth_stop_mm_.reset();  // of this hole
  tunnel.timestamp_ns = seen.timestamp_ns;
  tunnel.pose_count = seen.pose_count;
  tunnel.sigma_offset_mm = seen.sigma_offset_mm;
  tunnel.sigma_angle_deg = seen.sigma_angle_deg;
  said_.outcome = DrilledState::Outcome::Recorded;
  said_.tunnel = tunnel;
  forget_seen();
  JournalEntry entry = entry_of(JournalKind::Drilled);
  entry.achieved = tunnel;
  return entry;
}

// The poses that it rested on went with the word: what is seen from now on is of the tunnel that is drilled
// now.
std::optional<JournalEntry> Drilling::take_back(const std::optional<PlannedTunnel>& plan) {
  std::optional<JournalEntry> entry;
  if (said_.tunnel) {
    entry = entry_of(JournalKind::DrilledTakenBack);
    entry->achieved = said_.tunnel;
  } else if (plan) {
    // By word alone; or said while another source ran, and the record of that one is closed.
    if (said_.was_taken_back) return std::nullopt;
    entry = entry_of(JournalKind::SaidTooEarly, tunnels::name_of(plan->tunnel.key()));
  } else if (said_.outcome == DrilledState::Outcome::NotSaid) {
    return std::nullopt;
  }
  said_ = {};
  said_.was_taken_back = true;
  forget_seen();
  return entry;
}

DrilledState Drilling::state() const {
  DrilledState state = said_;
  state.has_evidence = is_seen_;
  return state;
}

}  // namespace arthronaut::operation
