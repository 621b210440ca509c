// A translucent picture as an OpenGL texture, to be laid over another one. On the thread that owns the
// context.
#pragma once

#include <cstdint>
#include <span>

namespace arthronaut::widgets {

class ColorTexture {
 public:
  ColorTexture() = default;
  ~ColorTexture();
  ColorTexture(const ColorTexture&) = delete;
  ColorTexture& operator=(const ColorTexture&) = delete;

  // Rows from the top, width * height pixels as bytes red, green, blue, alpha. Its pixels stay sharp.
  void upload(int width, int height, std::span<const std::uint32_t> rgba);
  [[nodiscard]] std::uint32_t texture() const { return texture_; }  // 0 before the first upload

 private:
  std::uint32_t texture_ = 0;
};

}  // namespace arthronaut::widgets
