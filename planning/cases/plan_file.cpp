#include "planning/cases/plan_file.h"

#include <nlohmann/json.hpp>

#include "planning/bones/mesh_hash.h"
#include "planning/files/atomic_file.h"
#include "planning/files/json_document.h"
#include "planning/files/sha256.h"
#include "planning/geometry/error.h"

namespace arthronaut::cases {

namespace {

namespace fs = std::filesystem;

fs::path plan_file(const fs::path& case_folder) { return case_folder / "plan.json"; }

}  // namespace

Plan plan_from(const std::string& text, const fs::path& file) {
  const auto root = files::parse_json(text, file, kPlanFormat, kPlanFormatVersion);
  Plan plan;
  for (const auto& node : root.objects("tunnels")) {
    tunnels::Tunnel tunnel;
    try {
      tunnel.bone = bones::bone_kind_from_text(node.text("bone"));
    } catch (const InvalidInput&) {
      node.fail("bone", "must be femur or tibia");
    }
    tunnel.entry_mm = node.vector3("entry_mm");
    tunnel.direction = node.vector3("direction");
    if (tunnel.direction.norm() < 1e-6) node.fail("direction", "must not be zero");
    tunnel.direction.normalize();
    tunnel.diameter_mm = node.positive_number("diameter_mm");
    if (!plan.tunnels.emplace(tunnel.bone, tunnel).second) node.fail("bone", "has two tunnels");
    if (node.has("mesh_sha256")) plan.mesh_sha256[tunnel.bone] = node.text("mesh_sha256");
  }
  return plan;
}

void read_plan(const fs::path& case_folder, Case& contents) {
  const fs::path file = plan_file(case_folder);
  if (!fs::exists(file)) return;
  const std::string text = files::read_text(file);
  contents.plan = plan_from(text, file);
  contents.plan_version = files::sha256_of(text);
}

Plan with_named_meshes(const Case& contents) {
  Plan plan = contents.plan;
  for (const auto& [kind, tunnel] : plan.tunnels) {
    const auto bone = contents.bones.find(kind);
    if (bone == contents.bones.end() || plan.mesh_sha256.contains(kind)) continue;
    plan.mesh_sha256[kind] = bones::mesh_sha256(bone->second.mesh);
  }
  return plan;
}

void name_meshes(Case& contents) { contents.plan = with_named_meshes(contents); }

nlohmann::ordered_json to_json(const Plan& plan) {
  auto tunnels = nlohmann::ordered_json::array();
  for (const auto& [kind, tunnel] : plan.tunnels) {
    nlohmann::ordered_json node = {{"bone", bones::to_text(kind)},
                                   {"entry_mm", files::to_json(tunnel.entry_mm)},
                                   {"direction", files::to_json(tunnel.direction)},
                                   {"diameter_mm", tunnel.diameter_mm}};
    if (const auto hash = plan.mesh_sha256.find(kind); hash != plan.mesh_sha256.end()) {
      node["mesh_sha256"] = hash->second;
    }
    tunnels.push_back(std::move(node));
  }
  return {{"format", kPlanFormat}, {"version", kPlanFormatVersion}, {"tunnels", std::move(tunnels)}};
}

void save_plan(const fs::path& folder, const Plan& plan) {
  files::write_json(plan_file(folder), to_json(plan));
}

std::string plan_version(const fs::path& folder) {
  const fs::path file = plan_file(folder);
  return fs::exists(file) ? files::sha256_of_file(file) : "";
}

std::string save_plan_over(const fs::path& folder, const Plan& plan, const std::string& version) {
  if (plan_version(folder) != version) {
    throw InvalidInput(plan_file(folder), "",
                       "was changed by another program since it was opened here; nothing was written");
  }
  save_plan(folder, plan);
  return plan_version(folder);
}

PlanFit plan_fit(const Plan& plan, bones::BoneKind bone, const std::string& mesh_sha256) {
  if (!plan.tunnels.contains(bone)) return {};
  const std::string name(bones::to_text(bone));
  if (mesh_sha256.empty()) {
    return {PlanFit::Outcome::NoBone, "the tunnel is planned on a " + name + " that the case lacks"};
  }
  const auto planned_on = plan.mesh_sha256.find(bone);
  if (planned_on == plan.mesh_sha256.end()) return {PlanFit::Outcome::Unknown, ""};
  if (planned_on->second == mesh_sha256) return {PlanFit::Outcome::Fits, ""};
  return {PlanFit::Outcome::OtherMesh,
          "the tunnel was planned on another surface of the " + name + " than the case holds now"};
}

PlanFit plan_fit(const Case& contents, bones::BoneKind bone) {
  const auto found = contents.bones.find(bone);
  return plan_fit(contents.plan, bone,
                  found == contents.bones.end() ? "" : bones::mesh_sha256(found->second.mesh));
}

bool plan_fits(const Case& contents, bones::BoneKind bone) { return plan_fit(contents, bone).is_valid(); }

}  // namespace arthronaut::cases
