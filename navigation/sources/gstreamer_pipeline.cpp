#include "navigation/sources/gstreamer_pipeline.h"

#include <gst/app/gstappsink.h>
#include <gst/video/video.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "navigation/sources/capture_time.h"
#include "navigation/sources/device_identity.h"
#include "navigation/sources/gstreamer_owned.h"
#include "navigation/sources/luma_planes.h"
#include "navigation/sources/recovering_source.h"
#include "navigation/worker/recycler.h"
#include "planning/geometry/error.h"

namespace arthronaut::sources {

namespace {

constexpr GstClockTime kOpensWithin = 10 * GST_SECOND, kSilence = 2 * GST_SECOND;

// The formats whose way to BGR is OpenCV's, and of which all but BGR have a luma of their own.
constexpr const char* kCaps = "video/x-raw,format=(string){ I420, NV12, GRAY8, YUY2, UYVY, P010_10LE, BGR }";

// Whatever the pipeline gives is converted just before the sink, where it is no such format already.
std::string with_conversion(const std::string& pipeline) {
  const std::size_t sink = pipeline.rfind("appsink");
  if (sink == std::string::npos)
    throw InvalidInput(shown_address("gst:" + pipeline) +
                       ": must end in an appsink: gst:videotestsrc ! appsink");
  return pipeline.substr(0, sink) + "videoconvert ! " + pipeline.substr(sink);
}

// Empty: OpenCV has no way for it, as for colours at half the size in a picture of odd size.
cv::Mat to_bgr(const GstVideoFrame& mapped) {
  const int width = GST_VIDEO_FRAME_WIDTH(&mapped), height = GST_VIDEO_FRAME_HEIGHT(&mapped);
  const GstVideoFormat given = GST_VIDEO_FRAME_FORMAT(&mapped);
  const bool has_whole_colours = given == GST_VIDEO_FORMAT_BGR || given == GST_VIDEO_FORMAT_GRAY8;
  if (!has_whole_colours && (width % 2 != 0 || height % 2 != 0)) return {};
  const auto plane = [&](int i, int rows, int columns, int type) {
    return cv::Mat(rows, columns, type, GST_VIDEO_FRAME_PLANE_DATA(&mapped, i),
                   static_cast<std::size_t>(GST_VIDEO_FRAME_PLANE_STRIDE(&mapped, i)));
  };
  cv::Mat bgr;
  switch (given) {
    case GST_VIDEO_FORMAT_I420: {  // OpenCV wants the planes under one another, without gaps
      cv::Mat packed(height * 3 / 2, width, CV_8UC1);
      plane(0, height, width, CV_8UC1).copyTo(packed.rowRange(0, height));
      const int half = width / 2;
      for (int i = 1; i < 3; ++i) {
        cv::Mat to(height / 2, half, CV_8UC1,
                   packed.ptr(height) + static_cast<std::ptrdiff_t>(i - 1) * half * (height / 2));
        plane(i, height / 2, half, CV_8UC1).copyTo(to);
      }
      cv::cvtColor(packed, bgr, cv::COLOR_YUV2BGR_I420);
      break;
    }
    case GST_VIDEO_FORMAT_NV12:
      cv::cvtColorTwoPlane(plane(0, height, width, CV_8UC1), plane(1, height / 2, width / 2, CV_8UC2), bgr,
                           cv::COLOR_YUV2BGR_NV12);
      break;
    case GST_VIDEO_FORMAT_P010_10LE: {  // ten bits in the upper end of sixteen: the upper byte is the picture
      cv::Mat luma, colour;
      plane(0, height, width, CV_16UC1).convertTo(luma, CV_8U, 1.0 / 256, -0.498);
      plane(1, height / 2, width / 2, CV_16UC2).convertTo(colour, CV_8U, 1.0 / 256, -0.498);
      cv::cvtColorTwoPlane(luma, colour, bgr, cv::COLOR_YUV2BGR_NV12);
      break;
    }
    case GST_VIDEO_FORMAT_GRAY8:
      cv::cvtColor(plane(0, height, width, CV_8UC1), bgr, cv::COLOR_GRAY2BGR);
      break;
    case GST_VIDEO_FORMAT_YUY2:
      cv::cvtColor(plane(0, height, width, CV_8UC2), bgr, cv::COLOR_YUV2BGR_YUY2);
      break;
    case GST_VIDEO_FORMAT_UYVY:
      cv::cvtColor(plane(0, height, width, CV_8UC2), bgr, cv::COLOR_YUV2BGR_UYVY);
      break;
    case GST_VIDEO_FORMAT_BGR:
      bgr = plane(0, height, width, CV_8UC3).clone();
      break;
    default:
      break;
  }
  return bgr;
}

// By the range that the caps name: MJPEG has all 256 steps, most else 16 to 235. (The colours, which are only
// shown, are OpenCV's: 16 to 235.)
LumaPlane luma_plane(const GstVideoFrame& mapped) {
  const GstVideoFormat given = GST_VIDEO_FRAME_FORMAT(&mapped);
  if (given == GST_VIDEO_FORMAT_BGR) return {};
  LumaPlane plane;
  plane.data = static_cast<const std::uint8_t*>(GST_VIDEO_FRAME_COMP_DATA(&mapped, 0));
  plane.stride = GST_VIDEO_FRAME_COMP_STRIDE(&mapped, 0);
  plane.step = GST_VIDEO_FRAME_COMP_PSTRIDE(&mapped, 0);
  plane.bits = GST_VIDEO_FRAME_COMP_DEPTH(&mapped, 0);
  plane.shift = given == GST_VIDEO_FORMAT_P010_10LE ? 6 : 0;
  plane.is_full_range =
      given == GST_VIDEO_FORMAT_GRAY8 || mapped.info.colorimetry.range == GST_VIDEO_COLOR_RANGE_0_255;
  plane.width = GST_VIDEO_FRAME_WIDTH(&mapped);
  plane.height = GST_VIDEO_FRAME_HEIGHT(&mapped);
  return plane;
}

// A picture of a pipeline, mapped as long as it is held.
class MappedPicture final : public camera::PictureMemory {
 public:
  // Takes the sample over. False: it can't be read.
  [[nodiscard]] bool hold(GstSample* sample) {
    sample_.reset(sample);
    is_mapped_ = gst_video_info_from_caps(&info_, gst_sample_get_caps(sample)) != 0 &&
                 gst_video_frame_map(&mapped_, &info_, gst_sample_get_buffer(sample), GST_MAP_READ) != 0;
    return is_mapped_;
  }
  void let_go() {
    if (std::exchange(is_mapped_, false)) gst_video_frame_unmap(&mapped_);
    sample_.reset();
  }
  MappedPicture() = default;
  MappedPicture(const MappedPicture&) = delete;
  MappedPicture& operator=(const MappedPicture&) = delete;
  ~MappedPicture() override { let_go(); }

