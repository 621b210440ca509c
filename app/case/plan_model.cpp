#include "app/case/plan_model.h"

#include "app/scene/scene_content.h"
#include "planning/geometry/error.h"

namespace arthronaut::open_case {

namespace {

landmarks::Landmarks landmarks_of(const cases::Case& knee, bones::BoneKind kind) {
  const auto found = knee.landmarks.find(kind);
  return found == knee.landmarks.end() ? landmarks::Landmarks{} : found->second;
}

}  // namespace

PlanModel::PlanModel(cases::Case knee) : knee_(std::move(knee)) {
  for (const auto& [kind, bone] : knee_.bones) {
    if (bone.mesh.empty()) continue;
    bones_.emplace(
        kind, BoneModel{scene::simplified(bone.mesh),
                        std::make_shared<geometry::Surface>(bone.mesh),
                        geometry::bounds_of(bone.mesh),
                        {},
                        tunnels::surroundings_of(bone.mesh, kind, landmarks_of(knee_, kind), knee_.side)});
    measure(kind);
  }
  if (bones_.empty()) throw InvalidInput("the case \"" + knee_.name + "\" has no bone to show");
}

std::optional<tunnels::Tunnel> PlanModel::tunnel(bones::BoneKind kind) const {
  const auto found = knee_.plan.tunnels.find(kind);
  if (found == knee_.plan.tunnels.end()) return std::nullopt;
  return found->second;
}

const tunnels::TunnelGeometry& PlanModel::measured(bones::BoneKind kind) const {
  return bones_.at(kind).measured;
}

std::vector<tunnels::PlanCheck> PlanModel::checks(bones::BoneKind kind) const {
  const auto planned = tunnel(kind);
  if (!planned) return {};
  return tunnels::check_plan(*planned, measured(kind), bones_.at(kind).surroundings);
}

double PlanModel::drawn_length_mm(bones::BoneKind kind) const {
  constexpr double kLengthOfOneThatMisses_mm = 30;
  const tunnels::TunnelGeometry& geometry = measured(kind);
  return geometry.enters_bone ? geometry.length_mm : kLengthOfOneThatMisses_mm;
}

geometry::Bounds PlanModel::bounds(std::optional<bones::BoneKind> only) const {
  if (only && has_bone(*only)) return bones_.at(*only).bounds;
  geometry::Bounds all = bones_.begin()->second.bounds;
  for (const auto& [kind, bone] : bones_) {
    all.min_mm = all.min_mm.cwiseMin(bone.bounds.min_mm);
    all.max_mm = all.max_mm.cwiseMax(bone.bounds.max_mm);
  }
  return all;
}

void PlanModel::set_tunnel(bones::BoneKind kind, const std::optional<tunnels::Tunnel>& tunnel) {
  if (tunnel)
    knee_.plan.tunnels.insert_or_assign(kind, *tunnel);
  else
    knee_.plan.tunnels.erase(kind);
  measure(kind);
  ++revision_;
}

void PlanModel::measure(bones::BoneKind kind) {
  BoneModel& bone = bones_.at(kind);
  const auto planned = tunnel(kind);
  bone.measured = planned ? tunnels::measure(*planned, *bone.surface) : tunnels::TunnelGeometry{};
}

}  // namespace arthronaut::open_case
