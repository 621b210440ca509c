// The live picture as an OpenGL texture. On the thread that owns the context.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "app/widgets/layout.h"
#include "navigation/camera/frame.h"

namespace arthronaut::widgets {

// A picture without transparency: not mixed with what lies under it, which costs half of its drawing where
// the processor draws. The tint is opaque. The version is the texture's (draw_damage.h).
void draw_opaque(ImDrawList& draw, std::uint32_t texture, std::uint64_t version, const Rect& at,
                 const ImVec2& uv_min, const ImVec2& uv_max, ImU32 tint);

class VideoTexture {
 public:
  VideoTexture() = default;
  ~VideoTexture();
  VideoTexture(const VideoTexture&) = delete;
  VideoTexture& operator=(const VideoTexture&) = delete;

  // Uploads a frame that is not the one uploaded last; of a `part` (pixels of the picture) only what lies in
  // it, by whole pixels outward. Null is ignored. Returns how many bytes were uploaded.
  std::size_t upload(const camera::FramePtr& frame, const std::optional<Rect>& part = std::nullopt);
  [[nodiscard]] std::uint32_t texture() const { return texture_; }  // 0 before the first upload
  [[nodiscard]] std::uint64_t version() const { return version_; }  // another one after every upload
  [[nodiscard]] int width() const { return width_; }                // of the picture
  [[nodiscard]] int height() const { return height_; }
  // What of it the texture holds, in pixels of the picture.
  [[nodiscard]] Rect held() const;
  // Where a pixel of the picture, counted from the edge of its first one, stands in the texture: 0 to 1.
  [[nodiscard]] ImVec2 place_of(const ImVec2& pixel) const;

 private:
  std::uint32_t texture_ = 0;
  std::uint64_t version_ = 0;
  int width_ = 0, height_ = 0;
  int left_ = 0, top_ = 0, held_width_ = 0, held_height_ = 0;
  camera::FramePtr uploaded_;
  std::vector<std::uint8_t> made_;  // its colours, of frames that keep none
};

}  // namespace arthronaut::widgets
