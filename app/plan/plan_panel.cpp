#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "app/plan/anatomical_text.h"
#include "app/plan/plan_view.h"
#include "app/plan/roof_line.h"
#include "app/widgets/list_rows.h"
#include "app/widgets/tooltip.h"
#include "app/widgets/wrapped_text.h"
#include "planning/files/local_time.h"
#include "planning/files/unit_signs.h"
#include "planning/files/utc_clock.h"
#include "planning/landmarks/grid_landmarks.h"
#include "planning/plan_review/tunnel_verdict.h"

namespace arthronaut::plan {

widgets::Severity severity_of(tunnels::PlanCheck::Verdict verdict) {
  switch (verdict) {
    case tunnels::PlanCheck::Verdict::Fine:
      return widgets::Severity::Good;
    case tunnels::PlanCheck::Verdict::Look:
      return widgets::Severity::Caution;
    case tunnels::PlanCheck::Verdict::Wrong:
      return widgets::Severity::Bad;
    case tunnels::PlanCheck::Verdict::Note:
    case tunnels::PlanCheck::Verdict::NotChecked:
      return widgets::Severity::Quiet;
  }
  return widgets::Severity::Quiet;
}

namespace {

widgets::Severity severity_of_save(open_case::PlanStatus::Save save) {
  switch (save) {
    case open_case::PlanStatus::Save::Saved:
      return widgets::Severity::Good;
    case open_case::PlanStatus::Save::NotYet:
      return widgets::Severity::Quiet;
    case open_case::PlanStatus::Save::Failed:
      return widgets::Severity::Bad;
    case open_case::PlanStatus::Save::ReadOnly:
    case open_case::PlanStatus::Save::Conflict:
      return widgets::Severity::Caution;
  }
  return widgets::Severity::Quiet;
}

void draw_numbers(const widgets::Ui& ui, const tunnels::Tunnel& tunnel,
                  const tunnels::TunnelGeometry& geometry, bool leaves_images) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x, height = ui.theme.px(100);
  widgets::Rect row{at.x, at.y, width, height};
  const widgets::Rect left = row.cut_left(width / 2);
  const bool inside = geometry.enters_bone;
  widgets::number_block(ui, left, leaves_images ? "Within images" : "Length in bone",
                        inside ? widgets::fixed(geometry.length_mm, 1) : "\u2013", "mm",
                        leaves_images ? widgets::Severity::Caution : widgets::Severity::Quiet);
  widgets::number_block(ui, row, "Diameter", widgets::fixed(tunnel.diameter_mm, 1), "mm",
                        widgets::Severity::Quiet);
  ImGui::Dummy({width, height});
}

// share: of the width, for the left one.
void button_pair(const widgets::Ui& ui, const char* left, const char* right, float share = 0.5F) {
  const float gap = ImGui::GetStyle().ItemSpacing.x, width = ImGui::GetContentRegionAvail().x - gap;
  widgets::action_button(ui, left, share * width);
  ImGui::SameLine();
  widgets::action_button(ui, right, (1 - share) * width);
}

void draw_saved(const widgets::Ui& ui, const PlanPanel& panel) {
  const open_case::PlanStatus& status = panel.history.status();
  button_pair(ui, "plan.undo", "plan.redo");
  // No tick for a plan that is none.
  const bool is_none =
      status.save == open_case::PlanStatus::Save::Saved && panel.model.knee().plan.tunnels.empty();
  widgets::status_row(ui, is_none ? widgets::Severity::Quiet : severity_of_save(status.save), "Plan",
                      is_none ? "none; " + status.text : status.text);
}

// What draw_saved() needs beyond its one line: a conflict and a failure have more words.
float more_of_saved(const widgets::Ui& ui, const open_case::PlanStatus& status) {
  ImFont* font = ui.theme.body;
  const float width = ImGui::GetContentRegionAvail().x - ui.theme.px(90), room = width + ui.theme.px(60);
  const float wide = font->CalcTextSizeA(font->FontSize, 1e9F, 0, status.text.c_str()).x;
  return wide <= width ? 0
                       : font->CalcTextSizeA(font->FontSize, 1e9F, room,
                                             widgets::wrapped(font, status.text, room).c_str())
                             .y;
}

// What to do next, and the button that begins it.
void draw_next(const widgets::Ui& ui, const NextStep& next) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x, edge = ui.theme.px(12);
  ImFont* font = ui.theme.strong;
  const std::string lines = widgets::wrapped(font, next.text, width - 2 * edge);
  const float words = font->CalcTextSizeA(font->FontSize, 1e9F, 0, lines.c_str()).y;
  const float height = ui.theme.body->FontSize + words + 2 * edge;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(at, {at.x + width, at.y + height}, IM_COL32(24, 44, 58, 255), ui.theme.px(6));
  draw.AddRectFilled(at, {at.x + ui.theme.px(5), at.y + height}, widgets::kAccent, ui.theme.px(3));
  draw.AddText(ui.theme.body, ui.theme.body->FontSize, {at.x + edge, at.y + edge * 0.7F}, widgets::kAccent,
               "Next");
  draw.AddText(font, font->FontSize, {at.x + edge, at.y + edge * 0.7F + ui.theme.body->FontSize},
               widgets::kText, lines.c_str());
  ImGui::PushID("next");
  if (ImGui::InvisibleButton("do", {width, height})) ui.actions.run(next.action);
  ImGui::PopID();
  ui.log.note_button("plan.next", at, {at.x + width, at.y + height});
}

