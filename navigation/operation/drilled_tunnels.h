// Which tunnels of a knee are drilled, by the surgeon's word, and whose world markers are out: of all sources
// of one kind, since the word outlives the source in which it was said. A rehearsal says nothing of the
// patient: whoever has several kinds of sources keeps one for each.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>

#include "navigation/operation/operation_state.h"

namespace arthronaut::operation {

struct DrilledTunnel {
  PlannedTunnel planned;                   // the very plan that was in force
  std::optional<AchievedTunnel> measured;  // empty: by word alone
  bool was_verified = false;               // the registration that it was drilled by, by touches
};

class DrilledTunnels {
 public:
  // A source begins: where the marker is out, the operation on that bone begins afresh.
  void begin(bones::BoneKind bone);
  // Said once more without a measurement, what was measured of the same plan stays.
  void say_drilled(const DrilledTunnel& tunnel);
  void set_verified(const tunnels::TunnelKey& key, bool is_verified);  // of one that is drilled
  // It was said too early. The marker is wanted again.
  void take_back(const tunnels::TunnelKey& key);
  void say_marker(bones::BoneKind bone, bool is_out);
  // What the operation says now; its sources are of one kind. What it says without one is taken, too.
  void follow(const OperationState& state);
  // What was said before; of a bone that had a source here since, a source has begun after it.
  void add_before(DrilledTunnels before);

  // Null: nothing is said of that very plan; another one of the same tunnel is not it.
  [[nodiscard]] const DrilledTunnel* find(const PlannedTunnel& planned) const;
  [[nodiscard]] bool marker_is_out(bones::BoneKind bone) const { return markers_out_.contains(bone); }
  [[nodiscard]] std::size_t count() const { return tunnels_.size(); }
  [[nodiscard]] std::size_t markers_out_count() const { return markers_out_.size(); }

 private:
  std::map<tunnels::TunnelKey, DrilledTunnel> tunnels_;
  std::set<bones::BoneKind> markers_out_;
  std::map<bones::BoneKind, std::shared_ptr<const SourceSetup>> sources_;  // that were followed last
};

}  // namespace arthronaut::operation
