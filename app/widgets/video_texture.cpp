#include "app/widgets/video_texture.h"

#include <GL/glew.h>

namespace arthronaut::widgets {

VideoTexture::~VideoTexture() {
  if (texture_ != 0) glDeleteTextures(1, &texture_);
}

void VideoTexture::upload(const camera::FramePtr& frame) {
  if (frame == nullptr || frame == uploaded_) return;
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
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  if (frame->width != width_ || frame->height != height_) {
    width_ = frame->width;
    height_ = frame->height;
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, width_, height_, 0, GL_BGR, GL_UNSIGNED_BYTE, bgr);
  } else {
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width_, height_, GL_BGR, GL_UNSIGNED_BYTE, bgr);
  }
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  uploaded_ = frame;
}

}  // namespace arthronaut::widgets
