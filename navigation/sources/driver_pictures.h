// Inner header: frames of pictures that lie uncompressed in a driver's memory. The luma is looked at where it
// lies where it is a plane that uses all 256 steps; else it is written once. Colours are made of the driver's
// picture, by whoever shows them; the picture goes back to the driver with the last who looks at it. When the
// driver would run out of memory by that, it is copied and goes back at once.
#pragma once

#include <linux/videodev2.h>

#include <memory>

#include "navigation/camera/frame.h"
#include "navigation/sources/camera_buffers.h"
#include "navigation/sources/pixel_formats.h"
#include "navigation/worker/recycler.h"

namespace arthronaut::sources {

struct PictureLayout {
  AVPixelFormat format = AV_PIX_FMT_NONE;
  int width = 0, height = 0, stride = 0;  // of the first plane
  bool is_full_range = false;
  // Of what the driver says of its format. Precondition: it is in the table, and not compressed.
  static PictureLayout of(const v4l2_pix_format& format);
  [[nodiscard]] std::size_t byte_count() const;  // of a whole picture
};

class DriverPictures {
 public:
  DriverPictures(PictureLayout layout, std::shared_ptr<CameraBuffers> buffers);
  // With width, height and luma. Takes the buffer over. Null: it holds no whole picture.
  [[nodiscard]] std::shared_ptr<camera::Frame> make(const CameraBuffers::Filled& filled);

 private:
  class Memory;
  PictureLayout layout_;
  std::shared_ptr<CameraBuffers> buffers_;
  worker::Recycler<Memory> memories_;
  worker::Recycler<camera::Frame> frames_;
};

}  // namespace arthronaut::sources
