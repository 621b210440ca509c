#include <chrono>
#include <opencv2/videoio.hpp>

#include "navigation/sources/frame_source.h"
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
    info_.is_live = true;
  }

  const SourceInfo& info() const override { return info_; }

  camera::FramePtr next() override {
    if (!capture_.grab()) throw DeviceError(info_.name + ": gives no more pictures");
    const auto grabbed_at = std::chrono::steady_clock::now();
    cv::Mat picture;
    if (!capture_.retrieve(picture) || picture.type() != CV_8UC3) {
      throw DeviceError(info_.name + ": gave a picture that can't be read");
    }
    if (next_index_ == 0) started_at_ = grabbed_at;
    auto frame = std::make_shared<camera::Frame>();
    frame->index = next_index_++;
    frame->timestamp_ns =
        std::chrono::duration_cast<std::chrono::nanoseconds>(grabbed_at - started_at_).count();
    frame->width = picture.cols;
    frame->height = picture.rows;
    const cv::Mat packed = picture.isContinuous() ? picture : picture.clone();
    frame->bgr.assign(packed.datastart, packed.dataend);
    return frame;
  }

 private:
  cv::VideoCapture capture_;
  SourceInfo info_;
  std::chrono::steady_clock::time_point started_at_;
  std::int64_t next_index_ = 0;
};

}  // namespace

std::unique_ptr<FrameSource> open_device(int device_index) {
  return std::make_unique<CameraDevice>(device_index);
}

}  // namespace arthronaut::sources
