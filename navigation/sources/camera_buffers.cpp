#include "navigation/sources/camera_buffers.h"

#include <poll.h>
#include <sys/mman.h>

#include <cerrno>

#include "navigation/sources/capture_time.h"
#include "planning/geometry/error.h"

namespace arthronaut::sources {

namespace {

// One that is written, one that waits, and of the rest as many as the screen, the record and the pipeline
// look at in one moment. 8 of 1080p YUYV are 33 MB.
constexpr std::uint32_t kWished = 8, kLeast = 3;

v4l2_buffer empty_buffer(std::uint32_t index = 0) {
  v4l2_buffer buffer{};
  buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  buffer.memory = V4L2_MEMORY_MMAP;
  buffer.index = index;
  return buffer;
}

}  // namespace

CameraBuffers::CameraBuffers(std::unique_ptr<V4l2Device> device) : device_(std::move(device)) {
  // A device without events (a webcam) does not change its format by itself.
  v4l2_event_subscription change{};
  change.type = V4L2_EVENT_SOURCE_CHANGE;
  (void)device_->request(VIDIOC_SUBSCRIBE_EVENT, &change);
  v4l2_requestbuffers request{};
  request.count = kWished;
  request.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  request.memory = V4L2_MEMORY_MMAP;
  if (const int error = device_->request(VIDIOC_REQBUFS, &request); error != 0) device_->fail("", error);
  if (request.count < kLeast) throw DeviceError(device_->name() + ": has no memory for its pictures");
  try {
    mapped_.reserve(request.count);
    for (std::uint32_t i = 0; i < request.count; ++i) map(i);
    for (std::uint32_t i = 0; i < request.count; ++i) give_back(static_cast<int>(i));
    int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (const int error = device_->request(VIDIOC_STREAMON, &type); error != 0) device_->fail("", error);
  } catch (const DeviceError&) {
    for (const Mapped& one : mapped_) ::munmap(one.address, one.byte_count);
    throw;
  }
}

CameraBuffers::~CameraBuffers() {
  stop();
  for (const Mapped& one : mapped_) ::munmap(one.address, one.byte_count);
}

void CameraBuffers::map(std::uint32_t index) {
  v4l2_buffer buffer = empty_buffer(index);
  if (const int error = device_->request(VIDIOC_QUERYBUF, &buffer); error != 0) device_->fail("", error);
  void* const address =
      ::mmap(nullptr, buffer.length, PROT_READ | PROT_WRITE, MAP_SHARED, device_->file(), buffer.m.offset);
  if (address == MAP_FAILED) device_->fail("its pictures can't be mapped", errno);
  mapped_.push_back({address, buffer.length});
}

void CameraBuffers::stop() {
  const std::lock_guard lock(mutex_);
  if (device_->file() < 0) return;
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  (void)device_->request(VIDIOC_STREAMOFF, &type);
  device_->close();
}

bool CameraBuffers::has_changed() const {
  bool is_changed = false;
  v4l2_event event{};
  while (device_->request(VIDIOC_DQEVENT, &event) == 0) {
    is_changed = is_changed || (event.type == V4L2_EVENT_SOURCE_CHANGE &&
                                (event.u.src_change.changes & V4L2_EVENT_SRC_CH_RESOLUTION) != 0);
    event = {};
  }
  return is_changed;
}

CameraBuffers::Came CameraBuffers::wait(int patience_ms) {
  pollfd waits{.fd = device_->file(), .events = POLLIN | POLLPRI, .revents = 0};
  const int ready = ::poll(&waits, 1, patience_ms);
  if (ready < 0 && errno != EINTR) device_->fail("", errno);
  if (ready <= 0) return Came::Nothing;
  if ((waits.revents & POLLPRI) != 0 && has_changed()) return Came::Change;
  if ((waits.revents & POLLIN) != 0) return Came::Picture;
  // Nothing to take, and nothing that will come.
  if ((waits.revents & (POLLERR | POLLHUP | POLLNVAL)) != 0) device_->fail("", ENODEV);
  return Came::Nothing;
}

std::optional<CameraBuffers::Filled> CameraBuffers::take() {
  v4l2_buffer buffer = empty_buffer();
  if (const int error = device_->request(VIDIOC_DQBUF, &buffer); error != 0) {
    if (error == EAGAIN) return std::nullopt;
    device_->fail("", error);
  }
  {
    const std::lock_guard lock(mutex_);
    --with_driver_;
  }
  Filled filled;
  filled.buffer = static_cast<int>(buffer.index);
  filled.data = static_cast<const std::uint8_t*>(mapped_[buffer.index].address);
  filled.byte_count = std::min<std::size_t>(buffer.bytesused, mapped_[buffer.index].byte_count);
  filled.sequence = buffer.sequence;
  filled.is_damaged = (buffer.flags & V4L2_BUF_FLAG_ERROR) != 0;
  filled.received_ns = steady_now_ns();
  // Any other clock than the monotonic one (the wall's, a copy of the encoder's) says nothing here.
  const bool is_stamped = (buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  const double stamp_ms = is_stamped ? static_cast<double>(buffer.timestamp.tv_sec) * 1e3 +
                                           static_cast<double>(buffer.timestamp.tv_usec) * 1e-3
                                     : 0;
  const CaptureTime captured = capture_time(stamp_ms, filled.received_ns);
  filled.captured_ns = captured.ns;
  filled.clock = captured.clock;
  return filled;
}

void CameraBuffers::give_back(int buffer) {
  const std::lock_guard lock(mutex_);
  if (device_->file() < 0) return;
  v4l2_buffer given = empty_buffer(static_cast<std::uint32_t>(buffer));
  // A device that is gone takes none, which take() will tell.
  if (device_->request(VIDIOC_QBUF, &given) == 0) ++with_driver_;
}

bool CameraBuffers::can_spare() const {
  const std::lock_guard lock(mutex_);
  return with_driver_ >= static_cast<int>(kLeast);
}

}  // namespace arthronaut::sources
