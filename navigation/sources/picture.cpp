#include "navigation/sources/picture.h"

#include <algorithm>
#include <fstream>

#include "navigation/sources/frame_source.h"
#include "navigation/sources/picture_size.h"
#include "navigation/sources/still_codec.h"
#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"

namespace arthronaut::sources {
namespace {

constexpr std::uint64_t kLargestImage_px = 64'000'000;  // twice 8K

std::vector<std::uint8_t> read_bytes(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  // A pipe would be waited for.
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    throw InvalidInput(file, "", "is no file");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw IoError(file, "can't be opened");
  std::vector<std::uint8_t> bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  if (stream.bad()) throw IoError(file, "can't be read");
  if (bytes.empty()) throw InvalidInput(file, "", "is empty");
  return bytes;
}

// A decoder may fill what is missing with grey, and says at best that something is wrong, not what.
bool is_cut_off(const std::vector<std::uint8_t>& bytes) {
  const auto contains_at_end = [&](std::initializer_list<std::uint8_t> mark) {
    const std::size_t tail = std::min<std::size_t>(bytes.size(), 4096);
    return std::search(bytes.end() - static_cast<std::ptrdiff_t>(tail), bytes.end(), mark.begin(),
                       mark.end()) != bytes.end();
  };
  if (bytes.size() < 8) return true;
  if (bytes[0] == 0xFF && bytes[1] == 0xD8) return !contains_at_end({0xFF, 0xD9});
  if (bytes[0] == 0x89 && bytes[1] == 'P') return !contains_at_end({'I', 'E', 'N', 'D'});
  return false;
}

}  // namespace

void read_picture_into(const std::filesystem::path& file, camera::Frame& frame) {
  if (std::filesystem::is_directory(file)) throw InvalidInput(file, "", "is a folder, not a picture");
  const std::vector<std::uint8_t> bytes = read_bytes(file);
  if (is_cut_off(bytes)) throw InvalidInput(file, "", "the picture breaks off before its end");
  const std::optional<PictureSize> size = picture_size(bytes);
  if (!size) throw InvalidInput(file, "", "is not a picture that can be decoded");
  if (size->width == 0 || size->height == 0) throw InvalidInput(file, "", "has no pixels");
  if (size->width > kLargestImage_px / size->height) {
    throw InvalidInput(file, "",
                       "claims " + std::to_string(size->width) + " x " + std::to_string(size->height) +
                           " pixels, more than the " + std::to_string(kLargestImage_px / 1'000'000) +
                           " million that a picture may have");
  }
  if (const std::string problem = decode_still(bytes, frame); !problem.empty())
    throw InvalidInput(file, "", problem);
}

camera::Frame read_picture(const std::filesystem::path& file) {
  camera::Frame frame;
  read_picture_into(file, frame);
  return frame;
}

void write_png(const std::filesystem::path& file, const camera::Frame& picture) {
  const std::string png = encode_png(picture);
  if (png.empty()) throw IoError(file, "the picture can't be encoded");
  files::write_atomically(file, png);
}

}  // namespace arthronaut::sources
