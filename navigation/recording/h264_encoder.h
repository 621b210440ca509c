// Inner header: the H.264 encoder of a recording: by the graphics processor where there is one that does it
// (VA-API), else by libx264.
#pragma once

#include <filesystem>

#include "navigation/recording/video_encoder.h"
#include "navigation/sources/libav.h"

extern "C" {
#include <libavutil/buffer.h>
}

namespace arthronaut::recording {

struct FreeBuffer {
  void operator()(AVBufferRef* p) const { av_buffer_unref(&p); }
};

struct H264Encoder {
  sources::LibavPtr<AVCodecContext> encoder;
  // Of the graphics processor: where pictures are put for it. Null for libx264.
  std::unique_ptr<AVBufferRef, FreeBuffer> frames = nullptr;
  sources::LibavPtr<AVFrame> reordered = nullptr, on_device = nullptr;
};

// Takes 8-bit 4:2:0 in full range (4:4:4 where a size is odd, which libx264 alone does). Throws IoError where
// there is neither encoder.
[[nodiscard]] H264Encoder open_h264(const std::filesystem::path& file, int width, int height, AVRational rate,
                                    H264For purpose);
// A picture where the graphics processor looks for it; valid until the next one. Precondition: frames. Throws
// IoError.
[[nodiscard]] const AVFrame* uploaded(H264Encoder& h264, const AVFrame& picture,
                                      const std::filesystem::path& file);

}  // namespace arthronaut::recording
