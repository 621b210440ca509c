#include "navigation/recording/video_encoder.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "planning/files/private_folder.h"
#include "planning/geometry/error.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/log.h>
#include <libavutil/opt.h>
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
};
template <class T>
using LibavPtr = std::unique_ptr<T, FreeLibav>;

// A cluster, the unit that reaches the disk, is no longer than this.
constexpr const char* kClusterMs = "250";

// Colour differences of full-range BT.601 in 16-bit fixed point: (B - Y) / 1.772 and (R - Y) / 1.402.
constexpr int kBlue = 36984, kRed = 46745;

// In steps of four: the last two bits of a colour difference are noise, which would be most of the file.
std::uint8_t coarse(int difference_of_four_pixels, int factor) {
  const int value = 128 + ((difference_of_four_pixels * factor + (1 << 17)) >> 18);
  return static_cast<std::uint8_t>(std::clamp((value + 2) & ~3, 0, 252));
}

// Half the resolution needs even sizes.
AVPixelFormat format_of(int width, int height) {
  return (width | height) % 2 == 0 ? AV_PIX_FMT_YUV420P : AV_PIX_FMT_YUV444P;
}

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
    const AVCodec* codec = avcodec_find_encoder(AV_CODEC_ID_UTVIDEO);
    if (!codec) throw IoError(file, "cannot write the video: this libavcodec has no Ut Video encoder");
    encoder.reset(avcodec_alloc_context3(codec));
    encoder->width = width;
    encoder->height = height;
    encoder->pix_fmt = format_of(width, height);
    encoder->color_range = AVCOL_RANGE_JPEG;    // luma is grey as it is tracked, 0 to 255
    encoder->colorspace = AVCOL_SPC_SMPTE170M;  // BT.601, the matrix of camera::gray_from
    encoder->framerate = {static_cast<int>(std::lround(1000 * frames_per_second)), 1000};
    encoder->time_base = av_inv_q(encoder->framerate);
    encoder->thread_count = 1;  // the other core tracks
    encoder->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    av_opt_set(encoder->priv_data, "pred", "left", 0);
    check(avcodec_open2(encoder.get(), codec, nullptr), "cannot start the video encoder");
  }

  void open_file() {
    stream = avformat_new_stream(container.get(), nullptr);
    if (!stream) throw IoError(file, "cannot start the video");
    avcodec_parameters_from_context(stream->codecpar, encoder.get());
    stream->time_base = encoder->time_base;
    stream->avg_frame_rate = encoder->framerate;
    files::begin_private_file(file);
    check(avio_open(&container->pb, file.c_str(), AVIO_FLAG_WRITE), "cannot create");
    container->flags |= AVFMT_FLAG_FLUSH_PACKETS;
    AVDictionary* settings = nullptr;
    av_dict_set(&settings, "cluster_time_limit", kClusterMs, 0);
    const int result = avformat_write_header(container.get(), &settings);
    av_dict_free(&settings);
    check(result, "cannot write");
  }

  void open_picture(int width, int height) {
    picture->format = format_of(width, height);
    picture->width = width;
    picture->height = height;
    picture->color_range = AVCOL_RANGE_JPEG;
    check(av_frame_get_buffer(picture.get(), 0), "cannot start the video");
  }

  void fill_luma(const camera::Frame& frame) {
    camera::gray_from(frame, gray);
    for (int y = 0; y < frame.height; ++y) {
      const std::uint8_t* const row = gray.data() + static_cast<std::ptrdiff_t>(y) * frame.width;
      std::copy(row, row + frame.width, plane_row(0, y));
    }
  }

  // Means of two by two pixels, or each pixel where the size is odd.
  void fill_colour(const camera::Frame& frame) {
    const std::vector<std::uint8_t>& bgr = camera::bgr_of(frame, colours);
    const std::ptrdiff_t width = frame.width;
    const int step = picture->format == AV_PIX_FMT_YUV420P ? 2 : 1;
    const std::ptrdiff_t right = step - 1, below = (step - 1) * width;
    for (int y = 0; y < frame.height; y += step) {
      std::uint8_t* const blue_row = plane_row(1, y / step);
      std::uint8_t* const red_row = plane_row(2, y / step);
      for (int x = 0; x < frame.width; x += step) {
        const std::ptrdiff_t at = y * width + x;
        int blue = 0, red = 0;
        for (const std::ptrdiff_t pixel : {at, at + right, at + below, at + below + right}) {
          const int luma = gray[static_cast<std::size_t>(pixel)];
          blue += bgr[static_cast<std::size_t>(3 * pixel)] - luma;
          red += bgr[static_cast<std::size_t>(3 * pixel + 2)] - luma;
        }
        blue_row[x / step] = coarse(blue, kBlue);
        red_row[x / step] = coarse(red, kRed);
      }
    }
  }

  [[nodiscard]] std::uint8_t* plane_row(int plane, int y) {
    return picture->data[plane] + static_cast<std::ptrdiff_t>(y) * picture->linesize[plane];
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
  LibavPtr<AVPacket> packet;
  LibavPtr<AVFrame> picture;
  std::vector<std::uint8_t> gray, colours;
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
  s.fill_luma(picture);
  s.fill_colour(picture);
  s.picture->pts = s.count++;
  s.send(s.picture.get());
}

void VideoEncoder::finish() {
  state_->send(nullptr);
  state_->check(av_write_trailer(state_->container.get()), "cannot write");
  state_->check(avio_closep(&state_->container->pb), "cannot write");
}

}  // namespace arthronaut::recording
