// How a session keeps its pictures, and where each of them lies.
//
// A video is a row of parts, each a file of its own: a stream that breaks off and comes back, and one that
// cannot be kept as it came for a while, begins a new part. Within a part nothing changes: one decoder gives
// all of it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "navigation/camera/frame.h"

namespace arthronaut::recording {

enum class PicturesAs {
  AsTheyCame,  // the stream's own packets, as they came over the network; what cannot be kept so: Lossless
  Lossless,    // Ut Video: luma to the last bit, colour for the eye
  H264,        // a sixth of that on the disk; tracked again, poses differ slightly
};
// "as they came", "lossless", "H.264".
[[nodiscard]] std::string_view to_text(PicturesAs as);
// As a command's option and a file say it: "as-they-came", "lossless", "h264". Throws InvalidInput.
[[nodiscard]] std::string_view to_option(PicturesAs as);
[[nodiscard]] PicturesAs pictures_as_from_option(std::string_view option);

struct VideoPart {
  std::string file;                // within the session's folder
  std::int64_t first_picture = 0;  // of the session's pictures
  PicturesAs as = PicturesAs::Lossless;
  std::string codec = {};  // libavcodec's name of it
  int held_back = 0;       // sources::KeptStreamFile
};

// A picture of a video that the recorder wrote.
struct KeptPicture {
  std::int64_t frame = 0;         // of the session
  std::int64_t packet = 0;        // in its part's file, from 0
  std::int64_t start_packet = 0;  // where decoding must begin to come to it, and when that is in the file
  std::int64_t start_ms = 0;
  std::optional<std::uint64_t> luma = std::nullopt;  // digest_of_luma(); records of before have none
};

// The part that a picture is in: an index into parts, which begin at picture 0. Precondition: there are some.
[[nodiscard]] std::size_t part_of(const std::vector<VideoPart>& parts, std::int64_t picture);

// Of a picture as it is tracked: the same number for the same bytes, another one for others, but for chance.
[[nodiscard]] std::uint64_t digest_of_luma(const camera::GrayView& luma);

}  // namespace arthronaut::recording
