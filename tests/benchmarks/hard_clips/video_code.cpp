#include "tests/benchmarks/hard_clips/video_code.h"

#include <cmath>
#include <cstring>
#include <opencv2/imgproc.hpp>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavutil/opt.h>
}

#include "planning/geometry/error.h"

namespace arthronaut::hard_clips {

struct VideoCode::State {
  AVCodecContext* encoder = nullptr;
  AVCodecContext* decoder = nullptr;
  AVFrame* in = av_frame_alloc();
  AVFrame* out = av_frame_alloc();
  AVPacket* packet = av_packet_alloc();
  std::int64_t next = 0;

  ~State() {
    avcodec_free_context(&encoder);
    avcodec_free_context(&decoder);
    av_frame_free(&in);
    av_frame_free(&out);
    av_packet_free(&packet);
  }
  static void check(int result, const char* what) {
    if (result < 0) throw InvalidInput(std::string("H.264: ") + what);
  }
};

VideoCode::VideoCode(int width, int height, double frames_per_second, double bit_rate)
    : state_(std::make_unique<State>()) {
  av_log_set_level(AV_LOG_QUIET);
  const AVCodec* encoder = avcodec_find_encoder_by_name("libx264");
  const AVCodec* decoder = avcodec_find_decoder(AV_CODEC_ID_H264);
  if (!encoder || !decoder) throw InvalidInput("H.264: this libavcodec has no libx264");
  state_->encoder = avcodec_alloc_context3(encoder);
  state_->encoder->width = width;
  state_->encoder->height = height;
  state_->encoder->pix_fmt = AV_PIX_FMT_YUV420P;
  state_->encoder->time_base = {1000, static_cast<int>(std::lround(1000 * frames_per_second))};
  state_->encoder->framerate = av_inv_q(state_->encoder->time_base);
  state_->encoder->bit_rate = static_cast<std::int64_t>(bit_rate);
  state_->encoder->thread_count = 1;
  av_opt_set(state_->encoder->priv_data, "preset", "veryfast", 0);
  av_opt_set(state_->encoder->priv_data, "tune", "zerolatency", 0);  // a frame out for each frame in
  State::check(avcodec_open2(state_->encoder, encoder, nullptr), "cannot start the encoder");
  state_->decoder = avcodec_alloc_context3(decoder);
  state_->decoder->thread_count = 1;
  state_->decoder->flags |= AV_CODEC_FLAG_LOW_DELAY;
  State::check(avcodec_open2(state_->decoder, decoder, nullptr), "cannot start the decoder");
  state_->in->format = AV_PIX_FMT_YUV420P;
  state_->in->width = width;
  state_->in->height = height;
  State::check(av_frame_get_buffer(state_->in, 0), "no memory");
}

VideoCode::~VideoCode() = default;

void VideoCode::code(cv::Mat& bgr) {
  cv::Mat planes;
  cv::cvtColor(bgr, planes, cv::COLOR_BGR2YUV_I420);
  State::check(av_frame_make_writable(state_->in), "no memory");
  const int width = bgr.cols, height = bgr.rows;
  const std::uint8_t* from = planes.data;
  for (int plane = 0; plane < 3; ++plane) {
    const int across = plane == 0 ? width : width / 2, down = plane == 0 ? height : height / 2;
    for (int y = 0; y < down; ++y, from += across)
      std::memcpy(state_->in->data[plane] + y * state_->in->linesize[plane], from, across);
  }
  state_->in->pts = state_->next++;
  State::check(avcodec_send_frame(state_->encoder, state_->in), "cannot encode");
  State::check(avcodec_receive_packet(state_->encoder, state_->packet), "no packet for a frame");
  State::check(avcodec_send_packet(state_->decoder, state_->packet), "cannot decode");
  av_packet_unref(state_->packet);
  State::check(avcodec_receive_frame(state_->decoder, state_->out), "no frame for a packet");
  std::uint8_t* to = planes.data;
  for (int plane = 0; plane < 3; ++plane) {
    const int across = plane == 0 ? width : width / 2, down = plane == 0 ? height : height / 2;
    for (int y = 0; y < down; ++y, to += across)
      std::memcpy(to, state_->out->data[plane] + y * state_->out->linesize[plane], across);
  }
  av_frame_unref(state_->out);
  cv::cvtColor(planes, bgr, cv::COLOR_YUV2BGR_I420);
}

}  // namespace arthronaut::hard_clips