// What spoke against the bone when it was made, but for the side, and of its grid: all that follows from them
// is as doubtful.
void draw_doubts(const widgets::Ui& ui, const PlanPanel& panel) {
  const bones::BoneKind bone = panel.key.bone;
  const std::vector<std::string> others = plan_review::doubts_but_side(panel.doubts, bone);
  ui.log.note_state("bone_doubts", std::to_string(others.size()));
  for (const std::string& doubt : others) widgets::status_row(ui, widgets::Severity::Caution, "Bone", doubt);
  const std::string side = plan_review::side_note(panel.doubts);
  ui.log.note_state("side_note", side);
  if (!side.empty()) widgets::status_row(ui, widgets::Severity::Quiet, "Side", side);
  const bool has_grid = panel.model.has_bone(bone) && panel.model.surroundings(bone).has_grid();
  const std::string grid =
      !has_grid ? ""
                : landmarks::grid_doubt(bone, panel.model.landmarks(bone), panel.model.landmark_states(bone));
  ui.log.note_state("grid_doubt", grid);
  if (!grid.empty()) widgets::status_row(ui, widgets::Severity::Caution, "Grid", grid);
}

void draw_checks(const widgets::Ui& ui, const PlanPanel& panel) {
  const auto tunnel = panel.model.tunnel(panel.key);
  const std::string side = plan_review::side_doubt(panel.doubts);
  if (!side.empty()) widgets::status_row(ui, widgets::Severity::Bad, "Side", side);
  if (!tunnel) {
    draw_doubts(ui, panel);
    widgets::text_in(ui.theme.body, widgets::kText,
                     "No tunnel yet. Press P and click on the bone where it is to begin.");
    return;
  }
  const tunnels::TunnelGeometry& geometry = panel.model.measured(panel.key);
  const auto& image_cuts = panel.model.surroundings(panel.key.bone).unseen.image_cuts;
  const bool leaves_images = geometry.enters_bone && bones::images_end_at(image_cuts, geometry.exit_mm);
  draw_numbers(ui, *tunnel, geometry, leaves_images);
  if (geometry.enters_bone)
    widgets::text_in(ui.theme.body, widgets::kText,
                     (leaves_images ? "Leaves the images " : "Leaves the bone ") +
                         place_from_entry(geometry.exit_mm - geometry.entry_on_surface_mm,
                                          panel.model.axes(panel.key.bone)));
  ImGui::Dummy({0, ui.theme.px(4)});
  const auto checks = plan_review::as_side_is_doubted(panel.model.checks(panel.key), side);
  bool has_doubts = false;
  for (const tunnels::PlanCheck* const check : worst_first(checks)) {
    // What speaks against the tunnel can be mended here: it must not be pushed out of sight by what stays
    // with the bone.
    if (!tunnels::is_failed(*check) && !std::exchange(has_doubts, true)) draw_doubts(ui, panel);
    ImGui::BeginGroup();
    widgets::status_row(ui, severity_of(check->verdict), check->name, files::with_signs(check->text));
    ImGui::EndGroup();
    if (ImGui::IsItemHovered() && !check->source.empty())
      widgets::tooltip(ui, files::with_signs(check->source));
  }
  if (!has_doubts) draw_doubts(ui, panel);
  widgets::text_in(ui.theme.body, widgets::kQuietText,
                   "Customary values, not limits of safety. The surgeon decides.");
}

// Whose tunnel it is, and beside it the way to the other.
void draw_title(const widgets::Ui& ui, const tunnels::TunnelKey& key) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ui.theme.px(196), height = ui.theme.px(44);
  // Beside the button there is no room for more.
  std::string title = adjective(key) + (key.bundle == norms::Bundle::Whole ? " tunnel" : "");
  title[0] = key.bone == bones::BoneKind::Femur ? 'F' : 'T';
  ImGui::GetWindowDrawList()->AddText(ui.theme.title, ui.theme.title->FontSize,
                                      {at.x, at.y + (height - ui.theme.title->FontSize) / 2}, widgets::kText,
                                      title.c_str());
  ImGui::SetCursorScreenPos({at.x + ImGui::GetContentRegionAvail().x - width, at.y});
  widgets::action_button(ui, "plan.bone", width, height);
}

