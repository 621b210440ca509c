// What of the screen has to be drawn anew. Where the processor draws, text and panels cost four times what
// the live picture does, and nearly all of them stand still from frame to frame.
//
// The screen is cut into tiles. What covers a tile (places, colours, textures, clipping, order) is folded
// into one number; a tile whose number is another one is drawn anew. What a texture holds nobody can see from
// ImGui's lists: shows_version() says so for the picture that follows; a picture without it, other than
// letters, counts as changed in every frame. So whoever says nothing costs time, and never a stale screen.
// Besides, every frame draws one row of tiles whether it changed or not: whatever is amiss is gone within
// seconds.
#pragma once

#include <imgui.h>

#include <cstdint>
#include <span>
#include <vector>

namespace arthronaut::widgets {

// The next picture of this list shows a texture whose content has this number, above 0. After the picture:
// draw.AddCallback(ImDrawCallback_ResetRenderState, nullptr).
void shows_version(ImDrawList& draw, std::uint64_t version);
// The same of a picture without transparency, and a callback that sets up OpenGL for it.
using PictureSetUp = void (*)(const ImDrawList*, const ImDrawCmd*);
void shows_opaque(ImDrawList& draw, std::uint64_t version, PictureSetUp set_up);

struct PixelArea {
  int left = 0, top = 0, right = 0, bottom = 0;  // right and bottom: the first pixels outside
  [[nodiscard]] bool meets(const PixelArea& other) const {
    return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
  }
  [[nodiscard]] long size() const {
    return static_cast<long>(right - left) * static_cast<long>(bottom - top);
  }
  bool operator==(const PixelArea&) const = default;
};
[[nodiscard]] PixelArea both_of(const PixelArea& a, const PixelArea& b);  // the smallest that holds them

class DrawDamage {
 public:
  static constexpr int kTile_px = 32, kMostAreas = 16;

  // What differs from the call before, as areas that do not meet. All of the screen when that was of another
  // size, or after forget(). `letters`: the texture that never changes. Valid until the next call.
  [[nodiscard]] std::span<const PixelArea> changed(const ImDrawData& data, ImTextureID letters);
  // Nothing is known of what stands on the screen.
  void forget() { tiles_.clear(); }

 private:
  void fold(const ImDrawData& data, ImTextureID letters);
  void fold_triangle(const ImDrawVert* const (&corners)[3], const PixelArea& clip, std::uint64_t look);
  void find_areas();
  void limit_areas();

  int width_ = 0, height_ = 0, columns_ = 0, rows_ = 0;
  int row_drawn_anyway_ = 0;
  std::uint64_t frame_ = 0;
  std::vector<std::uint64_t> tiles_, folded_;
  std::vector<PixelArea> areas_;
};

// Where ImGui's renderer lets this command draw, in whole pixels of a screen so high.
[[nodiscard]] PixelArea clip_of(const ImDrawCmd& command, int height_px);
// What of the screen the largest opaque picture covers, whole pixels; empty without one.
[[nodiscard]] PixelArea opaque_area(const ImDrawData& data);
// An area without what `hole` covers of it: up to four, which do not meet.
[[nodiscard]] std::vector<PixelArea> without(const PixelArea& area, const PixelArea& hole);
// Leaves of the frame's lists what draws in these areas, which do not meet, and nothing else. A callback that
// is no picture's is called once, after what stands before it in its list.
void keep_only(ImDrawData& data, std::span<const PixelArea> areas);

}  // namespace arthronaut::widgets
