// Inner header: what the readers of files and of streams share of libavformat, libavcodec and libswscale.
#pragma once

#include <memory>
#include <string>

#include "navigation/camera/frame.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libswscale/swscale.h>
}

namespace arthronaut::sources {

inline constexpr std::int64_t kMostPixels = 64'000'000;  // twice 8K; a header that claims more is a bomb

struct FreeLibav {
  void operator()(AVFormatContext* p) const { avformat_close_input(&p); }
  void operator()(AVCodecContext* p) const { avcodec_free_context(&p); }
  void operator()(AVPacket* p) const { av_packet_free(&p); }
  void operator()(AVFrame* p) const { av_frame_free(&p); }
  void operator()(SwsContext* p) const { sws_freeContext(p); }
};
template <class T>
using LibavPtr = std::unique_ptr<T, FreeLibav>;

// "Invalid data found when processing input".
[[nodiscard]] std::string libav_message(int error);

// Colours of decoded pictures by BT.601, whatever they are tagged with: camera::gray_from() then computes the
// luma that was sent.
class BgrConverter {
 public:
  // The picture's luma and colours use all 256 steps.
  void expect_full_range() { is_full_range_ = true; }
  // Fills width, height and bgr. False: no way from this pixel format.
  [[nodiscard]] bool convert(const AVFrame& picture, camera::Frame& frame);

 private:
  LibavPtr<SwsContext> converter_;
  bool is_full_range_ = false;
};

}  // namespace arthronaut::sources
