// What is known of the hole that is drilled: what was seen of guide or drill meanwhile, what the surgeon read
// off the depth stop, and his word that it is drilled.
//
// All of it is of one plan. What was seen is of one source, of one registration and of numbers that held
// while they were shown: it ends with each of these. The reading is of the hole: it stays while a source is
// taken up again, and ends when the tunnel is recorded. The word is of the record in which it was said, which
// ends with its source; one that was said too early can be taken back all the same.
//
// Thread-free, deterministic. Lengths in mm, the bone's frame.
#pragma once

#include <optional>

#include "navigation/guidance/drill_evidence.h"
#include "navigation/operation/journal_entry.h"
#include "navigation/operation/now_and_then.h"
#include "navigation/operation/operation_state.h"
#include "planning/geometry/surface.h"

namespace arthronaut::operation {

class Drilling {
 public:
  // Another plan: nothing of before is of it. Empty: nothing is to be drilled.
  void on_plan(const std::optional<PlannedTunnel>& plan);
  // Other pictures, with the plan in force. Of what was said and seen nothing is theirs.
  void on_source(const std::optional<PlannedTunnel>& plan);
  // Another registration, or the same that does not stand any more: poses were by what is not in force now.
  void on_registration() { forget_seen(); }
  // Another hole, in a bone whose marker sits elsewhere: what was seen goes with its registration.
  void on_marker_placed_anew();
  // What was seen was seen by wrong numbers.
  void forget_seen();
  // By wrong numbers of the guide alone: what was seen of a drill by its own marker stays.
  void forget_guide();

  // Every frame's guidance, in order of time. Allocates nothing. One through the wrong medium forgets what
  // was seen until then.
  void add(const guidance::GuidanceNumbers& guidance, std::int64_t now_ns);
  void read_depth_stop(std::optional<double> depth_mm) { depth_stop_mm_ = depth_mm; }
  // The surgeon's word that it is drilled: recorded where enough was seen meanwhile. Said once more, with
  // nothing new seen, the tunnel that is recorded stays as it is. surface: null: the entry stays where the
  // poses were compared. without_picture_s: see TunnelDrilled; what was seen before stays for a word that is
  // said while pictures come again. What the journal is to say; empty: nothing. Precondition: on_plan() or
  // on_source() was told of `plan` last.
  [[nodiscard]] std::optional<JournalEntry> say_drilled(const std::optional<PlannedTunnel>& plan,
                                                        const geometry::Surface* surface,
                                                        double without_picture_s = 0);
  // And that it is not: said too early, maybe while another source ran.
  [[nodiscard]] std::optional<JournalEntry> take_back(const std::optional<PlannedTunnel>& plan);

  [[nodiscard]] const std::optional<double>& depth_stop_mm() const { return depth_stop_mm_; }
  [[nodiscard]] DrilledState state() const;

 private:
  std::optional<guidance::DrillEvidence> evidence_;  // empty: no plan, or no source yet
  bool is_seen_ = false;  // that it is usable, as of the last time that it was summed up
  NowAndThen sums_up_;
  std::optional<double> depth_stop_mm_;
  DrilledState said_;
};

}  // namespace arthronaut::operation