void draw_tools(const widgets::Ui& ui, const tunnels::TunnelKey& key) {
  ImGui::Separator();
  button_pair(ui, "plan.default", "plan.place");
  button_pair(ui, "plan.narrower", "plan.wider");
  constexpr float kShare = 0.54F;  // for "Remove tunnel" and its key
  if (key.bundle == norms::Bundle::Whole) return button_pair(ui, "plan.remove", "plan.bundles", kShare);
  button_pair(ui, "plan.remove", "plan.other_bundle", kShare);
  widgets::action_button(ui, "plan.single", ImGui::GetContentRegionAvail().x);
}

// One of a list that can be clicked on.
struct ListRow {
  std::string id, text;
  bool is_here = false, is_faint = false, is_chosen = false;  // chosen: keys act on it
};

bool draw_row(const widgets::Ui& ui, const ListRow& row) {
  const float height = ui.theme.px(36), width = ImGui::GetContentRegionAvail().x;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::PushID(row.id.c_str());
  const bool is_clicked = ImGui::InvisibleButton("row", {width, height});
  ImGui::PopID();
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  if (row.is_here || ImGui::IsItemHovered())
    draw.AddRectFilled(at, {at.x + width, at.y + height},
                       row.is_here ? IM_COL32(28, 74, 104, 255) : IM_COL32(38, 47, 57, 255), ui.theme.px(6));
  if (row.is_chosen)
    draw.AddRect(at, {at.x + width, at.y + height}, widgets::kAccent, ui.theme.px(6), 0, ui.theme.px(2));
  ImFont* font = ui.theme.body;
  const std::string fitting = widgets::fitting(font, row.text, width - ui.theme.px(20));
  widgets::draw_text(draw, font, at.x + ui.theme.px(10), at.y + (height - font->FontSize) / 2,
                     row.is_faint  ? widgets::kPanelEdge
                     : row.is_here ? widgets::kText
                                   : widgets::kQuietText,
                     fitting);
  if (ImGui::IsItemHovered() && fitting != row.text) widgets::tooltip(ui, row.text);
  if (ImGui::IsRectVisible(at, {at.x + width, at.y + height}))
    ui.log.note_button("plan." + row.id, at, {at.x + width, at.y + height});
  return is_clicked;
}

// Every step, the newest last; a click goes back, or forward, to it.
std::optional<std::size_t> draw_steps(const widgets::Ui& ui, const open_case::PlanHistory& history,
                                      float room_below_px) {
  std::optional<std::size_t> clicked;
  widgets::text_in(ui.theme.body, widgets::kQuietText, "Click on a step to go back or forward to it.");
  // No more than its rows need: the versions are below.
  const float rows =
      static_cast<float>(history.step_count() + 1) * (ui.theme.px(36) + ImGui::GetStyle().ItemSpacing.y);
  ImGui::BeginChild("steps", {0, std::min(rows, 0.55F * (ImGui::GetContentRegionAvail().y - room_below_px))});
  for (std::size_t i = 0; i <= history.step_count(); ++i) {
    const bool is_here = i == history.position(), is_undone = i > history.position();
    const float top = ImGui::GetCursorScreenPos().y;
    const std::string text = i == 0 ? "Before these steps" : history.step_name(i - 1);
    if (draw_row(ui,
                 {"step." + std::to_string(i), text + (is_undone ? "  (undone)" : ""), is_here, is_undone}))
      clicked = i;
    if (is_here) widgets::bring_into_sight(i, top, ImGui::GetCursorScreenPos().y - top);
  }
  ImGui::EndChild();
  return clicked;
}

// A version's note, or that it has none; a click writes it, in the field that is then in its place.
void draw_version_words(const widgets::Ui& ui, const PlanPanel& panel, std::size_t place,
                        PanelClick& clicked) {
  const cases::PlanVersion& version = panel.versions[place].version;
  ImGui::PushID(version.number);
  if (panel.version_field.is_of(version.number)) {
    if (auto words = panel.version_field.draw(ui)) clicked.words = {version.number, std::move(*words)};
  } else if (draw_row(ui, {"version_words." + std::to_string(version.number),
                           !version.words.note.empty()   ? version.words.note
                           : !version.words.name.empty() ? "Name and note..."
                           : place == panel.version      ? "No name: click here, or Shift+K"
                                                         : "No name: click here",
                           false, false})) {
    clicked.named = place;
  }
  ImGui::PopID();
}

