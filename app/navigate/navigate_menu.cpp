// Where things stand on the theatre screen, and the menu: everything that is not needed at every moment.
#include "app/navigate/navigate_view.h"

namespace arthronaut::navigate {

namespace {

// Rows of buttons of one width; returns the height taken.
float draw_buttons(const widgets::Ui& ui, const widgets::Rect& area, const std::vector<const char*>& ids,
                   int columns, float height) {
  const float gap = ui.theme.px(6);
  const float width = (area.width - gap * static_cast<float>(columns - 1)) / static_cast<float>(columns);
  int count = 0;
  for (const char* id : ids) {
    if (ui.actions.find(id) == nullptr) continue;
    const auto column = static_cast<float>(count % columns), row = static_cast<float>(count / columns);
    ++count;
    ImGui::SetCursorScreenPos({area.x + column * (width + gap), area.y + row * (height + gap)});
    widgets::action_button(ui, id, width, height);
  }
  const int rows = (count + columns - 1) / columns;
  return static_cast<float>(rows) * (height + gap);
}

}  // namespace

TheatreLayout NavigateView::layout_in(const widgets::Ui& ui, const widgets::Rect& area) const {
  TheatreLayoutOptions options;
  options.scale = ui.theme.scale;
  options.afar_px = ui.theme.afar->FontSize;
  options.guides = layout(theatre::LiveOperation::now_s()) == NavigateLayout::Guide;
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
  std::vector<const char*> ids{"navigate.next"};
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
  widgets::Rect rest = area;
  const std::vector<const char*> ids{"navigate.menu",
                                     "navigate.back",
                                     "navigate.stop",
                                     "navigate.digitise",
                                     "navigate.register",
                                     "navigate.take_back",
                                     "navigate.exclude",
                                     "navigate.clear",
                                     "navigate.touch",
                                     "navigate.control_point",
                                     "navigate.check_guide",
                                     "navigate.forget_touches",
                                     "navigate.earlier",
                                     "navigate.later",
                                     "navigate.panel",
                                     "navigate.overlay",
                                     "navigate.undistort",
                                     "navigate.sounds",
                                     "navigate.depth_stop",
                                     "navigate.drilled",
                                     "navigate.marker_anew",
                                     "navigate.bone",
                                     "navigate.tunnel_am",
                                     "navigate.tunnel_pl",
                                     "navigate.record",
                                     "navigate.camera",
                                     "navigate.video",
                                     "navigate.scratch",
                                     "navigate.drill",
                                     "navigate.medium",
                                     "mode.plan",
                                     "mode.setup",
                                     "mode.review",
                                     "app.screenshot",
                                     "app.record_screen",
                                     "app.send_screen",
                                     "app.keys",
                                     "app.quit"};
  const float columns = 3, height = ui.theme.px(36);
  (void)rest.cut_top(draw_buttons(ui, rest, ids, static_cast<int>(columns), height));
  draw_registration_details(ui, rest.cut_right(rest.width * 0.5F, ui.theme.px(8)), screen);
  draw_tracking(ui, rest, screen);
}

}  // namespace arthronaut::navigate
