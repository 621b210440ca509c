#include "app/navigate/menu_page.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "app/navigate/theatre_layout.h"

namespace arthronaut::navigate {
namespace {

using Ids = std::vector<std::string_view>;

bool always(std::string_view) { return true; }
bool never(std::string_view) { return false; }

// Nothing is lost, whatever can be used, and nothing but the menu's own two buttons stands on both pages.
TEST(MenuPage, TheTwoPagesHoldEverythingOnce) {
  const auto every_other = [](std::string_view id) { return id.size() % 2 == 0; };
  std::size_t all = 0;
  for (const std::function<bool(std::string_view)>& can_run :
       {std::function(always), std::function(never), std::function<bool(std::string_view)>(every_other)}) {
    const Ids first = menu_page(false, can_run), more = menu_page(true, can_run);
    std::set<std::string_view> ids(first.begin(), first.end());
    ids.insert(more.begin(), more.end());
    EXPECT_EQ(ids.size() + 2, first.size() + more.size());
    if (all == 0) all = ids.size();
    EXPECT_EQ(ids.size(), all);
  }
}

TEST(MenuPage, TheFirstHoldsWhatCanBeUsedAlone) {
  EXPECT_EQ(menu_page(false, never), (Ids{"navigate.menu", "navigate.more"}));
  const auto draws = [](std::string_view id) { return id == "navigate.digitise"; };
  EXPECT_EQ(menu_page(false, draws), (Ids{"navigate.menu", "navigate.more", "navigate.digitise"}));
}

// However much can be used, the states under the first page keep a quarter of the block, and nothing leaves
// it.
TEST(MenuPage, TheStatesKeepTheirRoom) {
  for (const auto& [width, height] : {std::pair(1280, 720), std::pair(1920, 1080), std::pair(3840, 2160)}) {
    const float scale = widgets::scale_for(width, height);
    const float afar = widgets::afar_px({width, height, 0}, scale);
    const widgets::Rect area =
        widgets::Rect{0, 0, static_cast<float>(width), static_cast<float>(height)}.inset(12 * scale);
    const widgets::Rect block =
        theatre_layout(area, {scale, afar, 64 * scale, false, true, true, false}).block;
    for (const bool shows_more : {false, true}) {
      widgets::Rect buttons = block;
      const Ids ids = menu_page(shows_more, always);
      const widgets::Rect states = cut_menu_states(buttons, ids.size(), scale);
      if (!shows_more) {
        EXPECT_GT(states.height, block.height / 4) << width;
      }
      const auto rows = static_cast<float>((ids.size() + kMenuColumns - 1) / kMenuColumns);
      EXPECT_GE(buttons.height + 1, rows * menu_row_height(scale)) << width;
      EXPECT_LE(states.y + states.height, block.y + block.height + 1) << width;
    }
  }
}

}  // namespace
}  // namespace arthronaut::navigate
