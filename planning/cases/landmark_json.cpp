#include "planning/cases/landmark_json.h"

#include <nlohmann/json.hpp>

#include "planning/geometry/error.h"

namespace arthronaut::cases {

nlohmann::ordered_json landmarks_to_json(const landmarks::Landmarks& landmarks,
                                         const landmarks::LandmarkStates& states) {
  auto json = nlohmann::ordered_json::array();
  for (const auto& [name, position] : landmarks) {
    json.push_back({{"name", name},
                    {"position_mm", files::to_json(position)},
                    {"state", landmarks::to_text(landmarks::state_of(states, name))}});
  }
  return json;
}

landmarks::Landmarks landmarks_from(const files::JsonObject& bone, landmarks::LandmarkStates& states) {
  landmarks::Landmarks landmarks;
  if (!bone.has("landmarks")) return landmarks;
  for (const auto& node : bone.objects("landmarks")) {
    if (!landmarks.emplace(node.text("name"), node.vector3("position_mm")).second)
      node.fail("name", "is there twice");
    if (!node.has("state")) continue;
    try {
      states[node.text("name")] = landmarks::landmark_state_from_text(node.text("state"));
    } catch (const InvalidInput&) {
      node.fail("state", "must be proposed or confirmed");
    }
  }
  return landmarks;
}

}  // namespace arthronaut::cases
