#include "app/command_line/plan_report.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "planning/files/format.h"
#include "planning/files/json_document.h"
#include "planning/tunnels/knee_checks.h"
#include "planning/tunnels/plan_checks.h"

namespace arthronaut::command_line {

namespace {

using tunnels::PlanCheck;

landmarks::Landmarks landmarks_of(const cases::Case& knee, bones::BoneKind kind) {
  const auto found = knee.landmarks.find(kind);
  return found == knee.landmarks.end() ? landmarks::Landmarks{} : found->second;
}

// The tunnel of the other bone, measured, for what concerns both.
struct OtherTunnel {
  std::optional<tunnels::Tunnel> tunnel;
  tunnels::TunnelGeometry measured;
};

OtherTunnel other_tunnel(const cases::Case& knee, bones::BoneKind kind) {
  const bones::BoneKind other =
      kind == bones::BoneKind::Femur ? bones::BoneKind::Tibia : bones::BoneKind::Femur;
  const auto planned = knee.plan.tunnels.find(other);
  const auto bone = knee.bones.find(other);
  if (planned == knee.plan.tunnels.end() || bone == knee.bones.end()) return {};
  return {planned->second, tunnels::measure(planned->second, geometry::Surface(bone->second.mesh))};
}

tunnels::KneeSurroundings knee_surroundings_of(const cases::Case& knee) {
  const auto femur = knee.bones.find(bones::BoneKind::Femur);
  if (femur == knee.bones.end()) return {};
  return tunnels::knee_surroundings_of(
      femur->second.mesh, tunnels::surroundings_of(femur->second.mesh, bones::BoneKind::Femur,
                                                   landmarks_of(knee, bones::BoneKind::Femur), knee.side));
}

// Those of the bone, then those of the whole knee that concern it.
std::vector<PlanCheck> checks_of(const cases::Case& knee, const tunnels::Tunnel& tunnel,
                                 const tunnels::TunnelGeometry& measured) {
  const auto surroundings = tunnels::surroundings_of(knee.bones.at(tunnel.bone).mesh, tunnel.bone,
                                                     landmarks_of(knee, tunnel.bone), knee.side);
  auto checks = tunnels::check_plan(tunnel, measured, surroundings);
  if (!measured.enters_bone) return checks;
  const OtherTunnel other = other_tunnel(knee, tunnel.bone);
  tunnels::KneePlan plan{&tunnel, &measured, other.tunnel ? &*other.tunnel : nullptr, &other.measured};
  if (tunnel.bone == bones::BoneKind::Tibia) {
    std::swap(plan.femoral, plan.tibial);
    std::swap(plan.femoral_measured, plan.tibial_measured);
  }
  for (auto& check : tunnels::check_knee(tunnel.bone, plan, knee_surroundings_of(knee)))
    checks.push_back(std::move(check));
  return checks;
}

const char* sign_of(PlanCheck::Verdict verdict) {
  switch (verdict) {
    case PlanCheck::Verdict::Look:
    case PlanCheck::Verdict::Wrong:
      return "  ! ";
    case PlanCheck::Verdict::NotChecked:
      return "  ? ";
    case PlanCheck::Verdict::Fine:
    case PlanCheck::Verdict::Note:
      break;
  }
  return "    ";
}

}  // namespace

void describe_tunnel(const Context& context, const cases::Case& knee, const tunnels::Tunnel& tunnel,
                     const geometry::Surface& surface) {
  const auto measured = tunnels::measure(tunnel, surface);
  const auto& e = tunnel.entry_mm;
  const auto& d = tunnel.direction;
  context.say(files::format("%s tunnel, %.1f mm", std::string(bones::to_text(tunnel.bone)).c_str(),
                            tunnel.diameter_mm));
  context.say(files::format("  entry      %.3f, %.3f, %.3f mm", e.x(), e.y(), e.z()));
  context.say(files::format("  direction  %.5f, %.5f, %.5f", d.x(), d.y(), d.z()));
  if (measured.enters_bone) {
    const auto& x = measured.exit_mm;
    context.say(files::format("  length     %.2f mm inside bone", measured.length_mm));
    context.say(files::format("  exit       %.3f, %.3f, %.3f mm", x.x(), x.y(), x.z()));
    context.say(files::format("  wall       %.2f mm at the thinnest", measured.wall_mm));
  }
  if (const auto fit = cases::plan_fit(knee, tunnel.bone); !fit.is_valid())
    context.say("  ! not valid: " + fit.reason);
  for (const auto& check : checks_of(knee, tunnel, measured)) {
    const bool is_amiss =
        check.verdict == PlanCheck::Verdict::Look || check.verdict == PlanCheck::Verdict::Wrong;
    const std::string source = is_amiss && !check.source.empty() ? " [" + check.source + "]" : "";
    context.say(sign_of(check.verdict) + check.name + ": " + check.text + source);
  }
}

nlohmann::ordered_json tunnel_to_json(const cases::Case& knee, const tunnels::Tunnel& tunnel,
                                      const geometry::Surface& surface, const PlanVerdict& verdict) {
  const auto measured = tunnels::measure(tunnel, surface);
  nlohmann::ordered_json node = {{"bone", bones::to_text(tunnel.bone)},
                                 {"entry_mm", files::to_json(tunnel.entry_mm)},
                                 {"direction", files::to_json(tunnel.direction)},
                                 {"diameter_mm", tunnel.diameter_mm},
                                 {"enters_bone", measured.enters_bone}};
  if (measured.enters_bone) {
    node["exit_mm"] = files::to_json(measured.exit_mm);
    node["length_mm"] = measured.length_mm;
    node["wall_mm"] = measured.wall_mm;
  }
  auto checks = nlohmann::ordered_json::array();
  for (const auto& check : checks_of(knee, tunnel, measured)) {
    checks.push_back({{"name", check.name},
                      {"verdict", to_text(check.verdict)},
                      {"text", check.text},
                      {"source", check.source}});
  }
  node["checks"] = std::move(checks);
  auto reasons = verdict.reasons;
  const auto fit = cases::plan_fit(knee, tunnel.bone);
  if (!fit.is_valid()) reasons.push_back(fit.reason);
  if (!verdict.source.empty()) node["source"] = verdict.source;
  node["reliable"] = verdict.is_reliable && fit.is_valid();
  node["reasons"] = reasons;
  return node;
}

}  // namespace arthronaut::command_line
