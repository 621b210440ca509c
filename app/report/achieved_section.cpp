#include "app/report/achieved_section.h"

#include "app/report/report_words.h"
#include "app/report/session_rows.h"

namespace arthronaut::report {

void draw_achieved(FlowingPages& pages, const Content& content, const operation::AchievedTunnel& achieved,
                   bool is_own) {
  pages.heading("Planned against achieved: " + tunnels::name_of(achieved.planned.key()));
  if (const std::string since = changed_since(content, achieved.planned); !since.empty())
    pages.sentence(since, {.bold = true, .ink = kWarning});
  const auto planned_measured = operation::compare(achieved.planned, achieved.measured);
  std::vector<std::vector<std::string>> rows = {
      {"Comparison", "Offset of the entry", "Offset of the axis", "Angle"},
      {"As navigation measured it, against the plan", number(planned_measured.entry_mm, " mm", 2),
       number(planned_measured.axis_to_entry_mm, " mm", 2), number(planned_measured.angle_deg, "°", 2)}};
  if (achieved.truth) {
    const auto planned_true = operation::compare(achieved.planned, *achieved.truth);
    const auto measured_true = operation::compare(*achieved.truth, achieved.measured);
    rows.push_back({"As it truly lies (simulator), against the plan", number(planned_true.entry_mm, " mm", 2),
                    number(planned_true.axis_to_entry_mm, " mm", 2), number(planned_true.angle_deg, "°", 2)});
    rows.push_back({"Error of navigation: measured against true", number(measured_true.entry_mm, " mm", 2),
                    number(measured_true.axis_to_entry_mm, " mm", 2),
                    number(measured_true.angle_deg, "°", 2)});
  }
  pages.table({80, 32, 32, 26}, rows);
  if (const auto place = place_of(content, achieved)) {
    std::string words = "As navigation measured it: entry " + postop::off_in_words(*place);
    if (const std::string grid = postop::grid_in_words(*place); !grid.empty()) words += "; " + grid;
    if (const std::string wall = postop::wall_in_words(*place); !wall.empty())
      words += "; least wall " + wall;
    pages.sentence(words + ".");
  }
  pages.sentence(
      "Depth reached " + (achieved.depth_mm ? number(*achieved.depth_mm, " mm") : "not known") +
          ". Predicted error of these figures, one sigma: " + number(achieved.sigma_offset_mm, " mm", 2) +
          ", " + number(achieved.sigma_angle_deg, "°", 2) + ". Median of " +
          std::to_string(achieved.pose_count) + " poses of guide or drill at the planned entry" +
          (is_own ? seen_and_said(*content.session, achieved) : "") + ".",
      {.size_pt = 8.5, .ink = kGray});
}

}  // namespace arthronaut::report
