#include "planning/default_plan/aim.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "planning/geometry/rigid_transform.h"
#include "planning/tunnels/knee_checks.h"
#include "planning/tunnels/plan_norms.h"
#include "planning/tunnels/portal.h"

namespace arthronaut::default_plan {

namespace {

using Eigen::Vector3d;
using geometry::rad_from_deg;

constexpr double kLeastFacing = 0.25;  // of the exit's normal along where it should look
// How far inside of its limit a number should stay: what is about as good is a mean of several directions,
// and another scan shows all of them a little otherwise.
constexpr double kMargin = 0.5;
// What a millimetre or a degree beyond that, a check that is failed, and a step away from what was asked for
// count.
constexpr double kPerMillimetre = 4, kPerDegree = 0.5, kPerBetween = 8, kPerFailed = 12, kPerStep = 0.6;
// What costs less than so much more than the best counts, too: four steps, or 0.6 mm of wall.
constexpr double kStillCounts = 2.4;

struct Candidate {
  Vector3d direction;
  double steps = 0;  // away from what was asked for
};

std::vector<Candidate> through_portal(const tunnels::Tunnel& at, const Joint& joint, const Options& options) {
  std::vector<Candidate> candidates;
  const auto& axes = joint.axes;
  const Vector3d usual = tunnels::anteromedial_portal(joint.hinge, axes).at_mm;  // of the extended knee
  for (const double more : {0.0, -5.0, 5.0, -10.0, 10.0, 15.0, -15.0}) {
    const auto flexed = graft::femur_from_tibia(
        joint.hinge, rad_from_deg(std::clamp(options.flexion_deg + more, 100.0, 130.0)));
    for (const double medial : {0.0, -5.0, 5.0, 8.0}) {
      for (const double distal : {0.0, -5.0, 5.0}) {
        const Vector3d portal =
            flexed * Vector3d(usual - joint.hinge.scale() * (medial * axes.lateral + distal * axes.proximal));
        candidates.push_back({(at.entry_mm - portal).normalized(),
                              std::abs(more) / 5 + std::abs(medial) / 5 + std::abs(distal) / 5});
      }
    }
  }
  return candidates;
}

// The posterolateral tunnel starts behind the anteromedial one and has to come out medially of it.
std::vector<Candidate> along_guide(const Joint& joint, const Options& options, bool is_beside) {
  std::vector<Candidate> candidates;
  const auto& axes = joint.axes;
  const double coronal_deg = tunnels::PlanNorms{}.tibial_coronal_deg.center;
  const std::array<double, 8> guides{0, -5, 5, -10, 10, -15, 15, 20};
  std::vector<double> coronals{0, -2.5, 2.5, -5, 5, -10};
  if (is_beside) coronals.insert(coronals.end(), {10, -15, -20});
  for (const double guide : guides) {
    for (const double coronal : coronals) {
      const double forward = 1 / std::tan(rad_from_deg(options.guide_deg + guide));
      const double medial = 1 / std::tan(rad_from_deg(coronal_deg + coronal));
      candidates.push_back({(forward * axes.anterior - medial * axes.lateral - axes.proximal).normalized(),
                            std::abs(guide) / 5 + std::abs(coronal) / 2.5});
    }
  }
  return candidates;
}

double misfit_cost(const tunnels::PlanCheck& check) {
  if (!check.value || check.unit == "%") return 0;  // shares of a grid are the entry's, however it is aimed
  const double beyond = std::max({0.0, check.least ? *check.least + kMargin - *check.value : 0.0,
                                  check.greatest ? *check.value - *check.greatest + kMargin : 0.0});
  return (check.unit == "deg" ? kPerDegree : kPerMillimetre) * beyond;
}

}  // namespace

std::optional<tunnels::Tunnel> aim(const tunnels::Tunnel& at_entry, const geometry::Surface& surface,
                                   const Joint& joint, const Options& options,
                                   const tunnels::Tunnel* beside) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const bool is_femur = at_entry.bone == bones::BoneKind::Femur;
  const auto& axes = joint.axes;
  const Vector3d exit_side =
      is_femur ? axes.lateral : Vector3d((axes.anterior - 0.7 * axes.lateral).normalized());
  auto candidates =
      is_femur ? through_portal(at_entry, joint, options) : along_guide(joint, options, beside != nullptr);
  const auto neighbour = beside != nullptr ? tunnels::measure(*beside, surface) : tunnels::TunnelGeometry{};
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.steps < b.steps; });
  // Of the tunnel itself; infinite where it cannot be.
  const auto cost_along = [&](const Vector3d& direction) {
    tunnels::Tunnel tunnel = at_entry;
    tunnel.direction = direction;
    const auto measured = tunnels::measure(tunnel, surface);
    if (!measured.enters_bone || (measured.entry_on_surface_mm - tunnel.entry_mm).norm() > 2) return kNever;
    if (measured.exit.normal.dot(exit_side) < kLeastFacing) return kNever;
    double cost = 0;
    for (const tunnels::PlanCheck& check : tunnels::check_plan(tunnel, measured, joint.surroundings))
      cost += misfit_cost(check) + (tunnels::is_failed(check) ? kPerFailed : 0);
    if (joint.leaves_unseen(measured)) cost += 2 * kPerFailed;  // length and exit, which nobody can check
    if (neighbour.enters_bone) {
      const auto between = tunnels::check_pair(tunnel, measured, *beside, neighbour);
      cost += kPerBetween * std::max(0.0, *between.least - *between.value);
    }
    return cost;
  };
  std::vector<std::pair<double, Vector3d>> possible;
  double least_cost = kNever;
  Vector3d best = at_entry.direction;
  for (const Candidate& candidate : candidates) {
    if (options.stop.stop_requested()) return std::nullopt;
    const double by_steps = kPerStep * candidate.steps;
    if (by_steps >= least_cost + kStillCounts) break;  // the rest can only cost more
    const double cost = by_steps + cost_along(candidate.direction);
    if (!std::isfinite(cost)) continue;
    possible.emplace_back(cost, candidate.direction);
    if (cost < least_cost) least_cost = cost, best = candidate.direction;
  }
  if (possible.empty()) return std::nullopt;
  // The best alone would leap from one candidate to another that is as good: what is about as good counts,
  // the nearer to the best the more.
  Vector3d sum = Vector3d::Zero();
  for (const auto& [cost, direction] : possible)
    sum += std::max(0.0, 1 - (cost - least_cost) / kStillCounts) * direction;
  // Where the mean of them fails what the best passes, no further from the best than is needed.
  const Vector3d mean = sum.normalized();
  tunnels::Tunnel aimed = at_entry;
  for (const double share : {1.0, 0.75, 0.5, 0.25, 0.0}) {
    aimed.direction = (share * mean + (1 - share) * best).normalized();
    if (cost_along(aimed.direction) <= least_cost + kStillCounts) break;
  }
  return aimed;
}

}  // namespace arthronaut::default_plan