  [[nodiscard]] LumaPlane plane() const { return luma_plane(mapped_); }
  [[nodiscard]] const GstVideoInfo& info() const { return info_; }
  [[nodiscard]] camera::GrayView luma() const override { return plane().in_place(); }
  void bgr_into(std::vector<std::uint8_t>& bgr) const override {
    const cv::Mat made = to_bgr(mapped_);
    bgr.assign(made.datastart, made.dataend);
  }

 private:
  GstPtr<GstSample> sample_;
  GstVideoInfo info_{};
  GstVideoFrame mapped_{};
  bool is_mapped_ = false;
};

// Whether there is a way to BGR: not for colours at half the size in a picture of odd size.
bool can_be_shown(const GstVideoInfo& info) {
  const GstVideoFormat format = GST_VIDEO_INFO_FORMAT(&info);
  if (format == GST_VIDEO_FORMAT_BGR || format == GST_VIDEO_FORMAT_GRAY8) return true;
  return GST_VIDEO_INFO_WIDTH(&info) % 2 == 0 && GST_VIDEO_INFO_HEIGHT(&info) % 2 == 0;
}

// One run of a pipeline as a source; whoever opened it runs it again when it breaks.
class GStreamerPipeline final : public FrameSource {
 public:
  GStreamerPipeline(const std::string& pipeline, const Opening& opening) : stamps_(opening.stamps) {
    gst_init(nullptr, nullptr);
    info_.name = shown_address("gst:" + pipeline);
    info_.kind = SourceKind::Live;
    GError* problem = nullptr;
    pipeline_.reset(gst_parse_launch(with_conversion(pipeline).c_str(), &problem));
    const GstPtr<GError> owned(problem);
    if (pipeline_ == nullptr || problem != nullptr)
      throw InvalidInput(info_.name +
                         ": is no pipeline: " + (problem != nullptr ? problem->message : "empty"));
    if (!GST_IS_PIPELINE(pipeline_.get()))
      throw InvalidInput(info_.name + ": is no pipeline: it has no source");
    find_sink();
    // Its stamps are then on the clock that ages are told by.
    const GstPtr<GstClock> clock(gst_system_clock_obtain());
    gst_pipeline_use_clock(GST_PIPELINE(pipeline_.get()), clock.get());
    gst_element_set_state(pipeline_.get(), GST_STATE_PLAYING);
    first_ = pull(kOpensWithin);
    if (first_ == nullptr) {
      const std::string reason = told_on_bus();
      throw DeviceError(info_.name + ": " + (reason.empty() ? "gives no picture" : reason));
    }
    info_.image_size_px = {first_->width, first_->height};
    opening.identity = identity();
    // The end of a live one is a fault; that of a file is its end.
    info_.ends = gst_element_get_state(pipeline_.get(), nullptr, nullptr, 0) != GST_STATE_CHANGE_NO_PREROLL;
  }
  const SourceInfo& info() const override { return info_; }

  camera::FramePtr next() override {
    if (first_) return std::exchange(first_, nullptr);
    camera::FramePtr frame = pull(kSilence);
    if (frame != nullptr) return frame;
    const std::string reason = told_on_bus();
    if (gst_app_sink_is_eos(sink()) != 0 && reason.empty()) return nullptr;
    throw DeviceError(info_.name + ": " + (reason.empty() ? "gives no more pictures" : reason));
  }

