#include "navigation/recording/video_encoder.h"

#include <cmath>

#include "planning/geometry/error.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/log.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

namespace arthronaut::recording {

namespace {

struct FreeLibav {
  void operator()(AVFormatContext* p) const {
    avio_closep(&p->pb);
    avformat_free_context(p);
  }
  void operator()(AVCodecContext* p) const { avcodec_free_context(&p); }
  void operator()(AVPacket* p) const { av_packet_free(&p); }
  void operator()(AVFrame* p) const { av_frame_free(&p); }
  void operator()(SwsContext* p) const { sws_freeContext(p); }
};
template <class T>
using LibavPtr = std::unique_ptr<T, FreeLibav>;

// A key frame every half second: review jumps to any moment, and a cluster, the unit that reaches the disk,
// is no longer.
constexpr int kFramesPerKeyFrame = 30;
constexpr const char* kClusterMs = "250";
constexpr const char* kQuality = "10";

}  // namespace

struct VideoEncoder::State {
  State(const std::filesystem::path& to, int width, int height, double frames_per_second)
      : file(to), packet(av_packet_alloc()), picture(av_frame_alloc()) {
    av_log_set_level(AV_LOG_QUIET);  // what goes wrong is told by exception
    AVFormatContext* created = nullptr;
    check(avformat_alloc_output_context2(&created, nullptr, "matroska", file.c_str()),
          "cannot start the video");
    container.reset(created);
    open_encoder(width, height, frames_per_second);
    open_file();
    open_picture(width, height);
  }

  void check(int result, const std::string& what) const {
    if (result >= 0) return;
    char text[AV_ERROR_MAX_STRING_SIZE] = {};
    av_strerror(result, text, sizeof text);
    throw IoError(file, what + ": " + text);
  }

  void open_encoder(int width, int height, double frames_per_second) {
    const AVCodec* codec = avcodec_find_encoder_by_name("libx264");
    if (!codec) throw IoError(file, "cannot write the video: this libavcodec has no H.264 encoder");
    encoder.reset(avcodec_alloc_context3(codec));
    encoder->width = width;
    encoder->height = height;
    encoder->pix_fmt = AV_PIX_FMT_YUV420P;
    encoder->color_range = AVCOL_RANGE_MPEG;
    encoder->colorspace = AVCOL_SPC_SMPTE170M;  // BT.601, the matrix of camera::gray_from
    encoder->framerate = {static_cast<int>(std::lround(1000 * frames_per_second)), 1000};
    encoder->time_base = av_inv_q(encoder->framerate);
    encoder->gop_size = kFramesPerKeyFrame;
    encoder->thread_count = 1;  // the other core tracks
    encoder->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    av_opt_set(encoder->priv_data, "preset", "ultrafast", 0);
    av_opt_set(encoder->priv_data, "tune", "zerolatency", 0);
    av_opt_set(encoder->priv_data, "crf", kQuality, 0);
    check(avcodec_open2(encoder.get(), codec, nullptr), "cannot start the video encoder");
  }

  void open_file() {
    stream = avformat_new_stream(container.get(), nullptr);
    if (!stream) throw IoError(file, "cannot start the video");
    avcodec_parameters_from_context(stream->codecpar, encoder.get());
    stream->time_base = encoder->time_base;
    stream->avg_frame_rate = encoder->framerate;
    check(avio_open(&container->pb, file.c_str(), AVIO_FLAG_WRITE), "cannot create");
    container->flags |= AVFMT_FLAG_FLUSH_PACKETS;
    AVDictionary* settings = nullptr;
    av_dict_set(&settings, "cluster_time_limit", kClusterMs, 0);
    const int result = avformat_write_header(container.get(), &settings);
    av_dict_free(&settings);
    check(result, "cannot write");
  }

  void open_picture(int width, int height) {
    picture->format = AV_PIX_FMT_YUV420P;
    picture->width = width;
    picture->height = height;
    check(av_frame_get_buffer(picture.get(), 0), "cannot start the video");
    converter.reset(sws_getContext(width, height, AV_PIX_FMT_BGR24, width, height, AV_PIX_FMT_YUV420P,
                                   SWS_BILINEAR | SWS_ACCURATE_RND, nullptr, nullptr, nullptr));
    if (!converter) throw IoError(file, "cannot convert pictures for the video");
  }

  // Null: no more pictures.
  void send(const AVFrame* frame) {
    check(avcodec_send_frame(encoder.get(), frame), "cannot encode");
    while (true) {
      const int received = avcodec_receive_packet(encoder.get(), packet.get());
      if (received == AVERROR(EAGAIN) || received == AVERROR_EOF) return;
      check(received, "cannot encode");
      av_packet_rescale_ts(packet.get(), encoder->time_base, stream->time_base);
      packet->stream_index = stream->index;
      packet->duration = av_rescale_q(1, encoder->time_base, stream->time_base);
      check(av_interleaved_write_frame(container.get(), packet.get()), "cannot write");
    }
  }

  std::filesystem::path file;
  LibavPtr<AVFormatContext> container;
  LibavPtr<AVCodecContext> encoder;
  LibavPtr<SwsContext> converter;
  LibavPtr<AVPacket> packet;
  LibavPtr<AVFrame> picture;
  AVStream* stream = nullptr;
  std::int64_t count = 0;
};

VideoEncoder::VideoEncoder(const std::filesystem::path& file, int width, int height, double frames_per_second)
    : state_(std::make_unique<State>(file, width, height, frames_per_second)) {}

VideoEncoder::~VideoEncoder() = default;

void VideoEncoder::encode(const camera::Frame& picture) {
  State& s = *state_;
  if (picture.width != s.picture->width || picture.height != s.picture->height) {
    throw InvalidInput(s.file, "frame " + std::to_string(picture.index),
                       "is of another size than those before it");
  }
  s.check(av_frame_make_writable(s.picture.get()), "cannot encode");
  const std::uint8_t* const rows[1] = {picture.bgr.data()};
  const int strides[1] = {3 * picture.width};
  sws_scale(s.converter.get(), rows, strides, 0, picture.height, s.picture->data, s.picture->linesize);
  s.picture->pts = s.count++;
  s.send(s.picture.get());
}

void VideoEncoder::finish() {
  state_->send(nullptr);
  state_->check(av_write_trailer(state_->container.get()), "cannot write");
  state_->check(avio_closep(&state_->container->pb), "cannot write");
}

}  // namespace arthronaut::recording
