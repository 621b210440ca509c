#include "planning/cases/step_history.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "planning/bones/bone_json.h"
#include "planning/cases/landmark_json.h"
#include "planning/cases/plan_file.h"
#include "planning/files/json_document.h"
#include "planning/files/remove_file.h"

namespace arthronaut::cases {

namespace {

namespace fs = std::filesystem;
using bones::BoneKind;
using Json = nlohmann::ordered_json;
constexpr std::string_view kHistoryFormat = "arthronaut.history";
constexpr int kHistoryVersion = 1;

// A landmark of which no state is said is confirmed.
bool has_same_landmarks(const PlanState& a, const PlanState& b) {
  if (a.landmarks != b.landmarks) return false;
  const auto states_of = [](const PlanState& state, BoneKind kind) {
    const auto found = state.landmark_states.find(kind);
    return found == state.landmark_states.end() ? landmarks::LandmarkStates{} : found->second;
  };
  return std::ranges::all_of(a.landmarks, [&](const auto& of) {
    const auto of_a = states_of(a, of.first), of_b = states_of(b, of.first);
    return std::ranges::all_of(of.second, [&](const auto& mark) {
      return landmarks::state_of(of_a, mark.first) == landmarks::state_of(of_b, mark.first);
    });
  });
}

Json landmarks_of(const PlanState& state) {
  Json bones = Json::array();
  for (const auto& [kind, marks] : state.landmarks) {
    const auto states = state.landmark_states.find(kind);
    bones.push_back({{"kind", bones::to_text(kind)},
                     {"landmarks", landmarks_to_json(marks, states == state.landmark_states.end()
                                                                ? landmarks::LandmarkStates{}
                                                                : states->second)}});
  }
  return {{"bones", std::move(bones)}};
}

// Steps share most of what they change: each thing stands once, and is named by its place.
std::size_t place_in(Json& things, Json thing) {
  // The newest is the likeliest.
  for (std::size_t i = things.size(); i-- > 0;)
    if (things[i] == thing) return i;
  things.push_back(std::move(thing));
  return things.size() - 1;
}

template <typename Thing>
const Thing& at_place(const std::vector<Thing>& things, const files::JsonObject& node, const char* key) {
  const std::int64_t place = node.integer(key);
  if (place < 0 || static_cast<std::size_t>(place) >= things.size()) node.fail(key, "names nothing");
  return things[static_cast<std::size_t>(place)];
}

}  // namespace

bool is_same_tunnel(const tunnels::Tunnel& a, const tunnels::Tunnel& b) {
  return a.key() == b.key() && a.entry_mm == b.entry_mm && a.direction == b.direction &&
         a.diameter_mm == b.diameter_mm;
}

bool is_same_plan(const Plan& a, const Plan& b) {
  return a.mesh_sha256 == b.mesh_sha256 &&
         std::ranges::equal(a.tunnels, b.tunnels, [](const auto& one, const auto& another) {
           return is_same_tunnel(one.second, another.second);
         });
}

bool PlanState::operator==(const PlanState& other) const {
  return is_same_plan(plan, other.plan) && measurements == other.measurements &&
         has_same_landmarks(*this, other);
}

std::optional<std::size_t> StepHistory::position_of(const PlanState& state) const {
  std::optional<std::size_t> nearest;
  const auto away = [this](std::size_t at) { return at > position ? at - position : position - at; };
  for (std::size_t at = 0; at <= steps.size() && !steps.empty(); ++at) {
    if (nearest && away(at) >= away(*nearest)) continue;
    if ((at > 0 ? steps[at - 1].after : steps[0].before) == state) nearest = at;
  }
  return nearest;
}

fs::path step_history_file(const fs::path& case_folder) { return case_folder / "history.json"; }

StepHistory load_step_history(const fs::path& case_folder) {
  const fs::path file = step_history_file(case_folder);
  if (!fs::exists(file)) return {};
  const auto root = files::read_json(file, kHistoryFormat, kHistoryVersion);
  std::vector<PlanState> landmark_sets;
  for (const files::JsonObject& node : root.objects("landmarks")) {
    PlanState& set = landmark_sets.emplace_back();
    for (const files::JsonObject& bone : node.objects("bones")) {
      const BoneKind kind = bones::read_bone_kind(bone, "kind");
      set.landmarks[kind] = landmarks_from(bone, set.landmark_states[kind]);
    }
  }
  std::vector<std::vector<Measurement>> measured;
  for (const files::JsonObject& node : root.objects("measurements"))
    measured.push_back(measurements_from(node));
  std::vector<PlanState> states;
  for (const files::JsonObject& node : root.objects("states")) {
    PlanState state = at_place(landmark_sets, node, "landmarks");
    state.measurements = at_place(measured, node, "measurements");
    state.plan = plan_from(node.object("plan"));
    states.push_back(std::move(state));
  }
  StepHistory history;
  for (const files::JsonObject& node : root.objects("steps"))
    history.steps.push_back(
        {node.text("what"), at_place(states, node, "before"), at_place(states, node, "after")});
  const std::int64_t position = root.integer("position");
  if (position < 0 || static_cast<std::size_t>(position) > history.steps.size())
    root.fail("position", "is beyond the steps");
  history.position = static_cast<std::size_t>(position);
  history.side = bones::read_side(root, "side");
  return history;
}

void save_step_history(const fs::path& case_folder, const StepHistory& history) {
  if (history.steps.empty()) return files::remove_file(step_history_file(case_folder));
  Json landmark_sets = Json::array(), measured = Json::array(), states = Json::array(), steps = Json::array();
  const auto place_of = [&](const PlanState& state) {
    return place_in(states, {{"landmarks", place_in(landmark_sets, landmarks_of(state))},
                             {"measurements", place_in(measured, to_json(state.measurements))},
                             {"plan", to_json(state.plan)}});
  };
  for (const PlanStep& step : history.steps) {
    const std::size_t before = place_of(step.before);
    steps.push_back({{"what", step.what}, {"before", before}, {"after", place_of(step.after)}});
  }
  files::write_json(step_history_file(case_folder), {{"format", kHistoryFormat},
                                                     {"version", kHistoryVersion},
                                                     {"side", bones::to_text(history.side)},
                                                     {"position", history.position},
                                                     {"landmarks", std::move(landmark_sets)},
                                                     {"measurements", std::move(measured)},
                                                     {"states", std::move(states)},
                                                     {"steps", std::move(steps)}});
}

}  // namespace arthronaut::cases
