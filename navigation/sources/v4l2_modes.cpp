// The modes, inputs and standards of a camera: what v4l2_device.h declares of them.
#include <algorithm>
#include <array>
#include <cctype>

#include "navigation/sources/pixel_formats.h"
#include "navigation/sources/v4l2_device.h"
#include "planning/geometry/error.h"

namespace arthronaut::sources {

namespace {

// No driver has so many of anything; one that counts without end is not followed.
constexpr std::uint32_t kMost = 256;

// Of a driver that takes any rate or size between two: those in use.
constexpr std::array kUsualRates{60.0, 50.0, 30.0, 25.0};
constexpr std::array<std::array<int, 2>, 6> kUsualSizes{
    {{3840, 2160}, {1920, 1080}, {1280, 720}, {720, 576}, {720, 480}, {640, 480}}};

double rate_from(const v4l2_fract& interval) {
  return interval.numerator > 0 ? static_cast<double>(interval.denominator) / interval.numerator : 0;
}

class ModeList {
 public:
  ModeList(const V4l2Device& device, const CameraWish& wish) : device_(device), wish_(wish) {}

  std::vector<CameraMode> all() {
    for (v4l2_fmtdesc format{}; format.index < kMost; ++format.index) {
      format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
      if (device_.request(VIDIOC_ENUM_FMT, &format) != 0) break;
      add_sizes(format.pixelformat);
    }
    return std::move(modes_);
  }

 private:
  void add_sizes(std::uint32_t fourcc) {
    v4l2_frmsizeenum size{};
    size.pixel_format = fourcc;
    for (; size.index < kMost; ++size.index) {
      if (device_.request(VIDIOC_ENUM_FRAMESIZES, &size) != 0) break;
      if (size.type != V4L2_FRMSIZE_TYPE_DISCRETE) return add_sizes_between(fourcc, size.stepwise);
      add_rates(fourcc, size.discrete.width, size.discrete.height);
    }
    if (size.index == 0) add_size_of_signal(fourcc);
  }

  void add_sizes_between(std::uint32_t fourcc, const v4l2_frmsize_stepwise& range) {
    const auto add = [&](std::uint32_t width, std::uint32_t height) {
      const auto fits = [](std::uint32_t at, std::uint32_t least, std::uint32_t most, std::uint32_t step) {
        return at >= least && at <= most && (step == 0 || (at - least) % step == 0);
      };
      if (fits(width, range.min_width, range.max_width, range.step_width) &&
          fits(height, range.min_height, range.max_height, range.step_height))
        add_rates(fourcc, width, height);
    };
    const std::size_t before = modes_.size();
    for (const auto& [width, height] : kUsualSizes)
      add(static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height));
    for (const Eigen::Vector2i& size_px : {wish_.size_px, wish_.prefers_px})
      if (size_px.x() > 0)
        add(static_cast<std::uint32_t>(size_px.x()), static_cast<std::uint32_t>(size_px.y()));
    if (modes_.size() == before) add_rates(fourcc, range.max_width, range.max_height);
  }

  // A capture card that tells no sizes gives that of the signal, whatever is asked for.
  void add_size_of_signal(std::uint32_t fourcc) {
    v4l2_format format{};
    format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    format.fmt.pix.pixelformat = fourcc;
    const bool is_wished = wish_.size_px.x() > 0;
    format.fmt.pix.width = is_wished ? static_cast<std::uint32_t>(wish_.size_px.x()) : 8192;
    format.fmt.pix.height = is_wished ? static_cast<std::uint32_t>(wish_.size_px.y()) : 4320;
    if (device_.request(VIDIOC_TRY_FMT, &format) != 0 || format.fmt.pix.pixelformat != fourcc) return;
    add_rates(fourcc, format.fmt.pix.width, format.fmt.pix.height);
  }

  void add_rates(std::uint32_t fourcc, std::uint32_t width, std::uint32_t height) {
    v4l2_frmivalenum rate{};
    rate.pixel_format = fourcc;
    rate.width = width;
    rate.height = height;
    for (; rate.index < kMost; ++rate.index) {
      if (device_.request(VIDIOC_ENUM_FRAMEINTERVALS, &rate) != 0) break;
      if (rate.type != V4L2_FRMIVAL_TYPE_DISCRETE) {
        const double fastest = rate_from(rate.stepwise.min), slowest = rate_from(rate.stepwise.max);
        add(fourcc, width, height, fastest);
        for (const double usual : kUsualRates)
          if (usual < fastest && usual >= slowest) add(fourcc, width, height, usual);
        return;
      }
      add(fourcc, width, height, rate_from(rate.discrete));
    }
    if (rate.index == 0) add(fourcc, width, height, 0);
  }

