// Colours, type and sizes of every screen: dark, calm, read from two metres. Sizes are for a window 1080
// pixels high and scale with it, so that a screen looks alike at 720, 1080 and 2160 lines.
#pragma once

#include <imgui.h>

#include "app/scene/scene_content.h"

namespace arthronaut::widgets {

struct Theme {
  float scale = 1;           // of all sizes
  ImFont* body = nullptr;    // 24 px at scale 1
  ImFont* strong = nullptr;  // 24 px, semi-bold
  ImFont* title = nullptr;   // 34 px
  ImFont* number = nullptr;  // 64 px
  ImFont* afar = nullptr;    // kAfar_px, semi-bold, Latin letters and digits alone
  [[nodiscard]] float px(float size_at_1080) const { return size_at_1080 * scale; }
};

// What must be read from across the room: capitals 16 minutes of arc high at 2 m on a 27-inch screen. That is
// 2000 mm x tan(16') = 9.3 mm; such a screen has 1080 lines on 336 mm, so 30 px. A font's size counts from
// its highest to its deepest letter: capitals are 0.60 of it in Inter (0.727 / 1.21 em) and 0.63 in DejaVu
// Sans.
inline constexpr float kCapitalsOfSize = 0.60F;
inline constexpr float kAfar_px = 52;

inline constexpr ImU32 kBackground = IM_COL32(12, 15, 19, 255);
inline constexpr ImU32 kPanel = IM_COL32(22, 27, 33, 255);
inline constexpr ImU32 kPanelEdge = IM_COL32(44, 53, 63, 255);
inline constexpr ImU32 kText = IM_COL32(232, 237, 242, 255);
inline constexpr ImU32 kQuietText = IM_COL32(158, 171, 184, 255);
inline constexpr ImU32 kAccent = IM_COL32(86, 180, 233, 255);
inline constexpr ImU32 kHeld = IM_COL32(178, 92, 20, 255);  // fills while something is held down
inline constexpr ImU32 kGood = IM_COL32(64, 200, 150, 255);
inline constexpr ImU32 kCaution = IM_COL32(240, 190, 60, 255);
inline constexpr ImU32 kBad = IM_COL32(255, 112, 92, 255);

[[nodiscard]] ImU32 color_of(const scene::Color& color, float opacity = 1);

// The scale for a window of this size.
[[nodiscard]] float scale_for(int width_px, int height_px);
// (Re)builds fonts and style for a scale. Inter where it is installed, DejaVu Sans else, ImGui's own as the
// last resort. Between frames only; the caller refreshes the font texture.
[[nodiscard]] Theme build_theme(float scale);

}  // namespace arthronaut::widgets
