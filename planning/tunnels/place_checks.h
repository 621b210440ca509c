// The checks of where a tunnel begins, opens and ends. Inner header of tunnels: see plan_checks.h.
#pragma once

#include "planning/tunnels/plan_checks.h"

namespace arthronaut::tunnels {

[[nodiscard]] PlanCheck not_checked(const char* name, const std::string& missing);
// Where the tunnel leaves the bone unseen, in words (UnseenParts::reached; empty: it does not), and what is
// then said of a check that asks where it leaves.
[[nodiscard]] std::string unseen_at_exit(const TunnelGeometry& geometry,
                                         const PlanSurroundings& surroundings);
[[nodiscard]] PlanCheck not_seen(const char* name, const std::string& unseen);
// That nobody looked where the bone is unseen, and how to mend it.
[[nodiscard]] PlanCheck not_looked_for();
[[nodiscard]] std::string number_text(double value, const char* unit);  // "24.1 mm"
[[nodiscard]] std::string limit_text(double value, const char* unit);   // "25 mm"

[[nodiscard]] PlanCheck check_entry_place(const Tunnel& tunnel, const TunnelGeometry& geometry,
                                          const PlanSurroundings& surroundings);
[[nodiscard]] PlanCheck check_exit_place(const Tunnel& tunnel, const TunnelGeometry& geometry,
                                         const PlanSurroundings& surroundings);
// What the exit comes near: the lateral epicondyle and the posterior cortex; the tuberosity.
[[nodiscard]] std::vector<PlanCheck> check_exit_neighbours(const Tunnel& tunnel,
                                                           const TunnelGeometry& geometry,
                                                           const PlanSurroundings& surroundings,
                                                           const PlanNorms& norms);
[[nodiscard]] PlanCheck check_mouth(const TunnelGeometry& geometry, const PlanNorms& norms);
[[nodiscard]] std::vector<PlanCheck> check_footprint(const Tunnel& tunnel, const TunnelGeometry& geometry,
                                                     const PlanSurroundings& surroundings);

}  // namespace arthronaut::tunnels
