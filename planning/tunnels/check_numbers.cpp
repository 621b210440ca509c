#include "planning/tunnels/check_numbers.h"

#include <nlohmann/json.hpp>

namespace arthronaut::tunnels {

void put_numbers(const PlanCheck& check, nlohmann::ordered_json& node) {
  if (!check.value) return;
  node["value"] = *check.value;
  node["unit"] = check.unit;
  if (check.least) node["least"] = *check.least;
  if (check.greatest) node["greatest"] = *check.greatest;
}

}  // namespace arthronaut::tunnels
