#include <algorithm>
#include <chrono>
#include <opencv2/videoio.hpp>

#include "navigation/sources/capture_time.h"
#include "navigation/sources/frame_source.h"
#include "navigation/sources/logged_source.h"
#include "planning/geometry/error.h"

namespace arthronaut::sources {
namespace {

class CameraDevice : public FrameSource {
 public:
  explicit CameraDevice(int device_index) {
    const std::string name = "camera " + std::to_string(device_index);
    if (device_index < 0 || !capture_.open(device_index)) throw DeviceError(name + ": can't be opened");
    // Wishes, not demands: what the device gives instead is reported in info().
    capture_.set(cv::CAP_PROP_FRAME_WIDTH, 1920);
    capture_.set(cv::CAP_PROP_FRAME_HEIGHT, 1080);
    capture_.set(cv::CAP_PROP_FPS, 60);
    info_.name = name;
    info_.image_size_px = {static_cast<int>(capture_.get(cv::CAP_PROP_FRAME_WIDTH)),
                           static_cast<int>(capture_.get(cv::CAP_PROP_FRAME_HEIGHT))};
    info_.frames_per_second = capture_.get(cv::CAP_PROP_FPS);
    info_.kind = SourceKind::Live;
    stamps_pictures_ = capture_.getBackendName() == "V4L2";
  }

  const SourceInfo& info() const override { return info_; }

  camera::FramePtr next() override {
    if (!capture_.grab()) throw DeviceError(info_.name + ": gives no more pictures");
    const CaptureTime captured =
        capture_time(stamps_pictures_ ? capture_.get(cv::CAP_PROP_POS_MSEC) : 0, steady_now_ns());
    cv::Mat picture;
    if (!capture_.retrieve(picture) || picture.type() != CV_8UC3) {
      throw DeviceError(info_.name + ": gave a picture that can't be read");
    }
    if (next_index_ == 0) started_at_ns_ = captured.ns;
    auto frame = std::make_shared<camera::Frame>();
    frame->index = next_index_++;
    // A clock that changes over (a driver's stamp that is missing once) must not run backwards.
    last_timestamp_ns_ = std::max(captured.ns - started_at_ns_, last_timestamp_ns_ + 1);
    frame->timestamp_ns = last_timestamp_ns_;
    frame->captured_ns = captured.ns;
    frame->capture_clock = captured.clock;
    frame->width = picture.cols;
    frame->height = picture.rows;
    const cv::Mat packed = picture.isContinuous() ? picture : picture.clone();
    frame->bgr.assign(packed.datastart, packed.dataend);
    return frame;
  }

 private:
  cv::VideoCapture capture_;
  SourceInfo info_;
  bool stamps_pictures_ = false;  // only V4L2 passes the driver's own stamp on as CAP_PROP_POS_MSEC
  std::int64_t started_at_ns_ = 0, last_timestamp_ns_ = -1;
  std::int64_t next_index_ = 0;
};

}  // namespace

std::unique_ptr<FrameSource> open_device(int device_index) {
  return logged(std::make_unique<CameraDevice>(device_index));
}

}  // namespace arthronaut::sources
