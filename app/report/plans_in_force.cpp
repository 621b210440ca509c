#include "app/report/plans_in_force.h"

#include <map>
#include <optional>

#include "app/report/session_rows.h"
#include "planning/bones/mesh_hash.h"
#include "planning/files/format.h"

namespace arthronaut::report {

std::vector<PlanInForce> plans_in_force(const recording::RecordedSession& session) {
  std::vector<PlanInForce> plans;
  std::optional<operation::PlannedTunnel> last;
  for (const recording::SessionEvent& event : session.events()) {
    if (event.kind == recording::kSourceEndedEvent) break;
    if (event.kind != recording::kPlanEvent) continue;
    const auto change = session.plan_of(event);
    std::optional<operation::PlannedTunnel> next;
    if (change.plan) next = {*change.plan, change.planned_length_mm};
    if (event.after_frame < 0)
      plans.clear();
    else if (next == last)
      continue;
    last = next;
    if (next) plans.push_back({&event, *next, time_s(session, event.timestamp_ns)});
  }
  return plans;
}

std::string in_words(const operation::PlannedTunnel& plan) {
  return tunnels::name_of(plan.tunnel.key()) +
         files::format(", %.1f mm wide, %.1f mm long", plan.tunnel.diameter_mm, plan.length_mm);
}

std::string plans_in_words(const std::vector<PlanInForce>& plans) {
  std::string words;
  for (const PlanInForce& next : plans)
    words +=
        (words.empty() ? "" : "; from " + recording::clock_text(next.since_s) + " ") + in_words(next.plan);
  return words;
}

std::vector<std::string> plan_warnings(const recording::RecordedSession& session, const Content& content) {
  std::vector<std::string> warnings;
  std::map<tunnels::TunnelKey, operation::PlannedTunnel> last;
  for (const PlanInForce& next : plans_in_force(session)) {
    const tunnels::TunnelKey key = next.plan.tunnel.key();
    if (const auto before = last.find(key); before != last.end() && before->second != next.plan)
      warnings.push_back("THE PLAN WAS CHANGED IN THE SESSION, at " + recording::clock_text(next.since_s) +
                         ": from " + in_words(before->second) + ", to " + in_words(next.plan) + ".");
    last.insert_or_assign(key, next.plan);
  }
  const auto bone = content.knee.bones.find(session.header().bone);
  if (bone == content.knee.bones.end() ||
      recording::is_of_another_surface(session.header(), bones::mesh_sha256(bone->second.mesh)))
    return warnings;
  for (const auto& [key, plan] : last)
    if (const std::string by = difference_from_now(content, plan.tunnel); !by.empty())
      warnings.push_back("THE PLAN IS ANOTHER ONE NOW: the session was planned to the " + in_words(plan) +
                         "; this tunnel was " + by + ".");
  return warnings;
}

}  // namespace arthronaut::report
