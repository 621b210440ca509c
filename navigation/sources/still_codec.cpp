#include "navigation/sources/still_codec.h"

#include <algorithm>

#include "navigation/sources/libav.h"
#include "navigation/sources/picture_size.h"

extern "C" {
#include <libavutil/log.h>
#include <libavutil/pixdesc.h>
}

namespace arthronaut::sources {

namespace {

constexpr const char* kNoPicture = "is not a picture that can be decoded";

AVCodecID codec_of(PictureFormat format) {
  switch (format) {
    case PictureFormat::Png:
      return AV_CODEC_ID_PNG;
    case PictureFormat::Jpeg:
      return AV_CODEC_ID_MJPEG;
    case PictureFormat::Bmp:
      return AV_CODEC_ID_BMP;
    case PictureFormat::Tiff:
      return AV_CODEC_ID_TIFF;
    case PictureFormat::WebP:
      return AV_CODEC_ID_WEBP;
    case PictureFormat::Pbm:
      return AV_CODEC_ID_PBM;
    case PictureFormat::Pgm:
      return AV_CODEC_ID_PGM;
    case PictureFormat::Ppm:
      return AV_CODEC_ID_PPM;
  }
  return AV_CODEC_ID_NONE;
}

// Null: it can't be decoded whole.
LibavPtr<AVFrame> decode(std::span<const std::uint8_t> bytes) {
  const std::optional<PictureFormat> format = picture_format(bytes);
  const AVCodec* const codec = format ? avcodec_find_decoder(codec_of(*format)) : nullptr;
  if (codec == nullptr) return nullptr;
  av_log_set_level(AV_LOG_QUIET);
  LibavPtr<AVCodecContext> decoder(avcodec_alloc_context3(codec));
  decoder->thread_count = 1;
  decoder->max_pixels = kMostPixels;
  // Of TIFF, it would refuse every tag that it does not know.
  if (*format != PictureFormat::Tiff) decoder->err_recognition = AV_EF_CRCCHECK | AV_EF_EXPLODE;
  if (avcodec_open2(decoder.get(), codec, nullptr) < 0) return nullptr;
  // With room behind the data, which decoders read beyond.
  LibavPtr<AVPacket> packet(av_packet_alloc());
  if (av_new_packet(packet.get(), static_cast<int>(bytes.size())) < 0) return nullptr;
  std::copy(bytes.begin(), bytes.end(), packet->data);
  if (avcodec_send_packet(decoder.get(), packet.get()) < 0) return nullptr;
  (void)avcodec_send_packet(decoder.get(), nullptr);  // there is no other one to wait for
  LibavPtr<AVFrame> picture(av_frame_alloc());
  if (avcodec_receive_frame(decoder.get(), picture.get()) < 0 || !is_whole(*picture)) return nullptr;
  return picture;
}

// One byte a pixel out of a plane whose samples are `step` bytes apart.
std::vector<std::uint8_t> samples_of(const AVFrame& picture, const AVComponentDescriptor& component) {
  std::vector<std::uint8_t> samples;
  samples.reserve(static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height));
  for (int y = 0; y < picture.height; ++y) {
    const std::uint8_t* const row = picture.data[component.plane] +
                                    static_cast<std::ptrdiff_t>(y) * picture.linesize[component.plane] +
                                    component.offset;
    for (int x = 0; x < picture.width; ++x) samples.push_back(row[x * component.step]);
  }
  return samples;
}

std::vector<std::uint8_t> three_times(const std::vector<std::uint8_t>& grey) {
  std::vector<std::uint8_t> bgr;
  bgr.reserve(3 * grey.size());
  for (const std::uint8_t value : grey) bgr.insert(bgr.end(), 3, value);
  return bgr;
}

}  // namespace

std::string decode_still(std::span<const std::uint8_t> bytes, camera::Frame& frame) {
  const LibavPtr<AVFrame> picture = decode(bytes);
  if (!picture) return kNoPicture;
  const auto format = static_cast<AVPixelFormat>(picture->format);
  const AVPixFmtDescriptor* const described = av_pix_fmt_desc_get(format);
  if (described == nullptr) return kNoPicture;
  const AVComponentDescriptor& first = described->comp[0];
  if (first.depth > 8) return "has " + std::to_string(first.depth) + " bits a channel; 8 are needed";

  frame.width = picture->width;
  frame.height = picture->height;
  frame.luma.clear();
  constexpr std::uint64_t kOther = AV_PIX_FMT_FLAG_RGB | AV_PIX_FMT_FLAG_PAL | AV_PIX_FMT_FLAG_BITSTREAM;
  const bool has_luma = (described->flags & kOther) == 0;
  if (has_luma && described->nb_components <= 2) {  // grey, perhaps with transparency
    frame.bgr = three_times(samples_of(*picture, first));
    return "";
  }
  BgrConverter converter;
  const bool is_jpeg = has_luma && picture_format(bytes) == PictureFormat::Jpeg;
  if (is_jpeg) converter.expect_full_range();
  if (!converter.convert(*picture, frame.bgr)) return kNoPicture;
  if (is_jpeg) frame.luma = samples_of(*picture, first);
  return "";
}

std::string encode_png(const camera::Frame& frame) {
  const AVCodec* const codec = avcodec_find_encoder(AV_CODEC_ID_PNG);
  if (codec == nullptr) return "";
  av_log_set_level(AV_LOG_QUIET);
  LibavPtr<AVCodecContext> encoder(avcodec_alloc_context3(codec));
  encoder->width = frame.width;
  encoder->height = frame.height;
  encoder->pix_fmt = AV_PIX_FMT_RGB24;
  encoder->time_base = {1, 1};
  encoder->thread_count = 1;
  if (avcodec_open2(encoder.get(), codec, nullptr) < 0) return "";
  LibavPtr<AVFrame> picture(av_frame_alloc());
  picture->width = frame.width;
  picture->height = frame.height;
  picture->format = AV_PIX_FMT_RGB24;
  if (av_frame_get_buffer(picture.get(), 0) < 0) return "";
  const std::uint8_t* from = frame.bgr.data();
  for (int y = 0; y < frame.height; ++y) {
    std::uint8_t* to = picture->data[0] + static_cast<std::ptrdiff_t>(y) * picture->linesize[0];
    for (int x = 0; x < frame.width; ++x, from += 3, to += 3) std::reverse_copy(from, from + 3, to);
  }
  LibavPtr<AVPacket> packet(av_packet_alloc());
  if (avcodec_send_frame(encoder.get(), picture.get()) < 0) return "";
  (void)avcodec_send_frame(encoder.get(), nullptr);
  if (avcodec_receive_packet(encoder.get(), packet.get()) < 0) return "";
  return {reinterpret_cast<const char*>(packet->data), static_cast<std::size_t>(packet->size)};
}

}  // namespace arthronaut::sources
