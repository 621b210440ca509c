// Plans that somebody wanted to keep beside the one that is worked on: plan_versions/1.json, 2.json, ... of
// the case's folder, each a plan.json of its own with the time at which it was kept. A version is never
// changed and never written over.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "planning/cases/case.h"

namespace arthronaut::cases {

struct PlanVersion {
  int number = 0;        // from 1
  std::string kept_utc;  // ISO 8601
  Plan plan;
};

// The oldest first; none where none was kept. Throws IoError or InvalidInput (file, place, reason).
[[nodiscard]] std::vector<PlanVersion> load_plan_versions(const std::filesystem::path& case_folder);
// Keeps the plan under the next number. Atomic. Throws IoError; InvalidInput for a plan without a tunnel.
PlanVersion keep_plan_version(const std::filesystem::path& case_folder, const Plan& plan);

// How one tunnel differs between two plans.
struct TunnelDifference {
  tunnels::TunnelKey key = bones::BoneKind::Femur;
  enum class Kind { Same, Moved, OnlyHere, OnlyThere } kind = Kind::Same;
  // Of Same and Moved; there less here.
  double entry_mm = 0, angle_deg = 0, diameter_mm = 0;
  // Whether going from there to here loses the tunnel as it is there.
  [[nodiscard]] bool is_lost_here() const { return kind == Kind::Moved || kind == Kind::OnlyThere; }
  [[nodiscard]] std::string in_words() const;  // "femur: entry 2.1 mm off, 0.5 mm wider"
};
// Of the tunnels that either plans. Same: not further apart than is seen, 0.05 mm and 0.05 deg.
[[nodiscard]] std::vector<TunnelDifference> compare_plans(const Plan& here, const Plan& there);

}  // namespace arthronaut::cases
