// Inner header: one still picture out of its bytes, and into them. Decoded by the libraries that decode the
// videos: OpenCV's own reader of pictures brings in fifty libraries more, which every start of the
// program would wait for.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "navigation/camera/frame.h"

namespace arthronaut::sources {

// Width, height and colours of `frame`; its luma, too, where the picture has one of its own (JPEG). Whatever
// transparency there is counts for nothing. Empty: done; else what is wrong with the picture, and the frame
// holds nothing that can be relied on.
[[nodiscard]] std::string decode_still(std::span<const std::uint8_t> bytes, camera::Frame& frame);

// Empty: it can't be encoded.
[[nodiscard]] std::string encode_png(const camera::Frame& frame);

}  // namespace arthronaut::sources
