#include "app/widgets/color_texture.h"

#include <GL/glew.h>

namespace arthronaut::widgets {

ColorTexture::~ColorTexture() {
  if (texture_ != 0) glDeleteTextures(1, &texture_);
}

void ColorTexture::upload(int width, int height, std::span<const std::uint32_t> rgba) {
  if (width < 1 || height < 1 ||
      rgba.size() < static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
    return;
  if (texture_ == 0) glGenTextures(1, &texture_);
  glBindTexture(GL_TEXTURE_2D, texture_);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
}

}  // namespace arthronaut::widgets
