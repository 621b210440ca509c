// The list of every key that works in a mode, over the screen.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "app/mode/mode.h"
#include "app/widgets/controls.h"

namespace arthronaut::window {

// Explanations in two columns, each broken into lines and none of them cut. Pure.
struct KeyListLayout {
  float letters_px = 0, line_px = 0;  // no larger than the font; smaller where it takes that to show all
  std::vector<std::string> words;     // as they stand, with their line ends
  std::size_t first_on_the_right = 0;
};
// room_px: of a column, beside its keys; height_px: for the lines of a column.
[[nodiscard]] KeyListLayout key_list_layout(const ImFont* font, const std::vector<std::string>& explanations,
                                            float room_px, float height_px);

enum class KeyUse { Heading, Now, NotNow };
struct KeyRow {
  std::string key, words;  // the key is empty in a heading and in what cannot be done
  KeyUse use = KeyUse::Now;
};
// Of the actions whose id starts with one of the prefixes, under a heading each: what this screen can do now,
// those that are held down first; what all screens can ("app.", "mode."); what cannot be done as things
// stand, by name alone and in one row. A key may do something else at another moment: whoever looks for it
// now finds what it does now.
[[nodiscard]] std::vector<KeyRow> key_rows(const widgets::Actions& actions,
                                           const std::vector<std::string_view>& prefixes,
                                           const std::vector<mode::HeldKeys>& held);

// It covers what lies under it for the mouse, too. Returns whether it was clicked on.
[[nodiscard]] bool draw_key_list(const widgets::Ui& ui, const std::vector<KeyRow>& shown);

}  // namespace arthronaut::window
