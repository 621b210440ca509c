#include "navigation/sources/camera_device.h"

#include <algorithm>
#include <set>
#include <utility>

#include "navigation/sources/camera_buffers.h"
#include "navigation/sources/capture_time.h"
#include "navigation/sources/device_identity.h"
#include "navigation/sources/driver_pictures.h"
#include "navigation/sources/logged_source.h"
#include "navigation/sources/lost_pictures.h"
#include "navigation/sources/motion_jpeg.h"
#include "navigation/sources/recovering_source.h"
#include "navigation/sources/v4l2_device.h"
#include "planning/geometry/error.h"
#include "planning/log/log.h"

namespace arthronaut::sources {

namespace {

// A camera exposes, and a capture card looks for the signal, before the first picture.
constexpr std::int64_t kFirstWithin_ns = 3'000'000'000;
// Half a second is what may pass until somebody is told.
constexpr std::int64_t kSilent_ns = 400'000'000;
// A capture card without a signal may go on to give pictures, of its own making.
constexpr std::int64_t kLooksForSignal_ns = 200'000'000;
constexpr int kPatience_ms = 100;

CameraMode mode_to_take(const V4l2Device& device, const CameraWish& wish) {
  const std::vector<CameraMode> modes = modes_of(device, wish);
  if (const auto chosen = choose_mode(modes, wish)) return *chosen;
  std::set<std::string> given;
  for (const CameraMode& mode : modes) given.insert(text_of(mode));
  std::string all;
  for (const std::string& one : given) all += (all.empty() ? "" : "; ") + one;
  const std::string wished = text_of(wish);
  throw DeviceError(device.name() + ": gives nothing that can be read" +
                    (wished.empty() ? "" : " as asked for (" + wished + ")") + "; it gives " +
                    (all.empty() ? "nothing" : all));
}

// A device as it was plugged in; whoever opened it opens it again when it is back.
class CameraDevice final : public FrameSource {
 public:
  CameraDevice(const CameraAddress& address, const Opening& opening)
      : stamps_(opening.stamps), remark_(opening.remark) {
    auto device = std::make_unique<V4l2Device>(address.index);
    info_.name = device->name();
    take_input(*device, address.wish);
    refuse_without_signal(*device);
    CameraWish wish = address.wish;
    if (opening.is_again) wish.prefers_px = opening.first_size_px;  // it may have more modes by now
    const CameraMode mode = mode_to_take(*device, wish);
    const v4l2_pix_format format = take_mode(*device, mode);
    const double rate = rate_of(*device);
    info_.frames_per_second = rate > 0 ? rate : mode.frames_per_second;
    info_.image_size_px = mode.size_px;
    info_.kind = SourceKind::Live;
    info_.ends = false;
    info_.keeps_size = true;
    opening.identity = device_identity("/dev/video" + std::to_string(address.index));
    device_ = device.get();
    buffers_ = std::make_shared<CameraBuffers>(std::move(device));
    if (find_pixel_format(format.pixelformat)->is_compressed)
      decoder_.emplace();
    else
      raw_.emplace(PictureLayout::of(format), buffers_);
    if (info_.frames_per_second > 0)
      silent_ns_ = std::max(kSilent_ns, static_cast<std::int64_t>(3e9 / info_.frames_per_second));
    first_ = wait_for_picture(kFirstWithin_ns);
    log::info("source: " + info_.name + ": " + text_of(mode) +
              (is_interlaced(format) ? ", interlaced: what moves is combed" : "") +
              (first_->capture_clock == camera::CaptureClock::Driver
                   ? ", dated by its driver"
                   : ", dated when it is handed over: its driver has no usable clock"));
  }
  ~CameraDevice() override {
    buffers_->stop();
    if (lost_.lost() > 0)
      log::warning("source: " + info_.name + ": " + std::to_string(lost_.lost()) + " of " +
                   std::to_string(lost_.all()) + " pictures were lost between camera and computer");
  }
  CameraDevice(const CameraDevice&) = delete;
  CameraDevice& operator=(const CameraDevice&) = delete;

