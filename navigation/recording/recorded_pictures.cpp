#include "navigation/recording/recorded_pictures.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "navigation/sources/source_files.h"
#include "navigation/sources/still_images.h"
#include "navigation/sources/video_file.h"
#include "planning/geometry/error.h"

namespace arthronaut::recording {

namespace {

std::unique_ptr<sources::SeekableVideo> open(const SessionOverview& session) {
  const std::filesystem::path video = session.video();
  if (video.empty()) throw InvalidInput(session.folder, "", "no video was kept of this session");
  const bool is_there = std::filesystem::exists(video);
  if (is_there ? sources::looks_like_picture(video) : sources::is_printf_pattern(video))
    return sources::open_seekable_stills(video);
  if (!is_there) throw IoError(video, "the video is not there any more");
  return sources::open_seekable_video(
      video, session.header.video_has_exact_luma ? sources::LumaOf::File : sources::LumaOf::Colours);
}

}  // namespace

struct RecordedPictures::State {
  std::unique_ptr<sources::SeekableVideo> video;
  bool is_reencoded = false;
  std::vector<std::int64_t> frame_of_picture;  // rising
};

RecordedPictures::RecordedPictures(const SessionOverview& session) : state_(std::make_unique<State>()) {
  state_->video = open(session);
  state_->is_reencoded = session.header.video_is_reencoded;
  state_->frame_of_picture = session.frame_of_picture;
}

RecordedPictures::~RecordedPictures() = default;

camera::FramePtr RecordedPictures::picture(std::int64_t frame_index, std::int64_t timestamp_ns) {
  State& s = *state_;
  std::int64_t time_ns = timestamp_ns;  // of a source's own file: frames have its times
  if (s.is_reencoded) {
    const auto found = std::lower_bound(s.frame_of_picture.begin(), s.frame_of_picture.end(), frame_index);
    if (found == s.frame_of_picture.end() || *found != frame_index) return nullptr;
    const auto number = static_cast<double>(found - s.frame_of_picture.begin());
    time_ns = std::llround(number / s.video->info().frames_per_second * 1e9);
  }
  const camera::FramePtr picture = s.video->picture_at(time_ns);
  if (picture == nullptr) return nullptr;
  auto frame = std::make_shared<camera::Frame>(*picture);
  frame->index = frame_index;
  frame->timestamp_ns = timestamp_ns;
  return frame;
}

}  // namespace arthronaut::recording
