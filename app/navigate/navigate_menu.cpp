// Where things stand on the theatre screen, and the menu: everything that is not needed at every moment.
#include "app/navigate/menu_page.h"
#include "app/navigate/navigate_view.h"

namespace arthronaut::navigate {

namespace {

// Rows of buttons of one width.
void draw_buttons(const widgets::Ui& ui, const widgets::Rect& area, const std::vector<std::string_view>& ids,
                  int columns, float height) {
  const float gap = ui.theme.px(6);
  const float width = (area.width - gap * static_cast<float>(columns - 1)) / static_cast<float>(columns);
  int count = 0;
  for (const std::string_view id : ids) {
    if (ui.actions.find(id) == nullptr) continue;
    const auto column = static_cast<float>(count % columns), row = static_cast<float>(count / columns);
    ++count;
    ImGui::SetCursorScreenPos({area.x + column * (width + gap), area.y + row * (height + gap)});
    widgets::action_button(ui, id, width, height);
  }
}

}  // namespace

TheatreLayout NavigateView::layout_in(const widgets::Ui& ui, const widgets::Rect& area) const {
  TheatreLayoutOptions options;
  options.scale = ui.theme.scale;
  options.afar_px = ui.theme.afar->FontSize;
  options.number_px = ui.theme.number->FontSize;
  const double now = theatre::LiveOperation::now_s();
  options.guides = layout(now) == NavigateLayout::Guide;
  options.has_target = now - choices_.guidance_seen_s <= kGuideAway_s;
  options.is_whole_window = takes_window();
  options.has_buttons = !options.is_whole_window;
  return theatre_layout(area, options);
}

std::optional<widgets::Rect> NavigateView::header_in(const widgets::Ui& ui,
                                                     const widgets::Rect& window) const {
  if (!takes_window()) return std::nullopt;
  return layout_in(ui, window).header;
}

void NavigateView::draw_controls(const widgets::Ui& ui, const widgets::Rect& area) {
  std::vector<std::string_view> ids{"navigate.next"};
  // Where there are two to choose from, right beside the next step.
  if (model_ != nullptr)
    for (const auto& [bundle, id] : {std::pair(norms::Bundle::Anteromedial, "navigate.tunnel_am"),
                                     std::pair(norms::Bundle::Posterolateral, "navigate.tunnel_pl")})
      if (model_->knee().plan.tunnels.contains({choices_.bone, bundle})) ids.push_back(id);
  for (const char* id : {"navigate.camera", "navigate.video", "navigate.scratch", "navigate.drill",
                         "navigate.medium", "navigate.bone", "navigate.menu"})
    ids.push_back(id);
  draw_buttons(ui, area, ids, static_cast<int>(ids.size()), area.height);
}

void NavigateView::draw_menu(const widgets::Ui& ui, const widgets::Rect& area, const NavigateScreen& screen) {
  ui.log.note("navigate.menu_sheet", area.min(), area.max());
  ImGui::GetWindowDrawList()->AddRectFilled(area.min(), area.max(), widgets::kBackground);
  const auto can_run = [&](std::string_view id) {
    const widgets::Action* const action = ui.actions.find(id);
    return action != nullptr && action->can_run();
  };
  const std::vector<std::string_view> ids = menu_page(choices_.shows_more, can_run);
  widgets::Rect buttons = area;
  widgets::Rect states = cut_menu_states(buttons, ids.size(), ui.theme.scale);
  draw_buttons(ui, buttons, ids, kMenuColumns, menu_row_height(ui.theme.scale) - ui.theme.px(6));
  if (states.height <= 0) return;
  draw_registration_details(ui, states.cut_right(states.width * 0.5F, ui.theme.px(8)), screen);
  draw_tracking(ui, states, screen);
}

}  // namespace arthronaut::navigate
