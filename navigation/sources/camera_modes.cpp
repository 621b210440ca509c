#include "navigation/sources/camera_modes.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <tuple>

#include "navigation/sources/pixel_formats.h"
#include "planning/files/format.h"
#include "planning/geometry/error.h"

namespace arthronaut::sources {

namespace {

constexpr std::string_view kCamera = "/dev/video";
// Fewer pictures a second than television gives are too few to guide a hand by; more than 60 are more than
// any screen shows.
constexpr double kSlowest = 25, kFastest = 60;
// 30000/1001 is what is meant by 30, and 24.99 is 25.
constexpr double kSameRate = 0.05;

template <typename Number>
std::optional<Number> whole_number(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

// "/dev/video2?..." : 2 and "...".
struct AddressParts {
  int index = 0;
  std::string_view wish;
};

std::optional<AddressParts> parts_of(std::string_view text) {
  if (!text.starts_with(kCamera)) return std::nullopt;
  const std::size_t mark = text.find('?');
  const auto index = whole_number<int>(
      text.substr(kCamera.size(), mark == std::string_view::npos ? mark : mark - kCamera.size()));
  if (!index || *index < 0) return std::nullopt;
  return AddressParts{*index, mark == std::string_view::npos ? "" : text.substr(mark + 1)};
}

class WishReader {
 public:
  explicit WishReader(std::string_view address) : address_(address) {}

  // "key=value".
  void take(std::string_view part, CameraWish& wish) const {
    const std::size_t equals = part.find('=');
    const std::string_view key = part.substr(0, equals);
    const std::string_view value = equals == std::string_view::npos ? "" : part.substr(equals + 1);
    if (key == "format")
      wish.format = format(value);
    else if (key == "size")
      wish.size_px = size(value);
    else if (key == "rate")
      wish.frames_per_second = rate(value);
    else if (key == "standard" && !value.empty())
      wish.standard = value;
    else if (key == "input")
      wish.input = input(value);
    else
      refuse(part, "format=, size=, rate=, standard= or input= may stand here");
  }

 private:
  [[noreturn]] void refuse(std::string_view what, const std::string& why) const {
    throw InvalidInput(std::string(address_), "", "\"" + std::string(what) + "\": " + why);
  }
  [[nodiscard]] std::string format(std::string_view value) const {
    if (find_pixel_format(value) != nullptr) return std::string(value);
    std::string known;
    for (const PixelFormat& one : pixel_formats())
      if (known.find(one.name) == std::string::npos)
        known += (known.empty() ? "" : ", ") + std::string(one.name);
    refuse(value, "is no format that can be read: " + known);
  }
  [[nodiscard]] Eigen::Vector2i size(std::string_view value) const {
    const std::size_t by = value.find('x');
    if (by != std::string_view::npos) {
      const auto width = whole_number<int>(value.substr(0, by));
      const auto height = whole_number<int>(value.substr(by + 1));
      if (width && height && *width > 0 && *height > 0) return {*width, *height};
    }
    refuse(value, "is no size: 1920x1080");
  }
  [[nodiscard]] double rate(std::string_view value) const {
    if (const auto number = whole_number<double>(value); number && *number > 0 && *number <= 1000)
      return *number;
    refuse(value, "is no rate, in pictures a second: 60");
  }
  [[nodiscard]] int input(std::string_view value) const {
    if (const auto number = whole_number<int>(value); number && *number >= 0) return *number;
    refuse(value, "is no input: they are counted from 0");
  }

  std::string_view address_;
};

bool is_as_wished(const CameraMode& mode, const CameraWish& wish) {
  if (find_pixel_format(mode.format) == nullptr) return false;
  if (!wish.format.empty() && mode.format != wish.format) return false;
  if (wish.size_px.x() > 0 && mode.size_px != wish.size_px) return false;
  // Where the driver does not say, what comes decides.
  return wish.frames_per_second <= 0 || mode.frames_per_second <= 0 ||
         std::abs(mode.frames_per_second - wish.frames_per_second) < kSameRate * wish.frames_per_second;
}

// The greater the better.
auto worth_of(const CameraMode& mode) {
  const double rate = mode.frames_per_second <= 0 ? kFastest : std::min(mode.frames_per_second, kFastest);
  const bool is_fast_enough = rate > kSlowest - kSameRate;
  // A camera of 59.94 is no slower than one of 60.
  const long steps = std::lround(rate);
  const long area = static_cast<long>(mode.size_px.x()) * mode.size_px.y();
  const auto cost = find_pixel_format(mode.format) - pixel_formats().data();
  return is_fast_enough ? std::tuple(1L, area, steps, -cost) : std::tuple(0L, steps, area, -cost);
}

}  // namespace

bool is_camera_address(std::string_view text) { return parts_of(text).has_value(); }

CameraAddress read_camera_address(std::string_view text) {
  const AddressParts parts = parts_of(text).value();
  CameraAddress address{parts.index};
  const WishReader reader(text);
  std::string_view rest = parts.wish;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('&'), rest.size());
    reader.take(rest.substr(0, end), address.wish);
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return address;
}

std::string size_in_words(const Eigen::Vector2i& size_px) {
  return std::to_string(size_px.x()) + " x " + std::to_string(size_px.y());
}

std::string text_of(const CameraMode& mode) {
  const std::string rate =
      mode.frames_per_second > 0 ? files::format(", %.4g/s", mode.frames_per_second) : "";
  return size_in_words(mode.size_px) + rate + ", " + mode.format;
}

std::string text_of(const CameraWish& wish) {
  std::string text = wish.format;
  const auto add = [&](const std::string& more) { text += (text.empty() ? "" : ", ") + more; };
  if (wish.size_px.x() > 0) add(size_in_words(wish.size_px));
  if (wish.frames_per_second > 0) add(files::format("%.4g/s", wish.frames_per_second));
  return text;
}

std::optional<CameraMode> choose_mode(std::span<const CameraMode> modes, const CameraWish& wish) {
  if (wish.size_px.x() <= 0 && wish.prefers_px.x() > 0) {
    CameraWish with_size = wish;
    with_size.size_px = wish.prefers_px;
    if (const auto chosen = choose_mode(modes, with_size)) return chosen;
  }
  const CameraMode* best = nullptr;
  for (const CameraMode& mode : modes) {
    if (!is_as_wished(mode, wish)) continue;
    if (best == nullptr || worth_of(mode) > worth_of(*best)) best = &mode;
  }
  return best != nullptr ? std::optional(*best) : std::nullopt;
}

}  // namespace arthronaut::sources
