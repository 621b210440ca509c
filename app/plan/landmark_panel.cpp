#include "app/plan/landmark_panel.h"

#include <algorithm>

#include "app/widgets/list_rows.h"
#include "app/widgets/tooltip.h"
#include "app/widgets/wrapped_text.h"
#include "planning/landmarks/off_shape.h"

namespace arthronaut::plan {

namespace {

constexpr float kPicture_px = 180;  // at scale 1, square

}  // namespace

std::vector<LandmarkRow> landmark_rows(const open_case::PlanModel& model, bones::BoneKind bone) {
  std::vector<LandmarkRow> rows;
  if (!model.has_bone(bone)) return rows;
  for (const landmarks::LandmarkKind& kind : landmarks::known_landmarks(bone)) {
    LandmarkRow row{std::string(kind.name), std::string(kind.title), std::string(kind.meaning)};
    if (model.landmarks(bone).contains(row.name))
      row.state =
          landmarks::state_of(model.landmark_states(bone), row.name) == landmarks::LandmarkState::Confirmed
              ? LandmarkRow::State::Confirmed
              : LandmarkRow::State::Proposed;
    rows.push_back(std::move(row));
  }
  return rows;
}

bool lies_within_bone(std::string_view name) {
  return name.ends_with("_condyle_center") || name.starts_with("shaft_");
}

bool has_to_confirm(const std::vector<LandmarkRow>& rows) {
  return std::ranges::count(rows, LandmarkRow::State::Proposed, &LandmarkRow::state) > 0;
}

std::string confirmed_in_words(const std::vector<LandmarkRow>& rows) {
  const auto confirmed = std::ranges::count(rows, LandmarkRow::State::Confirmed, &LandmarkRow::state);
  const auto missing = std::ranges::count(rows, LandmarkRow::State::Missing, &LandmarkRow::state);
  return std::to_string(confirmed) + " of " + std::to_string(std::ssize(rows) - missing) + " confirmed" +
         (missing > 0 ? ", " + std::to_string(missing) + " not there" : "");
}

std::optional<double> off_proposal_mm(const open_case::PlanModel& model, bones::BoneKind bone,
                                      const std::string& name) {
  const auto& proposal = model.proposal(bone);
  if (!proposal) return std::nullopt;
  const auto here = model.landmarks(bone).find(name);
  if (here == model.landmarks(bone).end()) return std::nullopt;
  return landmarks::off_shape_mm(name, here->second, *proposal);
}

std::string state_in_words(LandmarkRow::State state, std::optional<double> off_proposal_mm) {
  if (state == LandmarkRow::State::Missing) return "not there: P, then click where it is";
  if (state == LandmarkRow::State::Proposed) return "proposed by the shape, looked at by nobody";
  if (!off_proposal_mm) return "confirmed";
  return "confirmed, " + widgets::fixed(*off_proposal_mm, 1) + " mm from where the bone's shape puts it" +
         (*off_proposal_mm > landmarks::kFarFromShape_mm ? ": look" : "");
}

std::optional<std::size_t> next_proposed(const std::vector<LandmarkRow>& rows, std::size_t from) {
  for (std::size_t i = 1; i <= rows.size(); ++i) {
    const std::size_t at = (from + i) % rows.size();
    if (rows[at].state == LandmarkRow::State::Proposed) return at;
  }
  return std::nullopt;
}

std::optional<std::size_t> draw_landmark_list(const widgets::Ui& ui, const open_case::PlanModel& model,
                                              bones::BoneKind bone, std::size_t selected,
                                              LandmarkDrawing& drawing, float room_below_px) {
  std::optional<std::size_t> clicked;
  const std::vector<LandmarkRow> rows = landmark_rows(model, bone);
  if (rows.empty()) return clicked;
  widgets::text_in(ui.theme.body, widgets::kQuietText, confirmed_in_words(rows));
  const LandmarkRow& row = rows[std::min(selected, rows.size() - 1)];
  const auto is_far = [&](const std::string& name) {
    return off_proposal_mm(model, bone, name).value_or(0) > landmarks::kFarFromShape_mm;
  };
  const std::string about = row.title + ": " + row.meaning + ".";
  const std::string word = state_in_words(row.state, off_proposal_mm(model, bone, row.name));
  // Below the list: its picture beside what the selected one means and its state, of however many lines; the
  // buttons.
  const float picture = ui.theme.px(kPicture_px), gap = ui.theme.px(12);
  ImFont* const body = ui.theme.body;
  const auto beside = [&](const std::string& text) {
    return widgets::wrapped(body, text, ImGui::GetContentRegionAvail().x - picture - gap);
  };
  const auto height_of = [&](const std::string& lines) {
    return body->CalcTextSizeA(body->FontSize, 1e9F, 0, lines.c_str()).y;
  };
  const std::string about_lines = beside(about), state_lines = beside(word);
  const float question = std::max(picture, height_of(about_lines) + height_of(state_lines));
  // Of each bone: one list is not scrolled to where the other one was.
  ImGui::PushID(static_cast<int>(bone));
  ImGui::BeginChild("landmarks", {0, ImGui::GetContentRegionAvail().y - question - room_below_px});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {0, ui.theme.px(2)});
  const float height = ui.theme.px(34);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    ImGui::PushID(static_cast<int>(i));
    if (ImGui::InvisibleButton("landmark", {width, height})) clicked = i;
    if (i == selected) widgets::bring_into_sight(i, at.y, height);
    const bool is_hovered = ImGui::IsItemHovered();
    ImGui::PopID();
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    if (i == selected || is_hovered)
      draw.AddRectFilled(at, {at.x + width, at.y + height},
                         i == selected ? IM_COL32(28, 74, 104, 255) : IM_COL32(38, 47, 57, 255),
                         ui.theme.px(6));
    const auto severity = rows[i].state == LandmarkRow::State::Missing ? widgets::Severity::Quiet
                          : rows[i].state == LandmarkRow::State::Proposed || is_far(rows[i].name)
                              ? widgets::Severity::Caution
                              : widgets::Severity::Good;
    widgets::draw_sign(draw, {at.x + ui.theme.px(14), at.y + height / 2}, ui.theme.px(8), severity);
    ImFont* font = i == selected ? ui.theme.strong : ui.theme.body;
    draw.AddText(font, font->FontSize, {at.x + ui.theme.px(32), at.y + (height - font->FontSize) / 2},
                 widgets::kText, rows[i].title.c_str());
    if (is_hovered) widgets::tooltip(ui, {at.x, at.y, width, height}, rows[i].title + ": " + rows[i].meaning);
    if (ImGui::IsRectVisible(at, {at.x + width, at.y + height}))
      ui.log.note_button("plan.landmark." + rows[i].name, at, {at.x + width, at.y + height});
  }
  ImGui::PopStyleVar();
  ImGui::EndChild();
  ImGui::PopID();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  drawing.draw(ui, {at.x, at.y, picture, picture}, model.knee().side, bone, row.name);
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddText(body, body->FontSize, {at.x + picture + gap, at.y}, widgets::kText, about_lines.c_str());
  draw.AddText(
      body, body->FontSize, {at.x + picture + gap, at.y + height_of(about_lines)},
      row.state == LandmarkRow::State::Proposed || is_far(row.name) ? widgets::kCaution : widgets::kQuietText,
      state_lines.c_str());
  ImGui::Dummy({0, question});
  ui.log.note_state("landmark_state", word);
  return clicked;
}

}  // namespace arthronaut::plan
