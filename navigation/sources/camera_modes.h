// What a camera can give, what is asked of it, and which of the two comes of it.
//
// A user names a camera as "/dev/video0", and may say more:
// "/dev/video0?format=mjpeg&size=1920x1080&rate=60", of one with an analogue input "standard=pal" (ntsc,
// secam, or as the driver calls it), of one with several inputs "input=1". What is left out is chosen.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace arthronaut::sources {

struct CameraWish {
  std::string format = {};        // as CameraMode::format; empty: chosen
  Eigen::Vector2i size_px{0, 0};  // 0: chosen
  double frames_per_second = 0;   // 0: chosen
  std::string standard = {};      // empty: the one that the driver detects, else has
  std::optional<int> input = {};  // else the one that the driver has
  // That of the calibration: taken where it is on offer and no size is wished.
  Eigen::Vector2i prefers_px{0, 0};
};

struct CameraAddress {
  int index = 0;  // of /dev/videoN
  CameraWish wish = {};
};

// Whether text names a camera, by its form alone: "/dev/videoN", with or without a wish.
[[nodiscard]] bool is_camera_address(std::string_view text);
// Precondition: is_camera_address(). Throws InvalidInput that names what is not understood of the wish.
[[nodiscard]] CameraAddress read_camera_address(std::string_view text);

struct CameraMode {
  // "nv12", "yu12", "p010", "yuyv", "uyvy", "bgr24", "rgb24", "grey", "mjpeg"; of what can't be read, what
  // the driver calls it: "H264".
  std::string format = {};
  Eigen::Vector2i size_px{0, 0};
  double frames_per_second = 0;  // 0: the driver does not say, or what is connected decides
  [[nodiscard]] bool operator==(const CameraMode& other) const = default;
};
[[nodiscard]] std::string size_in_words(const Eigen::Vector2i& size_px);  // "1920 x 1080"
// "1920 x 1080, 60/s, mjpeg".
[[nodiscard]] std::string text_of(const CameraMode& mode);
// "mjpeg, 1920 x 1080, 60/s": what was asked for; empty when nothing was.
[[nodiscard]] std::string text_of(const CameraWish& wish);

// Of the modes that can be read and are as wished: the largest with at least 25 pictures a second (a rate
// that is not known passes); of those the fastest, where more than 60 counts as 60; of those the one that
// costs least to read, in the order above, so that a compressed picture comes last but where it alone is fast
// enough. Where all are slower: the fastest, then the largest. nullopt: none is as wished.
[[nodiscard]] std::optional<CameraMode> choose_mode(std::span<const CameraMode> modes,
                                                    const CameraWish& wish);

}  // namespace arthronaut::sources
