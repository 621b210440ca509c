// The survey of a tunnel over the bones: the map of entries about its own, and the ways to drill it.
#include <GLFW/glfw3.h>

#include <algorithm>

#include "app/plan/plan_view.h"

namespace arthronaut::plan {

namespace {
constexpr float kScaleLines = 1.7F;  // of text: the steps' colours and their numbers
}

void PlanView::add_survey_actions(widgets::Actions& actions) {
  const auto has_tunnel = [this] { return model_ != nullptr && model_->tunnel(state_.key).has_value(); };
  actions.add(
      {"plan.map", "Entry map",
       "Where else the entry could be: about it every check is made of a tunnel of the same direction "
       "and diameter",
       GLFW_KEY_M, 0, false, has_tunnel, [this] { return state_.shows_map; },
       [this] {
         state_.shows_map = !state_.shows_map;
         state_.shows_isometry = false;  // one map at a time
         // A map behind the bone would be asked for and not be seen.
         if (state_.shows_map && is_entry_hidden())
           look_from(state_.key.bone == bones::BoneKind::Femur ? scene::ViewDirection::Notch
                                                               : scene::ViewDirection::Plateau);
       }});
  add_isometry_action(actions);
  actions.add(
      {"plan.aims", "Aims",
       "The ways to this entry: through the anteromedial portal at 100 to 130 degrees of flexion, and from "
       "outside in",
       GLFW_KEY_O, 0, false,
       [this, has_tunnel] { return has_tunnel() && state_.key.bone == bones::BoneKind::Femur; },
       [this] { return state_.shows_aims; },
       [this] {
         state_.shows_aims = !state_.shows_aims;
         state_.shown_revision = 0;
       }});
}

bool PlanView::is_entry_hidden() const {
  const auto tunnel = model_->tunnel(state_.key);
  if (!tunnel || state_.shows_lateral) return false;
  return !bones_.shows(tunnel->bone) ||
         is_hidden(bones_.visible(), bones_.camera().position_mm, tunnel->entry_mm);
}

// While a handle moves, every step would be surveyed for nothing.
std::shared_ptr<const Survey> PlanView::wanted_survey() {
  if ((!state_.shows_map && !state_.shows_aims) || history_.is_moving()) return nullptr;
  return survey_.of(*model_, state_.key);
}

void PlanView::add_map_marks(std::vector<PaneMark>& marks) const {
  if (!state_.shows_map || state_.survey == nullptr) return;
  for (const tunnels::EntrySample& sample : state_.survey->entries) {
    const bool is_fine = sample.verdict == tunnels::PlanCheck::Verdict::Fine;
    const bool is_wrong = sample.verdict == tunnels::PlanCheck::Verdict::Wrong;
    marks.push_back({is_fine    ? PaneMark::Shape::Dot
                     : is_wrong ? PaneMark::Shape::Saltire
                                : PaneMark::Shape::Circle,
                     "", "", sample.entry_mm,
                     is_fine    ? widgets::kGood
                     : is_wrong ? widgets::kBad
                                : widgets::kCaution,
                     false, is_fine ? "An entry here passes every check that can be made" : sample.reason});
  }
}

widgets::Rect PlanView::draw_survey_legend(const widgets::Ui& ui, const widgets::Rect& area) const {
  const bool is_shown = state_.shows_map || state_.shows_aims;
  const bool waits = state_.survey == nullptr || (state_.shows_aims && !state_.survey->has_aims);
  ui.log.note_state("survey", !is_shown ? "none" : waits ? "working" : "shown");
  const std::string share = widgets::fixed(100 * survey_.done_fraction(), 0) + " % ...";
  std::vector<std::string> lines;
  if (volume_.is_on()) lines.push_back(volume_.in_words(slices_.reason()));
  if (!is_shown) {
    // What is drawn of the images, and how lengths change.
  } else if (state_.survey == nullptr) {
    lines.emplace_back(model_->tunnel(state_.key) ? "Looking about the entry: " + share
                                                  : "There is no tunnel yet");
  } else {
    if (state_.shows_map) {
      lines.push_back(map_in_words(*state_.survey, model_->checks(state_.key)));
      if (is_entry_hidden())
        lines.push_back(state_.key.bone == bones::BoneKind::Femur
                            ? "They lie behind the bone from here: Notch (6) shows them"
                            : "They lie behind the bone from here: Plateau (7) shows them");
    }
    if (state_.shows_aims && !state_.survey->has_aims) {
      lines.push_back("Looking for the ways to drill it: " + share);
    } else if (state_.shows_aims && state_.key.bone == bones::BoneKind::Femur) {
      const auto& aims = state_.survey->portal;
      const auto clear = std::ranges::count(aims, true, &tunnels::PortalAim::is_clear);
      const double off_deg = tunnels::off_portal_deg(model_->tunnel(state_.key)->direction, aims);
      lines.push_back(aims.empty() ? "Portal: not known, since the flexion axis is missing"
                      : clear == 0 ? "Portal: no way is clear of the femur"
                                   : "Portal (yellow): " + std::to_string(clear) + " of " +
                                         std::to_string(aims.size()) + " ways are clear; this tunnel is " +
                                         widgets::fixed(off_deg, 0) + " degrees off the nearest");
      lines.push_back("From outside in (violet): " + std::to_string(state_.survey->outside_in.size()) +
                      " ways leave well");
    }
  }
  for (std::string& line : isometry_lines()) lines.push_back(std::move(line));
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float font = ui.theme.body->FontSize, step = font * 1.25F;
  // Above the word at the picture's lower edge, which says where that is.
  float bottom = area.y + area.height - ui.theme.px(14) - step;
  const bool has_scale = state_.isometry != nullptr;
  if (has_scale) bottom -= kScaleLines * step;
  float y = bottom - step * static_cast<float>(lines.size());
  widgets::Rect rest = area;
  if (lines.empty()) return rest;
  rest.height = y - area.y;
  // Read over the bone and the lines of aims, too.
  float wide = 0;
  for (const std::string& line : lines)
    wide = std::max(wide, ui.theme.body->CalcTextSizeA(font, 1e9F, 0, line.c_str()).x);
  const float end = bottom + (has_scale ? kScaleLines * step : 0);
  draw.AddRectFilled({area.x + ui.theme.px(10), y - ui.theme.px(4)},
                     {area.x + ui.theme.px(22) + wide, end + ui.theme.px(4)}, IM_COL32(12, 16, 20, 210),
                     ui.theme.px(6));
  if (has_scale) draw_isometry_scale(ui, {area.x + ui.theme.px(16), bottom, wide, kScaleLines * step});
  for (const std::string& line : lines) {
    const ImVec2 at{area.x + ui.theme.px(16), y};
    draw.AddText(ui.theme.body, font, {at.x + 1, at.y + 1}, widgets::kBackground, line.c_str());
    draw.AddText(ui.theme.body, font, at, widgets::kText, line.c_str());
    y += step;
  }
  return rest;
}

}  // namespace arthronaut::plan
