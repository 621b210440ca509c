#include "navigation/recording/recorded_pictures.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "navigation/recording/kept_pictures.h"
#include "navigation/sources/source_files.h"
#include "navigation/sources/still_images.h"
#include "navigation/sources/video_file.h"
#include "planning/geometry/error.h"

namespace arthronaut::recording {

namespace {

std::unique_ptr<sources::SeekableVideo> open_own(const SessionOverview& session) {
  const std::filesystem::path video = session.video();
  const bool is_there = std::filesystem::exists(video);
  if (is_there ? sources::looks_like_picture(video) : sources::is_printf_pattern(video))
    return sources::open_seekable_stills(video);
  if (!is_there) throw IoError(video, "the video is not there any more");
  return sources::open_seekable_video(
      video, session.header.video_has_exact_luma ? sources::LumaOf::File : sources::LumaOf::Colours);
}

}  // namespace

struct RecordedPictures::State {
  // The part in hand, by the one or the other.
  void open(std::size_t wanted) {
    if (part == wanted && (video != nullptr || stream)) return;
    video.reset();
    stream.reset();
    part = wanted;
    const std::filesystem::path file = folder / parts[wanted].file;
    if (!std::filesystem::exists(file)) throw IoError(file, "the video is not there any more");
    if (parts[wanted].as == PicturesAs::AsTheyCame)
      stream.emplace(kept_stream_file(folder, parts, wanted, pictures), sources::KeptStream::Use::ToLookAt);
    else
      video = sources::open_seekable_video(
          file, parts[wanted].as == PicturesAs::Lossless ? sources::LumaOf::File : sources::LumaOf::Colours);
  }

  camera::FramePtr picture_of(std::size_t number) {
    open(part_of(parts, static_cast<std::int64_t>(number)));
    const std::int64_t packet = pictures[number].packet;
    if (stream) return stream->picture(packet);
    return video->picture_at(
        std::llround(static_cast<double>(packet) / video->info().frames_per_second * 1e9));
  }

  std::filesystem::path folder;
  std::vector<VideoPart> parts;       // empty: the source's own video
  std::vector<KeptPicture> pictures;  // by rising frames
  std::size_t part = 0;
  std::unique_ptr<sources::SeekableVideo> video;
  std::optional<sources::KeptStream> stream;
};

RecordedPictures::RecordedPictures(const SessionOverview& session) : state_(std::make_unique<State>()) {
  State& s = *state_;
  if (session.video().empty()) throw InvalidInput(session.folder, "", "no video was kept of this session");
  s.folder = session.folder;
  s.parts = parts_of(session.header);
  s.pictures = session.pictures;
  if (s.parts.empty())
    s.video = open_own(session);
  else
    s.open(0);
}

RecordedPictures::~RecordedPictures() = default;

camera::FramePtr RecordedPictures::picture(std::int64_t frame_index, std::int64_t timestamp_ns) {
  State& s = *state_;
  camera::FramePtr picture;
  if (s.parts.empty()) {
    picture = s.video->picture_at(timestamp_ns);
  } else {
    const auto found =
        std::lower_bound(s.pictures.begin(), s.pictures.end(), frame_index,
                         [](const KeptPicture& kept, std::int64_t frame) { return kept.frame < frame; });
    if (found == s.pictures.end() || found->frame != frame_index) return nullptr;
    picture = s.picture_of(static_cast<std::size_t>(found - s.pictures.begin()));
  }
  if (picture == nullptr) return nullptr;
  auto frame = std::make_shared<camera::Frame>(*picture);
  frame->index = frame_index;
  frame->timestamp_ns = timestamp_ns;
  return frame;
}

}  // namespace arthronaut::recording
