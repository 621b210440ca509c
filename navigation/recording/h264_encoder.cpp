#include "navigation/recording/h264_encoder.h"

#include <algorithm>
#include <string>

#include "planning/geometry/error.h"

extern "C" {
#include <libavutil/hwcontext.h>
#include <libavutil/opt.h>
}

namespace arthronaut::recording {

namespace {

using sources::LibavPtr;

// Any picture is at most so many decodings away.
constexpr double kKeyFrameEvery_s = 0.5;

LibavPtr<AVCodecContext> described(const AVCodec& codec, int width, int height, AVRational rate) {
  LibavPtr<AVCodecContext> encoder(avcodec_alloc_context3(&codec));
  encoder->width = width;
  encoder->height = height;
  encoder->pix_fmt = (width | height) % 2 == 0 ? AV_PIX_FMT_YUV420P : AV_PIX_FMT_YUV444P;
  encoder->color_range = AVCOL_RANGE_JPEG;    // luma is grey as it is tracked, 0 to 255
  encoder->colorspace = AVCOL_SPC_SMPTE170M;  // BT.601, the matrix of camera::gray_from
  encoder->framerate = rate;
  encoder->time_base = av_inv_q(rate);
  encoder->gop_size = std::max(1, static_cast<int>(kKeyFrameEvery_s * av_q2d(rate)));
  encoder->max_b_frames = 0;
  encoder->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  return encoder;
}

// Null where there is no such device, or it does not encode such pictures.
H264Encoder by_graphics_processor(int width, int height, AVRational rate, H264For purpose) {
  const AVCodec* const codec = avcodec_find_encoder_by_name("h264_vaapi");
  AVBufferRef* device = nullptr;
  if (codec == nullptr || (width | height) % 2 != 0 ||
      av_hwdevice_ctx_create(&device, AV_HWDEVICE_TYPE_VAAPI, nullptr, nullptr, 0) < 0)
    return {};
  const std::unique_ptr<AVBufferRef, FreeBuffer> owned(device);
  H264Encoder h264;
  h264.frames.reset(av_hwframe_ctx_alloc(device));
  if (h264.frames == nullptr) return {};
  auto& frames = *reinterpret_cast<AVHWFramesContext*>(h264.frames->data);
  frames.format = AV_PIX_FMT_VAAPI;
  frames.sw_format = AV_PIX_FMT_NV12;
  frames.width = width;
  frames.height = height;
  frames.initial_pool_size = 8;
  if (av_hwframe_ctx_init(h264.frames.get()) < 0) return {};
  h264.encoder = described(*codec, width, height, rate);
  h264.encoder->pix_fmt = AV_PIX_FMT_VAAPI;
  h264.encoder->hw_frames_ctx = av_buffer_ref(h264.frames.get());
  constexpr int kCoarser = 8;  // on this encoder's scale
  h264.encoder->global_quality = static_cast<int>(purpose) + kCoarser;
  if (avcodec_open2(h264.encoder.get(), codec, nullptr) < 0) return {};
  h264.reordered.reset(av_frame_alloc());
  h264.reordered->format = AV_PIX_FMT_NV12;
  h264.reordered->width = width;
  h264.reordered->height = height;
  h264.on_device.reset(av_frame_alloc());
  if (av_frame_get_buffer(h264.reordered.get(), 0) < 0) return {};
  return h264;
}

void copy_rows(const std::uint8_t* from, int from_stride, std::uint8_t* to, int to_stride, int width,
               int rows) {
  for (int y = 0; y < rows; ++y) std::copy_n(from + y * from_stride, width, to + y * to_stride);
}

}  // namespace

H264Encoder open_h264(const std::filesystem::path& file, int width, int height, AVRational rate,
                      H264For purpose) {
  if (H264Encoder found = by_graphics_processor(width, height, rate, purpose); found.encoder != nullptr)
    return found;
  const AVCodec* const codec = avcodec_find_encoder_by_name("libx264");
  if (codec == nullptr) throw IoError(file, "cannot write the video: this libavcodec has no H.264 encoder");
  H264Encoder h264{described(*codec, width, height, rate)};
  h264.encoder->thread_count = 1;  // the other core tracks
  // The quickest there is.
  av_opt_set(h264.encoder->priv_data, "preset", "ultrafast", 0);
  av_opt_set(h264.encoder->priv_data, "tune", "zerolatency", 0);
  av_opt_set(h264.encoder->priv_data, "crf", std::to_string(static_cast<int>(purpose)).c_str(), 0);
  if (avcodec_open2(h264.encoder.get(), codec, nullptr) < 0)
    throw IoError(file, "cannot start the H.264 encoder");
  return h264;
}

const AVFrame* uploaded(H264Encoder& h264, const AVFrame& picture, const std::filesystem::path& file) {
  AVFrame& reordered = *h264.reordered;
  if (av_frame_make_writable(&reordered) < 0) throw IoError(file, "cannot encode: out of memory");
  copy_rows(picture.data[0], picture.linesize[0], reordered.data[0], reordered.linesize[0], picture.width,
            picture.height);
  for (int y = 0; y < picture.height / 2; ++y)
    for (int x = 0; x < picture.width / 2; ++x)
      for (int plane = 1; plane <= 2; ++plane)
        reordered.data[1][y * reordered.linesize[1] + 2 * x + plane - 1] =
            picture.data[plane][y * picture.linesize[plane] + x];
  av_frame_unref(h264.on_device.get());
  if (av_hwframe_get_buffer(h264.frames.get(), h264.on_device.get(), 0) < 0 ||
      av_hwframe_transfer_data(h264.on_device.get(), &reordered, 0) < 0)
    throw IoError(file, "cannot encode: the graphics processor does not take the picture");
  h264.on_device->pts = picture.pts;
  return h264.on_device.get();
}

}  // namespace arthronaut::recording
