// What was done to a case's plan, step by step: history.json of the case's folder, so that it can still be
// taken back when the program was ended, however that came.
//
// It is written before the plan is: after a crash in between the plan is that of one of its steps, and
// position_of() finds which. Of a plan that is none of them, as one that another program saved, nothing can
// be taken back.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "planning/cases/case.h"
#include "planning/cases/measurements.h"

namespace arthronaut::cases {

// What a step may change.
struct PlanState {
  Plan plan;
  std::vector<Measurement> measurements;
  std::map<bones::BoneKind, landmarks::Landmarks> landmarks;
  std::map<bones::BoneKind, landmarks::LandmarkStates> landmark_states;
  // To the bit, as the files of a case give their numbers back.
  [[nodiscard]] bool operator==(const PlanState& other) const;
};

// The same to the bit.
[[nodiscard]] bool is_same_tunnel(const tunnels::Tunnel& a, const tunnels::Tunnel& b);
// The same tunnels to the bit, on the same meshes.
[[nodiscard]] bool is_same_plan(const Plan& a, const Plan& b);

struct PlanStep {
  std::string what;  // "Drag the aim of the femoral tunnel"
  PlanState before, after;
};

struct StepHistory {
  std::vector<PlanStep> steps;            // the oldest first
  std::size_t position = 0;               // so many of them are done, the others undone
  bones::Side side = bones::Side::Right;  // of the knee that was planned
  // The position in which a case is that is in this state, the nearest to `position`; nullopt: in none.
  [[nodiscard]] std::optional<std::size_t> position_of(const PlanState& state) const;
};

// So many are kept: an evening's work. The oldest go.
inline constexpr std::size_t kMostSteps = 200;

[[nodiscard]] std::filesystem::path step_history_file(const std::filesystem::path& case_folder);
// Empty without a file. Throws IoError or InvalidInput (file, place, reason).
[[nodiscard]] StepHistory load_step_history(const std::filesystem::path& case_folder);
// Atomic; without a step the file goes. Throws IoError; what was there is then as before.
void save_step_history(const std::filesystem::path& case_folder, const StepHistory& history);

}  // namespace arthronaut::cases
