#include "navigation/sources/still_images.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <regex>
#include <string>
#include <vector>

#include "navigation/sources/picture.h"
#include "planning/geometry/error.h"

namespace arthronaut::sources {
namespace {

constexpr double kFramesPerSecond = 60;

// "f_%04d.png" taken apart.
struct Pattern {
  std::string before, after;
  std::size_t width = 0;
  bool zero_filled = false;
};

std::optional<Pattern> parse_pattern(const std::filesystem::path& path) {
  static const std::regex kPattern("(.*)%(0?)([0-9]*)d(.*)");
  std::smatch match;
  const std::string name = path.filename().string();
  if (!std::regex_match(name, match, kPattern)) return std::nullopt;
  Pattern pattern{match[1], match[4], 0, !match[2].str().empty()};
  if (match[3].length() > 2) return std::nullopt;
  if (match[3].length() > 0) pattern.width = std::stoul(match[3]);
  return pattern;
}

// The number in a file's name when it is the one printf would have made of it.
std::optional<long> number_in(const std::string& name, const Pattern& pattern) {
  if (name.size() <= pattern.before.size() + pattern.after.size()) return std::nullopt;
  if (!name.starts_with(pattern.before) || !name.ends_with(pattern.after)) return std::nullopt;
  std::string digits =
      name.substr(pattern.before.size(), name.size() - pattern.before.size() - pattern.after.size());
  const std::size_t width = digits.size();
  if (!pattern.zero_filled) digits.erase(0, std::min(digits.find_first_not_of(' '), digits.size()));
  if (digits.empty() || digits.size() > 9 || digits.find_first_not_of("0123456789") != std::string::npos) {
    return std::nullopt;
  }
  const std::size_t shortest = std::to_string(std::stol(digits)).size();
  if (width != std::max(shortest, pattern.width)) return std::nullopt;
  return std::stol(digits);
}

std::vector<std::filesystem::path> list_pictures(const std::filesystem::path& path) {
  const std::optional<Pattern> pattern = parse_pattern(path);
  if (!pattern) return {path};
  const std::filesystem::path folder = path.parent_path().empty() ? "." : path.parent_path();
  std::error_code error;
  std::filesystem::directory_iterator entries(folder, error);
  if (error) throw IoError(folder, "can't be read: " + error.message());
  std::vector<std::pair<long, std::filesystem::path>> numbered;
  for (const auto& entry : entries) {
    if (const auto number = number_in(entry.path().filename().string(), *pattern)) {
      numbered.emplace_back(*number, entry.path());
    }
  }
  if (numbered.empty()) throw IoError(path, "no picture fits this pattern");
  std::sort(numbered.begin(), numbered.end());
  std::vector<std::filesystem::path> pictures;
  for (const auto& [number, picture] : numbered) {
    const long expected = numbered.front().first + static_cast<long>(pictures.size());
    if (number != expected) throw InvalidInput(path, "picture " + std::to_string(expected), "is missing");
    pictures.push_back(picture);
  }
  return pictures;
}

class StillImages : public FrameSource, public SeekableVideo {
 public:
  explicit StillImages(const std::filesystem::path& pattern) : pictures_(list_pictures(pattern)) {
    first_ = read_picture(pictures_.front());
    info_.name = pattern.filename().string();
    info_.image_size_px = {first_.width, first_.height};
    info_.frames_per_second = kFramesPerSecond;
    info_.frame_count = static_cast<std::int64_t>(pictures_.size());
  }

  const SourceInfo& info() const override { return info_; }

  camera::FramePtr next() override {
    const auto position = static_cast<std::size_t>(next_index_);
    if (position == pictures_.size()) return nullptr;
    auto frame = std::make_shared<camera::Frame>();
    if (position == 0 && !first_.bgr.empty()) {
      *frame = std::move(first_);
    } else {
      read_picture_into(pictures_[position], *frame);
    }
    if (frame->width != info_.image_size_px.x() || frame->height != info_.image_size_px.y()) {
      throw InvalidInput(pictures_[position], "", "has another size than the pictures before it");
    }
    frame->index = next_index_;
    frame->timestamp_ns =
        static_cast<std::int64_t>(static_cast<double>(next_index_) / kFramesPerSecond * 1e9 + 0.5);
    ++next_index_;
    return frame;
  }

  camera::FramePtr picture_at(std::int64_t time_ns, const OnTheWay& /*none is passed*/) override {
    next_index_ = std::llround(static_cast<double>(time_ns) * 1e-9 * kFramesPerSecond);
    if (next_index_ < 0 || next_index_ >= info_.frame_count) return nullptr;
    return next();
  }

 private:
  std::vector<std::filesystem::path> pictures_;
  SourceInfo info_;
  camera::Frame first_;  // decoded on opening, to learn the size
  std::int64_t next_index_ = 0;
};

}  // namespace

bool is_printf_pattern(const std::filesystem::path& path) { return parse_pattern(path).has_value(); }

std::unique_ptr<FrameSource> open_still_images(const std::filesystem::path& pattern) {
  return std::make_unique<StillImages>(pattern);
}

std::unique_ptr<SeekableVideo> open_seekable_stills(const std::filesystem::path& pattern) {
  return std::make_unique<StillImages>(pattern);
}

}  // namespace arthronaut::sources
