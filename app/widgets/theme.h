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
  ImFont* number = nullptr;  // 64 px, Western letters alone
  ImFont* afar = nullptr;    // afar_px(), semi-bold, Western letters alone
  [[nodiscard]] float px(float size_at_1080) const { return size_at_1080 * scale; }
};

// The one rule of size: what guides or warns is read from across the room when its capitals are 16 minutes of
// arc high at 2 m. A font's size counts from its highest to its deepest letter: capitals are 0.60 of it in
// Inter (0.727 / 1.21 em) and 0.63 in DejaVu Sans. On a 27-inch screen of 1080 lines (336 mm high) that is 30
// px of capital, 52 px of font.
inline constexpr double kAfar_arcmin = 16, kAfarDistance_mm = 2000;
inline constexpr float kCapitalsOfSize = 0.60F;
inline constexpr float kAfar_px = 50;  // at scale 1 on that screen; afar_px() says it for any

// A screen that is looked at. diagonal_mm 0: not known, or not believable; then it counts as 27 inches.
struct Screen {
  int width_px = 1920, height_px = 1080;  // of the whole screen
  double diagonal_mm = 0;
};
inline constexpr double kUsualDiagonal_mm = 27 * 25.4;
// The font size that the rule asks for on this screen.
[[nodiscard]] float afar_needed_px(const Screen& screen);
// The font size that is used at this scale: the one that is needed, as far as a layout of this scale can hold
// it, from 0.8 to 1.2 times its usual size.
[[nodiscard]] float afar_px(const Screen& screen, float scale);

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
// (Re)builds the fonts for a scale, with their picture. Inter where it is installed, DejaVu Sans else,
// ImGui's own as the last resort. Between frames only, or on any thread while there is no ImGui context; the
// caller refreshes the font texture.
[[nodiscard]] Theme build_theme(ImFontAtlas& fonts, float scale, float afar_px);
// Sizes and colours of ImGui's own widgets for a scale.
void build_style(float scale);

}  // namespace arthronaut::widgets
