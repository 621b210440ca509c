// The map of lengths on the femur: its key, its colours with their scale, and what the mouse asks of it.
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>

#include "app/plan/plan_view.h"
#include "app/widgets/tooltip.h"

namespace arthronaut::plan {

using bones::BoneKind;

void PlanView::add_isometry_action(widgets::Actions& actions) {
  actions.add(
      {"plan.isometry", "Isometry",
       "How much the graft's length changes from 0 to 120 degrees of flexion, wherever on the lateral "
       "wall of the notch it could begin: steps of 2 mm up to 20, the tibia turned about a fixed hinge",
       GLFW_KEY_M, GLFW_MOD_SHIFT, false,
       [this] {
         return model_ != nullptr && state_.key.bone == BoneKind::Femur &&
                model_->tunnel(state_.key).has_value();
       },
       [this] { return is_isometry_wanted(); },
       [this] {
         state_.shows_isometry = !state_.shows_isometry;
         state_.shows_map = false;  // one map at a time
         if (state_.shows_isometry && is_entry_hidden()) look_from(scene::ViewDirection::Notch);
       }});
}

bool PlanView::is_isometry_wanted() const {
  return state_.shows_isometry && state_.key.bone == BoneKind::Femur;
}

void PlanView::follow_isometry() {
  IsometryAsked asked;
  if (is_isometry_wanted()) asked = isometry_asked(*model_, state_.key, bone_doubts_);
  state_.no_isometry = std::move(asked.why_not);
  auto map = asked.request ? isometry_.of(*asked.request) : nullptr;
  if (map != nullptr && map->map.bands.empty()) {
    state_.no_isometry = "no lateral wall of the notch is found on this bone";
    map = nullptr;
  }
  if (map == state_.isometry) return;
  state_.isometry = std::move(map);
  state_.shown_revision = 0;
}

// Every other line between two steps has its number on the bone: more would stand on each other.
void PlanView::add_isometry_marks(std::vector<PaneMark>& marks) const {
  if (state_.isometry == nullptr) return;
  for (const tunnels::IsometryBand& band : state_.isometry->map.bands)
    if (band.line_at_mm && std::fmod(band.from_mm, 2 * tunnels::IsometrySteps{}.step_mm) == 0)
      marks.push_back({PaneMark::Shape::Dot, "", widgets::fixed(band.from_mm, 0), *band.line_at_mm,
                       widgets::kText, false,
                       "On this line the graft's length changes by " + widgets::fixed(band.from_mm, 0) +
                           " mm from 0 to 120 deg"});
}

void PlanView::say_isometry_at(const widgets::Ui& ui, const std::optional<scene::SceneRay>& mouse) const {
  std::string here;
  if (state_.isometry != nullptr && mouse)
    if (const auto met = first_visible(bones_.visible(), *mouse);
        met && met->bone == BoneKind::Femur && !met->is_section)
      if (const auto change = state_.isometry->of.at(met->point_mm, met->normal))
        here = "A graft that begins here changes by " + tunnels::to_text(*change);
  if (!here.empty()) widgets::tooltip_at_mouse(ui, here);
  ui.log.note_state("isometry_here", here);
  ui.log.note_state("isometry", !is_isometry_wanted()         ? "none"
                                : !state_.no_isometry.empty() ? state_.no_isometry
                                : state_.isometry == nullptr  ? "working"
                                                              : "shown");
}

std::vector<std::string> PlanView::isometry_lines() const {
  if (!is_isometry_wanted()) return {};
  if (!state_.no_isometry.empty()) return {"Isometry: not shown, " + state_.no_isometry};
  if (state_.isometry == nullptr) return {"Isometry: looking over the wall of the notch ..."};
  std::vector<std::string> lines = isometry_in_words(*model_, state_.key, state_.isometry->of);
  if (is_entry_hidden()) lines.emplace_back("It lies behind the bone from here: Notch (6) shows it");
  return lines;
}

void PlanView::draw_isometry_scale(const widgets::Ui& ui, const widgets::Rect& area) const {
  const auto& bands = state_.isometry->map.bands;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float font = ui.theme.body->FontSize;
  const auto text = [&](float x, const std::string& words, bool is_centred) {
    const float wide = ui.theme.body->CalcTextSizeA(font, 1e9F, 0, words.c_str()).x;
    draw.AddText(ui.theme.body, font, {is_centred ? x - wide / 2 : x, area.y + area.height - font},
                 widgets::kText, words.c_str());
  };
  const float left = area.x + ui.theme.px(12), unit = ui.theme.px(150);
  const float swatch =
      std::min((area.width - unit - ui.theme.px(24)) / static_cast<float>(bands.size()), ui.theme.px(64));
  float x = left;
  for (std::size_t i = 0; i < bands.size(); ++i, x += swatch) {
    draw.AddRectFilled({x, area.y}, {x + swatch, area.y + area.height - font},
                       widgets::color_of(isometry_color(i, bands.size())));
    text(x, widgets::fixed(bands[i].from_mm, 0), true);
  }
  if (std::isfinite(bands.back().to_mm)) text(x, widgets::fixed(bands.back().to_mm, 0), true);
  text(x + ui.theme.px(20), std::isfinite(bands.back().to_mm) ? "mm" : "mm and more", false);
}

}  // namespace arthronaut::plan