  void add(std::uint32_t fourcc, std::uint32_t width, std::uint32_t height, double rate) {
    CameraMode mode{format_name(fourcc), {static_cast<int>(width), static_cast<int>(height)}, rate};
    if (std::find(modes_.begin(), modes_.end(), mode) == modes_.end()) modes_.push_back(std::move(mode));
  }

  const V4l2Device& device_;
  const CameraWish& wish_;
  std::vector<CameraMode> modes_;
};

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return text;
}

// Every standard of the input in use, by the driver's names.
template <typename Visit>
void for_each_standard(const V4l2Device& device, const Visit& visit) {
  for (v4l2_standard standard{}; standard.index < kMost; ++standard.index) {
    if (device.request(VIDIOC_ENUMSTD, &standard) != 0) break;
    visit(standard.id, driver_text(standard.name, sizeof standard.name));
  }
}

v4l2_std_id family_of(const std::string& name) {
  if (name == "pal") return V4L2_STD_PAL;
  if (name == "ntsc") return V4L2_STD_NTSC;
  if (name == "secam") return V4L2_STD_SECAM;
  return 0;
}

void take_standard(const V4l2Device& device, const std::string& wished) {
  v4l2_std_id known = 0, standard = 0;
  std::string names;
  for_each_standard(device, [&](v4l2_std_id id, const std::string& name) {
    known |= id;
    names += (names.empty() ? "" : ", ") + name;
    if (!wished.empty() && lower(name) == lower(wished)) standard = id;
  });
  if (wished.empty()) {
    // Where nothing is detected all are possible; the driver's own stays.
    if (known == 0 || device.request(VIDIOC_QUERYSTD, &standard) != 0) return;
    if (standard == 0 || (standard & known) == known) return;
  } else if (standard == 0) {
    standard = family_of(lower(wished)) & known;
  }
  if (standard == 0)
    throw DeviceError(device.name() + ": knows no standard \"" + wished +
                      "\": " + (names.empty() ? "its input has none" : names));
  if (const int error = device.request(VIDIOC_S_STD, &standard); error != 0)
    device.fail("does not take the standard " + wished, error);
}

}  // namespace

std::vector<CameraMode> modes_of(const V4l2Device& device, const CameraWish& wish) {
  return ModeList(device, wish).all();
}

std::vector<CameraInput> inputs_of(const V4l2Device& device) {
  std::vector<CameraInput> inputs;
  int in_use = -1;
  if (device.request(VIDIOC_G_INPUT, &in_use) != 0) in_use = -1;
  for (v4l2_input input{}; input.index < kMost; ++input.index) {
    if (device.request(VIDIOC_ENUMINPUT, &input) != 0) break;
    CameraInput one{.index = static_cast<int>(input.index),
                    .name = driver_text(input.name, sizeof input.name)};
    one.is_in_use = one.index == in_use;
    if (one.is_in_use) {
      one.trouble = signal_trouble(device);
      v4l2_std_id set = 0;
      const bool has_standard = device.request(VIDIOC_G_STD, &set) == 0;
      for_each_standard(device, [&](v4l2_std_id id, const std::string& name) {
        one.standards.push_back(name);
        if (has_standard && one.standard.empty() && (id & set) == set && set != 0) one.standard = name;
      });
    }
    inputs.push_back(std::move(one));
  }
  return inputs;
}

void take_input(const V4l2Device& device, const CameraWish& wish) {
  if (wish.input) {
    int index = *wish.input;
    if (device.request(VIDIOC_S_INPUT, &index) != 0)
      throw DeviceError(device.name() + ": has no input " + std::to_string(*wish.input));
  }
  take_standard(device, wish.standard);
  // Of an input that does not count what comes (a webcam) there are none.
  v4l2_dv_timings timings{};
  if (device.request(VIDIOC_QUERY_DV_TIMINGS, &timings) == 0)
    (void)device.request(VIDIOC_S_DV_TIMINGS, &timings);
}

}  // namespace arthronaut::sources
