#include "app/report/settings_section.h"

#include "app/report/report_words.h"
#include "navigation/camera/calibration_words.h"
#include "navigation/camera/medium.h"
#include "navigation/recording/session.h"
#include "planning/files/utc_clock.h"

namespace arthronaut::report {

namespace {

// Of a body of several markers, all of them.
template <typename Body>
std::string ids_of(const Body& body) {
  std::string ids;
  for (const tools::BodyMarker& marker : tools::markers_of(body))
    ids += (ids.empty() ? "" : ", ") + std::to_string(marker.marker_id);
  return ids;
}

void camera_section(FlowingPages& pages, const Content& content) {
  const char* const whose = content.session ? "Camera of the session" : "The case's camera now";
  if (!content.camera_problem.empty()) {
    pages.heading(whose);
    pages.sentence("NOT READABLE: " + content.camera_problem, {.ink = kWarning});
  }
  if (!content.camera) return;
  const camera::CalibrationRecord& record = *content.camera;
  const auto& c = record.calibration;
  pages.heading(whose);
  pages.table(
      {38, 44, 36, 52},
      {{"Quantity", "Value", "Quantity", "Value"},
       {"Focal length", number(c.focal_px, " px", 2), "Distortion xi", number(c.distortion_xi, "", 4)},
       {"Principal point",
        number(c.principal_point_px.x(), ", ", 1) + number(c.principal_point_px.y(), " px", 1),
        "Centre of rotation",
        number(c.rotation_center_px.x(), ", ", 1) + number(c.rotation_center_px.y(), " px", 1)},
       {"Reprojection error", record.rms_px >= 0 ? number(record.rms_px, " px", 2) : "not recorded",
        "Calibrated in", camera::medium_to_text(c.refractive_index)},
       {"Date", record.date_utc.empty() ? "not recorded" : files::utc_in_words(record.date_utc),
        "Scope, head", camera::scope_in_words(record)}});
  if (content.case_has_another_camera)
    pages.sentence(
        "The case's camera.json is another one: these are the numbers that the session was "
        "navigated with.",
        {.size_pt = 8.5, .ink = kGray});
}

// Whether somebody measured it: a guide's error depends on that, and its tunnel's with it.
std::string known_by(const tools::Tool& tool) {
  const tools::NominalParts parts = tools::nominal_parts(tool);
  std::string words(provenance::to_text(tool.provenance.origin));
  if (tool.provenance.origin == provenance::Origin::Nominal || !parts.any()) return words;
  const auto add = [&](bool is_nominal, const char* part) {
    if (is_nominal) words += std::string(words.ends_with("nominal") ? " " : ", ") + part;
  };
  words += "; nominal";
  add(parts.tip, "tip");
  add(parts.axis, "axis");
  add(parts.end, "end");
  return words;
}

void tools_table(FlowingPages& pages, const recording::RecordedSession& session) {
  pages.heading("Tools");
  std::vector<std::vector<std::string>> rows = {
      {"Tool", "Marker", "Size", "Known", "Tip or axis in its frame, mm"}};
  const auto options = session.pipeline_options();
  for (const auto& world : options.tools.world_markers) {
    rows.push_back({std::string(bones::to_text(world.bone)) + " (world)", ids_of(world),
                    number(world.size_mm, " mm", 2), "", ""});
  }
  for (const auto& tool : options.tools.tools) {
    std::string where;
    if (tool.tip_mm) where = "tip " + point(*tool.tip_mm, 2);
    if (tool.axis)
      where = "axis through " + point(tool.axis->point_mm, 2) + " along " + point(tool.axis->direction, 3);
    rows.push_back({tool.name, ids_of(tool), number(tool.size_mm, " mm", 2), known_by(tool), where});
  }
  pages.table({30, 17, 18, 22, 83}, rows);
}

}  // namespace

void draw_settings_section(FlowingPages& pages, const Content& content) {
  pages.continue_as("Camera and tools");
  camera_section(pages, content);
  if (content.session) tools_table(pages, *content.session);
}

}  // namespace arthronaut::report
