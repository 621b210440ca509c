#include "app/review/ct_beside.h"

#include "planning/geometry/rigid_transform.h"

namespace arthronaut::review {

CtWords ct_in_words(const postop::Comparison& comparison, const tunnels::Tunnel& planned) {
  using widgets::Severity;
  const postop::AchievedTunnel& found = comparison.tunnel;
  const auto& reasons = comparison.bone.reasons.empty() ? found.reasons : comparison.bone.reasons;
  const std::string why = reasons.empty() ? "" : ": " + reasons.front();
  if (!found.is_found) return {Severity::Caution, "the tunnel was not found" + why};
  if (!postop::is_against(found, planned)) return {Severity::Quiet, "compared with another plan than this"};
  const std::string text = "offset of the entry " + widgets::fixed(found.offset_mm, 1) + " mm, angle " +
                           widgets::fixed(geometry::deg_from_rad(found.angle_rad), 1) + "\u00B0";
  using enum tunnels::Quantity;
  if (postop::is_relied_on(comparison, {Entry, Direction})) return {Severity::Quiet, text};
  if (const std::string known = known_in_words(relied_on(comparison)); !known.empty())
    return {Severity::Caution, text + "; reliable in part, " + known + why};
  return {Severity::Caution, text + "; not reliable" + why};
}

}  // namespace arthronaut::review
