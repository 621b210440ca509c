#include "navigation/sources/driver_pictures.h"

#include <algorithm>
#include <utility>

#include "navigation/sources/libav.h"
#include "navigation/sources/luma_planes.h"

extern "C" {
#include <libavutil/imgutils.h>
#include <libavutil/pixdesc.h>
}

namespace arthronaut::sources {

namespace {

// Rows of the planes after the first are as long, in proportion.
struct Planes {
  std::uint8_t* data[4] = {};
  int strides[4] = {};
  std::size_t byte_count = 0;
};

Planes planes_of(const PictureLayout& layout, const std::uint8_t* data) {
  Planes planes;
  const AVPixFmtDescriptor& described = *av_pix_fmt_desc_get(layout.format);
  const int count = av_pix_fmt_count_planes(layout.format);
  for (int plane = 0; plane < count; ++plane) {
    const bool is_chroma = plane > 0;
    const int height = is_chroma ? -((-layout.height) >> described.log2_chroma_h) : layout.height;
    // Half as wide, but both colours in one row where there are but two planes.
    planes.strides[plane] =
        is_chroma && count == 3 ? layout.stride >> described.log2_chroma_w : layout.stride;
    planes.data[plane] = const_cast<std::uint8_t*>(data) + planes.byte_count;  // libswscale reads alone
    planes.byte_count += static_cast<std::size_t>(planes.strides[plane]) * static_cast<std::size_t>(height);
  }
  return planes;
}

LumaPlane luma_in(const PictureLayout& layout, const std::uint8_t* data) {
  const AVPixFmtDescriptor& described = *av_pix_fmt_desc_get(layout.format);
  if ((described.flags & AV_PIX_FMT_FLAG_RGB) != 0) return {};
  const AVComponentDescriptor& luma = described.comp[0];
  return {.data = data + luma.offset,
          .stride = layout.stride,
          .step = luma.step,
          .bits = luma.depth,
          .shift = luma.shift,
          .is_full_range = layout.is_full_range,
          .width = layout.width,
          .height = layout.height};
}

}  // namespace

PictureLayout PictureLayout::of(const v4l2_pix_format& format) {
  PictureLayout layout{.format = find_pixel_format(format.pixelformat)->libav,
                       .width = static_cast<int>(format.width),
                       .height = static_cast<int>(format.height)};
  const int packed = av_image_get_linesize(layout.format, layout.width, 0);
  layout.stride = std::max(packed, static_cast<int>(format.bytesperline));
  const bool is_rgb = (av_pix_fmt_desc_get(layout.format)->flags & AV_PIX_FMT_FLAG_RGB) != 0;
  std::uint32_t range = format.quantization;
  if (range == V4L2_QUANTIZATION_DEFAULT)
    range = V4L2_MAP_QUANTIZATION_DEFAULT(is_rgb, format.colorspace, format.ycbcr_enc);
  // A sensor without colours has no television to please.
  layout.is_full_range = range == V4L2_QUANTIZATION_FULL_RANGE || layout.format == AV_PIX_FMT_GRAY8;
  return layout;
}

std::size_t PictureLayout::byte_count() const { return planes_of(*this, nullptr).byte_count; }

class DriverPictures::Memory final : public camera::PictureMemory {
 public:
  void hold(const PictureLayout& layout, const std::shared_ptr<CameraBuffers>& buffers,
            const CameraBuffers::Filled& filled) {
    layout_ = layout;
    if (buffers->can_spare()) {
      buffers_ = buffers;
      buffer_ = filled.buffer;
      data_ = filled.data;
    } else {
      copy_.assign(filled.data, filled.data + layout.byte_count());
      data_ = copy_.data();
      buffers->give_back(filled.buffer);
    }
  }
  void let_go() {
    if (const auto buffers = std::exchange(buffers_, nullptr)) buffers->give_back(buffer_);
  }

  [[nodiscard]] LumaPlane plane() const { return luma_in(layout_, data_); }
  [[nodiscard]] camera::GrayView luma() const override { return plane().in_place(); }
  void bgr_into(std::vector<std::uint8_t>& bgr) const override {
    // As in DecodedFrames: whoever shows does so on one thread.
    thread_local BgrConverter limited, full;
    thread_local const LibavPtr<AVFrame> picture(av_frame_alloc());
    const Planes planes = planes_of(layout_, data_);
    std::copy(std::begin(planes.data), std::end(planes.data), picture->data);
    std::copy(std::begin(planes.strides), std::end(planes.strides), picture->linesize);
    picture->format = layout_.format;
    picture->width = layout_.width;
    picture->height = layout_.height;
    full.expect_full_range();
    (void)(layout_.is_full_range ? full : limited).convert(*picture, bgr);
  }

 private:
  PictureLayout layout_;
  std::shared_ptr<CameraBuffers> buffers_;  // null: it is a copy
  int buffer_ = 0;
  const std::uint8_t* data_ = nullptr;
  std::vector<std::uint8_t> copy_;
};

DriverPictures::DriverPictures(PictureLayout layout, std::shared_ptr<CameraBuffers> buffers)
    : layout_(layout),
      buffers_(std::move(buffers)),
      memories_([](Memory& memory) { memory.let_go(); }),
      frames_([](camera::Frame& frame) { frame.memory.reset(); }) {}

std::shared_ptr<camera::Frame> DriverPictures::make(const CameraBuffers::Filled& filled) {
  if (filled.is_damaged || filled.byte_count < layout_.byte_count()) {
    buffers_->give_back(filled.buffer);
    return nullptr;
  }
  auto frame = frames_.take();
  frame->width = layout_.width;
  frame->height = layout_.height;
  auto memory = memories_.take();
  memory->hold(layout_, buffers_, filled);
  const LumaPlane plane = memory->plane();
  put_picture(*frame, std::move(memory), plane);
  return frame;
}

}  // namespace arthronaut::sources
