#include "app/screen_copy/screen_encoder.h"

#include <cmath>
#include <filesystem>

#include "navigation/sources/libav.h"
#include "planning/files/private_folder.h"
#include "planning/geometry/error.h"

extern "C" {
#include <libavutil/log.h>
#include <libavutil/opt.h>
}

namespace arthronaut::screen_copy {

namespace {

using sources::LibavPtr;

constexpr AVRational kMilliseconds{1, 1000};
// Whoever tunes in sees a whole picture within two seconds at 15 a second.
constexpr int kPicturesBetweenKeys = 30;

int even(int size) { return size & ~1; }

}  // namespace

bool is_stream(const std::string& target) { return target.starts_with("udp://"); }

struct ScreenEncoder::State {
  State(const std::string& to, int width, int height)
      : target(to),
        written(is_stream(to) ? to + (to.find('?') == std::string::npos ? "?pkt_size=1316" : "")
                              : to + ".part"),
        packet(av_packet_alloc()),
        frame(av_frame_alloc()) {
    av_log_set_level(AV_LOG_QUIET);  // what goes wrong is told by exception
    AVFormatContext* created = nullptr;
    check(avformat_alloc_output_context2(&created, nullptr, is_stream(to) ? "mpegts" : "matroska",
                                         written.c_str()),
          "cannot be begun");
    container.reset(created);
    open_encoder(even(width), even(height));
    open_output();
    frame->format = AV_PIX_FMT_YUV420P;
    frame->width = encoder->width;
    frame->height = encoder->height;
    check(av_frame_get_buffer(frame.get(), 0), "cannot be begun");
  }

  void check(int result, const std::string& what) const {
    if (result < 0) throw IoError(target, what + ": " + sources::libav_message(result));
  }

  void open_encoder(int width, int height) {
    const AVCodec* codec = avcodec_find_encoder_by_name("libx264");
    if (codec == nullptr) codec = avcodec_find_encoder(AV_CODEC_ID_H264);
    if (codec == nullptr) throw IoError(target, "this libavcodec has no H.264 encoder");
    encoder.reset(avcodec_alloc_context3(codec));
    encoder->width = width;
    encoder->height = height;
    encoder->pix_fmt = AV_PIX_FMT_YUV420P;
    encoder->time_base = kMilliseconds;
    encoder->gop_size = kPicturesBetweenKeys;
    encoder->max_b_frames = 0;
    encoder->thread_count = 1;  // the other cores guide
    if ((container->oformat->flags & AVFMT_GLOBALHEADER) != 0) encoder->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    // Others than x264 know none of these.
    av_opt_set(encoder->priv_data, "preset", "ultrafast", 0);
    av_opt_set(encoder->priv_data, "tune", "zerolatency", 0);
    av_opt_set(encoder->priv_data, "crf", "23", 0);
    check(avcodec_open2(encoder.get(), codec, nullptr), "the encoder cannot be begun");
  }

  void open_output() {
    stream = avformat_new_stream(container.get(), nullptr);
    if (stream == nullptr) throw IoError(target, "cannot be begun");
    avcodec_parameters_from_context(stream->codecpar, encoder.get());
    stream->time_base = kMilliseconds;
    if (!is_stream(target)) files::begin_private_file(written);
    check(avio_open(&container->pb, written.c_str(), AVIO_FLAG_WRITE), "cannot be created");
    container->flags |= AVFMT_FLAG_FLUSH_PACKETS;
    AVDictionary* settings = nullptr;
    av_dict_set(&settings, "cluster_time_limit", "1000", 0);
    const int result = avformat_write_header(container.get(), &settings);
    av_dict_free(&settings);
    check(result, "cannot be written");
  }

  void convert(const widgets::ScreenPicture& picture) {
    check(av_frame_make_writable(frame.get()), "cannot be written");
    scaler.reset(sws_getCachedContext(scaler.release(), picture.width, picture.height, AV_PIX_FMT_BGRA,
                                      encoder->width, encoder->height, AV_PIX_FMT_YUV420P, SWS_FAST_BILINEAR,
                                      nullptr, nullptr, nullptr));
    if (!scaler) throw IoError(target, "the picture cannot be converted");
    // From the top row down: the picture begins at its bottom.
    const int stride = 4 * picture.width;
    const std::uint8_t* const top =
        picture.bgra.data() + static_cast<std::ptrdiff_t>(stride) * (picture.height - 1);
    const std::uint8_t* const planes[] = {top};
    const int strides[] = {-stride};
    sws_scale(scaler.get(), planes, strides, 0, picture.height, frame->data, frame->linesize);
  }

  void send(const AVFrame* next) {
    check(avcodec_send_frame(encoder.get(), next), "cannot be encoded");
    while (avcodec_receive_packet(encoder.get(), packet.get()) == 0) {
      av_packet_rescale_ts(packet.get(), kMilliseconds, stream->time_base);
      packet->stream_index = 0;
      const int result = av_write_frame(container.get(), packet.get());
      av_packet_unref(packet.get());
      // Nobody who listens is no fault: UDP says so now and then.
      if (!is_stream(target)) check(result, "cannot be written");
    }
  }

  const std::string target, written;
  sources::LibavOutput container;
  LibavPtr<AVCodecContext> encoder;
  LibavPtr<AVPacket> packet;
  LibavPtr<AVFrame> frame;
  LibavPtr<SwsContext> scaler;
  AVStream* stream = nullptr;
  double begun_s = -1;
  std::int64_t last_ms = -1;
};

ScreenEncoder::ScreenEncoder(const std::string& target, int width, int height)
    : state_(std::make_unique<State>(target, width, height)) {}
ScreenEncoder::~ScreenEncoder() = default;

void ScreenEncoder::encode(const widgets::ScreenPicture& picture) {
  State& s = *state_;
  if (s.begun_s < 0) s.begun_s = picture.time_s;
  const auto at_ms = static_cast<std::int64_t>(std::llround(1000 * (picture.time_s - s.begun_s)));
  if (at_ms <= s.last_ms) return;
  s.last_ms = at_ms;
  s.convert(picture);
  s.frame->pts = at_ms;
  s.send(s.frame.get());
}

void ScreenEncoder::finish() {
  State& s = *state_;
  s.send(nullptr);
  const int result = av_write_trailer(s.container.get());
  if (is_stream(s.target)) return;
  s.check(result, "cannot be written");
  s.check(avio_closep(&s.container->pb), "cannot be written");
  std::error_code error;
  std::filesystem::rename(s.written, s.target, error);
  if (error) throw IoError(s.target, "cannot be created: " + error.message());
}

}  // namespace arthronaut::screen_copy
