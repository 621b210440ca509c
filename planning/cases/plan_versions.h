// Plans that somebody wanted to keep beside the one that is worked on: plan_versions/1.json, 2.json, ... of
// the case's folder, each a plan.json of its own with the time at which it was kept, the side that the case
// had then, and a name and a note for people. Its plan is never changed and never written over.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "planning/cases/case.h"

namespace arthronaut::cases {

// What somebody calls a version, and says of it; both may be empty. No patient's name: they stand in exports.
struct VersionWords {
  std::string name, note;
  bool operator==(const VersionWords&) const = default;
};

struct PlanVersion {
  int number = 0;        // from 1
  std::string kept_utc;  // ISO 8601
  Plan plan;
  VersionWords words = {};
  std::optional<bones::Side> side = {};  // of the knee that it was planned in; of older versions not known

  // "Version 3, "wider"".
  [[nodiscard]] std::string title() const;
};

inline constexpr std::size_t kLongestVersionName = 60, kLongestVersionNote = 1000;  // bytes

// The oldest first; none where none was kept. Throws IoError or InvalidInput (file, place, reason).
[[nodiscard]] std::vector<PlanVersion> load_plan_versions(const std::filesystem::path& case_folder);
// Keeps the plan under the next number. Atomic. Throws IoError; InvalidInput for a plan without a tunnel, and
// for words that are too long.
PlanVersion keep_plan_version(const std::filesystem::path& case_folder, const Plan& plan,
                              std::optional<bones::Side> side = {}, const VersionWords& words = {});
// The version has these words from then on, in place of those it had. Atomic. Throws as keep_plan_version();
// InvalidInput where no version has that number.
void say_of_version(const std::filesystem::path& case_folder, int number, const VersionWords& words);
// Those of which nobody said the side are of this one, which the case has had so far. Throws as
// load_plan_versions() and keep_plan_version().
void name_side_of_versions(const std::filesystem::path& case_folder, bones::Side side);
// Why a plan of the one side must not be taken in a knee of the other; empty where it may, or nobody knows.
[[nodiscard]] std::string side_refusal(const PlanVersion& version, bones::Side of_case);

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
