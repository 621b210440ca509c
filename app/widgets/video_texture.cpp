#include "app/widgets/video_texture.h"

#include <GL/glew.h>

#include <algorithm>
#include <cmath>

#include "app/widgets/draw_damage.h"

namespace arthronaut::widgets {

namespace {

void without_blending(const ImDrawList*, const ImDrawCmd*) { glDisable(GL_BLEND); }

}  // namespace

void draw_opaque(ImDrawList& draw, std::uint32_t texture, std::uint64_t version, const Rect& at,
                 const ImVec2& uv_min, const ImVec2& uv_max, ImU32 tint) {
  shows_opaque(draw, version, without_blending);
  draw.AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture)), at.min(), at.max(),
                uv_min, uv_max, tint);
  draw.AddCallback(ImDrawCallback_ResetRenderState, nullptr);
}

VideoTexture::~VideoTexture() {
  if (texture_ != 0) glDeleteTextures(1, &texture_);
}

std::size_t VideoTexture::upload(const camera::FramePtr& frame, const std::optional<Rect>& part) {
  if (frame == nullptr) return 0;
  const Rect whole{0, 0, static_cast<float>(frame->width), static_cast<float>(frame->height)};
  const Rect wanted = part.value_or(whole);
  const int left = static_cast<int>(std::floor(std::clamp(wanted.x, 0.F, whole.width - 1)));
  const int top = static_cast<int>(std::floor(std::clamp(wanted.y, 0.F, whole.height - 1)));
  const int width =
      std::clamp(static_cast<int>(std::ceil(wanted.x + wanted.width)) - left, 1, frame->width - left);
  const int height =
      std::clamp(static_cast<int>(std::ceil(wanted.y + wanted.height)) - top, 1, frame->height - top);
  const bool is_same_part = left == left_ && top == top_ && width == held_width_ && height == held_height_;
  if (frame == uploaded_ && is_same_part) return 0;
  if (texture_ == 0) {
    glGenTextures(1, &texture_);
    glBindTexture(GL_TEXTURE_2D, texture_);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  }
  const std::uint8_t* const bgr = camera::bgr_of(*frame, made_).data();
  glBindTexture(GL_TEXTURE_2D, texture_);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, frame->width);
  glPixelStorei(GL_UNPACK_SKIP_PIXELS, left);
  glPixelStorei(GL_UNPACK_SKIP_ROWS, top);
  if (width != held_width_ || height != held_height_)
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, width, height, 0, GL_BGR, GL_UNSIGNED_BYTE, bgr);
  else
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, GL_BGR, GL_UNSIGNED_BYTE, bgr);
  // As VTK and ImGui expect them.
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  for (const GLenum setting : {GL_UNPACK_ROW_LENGTH, GL_UNPACK_SKIP_PIXELS, GL_UNPACK_SKIP_ROWS})
    glPixelStorei(setting, 0);
  width_ = frame->width;
  height_ = frame->height;
  left_ = left;
  top_ = top;
  held_width_ = width;
  held_height_ = height;
  uploaded_ = frame;
  ++version_;
  return 3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

Rect VideoTexture::held() const {
  return {static_cast<float>(left_), static_cast<float>(top_), static_cast<float>(held_width_),
          static_cast<float>(held_height_)};
}

ImVec2 VideoTexture::place_of(const ImVec2& pixel) const {
  const Rect part = held();
  return {(pixel.x - part.x) / part.width, (pixel.y - part.y) / part.height};
}

}  // namespace arthronaut::widgets
