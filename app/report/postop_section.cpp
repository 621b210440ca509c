#include "app/report/postop_section.h"

#include <algorithm>
#include <cmath>

#include "planning/files/format.h"

namespace arthronaut::report {

namespace {

using files::format;

constexpr TextStyle kSmall{.size_pt = 8.5, .bold = false, .ink = kGray};

// In bone; empty where the plan misses it. The comparison is of today's plan.
std::string planned_length(const Content& content, const tunnels::TunnelKey& key) {
  const auto plan = content.knee.plan.tunnels.find(key);
  const auto bone = content.knee.bones.find(key.bone);
  if (bone == content.knee.bones.end()) return {};
  const auto geometry = tunnels::measure(plan->second, geometry::Surface(bone->second.mesh));
  return geometry.enters_bone ? format("; planned %.1f mm", geometry.length_mm) : "";
}

// A cell for each row below, in their order.
std::vector<std::string> column(const Content& content, const tunnels::TunnelKey& key) {
  const postop::Comparison& comparison = content.postoperative.at(key);
  const postop::AchievedTunnel& found = comparison.tunnel;
  using enum postop::ComparisonVerdict;
  const postop::ComparisonVerdict verdict = verdict_of(content, key);
  const tunnels::Quantities known = relied_on(comparison);
  using enum tunnels::Quantity;
  // Where only a part is relied on each number of the rest says so itself.
  const auto doubted = [&](std::string text, const tunnels::Quantities& needed) {
    const bool is_doubted = verdict == ReliableInPart && !std::ranges::includes(known, needed);
    return text == "\u2013" || !is_doubted ? text : text + "; NOT RELIABLE";
  };
  std::vector<std::string> cells = {tunnels::name_of(key), verdict == NotReliable ? "NOT RELIABLE"
                                                           : verdict == ReliableInPart
                                                               ? "RELIABLE IN PART: " + known_in_words(known)
                                                               : std::string(to_text(verdict))};
  if (found.is_found) {
    const bool is_of_plan = verdict == NotReliable || verdict == ReliableInPart || verdict == Reliable;
    cells.push_back(doubted(
        format("%.2f mm ", found.offset_mm) + postop::sigma_in_words(found.entry_sigma_mm, 2), {Entry}));
    cells.push_back(
        doubted(std::isfinite(found.offset_across_mm) ? format("%.2f mm", found.offset_across_mm) : "\u2013",
                {Entry, Direction}));
    const auto place = content.places.find(key);
    const bool has_place = place != content.places.end();
    const auto told = [&](std::string (&words)(const postop::AchievedPlace&),
                          const tunnels::Quantities& needed) {
      const std::string text = has_place ? words(place->second) : std::string();
      return doubted(text.empty() ? std::string("\u2013") : text, needed);
    };
    cells.push_back(told(postop::off_in_words, {Entry}));
    cells.push_back(told(postop::grid_in_words, {Entry}));
    cells.push_back(doubted(format("%.2f\u00B0 ", geometry::deg_from_rad(found.angle_rad)) +
                                postop::sigma_in_words(geometry::deg_from_rad(found.direction_sigma_rad), 2),
                            {Direction}));
    cells.push_back(doubted(
        format("%.1f mm", found.tunnel.diameter_mm) +
            (is_of_plan ? format("; planned %.1f mm", content.knee.plan.tunnels.at(key).diameter_mm) : ""),
        {Diameter}));
    const std::string widths = postop::widths_in_words(found.widths);
    cells.push_back(widths.empty() ? "not seen" : doubted(widths, {Diameter}));
    cells.push_back(
        doubted(postop::length_in_words(found) + (is_of_plan ? planned_length(content, key) : ""), {Length}));
    cells.push_back(told(postop::wall_in_words, tunnels::all_quantities()));
    cells.push_back(format("%.0f %%", 100 * found.metal_share));
  } else {
    cells.insert(cells.end(), 10, "\u2013");
  }
  cells.push_back(comparison.bone.is_found ? format("%.2f mm", comparison.bone.rms_mm) : "\u2013");
  return cells;
}

}  // namespace

void draw_postop_section(FlowingPages& pages, const Content& content) {
  pages.heading("Planned against achieved: CT after the operation", content.postoperative.empty() ? 6 : 60);
  if (!content.postoperative_problem.empty()) {
    pages.sentence("NOT READABLE: " + content.postoperative_problem, {.ink = kWarning});
    return;
  }
  if (content.postoperative.empty()) {
    pages.sentence("No comparison with images after the operation is kept in this case.", kSmall);
    return;
  }
  std::vector<std::vector<std::string>> rows = {{"Quantity"},
                                                {"Verdict"},
                                                {"Offset of the entry"},
                                                {"Offset of the axis"},
                                                {"Which way"},
                                                {"Entry in the grid"},
                                                {"Angle to the planned axis"},
                                                {"Diameter"},
                                                {"Diameter along the wall"},
                                                {"Length in bone"},
                                                {"Least wall"},
                                                {"Metal in it"},
                                                {"Bone off the images' edges, RMS"}};
  if (content.postoperative.size() == 1) {
    const auto cells = column(content, content.postoperative.begin()->first);
    rows.front() = {"Tunnel"};
    for (std::size_t row = 0; row < rows.size(); ++row) rows[row].push_back(cells[row]);
    pages.pairs(rows);
  } else {
    constexpr double kName_mm = 54;
    const auto count = static_cast<double>(content.postoperative.size());
    std::vector<double> widths_mm{kName_mm};
    for (const auto& [key, comparison] : content.postoperative) {
      const auto cells = column(content, key);
      for (std::size_t row = 0; row < rows.size(); ++row) rows[row].push_back(cells[row]);
      widths_mm.push_back((FlowingPages::kWidthMm - kName_mm) / count);
    }
    pages.table(widths_mm, rows);
  }
  for (const auto& [key, comparison] : content.postoperative)
    if (!comparison.kept_because.empty())
      pages.sentence(
          "\u2013 " + tunnels::name_of(key) + ", kept from earlier images: " + comparison.kept_because,
          {.ink = kWarning});
  for (const auto& [key, comparison] : content.postoperative)
    for (const std::string& doubt : doubts_of(content, key))
      pages.sentence("\u2013 " + tunnels::name_of(key) + ": " + doubt, {.ink = kWarning});
  pages.sentence(
      "\u00B1: one sigma by the scatter of the grey and the bone's pose. In none of these numbers: how far "
      "the "
      "plan's bone is from the patient's, the scanners' own scale, what moved since, how the tunnel has "
      "widened.",
      {.size_pt = 8, .ink = kGray});
}

std::vector<tunnels::Tunnel> tunnels_in_the_images(const Content& content) {
  std::vector<tunnels::Tunnel> tunnels;
  for (const auto& [key, comparison] : content.postoperative)
    if (verdict_of(content, key) == postop::ComparisonVerdict::Reliable)
      tunnels.push_back(comparison.tunnel.tunnel);
  return tunnels;
}

}  // namespace arthronaut::report
