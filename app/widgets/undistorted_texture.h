// The live picture without the lens' distortion, as an OpenGL texture. A fragment shader looks every pixel up
// in the view's table; where the machine can't do that, the CPU does. On the thread that owns the context,
// which is current.
#pragma once

#include <cstdint>
#include <memory>

#include "app/widgets/video_texture.h"
#include "navigation/camera/undistorted_picture.h"

namespace arthronaut::widgets {

class UndistortedTexture {
 public:
  // uses_gpu false: always on the CPU.
  explicit UndistortedTexture(bool uses_gpu = true) : uses_gpu_(uses_gpu) {}
  ~UndistortedTexture();
  UndistortedTexture(const UndistortedTexture&) = delete;
  UndistortedTexture& operator=(const UndistortedTexture&) = delete;

  // The frame as size_px x size_px pixels of the view, top row first in texture(). `video` holds the raw
  // frame and `camera` is that of the frame. Leaves the OpenGL state as it was. Nothing is done for the
  // frame, camera and size of the last call. Memory is taken when lens, medium or size change, not from frame
  // to frame.
  void draw(const camera::FramePtr& frame, const VideoTexture& video, const camera::CameraModel& camera,
            int size_px);

  [[nodiscard]] std::uint32_t texture() const { return texture_; }  // 0 before the first draw()
  [[nodiscard]] std::uint64_t version() const { return version_; }  // another one after every draw()
  [[nodiscard]] const camera::UndistortedView& view() const { return *view_; }  // after the first draw()
  // For tests: else both sides of a comparison could be the CPU's.
  [[nodiscard]] bool is_on_gpu() const { return program_ != 0; }

 private:
  void set_up();
  void upload_table();
  void resize(int size_px);
  void draw_on_gpu(const VideoTexture& video, const camera::CameraModel& camera);
  void draw_on_cpu(const camera::Frame& frame, const camera::CameraModel& camera);

  bool uses_gpu_;
  std::shared_ptr<const camera::UndistortedView> view_;
  camera::UndistortedPicture picture_;  // the CPU's
  std::uint32_t texture_ = 0, table_ = 0, framebuffer_ = 0, program_ = 0, vertices_ = 0;
  std::uint64_t version_ = 0;
  int size_px_ = 0;
  camera::FramePtr drawn_;
};

}  // namespace arthronaut::widgets