// What was kept, the newest first, each with how it differs from the plan that is worked on; a click takes
// it.
void draw_versions(const widgets::Ui& ui, const PlanPanel& panel, float room_below_px, PanelClick& clicked) {
  ImGui::Separator();
  button_pair(ui, "plan.keep", "plan.export");
  button_pair(ui, "plan.markups", "plan.side", 0.57F);  // for "Take markups" and its key
  ImGui::BeginChild("versions", {0, ImGui::GetContentRegionAvail().y - room_below_px});
  if (panel.versions.empty())
    widgets::text_in(ui.theme.body, widgets::kQuietText,
                     "No version is kept. One that is can be compared with, and taken again.");
  for (std::size_t i = panel.versions.size(); i-- > 0;) {
    const cases::PlanVersion& version = panel.versions[i].version;
    const auto differences = cases::compare_plans(panel.model.knee().plan, version.plan);
    const bool is_same = std::ranges::all_of(differences, [](const cases::TunnelDifference& difference) {
      return difference.kind == cases::TunnelDifference::Kind::Same;
    });
    const float top = ImGui::GetCursorScreenPos().y;
    const bool is_chosen = i == panel.version;
    if (draw_row(ui,
                 {"version." + std::to_string(version.number), version.title(), is_same, false, is_chosen}))
      clicked.version = i;
    if (is_chosen) widgets::bring_into_sight(i, top, ImGui::GetCursorScreenPos().y - top);
    widgets::text_in(ui.theme.body, widgets::kQuietText,
                     "Kept " + files::local_time_in_words(version.kept_utc) +
                         (cases::side_refusal(version, panel.model.knee().side).empty()
                              ? ""
                              : ", of a " + std::string(bones::to_text(*version.side)) + " knee"));
    draw_version_words(ui, panel, i, clicked);
    for (const std::string& line : against_the_plan(panel.model, panel.versions[i]))
      widgets::text_in(ui.theme.body, widgets::kQuietText, line);
  }
  ImGui::EndChild();
}

}  // namespace

PanelClick draw_plan_panel(const widgets::Ui& ui, const widgets::Rect& area, const PlanPanel& panel) {
  PanelClick clicked;
  widgets::begin_panel(ui, "plan.panel", area);
  draw_next(ui, panel.next);
  draw_title(ui, panel.key);
  const float page_width = ImGui::GetContentRegionAvail().x - 2 * ui.theme.px(6);
  // The longest word has the most room.
  for (const auto& [id, share] :
       {std::pair("plan.checks_page", 0.31F), std::pair("plan.landmarks_page", 0.4F),
        std::pair("plan.steps_page", 0.29F)}) {
    widgets::action_button(ui, id, share * page_width);
    ImGui::SameLine(0, ui.theme.px(6));
  }
  ImGui::NewLine();
  const float more = more_of_saved(ui, panel.history.status());
  switch (panel.page) {
    case PanelPage::Checks:
      // The checks scroll; what is pressed stays in sight.
      ImGui::BeginChild("checks", {0, ImGui::GetContentRegionAvail().y - more -
                                          ui.theme.px(panel.key.bundle == norms::Bundle::Whole ? 262 : 314)});
      draw_checks(ui, panel);
      ImGui::EndChild();
      draw_tools(ui, panel.key);
      ImGui::Separator();
      break;
    case PanelPage::Landmarks: {
      // The femur's roof has two lines of words and a button of its own.
      const bool has_roof =
          panel.key.bone == bones::BoneKind::Femur && panel.model.has_bone(bones::BoneKind::Femur);
      clicked.landmark = draw_landmark_list(ui, panel.model, panel.key.bone, panel.landmark,
                                            panel.landmark_drawing, ui.theme.px(has_roof ? 316 : 190) + more);
      if (has_roof) {
        widgets::text_in(ui.theme.body, widgets::kText, roof_line_in_words(panel.model));
        widgets::action_button(ui, "plan.roof", ImGui::GetContentRegionAvail().x);
      }
      button_pair(ui, "plan.landmark_confirm", "plan.landmark_place");
      button_pair(ui, "plan.landmark_reset", "plan.landmark_confirm_all", 0.4F);
      break;
    }
    case PanelPage::Steps:
      clicked.step = draw_steps(ui, panel.history, ui.theme.px(110) + more);
      draw_versions(ui, panel, ui.theme.px(110) + more, clicked);
      break;
  }
  draw_saved(ui, panel);
  widgets::end_panel();
  return clicked;
}

}  // namespace arthronaut::plan
