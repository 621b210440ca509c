#include "navigation/sources/motion_jpeg.h"

#include <algorithm>

#include "planning/geometry/error.h"

extern "C" {
#include <libavutil/log.h>
}

namespace arthronaut::sources {

namespace {

// A picture that lost its end on the bus would be decoded with a grey lower part. Drivers pad the end.
bool has_both_ends(const std::uint8_t* data, std::size_t byte_count) {
  constexpr std::size_t kMostPadding = 4096;
  if (byte_count < 4 || data[0] != 0xFF || data[1] != 0xD8) return false;
  const std::size_t first = byte_count > kMostPadding ? byte_count - kMostPadding : 2;
  for (std::size_t i = byte_count - 1; i > first; --i)
    if (data[i - 1] == 0xFF && data[i] == 0xD9) return true;
  return false;
}

}  // namespace

MotionJpeg::MotionJpeg() : packet_(av_packet_alloc()), picture_(av_frame_alloc()) {
  const AVCodec* const codec = avcodec_find_decoder(AV_CODEC_ID_MJPEG);
  if (codec == nullptr) throw DeviceError("no decoder for mjpeg");
  av_log_set_level(AV_LOG_QUIET);
  decoder_.reset(avcodec_alloc_context3(codec));
  decoder_->thread_count = 1;  // threads by frames hold pictures back
  decoder_->flags |= AV_CODEC_FLAG_LOW_DELAY;
  decoder_->max_pixels = kMostPixels;
  decoder_->err_recognition = AV_EF_EXPLODE;
  if (avcodec_open2(decoder_.get(), codec, nullptr) < 0) throw DeviceError("the decoder of mjpeg fails");
}

const AVFrame* MotionJpeg::decode(const std::uint8_t* data, std::size_t byte_count) {
  if (!has_both_ends(data, byte_count)) return nullptr;
  // Not written to: without a buffer of its own the decoder takes a copy, padded as it needs it.
  packet_->data = const_cast<std::uint8_t*>(data);
  packet_->size = static_cast<int>(byte_count);
  const bool is_sent = avcodec_send_packet(decoder_.get(), packet_.get()) >= 0;
  packet_->data = nullptr;
  packet_->size = 0;
  if (avcodec_receive_frame(decoder_.get(), picture_.get()) != 0 || !is_sent) return nullptr;
  const bool is_whole = picture_->decode_error_flags == 0 && (picture_->flags & AV_FRAME_FLAG_CORRUPT) == 0;
  return is_whole ? picture_.get() : nullptr;
}

}  // namespace arthronaut::sources
