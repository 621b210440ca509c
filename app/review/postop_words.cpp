#include <algorithm>
#include <cmath>

#include "app/review/postop_page.h"
#include "planning/files/format.h"

namespace arthronaut::review {

namespace {

using files::format;

// What was found and is not reliable is shown, with that word: a number alone would be believed.
void fill_found(const postop::AchievedTunnel& found, AchievedRow& row) {
  row.offset = format("%.1f mm ", found.offset_mm) + postop::sigma_in_words(found.entry_sigma_mm, 1) +
               " from the planned one";
  row.angle = format("%.1f\u00B0 ", geometry::deg_from_rad(found.angle_rad)) +
              postop::sigma_in_words(geometry::deg_from_rad(found.direction_sigma_rad), 1) +
              " to the planned axis";
  row.diameter = format("%.1f mm", found.tunnel.diameter_mm);
  row.length = postop::length_in_words(found);
  if (const std::string widths = postop::widths_in_words(found.widths); !widths.empty())
    row.diameter += "; along the wall " + widths;
}

// Where only a part is relied on each number of the rest says so itself.
void mark_unknown(const tunnels::Quantities& known, AchievedRow& row) {
  const auto mark = [](bool is_known, std::string& text) {
    if (!is_known && !text.empty()) text += "; NOT RELIABLE";
  };
  using enum tunnels::Quantity;
  mark(known.contains(Entry), row.offset);
  mark(known.contains(Entry), row.grid);
  mark(known.contains(Direction), row.angle);
  mark(known.contains(Diameter), row.diameter);
  mark(known.contains(Length), row.length);
  mark(false, row.wall);  // follows from all
}

}  // namespace

std::vector<AchievedRow> achieved_rows(const Comparisons& comparisons,
                                       const std::map<tunnels::TunnelKey, tunnels::Tunnel>& planned,
                                       const std::map<tunnels::TunnelKey, double>& planned_length_mm,
                                       const Places& places) {
  std::vector<AchievedRow> rows;
  for (const auto& [key, comparison] : comparisons) {
    const postop::AchievedTunnel& tunnel = comparison.tunnel;
    AchievedRow row;
    row.tunnel = tunnels::name_of(key);
    row.offset = row.angle = row.diameter = row.length = "\u2013";
    if (tunnel.is_found) fill_found(tunnel, row);
    if (const auto now = planned.find(key); now != planned.end() && tunnel.is_found)
      row.diameter += format("; planned %.1f mm", now->second.diameter_mm);
    if (const auto length = planned_length_mm.find(key); length != planned_length_mm.end() && tunnel.is_found)
      row.length += format("; planned %.1f mm", length->second);
    const bool is_of_plan = postop::is_against(tunnel, key, planned);
    const postop::ComparisonVerdict verdict = postop::verdict_of(comparison, is_of_plan);
    row.severity = !tunnel.is_found                                 ? widgets::Severity::Bad
                   : verdict == postop::ComparisonVerdict::Reliable ? widgets::Severity::Good
                                                                    : widgets::Severity::Caution;
    row.verdict = to_text(verdict);
    const tunnels::Quantities known = relied_on(comparison);
    if (verdict == postop::ComparisonVerdict::ReliableInPart) row.verdict += ": " + known_in_words(known);
    row.reasons = comparison.bone.reasons;
    if (const auto place = places.find(key); place != places.end() && tunnel.is_found && is_of_plan) {
      row.offset += ": " + postop::off_in_words(place->second);
      row.grid = postop::grid_in_words(place->second);
      row.wall = postop::wall_in_words(place->second);
    }
    if (verdict == postop::ComparisonVerdict::ReliableInPart) mark_unknown(known, row);
    if (verdict == postop::ComparisonVerdict::OfAnEarlierPlan)
      row.reasons.insert(row.reasons.begin(), "the plan was changed since: compare again");
    if (!comparison.kept_because.empty())
      row.reasons.push_back("kept from earlier images: " + comparison.kept_because);
    for (const std::string& reason : tunnel.reasons)
      if (std::find(row.reasons.begin(), row.reasons.end(), reason) == row.reasons.end())
        row.reasons.push_back(reason);
    rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<std::string> error_budget(const postop::Comparison& comparison,
                                      const postop::AchievedPlace* place, const Eigen::Vector3d& voxel_mm) {
  std::vector<std::string> lines;
  if (comparison.bone.is_found)
    lines.push_back(format(
        "Bone in the images: %.2f mm (rms) off their edges; %.0f %% of the surface near the "
        "entry was seen, %.0f %% of it lies on an edge.",
        comparison.bone.rms_mm, 100 * comparison.bone.in_view_share, 100 * comparison.bone.on_edge_share));
  if (comparison.tunnel.is_found) {
    const auto told = [](double sigma, const char* unit) {
      return std::isfinite(sigma) ? format("%.2f%s", sigma, unit) : std::string("not known");
    };
    std::string line = "Tunnel, one sigma by the scatter of the grey and the bone's pose: entry " +
                       told(comparison.tunnel.entry_sigma_mm, " mm") + ", direction " +
                       told(geometry::deg_from_rad(comparison.tunnel.direction_sigma_rad), "\u00B0");
    if (std::isfinite(comparison.tunnel.diameter_sigma_mm))
      line += format(", diameter %.2f mm", comparison.tunnel.diameter_sigma_mm);
    if (std::isfinite(comparison.tunnel.length_sigma_mm))
      line += format(", length %.2f mm", comparison.tunnel.length_sigma_mm);
    if (place != nullptr && place->wall_mm && std::isfinite(place->wall_sigma_mm))
      line += format(", least wall %.2f mm", place->wall_sigma_mm);
    lines.push_back(line + ".");
  }
  if (comparison.tunnel.is_found && comparison.tunnel.metal_share > 0)
    lines.push_back(format("Metal fills %.0f %% of it; the wall beside it was passed over.",
                           100 * comparison.tunnel.metal_share));
  if (!voxel_mm.isZero())
    lines.push_back(
        format("Voxels of the images: %.2f x %.2f x %.2f mm.", voxel_mm.x(), voxel_mm.y(), voxel_mm.z()));
  lines.emplace_back(
      "Not known, and in none of these numbers: how far the plan's bone is from the patient's (its "
      "segmentation), the scanners' own scale, what moved between drilling and scan, and how the tunnel has "
      "widened since.");
  return lines;
}

scene::SlicePlane plane_along(const tunnels::Tunnel& tunnel, double length_mm, int quarter_turns,
                              double mm_per_px) {
  scene::SlicePlane plane;
  plane.down = tunnel.direction.normalized();
  const Eigen::Vector3d side = plane.down.unitOrthogonal();
  plane.right = quarter_turns % 2 == 0 ? side : plane.down.cross(side).eval();
  plane.center_mm = tunnel.entry_mm + 0.5 * length_mm * plane.down;
  plane.mm_per_px = mm_per_px;
  return plane;
}

}  // namespace arthronaut::review
