// What a check of the plan measured and what it was held against, as keys for other programs: "value",
// "unit", "least", "greatest".
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "planning/tunnels/plan_checks.h"

namespace arthronaut::tunnels {

// Adds nothing where nothing was measured, and no limit that it was not held against.
void put_numbers(const PlanCheck& check, nlohmann::ordered_json& node);

}  // namespace arthronaut::tunnels
