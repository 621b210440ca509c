#include "navigation/sources/libav.h"

#include "navigation/sources/luma_planes.h"

extern "C" {
#include <libavutil/pixdesc.h>
}

namespace arthronaut::sources {

namespace {

// What libswscale takes for full range by its format alone; the colours are then made alike.
bool is_full_range(AVPixelFormat format) {
  switch (format) {
    case AV_PIX_FMT_YUVJ420P:
    case AV_PIX_FMT_YUVJ422P:
    case AV_PIX_FMT_YUVJ444P:
    case AV_PIX_FMT_YUVJ440P:
    case AV_PIX_FMT_YUVJ411P:
    case AV_PIX_FMT_GRAY8:
      return true;
    default:
      return false;
  }
}

// Where the luma of a picture lies; no data where it has none of its own (RGB, palettes).
LumaPlane luma_plane(const AVFrame& picture) {
  const auto format = static_cast<AVPixelFormat>(picture.format);
  const AVPixFmtDescriptor* const described = av_pix_fmt_desc_get(format);
  constexpr std::uint64_t kOther = AV_PIX_FMT_FLAG_RGB | AV_PIX_FMT_FLAG_PAL | AV_PIX_FMT_FLAG_BITSTREAM |
                                   AV_PIX_FMT_FLAG_HWACCEL | AV_PIX_FMT_FLAG_FLOAT | AV_PIX_FMT_FLAG_BE;
  if (described == nullptr || (described->flags & kOther) != 0 || described->nb_components == 0) return {};
  const AVComponentDescriptor& luma = described->comp[0];
  LumaPlane plane;
  plane.data = picture.data[luma.plane] + luma.offset;
  plane.stride = picture.linesize[luma.plane];
  plane.step = luma.step;
  plane.bits = luma.depth;
  plane.shift = luma.shift;
  plane.is_full_range = is_full_range(format);
  plane.width = picture.width;
  plane.height = picture.height;
  return plane;
}

}  // namespace

std::string libav_message(int error) {
  if (error == AVERROR_PROTOCOL_NOT_FOUND)
    return "no address of a kind that can be opened: rtsp://, rtsps://, udp://, srt://, tcp:// and gst: can";
  // The library's own words for these are of its insides.
  switch (error) {
    case AVERROR_INVALIDDATA:
      return "its data are of no known format";
    case AVERROR_HTTP_NOT_FOUND:
      return "the server has no stream of that name";
    case AVERROR_HTTP_UNAUTHORIZED:
      return "the server asks for a name and a password: rtsp://NAME:PASSWORD@HOST/PATH";
    case AVERROR_HTTP_FORBIDDEN:
      return "the server does not allow it";
    case AVERROR_HTTP_SERVER_ERROR:
      return "the server is there, but cannot give this stream";
    default:
      break;
  }
  char text[AV_ERROR_MAX_STRING_SIZE] = {};
  av_strerror(error, text, sizeof text);
  return text;
}

std::string why_no_address(const std::string& address) {
  // RTSP is a container to libavformat, and stands on no list of its protocols.
  const bool is_rtsp = address.starts_with("rtsp://") || address.starts_with("rtsps://");
  return is_rtsp || avio_find_protocol_name(address.c_str()) != nullptr
             ? ""
             : libav_message(AVERROR_PROTOCOL_NOT_FOUND);
}

double frames_per_second_of(const AVStream& stream) {
  const AVRational rate = stream.avg_frame_rate.num > 0 ? stream.avg_frame_rate : stream.r_frame_rate;
  return rate.num > 0 && rate.den > 0 ? av_q2d(rate) : 0;
}

LibavPtr<AVCodecContext> open_stream_decoder(const AVCodecParameters& parameters, AVRational time_base,
                                             std::string& problem, DecoderUse use) {
  const AVCodec* const codec = avcodec_find_decoder(parameters.codec_id);
  if (codec == nullptr) {
    problem = "no decoder for its video";
    return nullptr;
  }
  LibavPtr<AVCodecContext> decoder(avcodec_alloc_context3(codec));
  avcodec_parameters_to_context(decoder.get(), &parameters);
  // Threads by frames would hold back as many pictures as there are threads.
  decoder->thread_count = use == DecoderUse::Live ? 2 : 0;
  decoder->thread_type = use == DecoderUse::Live ? FF_THREAD_SLICE : FF_THREAD_FRAME | FF_THREAD_SLICE;
  if (use == DecoderUse::Live) decoder->flags |= AV_CODEC_FLAG_LOW_DELAY;
  decoder->max_pixels = kMostPixels;
  decoder->pkt_timebase = time_base;
  if (const int error = avcodec_open2(decoder.get(), codec, nullptr); error < 0) {
    problem = "its video can't be decoded: " + libav_message(error);
    return nullptr;
  }
  return decoder;
}

bool is_whole(const AVFrame& picture) {
  return picture.decode_error_flags == 0 && (picture.flags & AV_FRAME_FLAG_CORRUPT) == 0;
}

bool BgrConverter::convert(const AVFrame& picture, std::vector<std::uint8_t>& bgr) {
  converter_.reset(sws_getCachedContext(
      converter_.release(), picture.width, picture.height, static_cast<AVPixelFormat>(picture.format),
      picture.width, picture.height, AV_PIX_FMT_BGR24, SWS_BICUBIC, nullptr, nullptr, nullptr));
  if (!converter_) return false;
  if (is_full_range_) {
    const int* const bt601 = sws_getCoefficients(SWS_CS_ITU601);
    constexpr int kFullRange = 1, kUnity = 1 << 16;
    sws_setColorspaceDetails(converter_.get(), bt601, kFullRange, bt601, kFullRange, 0, kUnity, kUnity);
  }
  bgr.resize(static_cast<std::size_t>(3) * static_cast<std::size_t>(picture.width) *
             static_cast<std::size_t>(picture.height));
  std::uint8_t* const planes[] = {bgr.data()};
  const int strides[] = {3 * picture.width};
  sws_scale(converter_.get(), picture.data, picture.linesize, 0, picture.height, planes, strides);
  return true;
}

class DecodedFrames::Memory final : public camera::PictureMemory {
 public:
  void hold(const AVFrame& picture) {
    av_frame_unref(picture_.get());
    if (av_frame_ref(picture_.get(), &picture) < 0) throw std::bad_alloc();
  }
  void let_go() { av_frame_unref(picture_.get()); }

  [[nodiscard]] camera::GrayView luma() const override { return luma_plane(*picture_).in_place(); }
  void bgr_into(std::vector<std::uint8_t>& bgr) const override {
    // A converter keeps tables that cost as much as a picture; whoever shows does so on one thread.
    thread_local BgrConverter converter;
    (void)converter.convert(*picture_, bgr);
  }

 private:
  LibavPtr<AVFrame> picture_{av_frame_alloc()};
};

DecodedFrames::DecodedFrames()
    : memories_([](Memory& memory) { memory.let_go(); }),
      frames_([](camera::Frame& frame) { frame.memory.reset(); }) {}

std::shared_ptr<camera::Frame> DecodedFrames::make(const AVFrame& picture) {
  if (picture.format != known_format_) {
    BgrConverter converter;
    if (!converter.convert(picture, bgr_)) return nullptr;
    known_format_ = picture.format;
    bgr_ = {};
  }
  auto frame = frames_.take();
  frame->width = picture.width;
  frame->height = picture.height;
  auto memory = memories_.take();
  memory->hold(picture);
  put_picture(*frame, std::move(memory), luma_plane(picture));
  return frame;
}

}  // namespace arthronaut::sources
