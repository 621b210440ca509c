// How the theatre screen is cut up: the picture as large as the window allows, everything that is read from
// afar in one column beside it. Pure; works for 16:9, 16:10, 4:3 and 4K alike. Across two screens the picture
// has the left one; on the right one what is aimed by, or where the bone is touched, is as large as the
// column beside it allows; nothing lies on the seam.
#pragma once

#include "app/widgets/layout.h"
#include "app/widgets/theme.h"

namespace arthronaut::navigate {

struct TheatreLayout {
  widgets::Rect video;   // square
  widgets::Rect header;  // where the pictures come from, whose knee it is
  widgets::Rect rail;    // the nine steps
  widgets::Rect words;   // what to do now
  widgets::Rect main;    // registration, or numbers, or why there are none
  widgets::Rect target;  // bullseye; beside main, empty while the bone is registered
  widgets::Rect scene;   // 3D view
  // For questions and the menu, in the place of what is worked by: all of target, main and, where it stands
  // in the column, scene; across two screens what stands beside the column.
  widgets::Rect block;
  bool scene_is_in_block = false;
  widgets::Rect states;   // lens, markers, tools, record: one line
  widgets::Rect buttons;  // before a source runs; else empty
};

struct TheatreLayoutOptions {
  float scale = 1;              // of all sizes, as of the theme
  float afar_px = 52;           // size of the letters that must be read from afar
  float number_px = 64;         // and of the numbers
  bool guides = true;           // bullseye and numbers, else the registration
  bool has_target = true;       // else the bone stands in the place of a bullseye that shows nothing
  bool is_whole_window = true;  // a header is needed
  bool has_buttons = false;
};

// No two of the rectangles overlap, but for block, and all lie inside the area.
[[nodiscard]] TheatreLayout theatre_layout(const widgets::Rect& area, const TheatreLayoutOptions& options);

// So many letters that are read from afar fit beside each other in a column at the least.
inline constexpr float kColumnLetters = 28;

}  // namespace arthronaut::navigate
