#include "navigation/operation/drilled_tunnels.h"

#include <utility>

namespace arthronaut::operation {

void DrilledTunnels::begin(bones::BoneKind bone) {
  if (markers_out_.erase(bone) > 0)
    std::erase_if(tunnels_, [&](const auto& one) { return one.first.bone == bone; });
}

void DrilledTunnels::say_drilled(const DrilledTunnel& tunnel) {
  const bool is_less = !tunnel.measured && find(tunnel.planned) != nullptr;
  if (!is_less) tunnels_.insert_or_assign(tunnel.planned.tunnel.key(), tunnel);
}

void DrilledTunnels::set_verified(const tunnels::TunnelKey& key, bool is_verified) {
  if (const auto drilled = tunnels_.find(key); drilled != tunnels_.end())
    drilled->second.was_verified = is_verified;
}

void DrilledTunnels::take_back(const tunnels::TunnelKey& key) {
  tunnels_.erase(key);
  markers_out_.erase(key.bone);
}

void DrilledTunnels::say_marker(bones::BoneKind bone, bool is_out) {
  if (is_out)
    markers_out_.insert(bone);
  else
    markers_out_.erase(bone);
}

void DrilledTunnels::follow(const OperationState& state) {
  if (state.source != nullptr && std::exchange(sources_[state.bone], state.source) != state.source)
    begin(state.bone);
  // Without a source it knows nothing of a marker that was taken out before.
  if (state.source != nullptr || state.marker_is_out) say_marker(state.bone, state.marker_is_out);
  if (!state.plan) return;
  const tunnels::TunnelKey key = state.plan->tunnel.key();
  if (state.drilled.was_taken_back) {
    tunnels_.erase(key);
    return say_marker(state.bone, state.marker_is_out);
  }
  if (state.drilled.outcome == DrilledState::Outcome::NotSaid) return;
  const DrilledTunnel* const before = find(*state.plan);
  const bool was_verified = before != nullptr && before->was_verified;
  say_drilled({*state.plan, state.drilled.tunnel, was_verified});
  // The operation forgets it with the marker, the tunnel does not.
  if (state.verification != Verification::NotYet)
    set_verified(key, state.verification == Verification::ByTouches);
}

void DrilledTunnels::add_before(DrilledTunnels before) {
  for (const auto& [bone, source] : sources_) before.begin(bone);
  tunnels_.merge(before.tunnels_);
  markers_out_.merge(before.markers_out_);
}

const DrilledTunnel* DrilledTunnels::find(const PlannedTunnel& planned) const {
  const auto found = tunnels_.find(planned.tunnel.key());
  return found != tunnels_.end() && found->second.planned == planned ? &found->second : nullptr;
}

}  // namespace arthronaut::operation
