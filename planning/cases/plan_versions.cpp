#include "planning/cases/plan_versions.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "planning/bones/bone_json.h"
#include "planning/cases/plan_file.h"
#include "planning/files/atomic_file.h"
#include "planning/files/format.h"
#include "planning/files/json_document.h"
#include "planning/files/private_folder.h"
#include "planning/files/utc_clock.h"
#include "planning/geometry/error.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::cases {

namespace {

namespace fs = std::filesystem;

constexpr double kSeen = 0.05;  // mm and deg: less is the same

fs::path versions_folder(const fs::path& case_folder) { return case_folder / "plan_versions"; }

// 0: no version's name.
int number_of(const fs::path& file) {
  const std::string stem = file.stem().string();
  int number = 0;
  const auto [end, error] = std::from_chars(stem.data(), stem.data() + stem.size(), number);
  const bool is_number = error == std::errc() && end == stem.data() + stem.size() && number > 0;
  return is_number && file.extension() == ".json" ? number : 0;
}

fs::path version_file(const fs::path& case_folder, int number) {
  return versions_folder(case_folder) / (std::to_string(number) + ".json");
}

PlanVersion version_from(const fs::path& file) {
  const auto root = files::parse_json(files::read_text(file), file, kPlanFormat, kPlanFormatVersion);
  PlanVersion version{number_of(file), root.text("kept_utc"), plan_from(root)};
  if (root.has("name")) version.words.name = root.text("name");
  if (root.has("note")) version.words.note = root.text("note");
  if (root.has("side")) version.side = bones::read_side(root, "side");
  return version;
}

void write_version(const fs::path& case_folder, const PlanVersion& version) {
  if (version.words.name.size() > kLongestVersionName || version.words.note.size() > kLongestVersionNote)
    throw InvalidInput(case_folder, "plan_versions",
                       files::format("a name is %zu bytes long at the most, a note %zu", kLongestVersionName,
                                     kLongestVersionNote));
  nlohmann::ordered_json node = to_json(version.plan);
  node["kept_utc"] = version.kept_utc;
  if (version.side) node["side"] = bones::to_text(*version.side);
  if (!version.words.name.empty()) node["name"] = version.words.name;
  if (!version.words.note.empty()) node["note"] = version.words.note;
  files::write_json(version_file(case_folder, version.number), node);
}

}  // namespace

std::string PlanVersion::title() const {
  return "Version " + std::to_string(number) + (words.name.empty() ? "" : ", \"" + words.name + "\"");
}

std::vector<PlanVersion> load_plan_versions(const fs::path& case_folder) {
  std::vector<PlanVersion> versions;
  const fs::path folder = versions_folder(case_folder);
  if (!fs::exists(folder)) return versions;
  for (const auto& entry : fs::directory_iterator(folder))
    if (number_of(entry.path()) != 0) versions.push_back(version_from(entry.path()));
  std::ranges::sort(versions, {}, &PlanVersion::number);
  return versions;
}

PlanVersion keep_plan_version(const fs::path& case_folder, const Plan& plan, std::optional<bones::Side> side,
                              const VersionWords& words) {
  if (plan.tunnels.empty()) throw InvalidInput(case_folder, "plan", "has no tunnel to keep");
  int last = 0;
  const fs::path folder = versions_folder(case_folder);
  if (fs::exists(folder))
    for (const auto& entry : fs::directory_iterator(folder)) last = std::max(last, number_of(entry.path()));
  PlanVersion kept{last + 1, files::utc_now(), plan, words, side};
  files::create_private_folder(folder);
  write_version(case_folder, kept);
  return kept;
}

void say_of_version(const fs::path& case_folder, int number, const VersionWords& words) {
  const fs::path file = version_file(case_folder, number);
  if (number < 1 || !fs::exists(file))
    throw InvalidInput(case_folder, "plan_versions", "holds no version " + std::to_string(number));
  PlanVersion version = version_from(file);
  if (version.words == words) return;
  version.words = words;
  write_version(case_folder, version);
}

void name_side_of_versions(const fs::path& case_folder, bones::Side side) {
  for (PlanVersion& version : load_plan_versions(case_folder)) {
    if (version.side) continue;
    version.side = side;
    write_version(case_folder, version);
  }
}

std::string side_refusal(const PlanVersion& version, bones::Side of_case) {
  if (!version.side || *version.side == of_case) return "";
  return version.title() + " was planned in a " + std::string(bones::to_text(*version.side)) +
         " knee, the case is a " + std::string(bones::to_text(of_case)) + " one";
}

std::string TunnelDifference::in_words() const {
  const std::string name = tunnels::name_of(key);
  switch (kind) {
    case Kind::Same:
      return name + ": the same";
    case Kind::OnlyHere:
      return name + ": not planned there";
    case Kind::OnlyThere:
      return name + ": planned there alone";
    case Kind::Moved:
      break;
  }
  std::string words;
  const auto add = [&](const std::string& what) { words += (words.empty() ? ": " : ", ") + what; };
  if (entry_mm > kSeen) add(files::format("entry %.1f mm off", entry_mm));
  if (angle_deg > kSeen) add(files::format("turned by %.1f deg", angle_deg));
  if (std::abs(diameter_mm) > kSeen)
    add(files::format("%.1f mm %s", std::abs(diameter_mm), diameter_mm > 0 ? "wider" : "narrower"));
  return name + words;
}

std::vector<TunnelDifference> compare_plans(const Plan& here, const Plan& there) {
  using Kind = TunnelDifference::Kind;
  std::set<tunnels::TunnelKey> planned;
  for (const Plan* plan : {&here, &there})
    for (const auto& [key, tunnel] : plan->tunnels) planned.insert(key);
  std::vector<TunnelDifference> differences;
  for (const tunnels::TunnelKey& key : planned) {
    const auto a = here.tunnels.find(key), b = there.tunnels.find(key);
    TunnelDifference difference{.key = key};
    if (a == here.tunnels.end() || b == there.tunnels.end()) {
      difference.kind = a == here.tunnels.end() ? Kind::OnlyThere : Kind::OnlyHere;
    } else {
      difference.entry_mm = (b->second.entry_mm - a->second.entry_mm).norm();
      difference.angle_deg =
          geometry::deg_from_rad(geometry::angle_between_rad(a->second.direction, b->second.direction));
      difference.diameter_mm = b->second.diameter_mm - a->second.diameter_mm;
      if (difference.entry_mm > kSeen || difference.angle_deg > kSeen ||
          std::abs(difference.diameter_mm) > kSeen)
        difference.kind = Kind::Moved;
    }
    differences.push_back(difference);
  }
  return differences;
}

}  // namespace arthronaut::cases
