#include <filesystem>
#include <opencv2/videoio.hpp>

#include "navigation/sources/capture_time.h"
#include "navigation/sources/device_identity.h"
#include "navigation/sources/frame_source.h"
#include "navigation/sources/logged_source.h"
#include "navigation/sources/recovering_source.h"
#include "navigation/worker/recycler.h"
#include "planning/geometry/error.h"

namespace arthronaut::sources {
namespace {

// A device as it was plugged in; whoever opened it opens it again when it is back.
class CameraDevice : public FrameSource {
 public:
  CameraDevice(int device_index, const Opening& opening) : stamps_(opening.stamps) {
    const std::string name = "camera " + std::to_string(device_index);
    // Asked several times a second while it is out; OpenCV would try all it knows, and complain aloud.
    if (opening.is_again && !std::filesystem::exists("/dev/video" + std::to_string(device_index)))
      throw DeviceError(name + ": is not connected");
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
    info_.ends = false;
    opening.identity = device_identity("/dev/video" + std::to_string(device_index));
    stamps_pictures_ = capture_.getBackendName() == "V4L2";
  }

  const SourceInfo& info() const override { return info_; }

  camera::FramePtr next() override {
    if (!capture_.grab()) throw DeviceError(info_.name + ": gives no more pictures");
    const std::int64_t received_ns = steady_now_ns();
    const CaptureTime captured =
        capture_time(stamps_pictures_ ? capture_.get(cv::CAP_PROP_POS_MSEC) : 0, received_ns);
    cv::Mat& picture = picture_;
    if (!capture_.retrieve(picture) || picture.type() != CV_8UC3) {
      throw DeviceError(info_.name + ": gave a picture that can't be read");
    }
    const auto frame = frames_.take();
    stamps_.put_on(*frame, captured.ns, captured.clock);
    frame->received_ns = received_ns;
    frame->width = picture.cols;
    frame->height = picture.rows;
    const cv::Mat packed = picture.isContinuous() ? picture : picture.clone();
    frame->bgr.assign(packed.datastart, packed.dataend);
    frame->decoded_ns = steady_now_ns();
    return frame;
  }

 private:
  LiveStamps& stamps_;
  cv::VideoCapture capture_;
  cv::Mat picture_;
  worker::Recycler<camera::Frame> frames_;
  SourceInfo info_;
  bool stamps_pictures_ = false;  // only V4L2 passes the driver's own stamp on as CAP_PROP_POS_MSEC
};

}  // namespace

std::unique_ptr<FrameSource> open_device(int device_index) {
  return logged(recovering([device_index](const Opening& opening) {
    return std::make_unique<CameraDevice>(device_index, opening);
  }));
}

}  // namespace arthronaut::sources
