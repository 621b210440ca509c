#include "tests/fake_camera/kernel_camera.h"

#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>

namespace arthronaut::test {

int OpenCamera::enumerate_format(v4l2_fmtdesc& format) const {
  std::vector<std::uint32_t> known;
  for (std::uint32_t i = camera_.first_mode; i < camera_.mode_count; ++i)
    if (std::find(known.begin(), known.end(), camera_.modes[i].fourcc) == known.end())
      known.push_back(camera_.modes[i].fourcc);
  if (format.index >= known.size()) return EINVAL;
  format.pixelformat = known[format.index];
  return 0;
}

int OpenCamera::enumerate_size(v4l2_frmsizeenum& size) const {
  if (!camera_.tells_sizes) return ENOTTY;
  std::uint32_t index = 0;
  v4l2_frmsize_stepwise range{UINT32_MAX, 0, camera_.size_step, UINT32_MAX, 0, camera_.size_step};
  for (std::uint32_t i = camera_.first_mode; i < camera_.mode_count; ++i) {
    const FakeMode& one = camera_.modes[i];
    if (one.fourcc != size.pixel_format) continue;
    range.min_width = std::min(range.min_width, one.width);
    range.max_width = std::max(range.max_width, one.width);
    range.min_height = std::min(range.min_height, one.height);
    range.max_height = std::max(range.max_height, one.height);
    if (camera_.size_step > 0 || index++ != size.index) continue;
    size.type = V4L2_FRMSIZE_TYPE_DISCRETE;
    size.discrete = {one.width, one.height};
    return 0;
  }
  if (camera_.size_step == 0 || range.max_width == 0 || size.index > 0) return EINVAL;
  size.type = V4L2_FRMSIZE_TYPE_STEPWISE;
  size.stepwise = range;
  return 0;
}

int OpenCamera::enumerate_rate(v4l2_frmivalenum& rate) const {
  if (!camera_.tells_sizes) return ENOTTY;
  for (std::uint32_t i = camera_.first_mode; i < camera_.mode_count; ++i) {
    const FakeMode& one = camera_.modes[i];
    if (one.fourcc != rate.pixel_format || one.width != rate.width || one.height != rate.height) continue;
    if (rate.index >= std::size(one.rates) || one.rates[rate.index] == 0) return EINVAL;
    rate.type = V4L2_FRMIVAL_TYPE_DISCRETE;
    rate.discrete = {1, one.rates[rate.index]};
    return 0;
  }
  return EINVAL;
}

int OpenCamera::enumerate_input(v4l2_input& input) const {
  if (input.index > 0) return EINVAL;
  std::snprintf(reinterpret_cast<char*>(input.name), sizeof input.name, "%s",
                camera_.standards != 0 ? "S-Video" : "HDMI");
  input.type = V4L2_INPUT_TYPE_CAMERA;
  input.status = camera_.input_status;
  input.std = camera_.standards;
  return 0;
}

int OpenCamera::enumerate_standard(v4l2_standard& standard) const {
  constexpr std::pair<v4l2_std_id, const char*> kNames[] = {
      {V4L2_STD_PAL, "PAL"}, {V4L2_STD_NTSC, "NTSC"}, {V4L2_STD_SECAM, "SECAM"}};
  std::uint32_t index = 0;
  for (const auto& [id, name] : kNames) {
    if ((camera_.standards & id) == 0 || index++ != standard.index) continue;
    standard.id = id;
    std::snprintf(reinterpret_cast<char*>(standard.name), sizeof standard.name, "%s", name);
    return 0;
  }
  return camera_.standards != 0 ? EINVAL : ENODATA;
}

int OpenCamera::format(v4l2_format& format, bool is_set) {
  if (is_set && streams_) return EBUSY;
  // As drivers do: the mode itself, else the first of that format, else the first of all.
  std::uint32_t best = camera_.first_mode;
  bool has_format = false;
  for (std::uint32_t i = camera_.first_mode; i < camera_.mode_count; ++i) {
    const FakeMode& one = camera_.modes[i];
    if (one.fourcc != format.fmt.pix.pixelformat) continue;
    const bool is_it = one.width == format.fmt.pix.width && one.height == format.fmt.pix.height;
    if (is_it || !has_format) best = i;
    has_format = true;
    if (is_it) break;
  }
  const FakeMode& given = camera_.modes[best];
  v4l2_pix_format& pixels = format.fmt.pix;
  pixels = {};
  pixels.width = given.width;
  pixels.height = given.height;
  pixels.pixelformat = given.fourcc;
  pixels.field = given.field != 0 ? given.field : static_cast<std::uint32_t>(V4L2_FIELD_NONE);
  pixels.quantization = given.quantization;
  pixels.sizeimage = given.picture_bytes;
  if (!is_set) return 0;
  mode_ = best;
  rate_ = given.rates[0];
  return 0;
}

int OpenCamera::rate(v4l2_streamparm& parameters, bool is_set) {
  v4l2_fract& interval = parameters.parm.capture.timeperframe;
  if (is_set && interval.numerator > 0) {
    const double wished = static_cast<double>(interval.denominator) / interval.numerator;
    for (const std::uint32_t one : mode()->rates)
      if (one != 0 && std::abs(one - wished) < std::abs(static_cast<double>(rate_) - wished)) rate_ = one;
  }
  interval = {1, rate_};
  return 0;
}

int OpenCamera::request_buffers(v4l2_requestbuffers& request) {
  if (camera_.is_busy || (camera_.streaming > 0 && !streams_)) return EBUSY;
  request.count = std::clamp<std::uint32_t>(request.count, 0, 32);
  buffer_count_ = request.count;
  if (::ftruncate(file_, static_cast<off_t>(slot_bytes() * buffer_count_)) != 0) return ENOMEM;
  void* const at =
      ::mmap(nullptr, slot_bytes() * buffer_count_, PROT_READ | PROT_WRITE, MAP_SHARED, file_, 0);
  if (at == MAP_FAILED) return ENOMEM;
  slots_ = static_cast<std::uint8_t*>(at);
  return 0;
}

int OpenCamera::start() {
  if (camera_.is_busy) return EBUSY;
  pictures_ = std::make_unique<Mapping>(mode()->pictures, O_RDONLY, PROT_READ);
  const std::uint8_t* at = pictures_->data();
  if (at == nullptr) return EIO;
  const auto number = [&at] {
    std::uint32_t value = 0;
    std::memcpy(&value, at, sizeof value);
    at += sizeof value;
    return value;
  };
  each_picture_.clear();
  for (std::uint32_t left = number(); left > 0; --left) {
    const std::uint32_t size = number();
    each_picture_.emplace_back(at, size);
    at += size;
  }
  streams_ = true;
  sequence_ = 0;
  rate_ = std::max(1U, rate_);
  due_ns_ = clock_now_ns() + kFakeSecond_ns / rate_;
  camera_.mode_in_use = mode_;
  camera_.rate_in_use = rate_;
  camera_.most_streaming = std::max<int>(camera_.most_streaming, ++camera_.streaming);
  return 0;
}

int OpenCamera::stop() {
  if (slots_ != nullptr) ::munmap(slots_, slot_bytes() * buffer_count_);
  slots_ = nullptr;
  if (streams_) --camera_.streaming;
  streams_ = false;
  return 0;
}

void OpenCamera::write_picture(std::int64_t due_ns) {
  const std::uint32_t number = sequence_++;
  const auto& [bytes, size] = each_picture_[next_picture_++ % each_picture_.size()];
  if (camera_.loses > 0) {
    --camera_.loses;
    return;
  }
  if (empty_.empty()) return;
  v4l2_buffer buffer{};
  buffer.index = empty_.front();
  empty_.pop_front();
  std::memcpy(slots_ + slot_bytes() * buffer.index, bytes, size);
  buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  buffer.bytesused = size;
  buffer.sequence = number;
  if (camera_.clock == FakeClock::Monotonic) buffer.flags |= V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  const std::int64_t stamp_ns = camera_.clock == FakeClock::None   ? 0
                                : camera_.clock == FakeClock::Wall ? clock_now_ns(CLOCK_REALTIME)
                                                                   : due_ns;
  buffer.timestamp = {stamp_ns / kFakeSecond_ns, stamp_ns % kFakeSecond_ns / 1000};
  if (camera_.damages > 0) {
    --camera_.damages;
    buffer.flags |= V4L2_BUF_FLAG_ERROR;
    buffer.bytesused = size / 2;
  }
  full_.push_back(buffer);
  ++camera_.given;
}

void OpenCamera::make_due_pictures() {
  const std::int64_t now = clock_now_ns();
  for (; streams_ && due_ns_ <= now; due_ns_ += kFakeSecond_ns / rate_)
    if (!camera_.is_stalled) write_picture(due_ns_);
}

short OpenCamera::ready() {
  if (!camera_.is_plugged) return POLLERR | POLLHUP;
  make_due_pictures();
  short events = 0;
  if (!full_.empty() || (streams_ && camera_.picture_error != 0)) events |= POLLIN;
  if (hears_changes_ && changes_ != camera_.source_changes) events |= POLLPRI;
  return events;
}

int OpenCamera::take(v4l2_buffer& buffer) {
  if (camera_.picture_error != 0) return camera_.picture_error;
  make_due_pictures();
  if (full_.empty()) return EAGAIN;
  buffer = full_.front();
  full_.pop_front();
  return 0;
}

int OpenCamera::request(unsigned long what, void* with) {
  if (!camera_.is_plugged) return ENODEV;
  switch (what) {
    case VIDIOC_QUERYCAP: {
      auto& says = *static_cast<v4l2_capability*>(with);
      says = {};
      std::memcpy(says.driver, camera_.driver, sizeof camera_.driver);
      std::memcpy(says.card, camera_.card, sizeof camera_.card);
      std::memcpy(says.bus_info, camera_.bus, sizeof camera_.bus);
      // A camera without modes is the further node that webcams have, for metadata.
      says.device_caps =
          V4L2_CAP_STREAMING | (camera_.mode_count > 0 ? V4L2_CAP_VIDEO_CAPTURE : V4L2_CAP_META_CAPTURE);
      says.capabilities = says.device_caps | V4L2_CAP_DEVICE_CAPS | V4L2_CAP_VIDEO_CAPTURE;
      return 0;
    }
    case VIDIOC_ENUM_FMT:
      return enumerate_format(*static_cast<v4l2_fmtdesc*>(with));
    case VIDIOC_ENUM_FRAMESIZES:
      return enumerate_size(*static_cast<v4l2_frmsizeenum*>(with));
    case VIDIOC_ENUM_FRAMEINTERVALS:
      return enumerate_rate(*static_cast<v4l2_frmivalenum*>(with));
    case VIDIOC_G_INPUT:
      *static_cast<int*>(with) = 0;
      return 0;
    case VIDIOC_S_INPUT:
      return *static_cast<int*>(with) == 0 ? 0 : EINVAL;
    case VIDIOC_ENUMINPUT:
      return enumerate_input(*static_cast<v4l2_input*>(with));
    case VIDIOC_ENUMSTD:
      return enumerate_standard(*static_cast<v4l2_standard*>(with));
    case VIDIOC_QUERYSTD:
    case VIDIOC_G_STD:
      if (camera_.standards == 0) return ENODATA;
      *static_cast<v4l2_std_id*>(with) = camera_.standard;
      return 0;
    case VIDIOC_S_STD:
      if (camera_.standards == 0) return ENODATA;
      camera_.standard = *static_cast<v4l2_std_id*>(with);
      return 0;
    case VIDIOC_TRY_FMT:
      return format(*static_cast<v4l2_format*>(with), false);
    case VIDIOC_S_FMT:
      return format(*static_cast<v4l2_format*>(with), true);
    case VIDIOC_G_PARM:
      return rate(*static_cast<v4l2_streamparm*>(with), false);
    case VIDIOC_S_PARM:
      return rate(*static_cast<v4l2_streamparm*>(with), true);
    case VIDIOC_SUBSCRIBE_EVENT:
      hears_changes_ = true;
      return 0;
    case VIDIOC_DQEVENT: {
      if (changes_ == camera_.source_changes) return ENOENT;
      ++changes_;
      auto& event = *static_cast<v4l2_event*>(with);
      event.type = V4L2_EVENT_SOURCE_CHANGE;
      event.u.src_change.changes = V4L2_EVENT_SRC_CH_RESOLUTION;
      return 0;
    }
    case VIDIOC_REQBUFS:
      return request_buffers(*static_cast<v4l2_requestbuffers*>(with));
    case VIDIOC_QUERYBUF: {
      auto& buffer = *static_cast<v4l2_buffer*>(with);
      buffer.length = static_cast<std::uint32_t>(slot_bytes());
      buffer.m.offset = static_cast<std::uint32_t>(slot_bytes() * buffer.index);
      return 0;
    }
    case VIDIOC_QBUF:
      empty_.push_back(static_cast<v4l2_buffer*>(with)->index);
      return 0;
    case VIDIOC_DQBUF:
      return take(*static_cast<v4l2_buffer*>(with));
    case VIDIOC_STREAMON:
      return start();
    case VIDIOC_STREAMOFF:
      return stop();
    default:
      return ENOTTY;
  }
}

}  // namespace arthronaut::test
