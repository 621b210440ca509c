// What kind of source the pictures come from, said so that nobody in the room can miss it: a frame about the
// whole window and a word in large letters. The frame's pattern and the word say it without the colour.
#pragma once

#include <string_view>

#include "app/widgets/controls.h"
#include "navigation/sources/frame_source.h"

namespace arthronaut::widgets {

// is_of_now: of a live source the picture is of this moment; nothing else is called so.
// "LIVE", "NOT LIVE", "RECORDING", "SIMULATION".
[[nodiscard]] std::string_view banner_word(sources::SourceKind kind, bool is_of_now);
[[nodiscard]] ImU32 banner_color(sources::SourceKind kind, bool is_of_now);

// About the whole window and over everything: whole for Live, in long dashes for Recording, in short ones for
// Simulation. None for what is not live any more.
void draw_source_frame(const Ui& ui, const Rect& window, sources::SourceKind kind, bool is_of_now);

// The word on its colour, as wide as it needs; readable from afar (theme.h). Returns the width.
float draw_source_word(const Ui& ui, const Rect& area, sources::SourceKind kind, bool is_of_now);

}  // namespace arthronaut::widgets
