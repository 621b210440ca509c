#include "planning/default_plan/place_words.h"

#include <algorithm>
#include <cmath>

#include "planning/files/format.h"

namespace arthronaut::default_plan {

namespace {

using Eigen::Vector3d;
using tunnels::PlanCheck;

// On the plateau "0.9 mm lateral, 0.4 mm anterior"; on the wall of the notch "0.9 mm proximal, ...".
std::string way_in_words(const Vector3d& way_mm, bones::BoneKind bone,
                         const landmarks::AnatomicalAxes& axes) {
  const double lateral = way_mm.dot(axes.lateral), proximal = way_mm.dot(axes.proximal),
               anterior = way_mm.dot(axes.anterior);
  const std::string first =
      bone == bones::BoneKind::Tibia
          ? files::format("%.1f mm %s", std::abs(lateral), lateral > 0 ? "lateral" : "medial")
          : files::format("%.1f mm %s", std::abs(proximal), proximal > 0 ? "proximal" : "distal");
  return first + files::format(", %.1f mm %s", std::abs(anterior), anterior > 0 ? "anterior" : "posterior");
}

// Which way the surgeon would move, and why: at a tibia's mouth the thin place is mostly a flank of the
// eminence.
std::string thin_place_in_words(const tunnels::Tunnel& tunnel, const std::vector<PlanCheck>& failed,
                                const landmarks::AnatomicalAxes& axes) {
  const auto wall = std::ranges::find(failed, "Wall", &PlanCheck::name);
  if (wall == failed.end() || !wall->at_mm || !wall->value) return "";
  const Vector3d way_mm = *wall->at_mm - tunnel.entry_mm;
  if (way_mm.dot(tunnel.direction) > tunnel.diameter_mm) return "";  // not beside the mouth
  const bool is_on_ridge = *wall->value < -tunnel.diameter_mm / 4;   // the edge is nearer than half a radius
  return (is_on_ridge ? "; there it stands on a ridge narrower than the tunnel, and the bone falls away "
                      : "; there the bone beside it is thinnest ") +
         way_in_words(way_mm, tunnel.bone, axes) + " of the entry";
}

}  // namespace

std::string around_in_words(const tunnels::Tunnel& at_norm, const DefaultTunnel& made,
                            const landmarks::AnatomicalAxes& axes, bool fails_by_diameter) {
  std::string words = thin_place_in_words(at_norm, made.failed, axes);
  if (!made.other_entry) return words + "; with this aim no place within the norm's spread is better";
  const Vector3d way_mm = made.other_entry->entry_mm - at_norm.entry_mm;
  words +=
      files::format("; with this aim a tunnel %.1f mm from that entry (%s), still within the norm's spread, ",
                    way_mm.norm(), way_in_words(way_mm, at_norm.bone, axes).c_str());
  if (made.other_entry->passes())
    return words + "passes every check" +
           (fails_by_diameter ? " but that of its diameter, which was asked for" : "");
  words += "can be drilled; none there passes every check, and to be looked at is";
  for (const PlanCheck& check : made.other_entry->failed) words += " " + check.name + ": " + check.text + ";";
  words.pop_back();
  return words;
}

}  // namespace arthronaut::default_plan
