#include "app/navigate/theatre_layout.h"

#include <algorithm>
#include <cmath>

#include "app/widgets/two_screens.h"

namespace arthronaut::navigate {

namespace {

// The second of two screens, of which `column` is left for what is read: the target is a square of its
// height, or as wide as the column leaves it; the 3D view stands in what is left below it, else beside the
// numbers.
void cut_second_screen(TheatreLayout& layout, widgets::Rect& column, const TheatreLayoutOptions& options,
                       float least_column, float gap) {
  const float side = std::min(column.height, column.width - gap - least_column);
  layout.block = column.cut_left(side, gap);
  layout.scene = layout.block;
  if (!options.guides || !options.has_target) return;
  layout.target = layout.scene.cut_top(side, gap);
}

}  // namespace

TheatreLayout theatre_layout(const widgets::Rect& area, const TheatreLayoutOptions& options) {
  const float gap = std::round(12 * options.scale), afar = options.afar_px;
  TheatreLayout layout;
  widgets::Rect rest = area;
  if (options.has_buttons) layout.buttons = rest.cut_bottom(50 * options.scale, gap);
  // A letter is about half as wide as its line is high.
  const float least_column = kColumnLetters * 0.53F * afar;
  const bool is_two = widgets::is_two_screens(area.width, area.height);
  // Of two screens one is the picture's; as far from the seam as from the edge.
  const float widest =
      is_two ? (rest.width - 2 * gap) / 2 : std::max(rest.width - gap - least_column, rest.width * 0.4F);
  const float side = std::floor(std::min(rest.height, widest));
  widgets::Rect left = is_two ? rest.cut_left(widest, 2 * gap) : rest.cut_left(side, gap);
  const float below = left.height - side;
  const bool is_tall = !is_two && below > 5 * afar;  // as a screen of 4:3 is
  layout.video = {left.x + (left.width - side) / 2, is_tall ? left.y : left.y + below / 2, side, side};

  if (is_two) cut_second_screen(layout, rest, options, least_column, gap);
  // Side, patient and what is to be said now stand one below the other: a title and two lines.
  if (options.is_whole_window)
    layout.header =
        rest.cut_top(std::max(1.2F * afar + 30 * options.scale, (34 + 2 * 24 + 4) * options.scale), gap);
  layout.rail = rest.cut_top(1.25F * afar + 32 * options.scale, gap);
  layout.words = rest.cut_top(34 * options.scale + 3.1F * afar, gap);
  layout.states = rest.cut_bottom(44 * options.scale, gap);
  // "12.3 posterior" is 6.8 letters' heights wide.
  const float numbers_width = 6.8F * afar + 28 * options.scale;
  if (is_two) {
    const bool has_room_below = layout.scene.height > 5 * afar;
    layout.scene_is_in_block = has_room_below;
    layout.main = rest;
    if (has_room_below) return layout;
    layout.main = rest.cut_right(numbers_width, gap);
    layout.scene = rest;
    return layout;
  }
  layout.block = rest;
  layout.scene_is_in_block = !is_tall;
  // Where the window is taller than the picture, the 3D view stands under it, else in the column.
  if (is_tall) {
    layout.scene = {left.x, left.y + side + gap, side, below - gap};
    // Under the target there is room for offset, angle and what remains for a drill.
    const float numbers = 5 * afar + 3 * options.number_px + 32 * options.scale;
    if (options.guides) layout.target = rest.cut_top(std::min(rest.width, rest.height - gap - numbers), gap);
    layout.main = rest;
  } else if (options.guides) {
    // What is aimed by is as large as the numbers beside it allow.
    widgets::Rect column = rest.cut_left(std::min(rest.width - gap - numbers_width, rest.height * 0.8F), gap);
    if (options.has_target)
      layout.target = column.cut_top(std::min(column.width, column.height * 0.62F), gap);
    layout.scene = column;
    layout.main = rest;
  } else {
    layout.scene = rest.cut_top(rest.height * 0.4F, gap);
    layout.main = rest;
  }
  return layout;
}

}  // namespace arthronaut::navigate
