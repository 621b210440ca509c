#include "navigation/recording/video_encoder.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "navigation/recording/h264_encoder.h"
#include "navigation/recording/matroska_writer.h"
#include "navigation/sources/libav.h"
#include "planning/geometry/error.h"

extern "C" {
#include <libavutil/opt.h>
}

namespace arthronaut::recording {

namespace {

using sources::LibavPtr;

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
  State(const std::filesystem::path& to, int width, int height, double frames_per_second, PicturesAs as,
        H264For h264_for)
      : file(to), writer(to), packet(av_packet_alloc()), picture(av_frame_alloc()) {
    const AVRational rate{static_cast<int>(std::lround(1000 * frames_per_second)), 1000};
    if (as == PicturesAs::H264) {
      h264 = open_h264(file, width, height, rate, h264_for);
      encoder = std::move(h264.encoder);
    } else {
      open_ut_video(width, height, rate);
    }
    avcodec_parameters_from_context(writer.stream().codecpar, encoder.get());
    writer.stream().time_base = encoder->time_base;
    writer.stream().avg_frame_rate = encoder->framerate;
    writer.begin();
    open_picture(width, height);
  }

  void check(int result, const std::string& what) const { writer.check(result, what); }

  void open_ut_video(int width, int height, AVRational rate) {
    const AVCodec* codec = avcodec_find_encoder(AV_CODEC_ID_UTVIDEO);
    if (!codec) throw IoError(file, "cannot write the video: this libavcodec has no Ut Video encoder");
    encoder.reset(avcodec_alloc_context3(codec));
    encoder->width = width;
    encoder->height = height;
    encoder->pix_fmt = format_of(width, height);
    encoder->color_range = AVCOL_RANGE_JPEG;    // luma is grey as it is tracked, 0 to 255
    encoder->colorspace = AVCOL_SPC_SMPTE170M;  // BT.601, the matrix of camera::gray_from
    encoder->framerate = rate;
    encoder->time_base = av_inv_q(rate);
    encoder->thread_count = 1;  // the other core tracks
    encoder->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    av_opt_set(encoder->priv_data, "pred", "left", 0);
    check(avcodec_open2(encoder.get(), codec, nullptr), "cannot start the video encoder");
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
      packet->duration = 1;
      writer.write(*packet, encoder->time_base);
    }
  }

  std::filesystem::path file;
  MatroskaWriter writer;
  H264Encoder h264;  // empty for Ut Video
  LibavPtr<AVCodecContext> encoder;
  LibavPtr<AVPacket> packet;
  LibavPtr<AVFrame> picture;
  std::vector<std::uint8_t> gray, colours;
  std::int64_t count = 0;
};

VideoEncoder::VideoEncoder(const std::filesystem::path& file, int width, int height, double frames_per_second,
                           PicturesAs as, H264For h264_for)
    : state_(std::make_unique<State>(file, width, height, frames_per_second, as, h264_for)) {}

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
  if (s.h264.frames == nullptr) return s.send(s.picture.get());
  s.send(uploaded(s.h264, *s.picture, s.file));
}

void VideoEncoder::finish() {
  state_->send(nullptr);
  state_->writer.finish();
}

std::string VideoEncoder::codec() const { return state_->encoder->codec->name; }

}  // namespace arthronaut::recording
