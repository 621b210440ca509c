#include "navigation/recording/kept_video.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "planning/geometry/error.h"

namespace arthronaut::recording {

namespace {

struct Name {
  PicturesAs as;
  std::string_view text, option;
};
constexpr std::array kPictureNames = {Name{PicturesAs::AsTheyCame, "as they came", "as-they-came"},
                                      Name{PicturesAs::Lossless, "lossless", "lossless"},
                                      Name{PicturesAs::H264, "H.264", "h264"}};

const Name& name_of(PicturesAs as) { return kPictureNames[static_cast<std::size_t>(as)]; }

std::uint64_t mixed(std::uint64_t digest, std::uint64_t with) {
  digest = (digest ^ with) * 0x9E3779B97F4A7C15U;
  return digest ^ digest >> 29;
}

}  // namespace

std::string_view to_text(PicturesAs as) { return name_of(as).text; }
std::string_view to_option(PicturesAs as) { return name_of(as).option; }

PicturesAs pictures_as_from_option(std::string_view option) {
  for (const Name& name : kPictureNames)
    if (name.option == option) return name.as;
  throw InvalidInput("pictures are kept \"as-they-came\", \"lossless\" or \"h264\", not \"" +
                     std::string(option) + "\"");
}

std::size_t part_of(const std::vector<VideoPart>& parts, std::int64_t picture) {
  const auto after = std::upper_bound(
      parts.begin() + 1, parts.end(), picture,
      [](std::int64_t number, const VideoPart& part) { return number < part.first_picture; });
  return static_cast<std::size_t>(after - parts.begin()) - 1;
}

std::uint64_t digest_of_luma(const camera::GrayView& luma) {
  // Four at a time, since each waits for its own last product alone.
  constexpr std::size_t kLanes = 4;
  std::array<std::uint64_t, kLanes> lanes = {1, 2, 3, 4};
  std::array<std::uint64_t, kLanes> words{};
  const auto width = static_cast<std::size_t>(luma.width);
  for (int y = 0; y < luma.height; ++y) {
    const std::uint8_t* const row = luma.row(y);
    std::size_t x = 0;
    for (; x + sizeof words <= width; x += sizeof words) {
      std::memcpy(words.data(), row + x, sizeof words);
      for (std::size_t i = 0; i < kLanes; ++i) lanes[i] = mixed(lanes[i], words[i]);
    }
    words = {};
    std::memcpy(words.data(), row + x, width - x);
    for (std::size_t i = 0; i < kLanes; ++i) lanes[i] = mixed(lanes[i], words[i]);
  }
  std::uint64_t digest = width;
  for (const std::uint64_t lane : lanes) digest = mixed(digest, lane);
  return digest;
}

}  // namespace arthronaut::recording
