#include "app/plan/version_words.h"

#include <utility>

#include "planning/files/fixed_number.h"
#include "planning/files/unit_signs.h"

namespace arthronaut::plan {

KeptVersion measured_in(const open_case::PlanModel& model, cases::PlanVersion version) {
  KeptVersion kept{std::move(version), {}};
  for (const auto& [key, tunnel] : kept.version.plan.tunnels)
    if (model.has_bone(key.bone) && model.plan_fit(kept.version.plan, key).is_valid())
      kept.measured.emplace(
          key, plan_review::MeasuredTunnel{tunnel, tunnels::measure(tunnel, model.surface(key.bone))});
  return kept;
}

std::vector<std::string> against_the_plan(const open_case::PlanModel& model, const KeptVersion& kept) {
  using Kind = cases::TunnelDifference::Kind;
  std::vector<std::string> lines;
  for (const auto& difference : cases::compare_plans(model.knee().plan, kept.version.plan)) {
    std::string line = difference.in_words();
    const auto there = kept.measured.find(difference.key);
    if (difference.kind != Kind::Same && there != kept.measured.end()) {
      const tunnels::TunnelGeometry &then = there->second.geometry, &now = model.measured(difference.key);
      const auto beside = [&](double value_now) {
        return now.enters_bone ? " (now " + files::fixed(value_now, 1) + ")" : std::string();
      };
      line += !then.enters_bone
                  ? "; it misses the bone"
                  : "; " + files::fixed(then.length_mm, 1) + " mm long" + beside(now.length_mm) + ", wall " +
                        files::fixed(then.wall_mm, 1) + " mm" + beside(now.wall_mm);
    }
    if (kept.version.plan.tunnels.contains(difference.key) && there == kept.measured.end())
      line += "; planned on another surface of the bone";
    lines.push_back(files::with_signs(std::move(line)));
  }
  return lines;
}

}  // namespace arthronaut::plan