 private:
  GstAppSink* sink() const { return GST_APP_SINK(sink_.get()); }

  void find_sink() {
    const GstPtr<GstIterator> sinks(
        gst_bin_iterate_all_by_element_factory_name(GST_BIN(pipeline_.get()), "appsink"));
    GValue found = G_VALUE_INIT;
    if (gst_iterator_next(sinks.get(), &found) != GST_ITERATOR_OK)
      throw InvalidInput(info_.name + ": must end in an appsink");
    sink_.reset(GST_ELEMENT(g_value_dup_object(&found)));
    g_value_unset(&found);
    const GstPtr<GstCaps> caps(gst_caps_from_string(kCaps));
    gst_app_sink_set_caps(sink(), caps.get());
    // The reader behind us takes at once; what waits in here nobody would see the age of.
    gst_app_sink_set_max_buffers(sink(), 4);
    g_object_set(sink(), "sync", FALSE, nullptr);
  }

  // Of the camera that the pipeline begins with, where it does.
  [[nodiscard]] std::string identity() const {
    const GstPtr<GstIterator> cameras(
        gst_bin_iterate_all_by_element_factory_name(GST_BIN(pipeline_.get()), "v4l2src"));
    GValue found = G_VALUE_INIT;
    if (gst_iterator_next(cameras.get(), &found) != GST_ITERATOR_OK) return "";
    char* device = nullptr;
    g_object_get(g_value_get_object(&found), "device", &device, nullptr);
    const GstPtr<char> owned(device);
    g_value_unset(&found);
    return device != nullptr ? device_identity(device) : "";
  }

  // What a part of the pipeline complained of; empty: nothing.
  std::string told_on_bus() {
    const GstPtr<GstBus> bus(gst_element_get_bus(pipeline_.get()));
    const GstPtr<GstMessage> message(gst_bus_pop_filtered(bus.get(), GST_MESSAGE_ERROR));
    if (message != nullptr) {
      GError* problem = nullptr;
      gst_message_parse_error(message.get(), &problem, nullptr);
      const GstPtr<GError> owned(problem);
      complaint_ = problem->message;
    }
    return complaint_;
  }

  camera::FramePtr pull(GstClockTime within) {
    GstSample* const sample = pull_sample(within);
    if (sample == nullptr) return nullptr;
    const std::int64_t received_ns = steady_now_ns();
    auto memory = memories_.take();
    if (!memory->hold(sample)) throw DeviceError(info_.name + ": gave a picture that can't be read");
    const GstVideoInfo& format = memory->info();
    if (!can_be_shown(format))
      throw DeviceError(info_.name +
                        ": gives pictures of an odd size or format: put \"videoconvert ! "
                        "video/x-raw,format=BGR\" before the appsink");
    if (format.fps_d > 0) info_.frames_per_second = static_cast<double>(format.fps_n) / format.fps_d;
    auto frame = frames_.take();
    frame->width = GST_VIDEO_INFO_WIDTH(&format);
    frame->height = GST_VIDEO_INFO_HEIGHT(&format);
    stamp(*frame, sample);
    const LumaPlane plane = memory->plane();
    put_picture(*frame, std::move(memory), plane);
    frame->received_ns = received_ns;
    frame->decoded_ns = steady_now_ns();
    return frame;
  }

  // In short waits: an error on the bus does not end a wait for a picture.
  GstSample* pull_sample(GstClockTime within) {
    constexpr GstClockTime kLook = 100 * GST_MSECOND;
    for (GstClockTime waited = 0; waited < within; waited += kLook) {
      if (GstSample* const sample = gst_app_sink_try_pull_sample(sink(), kLook)) return sample;
      if (gst_app_sink_is_eos(sink()) != 0 || !told_on_bus().empty()) return nullptr;
    }
    return nullptr;
  }

  void stamp(camera::Frame& frame, GstSample* sample) {
    const GstClockTime running = gst_segment_to_running_time(gst_sample_get_segment(sample), GST_FORMAT_TIME,
                                                             GST_BUFFER_PTS(gst_sample_get_buffer(sample)));
    double stamp_ms = 0;  // none
    if (GST_CLOCK_TIME_IS_VALID(running))
      stamp_ms = static_cast<double>(gst_element_get_base_time(pipeline_.get()) + running) * 1e-6;
    const CaptureTime captured = capture_time(stamp_ms, steady_now_ns());
    stamps_.put_on(frame, captured.ns, captured.clock);
  }

  LiveStamps& stamps_;
  SourceInfo info_;
  RunningPipeline pipeline_;
  GstPtr<GstElement> sink_;
  std::string complaint_;
  worker::Recycler<MappedPicture> memories_{[](MappedPicture& memory) { memory.let_go(); }};
  worker::Recycler<camera::Frame> frames_{[](camera::Frame& frame) { frame.memory.reset(); }};
  camera::FramePtr first_;
};

}  // namespace

std::unique_ptr<FrameSource> open_gstreamer_pipeline(const std::string& pipeline) {
  return recovering(
      [pipeline](const Opening& opening) { return std::make_unique<GStreamerPipeline>(pipeline, opening); });
}

}  // namespace arthronaut::sources
