#include "navigation/sources/gstreamer_pipeline.h"

#include <gst/app/gstappsink.h>
#include <gst/gst.h>
#include <gst/video/video.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "navigation/sources/capture_time.h"
#include "planning/geometry/error.h"

namespace arthronaut::sources {

namespace {

constexpr GstClockTime kOpensWithin = 10 * GST_SECOND, kGivesUpAfter = 15 * GST_SECOND;

struct Unref {
  void operator()(GstElement* p) const { gst_object_unref(p); }
  void operator()(GstClock* p) const { gst_object_unref(p); }
  void operator()(GstSample* p) const { gst_sample_unref(p); }
  void operator()(GstMessage* p) const { gst_message_unref(p); }
  void operator()(GstBus* p) const { gst_object_unref(p); }
  void operator()(GstCaps* p) const { gst_caps_unref(p); }
  void operator()(GstIterator* p) const { gst_iterator_free(p); }
  void operator()(GError* p) const { g_error_free(p); }
  void operator()(char* p) const { g_free(p); }
};
template <class T>
using GstPtr = std::unique_ptr<T, Unref>;
// A pipeline must not run any more when it is let go.
struct StopAndUnref {
  void operator()(GstElement* p) const {
    gst_element_set_state(p, GST_STATE_NULL);
    gst_object_unref(p);
  }
};

// The formats whose way to BGR is OpenCV's; the first is what tracking gets without a detour.
constexpr const char* kCaps = "video/x-raw,format=(string){ I420, NV12, BGR, GRAY8, YUY2, UYVY }";

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

class GStreamerPipeline final : public FrameSource {
 public:
  explicit GStreamerPipeline(const std::string& pipeline) {
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
  }
  const SourceInfo& info() const override { return info_; }

  camera::FramePtr next() override {
    if (first_) return std::exchange(first_, nullptr);
    camera::FramePtr frame = pull(kGivesUpAfter);
    if (frame == nullptr) {
      if (gst_app_sink_is_eos(sink()) != 0 && told_on_bus().empty()) return nullptr;
      const std::string reason = told_on_bus();
      throw DeviceError(info_.name + ": " + (reason.empty() ? "has given no picture for 15 s" : reason));
    }
    if (frame->width != info_.image_size_px.x() || frame->height != info_.image_size_px.y())
      throw DeviceError(info_.name + ": gives pictures of another size now");
    return frame;
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
    const GstPtr<GstSample> sample(pull_sample(within));
    if (sample == nullptr) return nullptr;
    GstVideoInfo format;
    GstVideoFrame mapped;
    GstBuffer* const buffer = gst_sample_get_buffer(sample.get());
    if (gst_video_info_from_caps(&format, gst_sample_get_caps(sample.get())) == 0 ||
        gst_video_frame_map(&mapped, &format, buffer, GST_MAP_READ) == 0)
      throw DeviceError(info_.name + ": gave a picture that can't be read");
    const cv::Mat bgr = to_bgr(mapped);
    gst_video_frame_unmap(&mapped);
    if (bgr.empty())
      throw DeviceError(info_.name +
                        ": gives pictures of an odd size or format: put \"videoconvert ! "
                        "video/x-raw,format=BGR\" before the appsink");
    if (format.fps_d > 0) info_.frames_per_second = static_cast<double>(format.fps_n) / format.fps_d;
    auto frame = std::make_shared<camera::Frame>();
    frame->width = bgr.cols;
    frame->height = bgr.rows;
    frame->bgr.assign(bgr.datastart, bgr.dataend);
    stamp(*frame, sample.get(), buffer);
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

  void stamp(camera::Frame& frame, GstSample* sample, GstBuffer* buffer) {
    const GstClockTime running =
        gst_segment_to_running_time(gst_sample_get_segment(sample), GST_FORMAT_TIME, GST_BUFFER_PTS(buffer));
    double stamp_ms = 0;  // none
    if (GST_CLOCK_TIME_IS_VALID(running))
      stamp_ms = static_cast<double>(gst_element_get_base_time(pipeline_.get()) + running) * 1e-6;
    const CaptureTime captured = capture_time(stamp_ms, steady_now_ns());
    if (next_index_ == 0) started_at_ns_ = captured.ns;
    frame.index = next_index_++;
    last_timestamp_ns_ = std::max(captured.ns - started_at_ns_, last_timestamp_ns_ + 1);
    frame.timestamp_ns = last_timestamp_ns_;
    frame.captured_ns = captured.ns;
    frame.capture_clock = captured.clock;
  }

  SourceInfo info_;
  std::unique_ptr<GstElement, StopAndUnref> pipeline_;
  GstPtr<GstElement> sink_;
  std::string complaint_;
  camera::FramePtr first_;
  std::int64_t started_at_ns_ = 0, last_timestamp_ns_ = -1, next_index_ = 0;
};

}  // namespace

std::unique_ptr<FrameSource> open_gstreamer_pipeline(const std::string& pipeline) {
  return std::make_unique<GStreamerPipeline>(pipeline);
}

}  // namespace arthronaut::sources
