// The sources that are on offer, side by side with what they show: what is chosen by O in turn, at one look.
#include <imgui.h>

#include <algorithm>
#include <optional>

#include "app/setup/setup_view.h"

namespace arthronaut::setup {

void SetupView::show_gallery() {
  // A camera that a station reads would refuse to be looked at.
  step().station->stop();
  find_sources();
  std::vector<previews::Opener> openers;
  for (const FeedSource& source : step().source.offered())
    openers.push_back(source.look ? source.look : source.open);
  previews_.show(openers);
  shows_gallery_ = true;
}

void SetupView::close_gallery() {
  shows_gallery_ = false;
  previews_.close();
}

void SetupView::draw_gallery(const widgets::Ui& ui, const widgets::Rect& area) {
  widgets::Rect rest = area;
  const std::vector<FeedSource>& offered = step().source.offered();
  widgets::text_centered(ui, rest.cut_top(ui.theme.px(48)), ui.theme.strong, widgets::kQuietText,
                         offered.empty() ? "No source: connect a camera, or type a path (P)"
                                         : "O, or a click: choose    Space: start    L: back");
  const float count = static_cast<float>(std::max<std::size_t>(offered.size(), 1));
  const float height = std::clamp(rest.height / count, ui.theme.px(44), ui.theme.px(150));
  const FeedSource* const chosen = step().source.chosen();
  std::optional<std::size_t> clicked;
  for (std::size_t i = 0; i < offered.size() && rest.height >= height; ++i)
    if (previews_.draw(ui, rest.cut_top(height), i, offered[i].name, &offered[i] == chosen)) clicked = i;
  if (clicked) step().source.choose(*clicked);
}

}  // namespace arthronaut::setup
