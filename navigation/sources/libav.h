// Inner header: what readers and writers of files and of streams share of libavformat, libavcodec and
// libswscale.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "navigation/camera/frame.h"
#include "navigation/worker/recycler.h"

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

// Of a container that is written.
struct CloseOutput {
  void operator()(AVFormatContext* p) const {
    avio_closep(&p->pb);
    avformat_free_context(p);
  }
};
using LibavOutput = std::unique_ptr<AVFormatContext, CloseOutput>;

// "Invalid data found when processing input".
[[nodiscard]] std::string libav_message(int error);
// Why libavformat opens no such address, by its kind, in small letters, alone; empty where it may.
[[nodiscard]] std::string why_no_address(const std::string& address);
// As the container says, else as it was guessed of the first pictures; 0: neither.
[[nodiscard]] double frames_per_second_of(const AVStream& stream);

// Live: what must not hold pictures back, and what is decoded again to be the same to the last bit. Quick: by
// all cores.
enum class DecoderUse { Live, Quick };
// Of a stream that came over the network. Null: `problem` says why.
[[nodiscard]] LibavPtr<AVCodecContext> open_stream_decoder(const AVCodecParameters& parameters,
                                                           AVRational time_base, std::string& problem,
                                                           DecoderUse use = DecoderUse::Live);
// Neither damaged nor put together from what was there before.
[[nodiscard]] bool is_whole(const AVFrame& picture);

// Colours of decoded pictures by BT.601, whatever they are tagged with: camera::gray_from() then computes the
// luma that was sent.
class BgrConverter {
 public:
  // The picture's luma and colours use all 256 steps.
  void expect_full_range() { is_full_range_ = true; }
  // Packed. False: no way from this pixel format.
  [[nodiscard]] bool convert(const AVFrame& picture, std::vector<std::uint8_t>& bgr);

 private:
  LibavPtr<SwsContext> converter_;
  bool is_full_range_ = false;
};

// Makes frames of decoded pictures without converting colours: the luma is the one that was sent. Where it
// uses all 256 steps it is looked at where the decoder put it; where it is stretched from 16..235, or has
// more than 8 bits, it is written once. Colours are made by whoever shows them. One thread; frames may
// outlive it.
class DecodedFrames {
 public:
  DecodedFrames();
  // With width, height and luma; null: no way from this pixel format. The picture is kept, not copied.
  [[nodiscard]] std::shared_ptr<camera::Frame> make(const AVFrame& picture);

 private:
  class Memory;
  worker::Recycler<Memory> memories_;
  worker::Recycler<camera::Frame> frames_;
  std::vector<std::uint8_t> bgr_;  // while it is found out that there is a way
  int known_format_ = -1;
};

}  // namespace arthronaut::sources
