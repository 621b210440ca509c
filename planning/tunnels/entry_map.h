// Where an entry passes every check: a map on the wall of the notch, or on the plateau.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "planning/tunnels/plan_checks.h"

namespace arthronaut::tunnels {

struct EntrySample {
  Eigen::Vector3d entry_mm = Eigen::Vector3d::Zero();
  // The worst of its checks: Wrong, Look, else Fine. What could not be checked at all is the same everywhere
  // and does not count, so a map is as good as what it was made with.
  PlanCheck::Verdict verdict = PlanCheck::Verdict::NotChecked;
  std::string reason = {};  // the check that was worst: "Wall: 0.4 mm ..."; empty when Fine
};

// Points of the surface about one of them, spacing_mm apart in the plane that touches there, up to radius_mm;
// each where a line along that plane's normal comes down on the bone, so that what hangs over is not seen.
[[nodiscard]] std::vector<Eigen::Vector3d> entries_around(const geometry::Surface& bone,
                                                          const Eigen::Vector3d& about_mm, double radius_mm,
                                                          double spacing_mm);

// The tunnel to be judged at an entry. Without one the direction is kept.
using AimAt = std::function<Tunnel(const Eigen::Vector3d& entry_mm)>;

// One sample an entry, in their order. Some 5 ms each: run it beside the screen. Stops early, with the
// samples so far, when is_cancelled says so. further: the checks that concern more than this bone
// (knee_checks.h); may be empty.
struct EntryMapRequest {
  std::vector<Eigen::Vector3d> entries_mm;
  Tunnel like;
  AimAt aim_at = {};
  std::function<std::vector<PlanCheck>(const Tunnel&, const TunnelGeometry&)> further = {};
};
[[nodiscard]] std::vector<EntrySample> map_entries(const EntryMapRequest& request,
                                                   const geometry::Surface& bone,
                                                   const PlanSurroundings& surroundings,
                                                   const PlanNorms& norms = {},
                                                   const std::function<bool()>& is_cancelled = {});

}  // namespace arthronaut::tunnels
