// The tour in plan mode: what it is told, and its strip over the bones.
#include <GLFW/glfw3.h>

#include "app/plan/plan_view.h"

namespace arthronaut::plan {

using bones::BoneKind;

void PlanView::add_tour_actions(widgets::Actions& actions) {
  actions.add({"plan.tour", "Tour",
               "Leads through planning on the built-in knee; the same key leaves it, and takes it up again",
               GLFW_KEY_F9, 0, false, [this] { return model_ != nullptr && tour_.is_possible(); },
               [this] { return tour_.is_running(); },
               [this] {
                 if (tour_.is_running())
                   tour_.leave();
                 else
                   tour_.begin();
               }});
  actions.add({"plan.no_tour",
               "No tour",
               "It is not offered again; F9 begins it all the same",
               GLFW_KEY_F9,
               GLFW_MOD_SHIFT,
               false,
               [this] { return tour_.is_offered(); },
               {},
               [this] { tour_.leave(); }});
}

// The default plan follows from the landmarks alone, and is made anew when they have changed; until it is
// made there is none.
void PlanView::make_tour_defaults() {
  if (const auto made = tour_defaults_.take())
    for (const MadeTunnel& one : *made)
      if (one.made.is_usable()) state_.defaults.emplace(one.key.bone, one.made.tunnel);
  if (tour_defaults_.is_busy() || state_.defaults_of == model_->knee().landmarks) return;
  state_.defaults_of = model_->knee().landmarks;
  state_.defaults.clear();
  std::vector<tunnels::TunnelKey> keys;
  for (const BoneKind bone : {BoneKind::Femur, BoneKind::Tibia})
    if (model_->has_bone(bone)) keys.emplace_back(bone);
  tour_defaults_.start(*model_, keys);
}

void PlanView::follow_tour() {
  if (!tour_.is_running()) return;
  TourFacts facts;
  const scene::SceneCamera& camera = bones_.camera();
  facts.view_direction = (camera.focus_mm - camera.position_mm).normalized();
  if (state_.page == PanelPage::Landmarks) facts.landmarks_shown = state_.key.bone;
  if (state_.page == PanelPage::Checks) facts.checks_shown = state_.key.bone;
  for (const BoneKind bone : {BoneKind::Femur, BoneKind::Tibia}) {
    if (!model_->has_bone(bone)) continue;
    if (has_unconfirmed_grid(*model_, bone)) facts.unconfirmed.insert(bone);
    if (const auto tunnel = model_->tunnel(bone)) facts.tunnels.emplace(bone, *tunnel);
    if (has_wrong_check(*model_, bone)) facts.wrong.insert(bone);
  }
  if (tour_.wants_defaults()) make_tour_defaults();
  facts.defaults = state_.defaults;
  facts.can_redo = history_.can_redo();
  facts.is_saved = history_.status().save == open_case::PlanStatus::Save::Saved;
  facts.kept_versions = versions_.size();
  tour_.follow(facts);
}

// Above the bones, not over them: nothing of the picture is hidden.
void PlanView::draw_tour(const widgets::Ui& ui, const widgets::Rect& area, const TourCard& card) const {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(area.min(), area.max(), IM_COL32(24, 44, 58, 255), ui.theme.px(6));
  draw.AddRectFilled(area.min(), {area.x + ui.theme.px(5), area.y + area.height}, widgets::kAccent,
                     ui.theme.px(3));
  const float edge = ui.theme.px(16), height = ui.theme.px(48), gap = ui.theme.px(8);
  const float button = ui.theme.px(card.number == 0 ? 236 : 170);
  const float buttons = (card.number == 0 ? 2 : 1) * (button + gap);
  const std::string title = card.number == 0 ? card.title
                                             : std::to_string(card.number) + " of " +
                                                   std::to_string(kTourStepCount) + "  " + card.title;
  draw.AddText(ui.theme.strong, ui.theme.strong->FontSize, {area.x + edge, area.y + ui.theme.px(8)},
               widgets::kText, title.c_str());
  draw.AddText(ui.theme.body, ui.theme.body->FontSize,
               {area.x + edge, area.y + ui.theme.px(12) + ui.theme.strong->FontSize}, widgets::kText,
               card.text.c_str(), nullptr, area.width - buttons - 2 * edge);
  ImGui::SetCursorScreenPos({area.x + area.width - buttons, area.y + (area.height - height) / 2});
  widgets::action_button(ui, "plan.tour", button, height);
  if (card.number == 0) {
    ImGui::SameLine(0, gap);
    widgets::action_button(ui, "plan.no_tour", button, height);
  }
}

}  // namespace arthronaut::plan
