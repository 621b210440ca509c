// The steps of planning: each replaces the tunnel of one bone.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "app/case/history.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::open_case {

// Puts a tunnel, or none, into the model.
using TunnelSetter = std::function<void(bones::BoneKind, const std::optional<tunnels::Tunnel>&)>;

// Sets, changes or (after == nullopt) removes the tunnel of a bone. What `set` refers to must outlive the
// history. Steps of one drag on the same bone become one.
[[nodiscard]] std::unique_ptr<Step> set_tunnel(TunnelSetter set, bones::BoneKind bone,
                                               std::optional<tunnels::Tunnel> before,
                                               std::optional<tunnels::Tunnel> after, std::string description);

}  // namespace arthronaut::open_case
