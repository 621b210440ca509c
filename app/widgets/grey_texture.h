// A grey picture as an OpenGL texture: a slice, a thumbnail. On the thread that owns the context.
#pragma once

#include <cstdint>
#include <span>

namespace arthronaut::widgets {

class GreyTexture {
 public:
  GreyTexture() = default;
  ~GreyTexture();
  GreyTexture(const GreyTexture&) = delete;
  GreyTexture& operator=(const GreyTexture&) = delete;

  // Rows from the top, width * height bytes, 0 black.
  void upload(int width, int height, std::span<const std::uint8_t> grey);
  [[nodiscard]] std::uint32_t texture() const { return texture_; }  // 0 before the first upload
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }

 private:
  std::uint32_t texture_ = 0;
  int width_ = 0, height_ = 0;
};

}  // namespace arthronaut::widgets
