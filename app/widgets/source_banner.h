// What kind of source the pictures come from, said so that nobody in the room can miss it: a frame about the
// whole window and a word in large letters. The frame's pattern and the word say it without the colour.
#pragma once

#include <string_view>

#include "app/widgets/controls.h"
#include "navigation/sources/frame_source.h"

namespace arthronaut::widgets {

// "LIVE", "RECORDING", "SIMULATION".
[[nodiscard]] std::string_view banner_word(sources::SourceKind kind);
[[nodiscard]] ImU32 banner_color(sources::SourceKind kind);

// About the whole window and over everything: whole for Live, in long dashes for Recording, in short ones for
// Simulation.
void draw_source_frame(const Ui& ui, const Rect& window, sources::SourceKind kind);

// The word on its colour, as wide as it needs; readable from afar (theme.h). Returns the width.
float draw_source_word(const Ui& ui, const Rect& area, sources::SourceKind kind);

}  // namespace arthronaut::widgets