  const SourceInfo& info() const override { return info_; }

  camera::FramePtr next() override {
    if (first_) return std::exchange(first_, nullptr);
    return wait_for_picture(silent_ns_);
  }

 private:
  static bool is_interlaced(const v4l2_pix_format& format) {
    return format.field == V4L2_FIELD_INTERLACED || format.field == V4L2_FIELD_INTERLACED_TB ||
           format.field == V4L2_FIELD_INTERLACED_BT;
  }
  static void refuse_without_signal(const V4l2Device& device) {
    if (const std::string trouble = signal_trouble(device); !trouble.empty())
      throw DeviceError(device.name() + ": " + trouble);
  }

  camera::FramePtr wait_for_picture(std::int64_t patience_ns) {
    const std::int64_t begun_ns = steady_now_ns();
    bool has_damaged = false;
    for (;;) {
      const CameraBuffers::Came came = buffers_->wait(kPatience_ms);
      const std::int64_t now_ns = steady_now_ns();
      if (came == CameraBuffers::Came::Change)
        throw DeviceError(info_.name + ": the format of its signal has changed");
      if (now_ns - looked_at_ns_ > kLooksForSignal_ns) {
        refuse_without_signal(*device_);
        looked_at_ns_ = now_ns;
      }
      if (came == CameraBuffers::Came::Picture) {
        if (camera::FramePtr frame = take_picture(has_damaged)) return frame;
      }
      if (now_ns - begun_ns > patience_ns)
        throw DeviceError(info_.name + (has_damaged
                                            ? ": every picture comes damaged: check its cable"
                                            : ": gives no picture: check its cable, and that it is on"));
    }
  }

  // Null: none waits, or it is damaged.
  camera::FramePtr take_picture(bool& is_damaged) {
    const auto filled = buffers_->take();
    if (!filled) return nullptr;
    std::shared_ptr<camera::Frame> frame;
    if (raw_) {
      frame = raw_->make(*filled);
    } else {
      const AVFrame* const picture =
          filled->is_damaged ? nullptr : decoder_->decode(filled->data, filled->byte_count);
      buffers_->give_back(filled->buffer);
      if (picture != nullptr) frame = decoded_.make(*picture);
    }
    is_damaged = frame == nullptr;
    const std::int64_t missing = lost_.came(filled->sequence, is_damaged, filled->received_ns);
    if (remark_.empty() != lost_.words().empty() || !lost_.words().empty()) say_lost();
    if (frame == nullptr) return nullptr;
    stamps_.put_on(*frame, filled->captured_ns, filled->clock, missing);
    frame->received_ns = filled->received_ns;
    frame->decoded_ns = steady_now_ns();
    return frame;
  }

  void say_lost() {
    remark_ = lost_.words().empty() ? ""
                                    : info_.name + ": " + lost_.words() +
                                          ": check its cable, and whether this computer keeps up";
  }

  LiveStamps& stamps_;
  std::string& remark_;
  SourceInfo info_;
  const V4l2Device* device_ = nullptr;  // of buffers_
  std::shared_ptr<CameraBuffers> buffers_;
  std::optional<DriverPictures> raw_;  // of what comes uncompressed
  std::optional<MotionJpeg> decoder_;  // of what does not
  DecodedFrames decoded_;
  LostPictures lost_;
  camera::FramePtr first_;
  std::int64_t silent_ns_ = kSilent_ns, looked_at_ns_ = 0;
};

}  // namespace

std::unique_ptr<FrameSource> open_camera(const CameraAddress& address) {
  return logged(recovering(
      [address](const Opening& opening) { return std::make_unique<CameraDevice>(address, opening); }));
}

std::unique_ptr<FrameSource> open_device(int device_index) { return open_camera({device_index}); }

}  // namespace arthronaut::sources
