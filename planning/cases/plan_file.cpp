#include "planning/cases/plan_file.h"

#include <nlohmann/json.hpp>

#include "planning/bones/mesh_hash.h"
#include "planning/files/atomic_file.h"
#include "planning/files/format.h"
#include "planning/files/json_document.h"
#include "planning/files/sha256.h"
#include "planning/geometry/error.h"
#include "planning/tunnels/diameter_range.h"
#include "planning/tunnels/tunnel_json.h"

namespace arthronaut::cases {

namespace {

namespace fs = std::filesystem;

fs::path plan_file(const fs::path& case_folder) { return case_folder / "plan.json"; }

}  // namespace

std::vector<tunnels::TunnelKey> Plan::of(bones::BoneKind bone) const {
  std::vector<tunnels::TunnelKey> keys;
  for (const auto& [key, tunnel] : tunnels)
    if (key.bone == bone) keys.push_back(key);
  return keys;
}

void Plan::put(const tunnels::Tunnel& tunnel, const std::string& planned_on_mesh_sha256) {
  const tunnels::TunnelKey key = tunnel.key();
  const std::string mesh = planned_on_mesh_sha256;  // which may be that of a tunnel that goes
  for (const tunnels::TunnelKey& other : of(key.bone)) {
    if ((other.bundle == norms::Bundle::Whole) != (key.bundle == norms::Bundle::Whole)) remove(other);
  }
  tunnels.insert_or_assign(key, tunnel);
  if (mesh.empty())
    mesh_sha256.erase(key);
  else
    mesh_sha256.insert_or_assign(key, mesh);
}

void Plan::remove(const tunnels::TunnelKey& key) {
  tunnels.erase(key);
  mesh_sha256.erase(key);
}

Plan plan_from(const std::string& text, const fs::path& file) {
  return plan_from(files::parse_json(text, file, kPlanFormat, kPlanFormatVersion));
}

Plan plan_from(const files::JsonObject& root) {
  Plan plan;
  for (const auto& node : root.objects("tunnels")) {
    const tunnels::Tunnel tunnel = tunnels::read_tunnel(node, tunnels::read_key(node));
    if (tunnel.diameter_mm < tunnels::kLeastDiameter_mm || tunnel.diameter_mm > tunnels::kGreatestDiameter_mm)
      node.fail("diameter_mm", files::format("is %g, must be %g to %g", tunnel.diameter_mm,
                                             tunnels::kLeastDiameter_mm, tunnels::kGreatestDiameter_mm));
    const auto others = plan.of(tunnel.bone);
    if (plan.tunnels.contains(tunnel.key())) {
      node.fail("bone", tunnel.bundle == norms::Bundle::Whole ? "has two tunnels"
                                                              : "has two tunnels of the same bundle");
    }
    if (!others.empty() &&
        (tunnel.bundle == norms::Bundle::Whole || others.front().bundle == norms::Bundle::Whole))
      node.fail("bundle", "stands beside a single tunnel of the same bone");
    plan.tunnels.emplace(tunnel.key(), tunnel);
    if (node.has("mesh_sha256")) plan.mesh_sha256[tunnel.key()] = node.text("mesh_sha256");
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
  for (const auto& [key, tunnel] : plan.tunnels) {
    const auto bone = contents.bones.find(key.bone);
    if (bone == contents.bones.end() || plan.mesh_sha256.contains(key)) continue;
    plan.mesh_sha256[key] = bones::mesh_sha256(bone->second.mesh);
  }
  return plan;
}

void name_meshes(Case& contents) { contents.plan = with_named_meshes(contents); }

nlohmann::ordered_json to_json(const Plan& plan) {
  auto tunnels = nlohmann::ordered_json::array();
  int version = 1;
  for (const auto& [key, tunnel] : plan.tunnels) {
    nlohmann::ordered_json node = {{"bone", bones::to_text(key.bone)}};
    node.update(tunnels::to_json(tunnel));
    if (key.bundle != norms::Bundle::Whole) {
      node["bundle"] = norms::to_text(key.bundle);
      version = kPlanFormatVersion;
    }
    if (const auto hash = plan.mesh_sha256.find(key); hash != plan.mesh_sha256.end()) {
      node["mesh_sha256"] = hash->second;
    }
    tunnels.push_back(std::move(node));
  }
  return {{"format", kPlanFormat}, {"version", version}, {"tunnels", std::move(tunnels)}};
}

std::string plan_sha256(const Plan& plan) { return files::sha256_of(files::as_text(to_json(plan))); }

std::string short_plan_hash(const Plan& plan) { return plan_sha256(plan).substr(0, 12); }

std::string plan_in_words(const Case& contents) {
  const Plan plan = with_named_meshes(contents);
  return std::string(bones::to_text(contents.side)) + " knee, " +
         (plan.tunnels.empty() ? "nothing planned" : "plan " + short_plan_hash(plan));
}

fs::path export_folder(const fs::path& case_folder, const Plan& plan) {
  const fs::path folder = case_folder / "export";
  return plan.tunnels.empty() ? folder : folder / ("plan_" + short_plan_hash(plan));
}

void save_plan(const fs::path& folder, const Plan& plan) {
  const nlohmann::ordered_json json = to_json(plan);
  (void)plan_from(json.dump(), plan_file(folder));  // what could not be read again would shut the case
  files::write_json(plan_file(folder), json);
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

PlanFit plan_fit(const Plan& plan, const tunnels::TunnelKey& key, const std::string& mesh_sha256) {
  if (!plan.tunnels.contains(key)) return {};
  const std::string name(bones::to_text(key.bone));
  const std::string which =
      key.bundle == norms::Bundle::Whole ? "the tunnel" : "the tunnel " + tunnels::name_of(key);
  if (mesh_sha256.empty()) {
    return {PlanFit::Outcome::NoBone, which + " is planned on a " + name + " that the case lacks"};
  }
  const auto planned_on = plan.mesh_sha256.find(key);
  if (planned_on == plan.mesh_sha256.end()) return {PlanFit::Outcome::Unknown, ""};
  if (planned_on->second == mesh_sha256) return {PlanFit::Outcome::Fits, ""};
  return {PlanFit::Outcome::OtherMesh,
          which + " was planned on another surface of the " + name + " than the case holds now"};
}

PlanFit plan_fit(const Case& contents, const tunnels::TunnelKey& key) {
  const auto found = contents.bones.find(key.bone);
  return plan_fit(contents.plan, key,
                  found == contents.bones.end() ? "" : bones::mesh_sha256(found->second.mesh));
}

bool plan_fits(const Case& contents, const tunnels::TunnelKey& key) {
  return plan_fit(contents, key).is_valid();
}

}  // namespace arthronaut::cases
