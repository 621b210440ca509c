#include "navigation/recording/recorded_pictures.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "navigation/recording/cut_short.h"
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

camera::FramePtr with_names(const camera::Frame& picture, std::int64_t index, std::int64_t timestamp_ns) {
  auto frame = std::make_shared<camera::Frame>(picture);
  frame->index = index;
  frame->timestamp_ns = timestamp_ns;
  return frame;
}

// What is passed, by the names that the session has for it.
template <typename Rename>
sources::OnTheWay renamed(const sources::OnTheWay& on_the_way, const Rename& rename) {
  if (!on_the_way) return {};
  return [&on_the_way, rename](const auto& passed) {
    return on_the_way([&]() -> camera::FramePtr {
      const camera::FramePtr picture = passed();
      return picture == nullptr ? nullptr : rename(*picture);
    });
  };
}

}  // namespace

struct RecordedPictures::State {
  // False: a crash or a full disk has left the part behind before it held anything.
  bool open_if_begun(std::size_t wanted) {
    try {
      open(wanted);
    } catch (const InvalidInput&) {
      if (!is_cut_short) throw;
      return false;
    }
    return true;
  }

  // The part in hand, by the one or the other.
  void open(std::size_t wanted) {
    if (part == wanted && (video != nullptr || stream != nullptr)) return;
    video.reset();
    video_before.reset();
    stream.reset();
    stream_before.reset();
    part = wanted;
    const std::filesystem::path file = folder / parts[wanted].file;
    if (!std::filesystem::exists(file)) throw IoError(file, "the video is not there any more");
    if (parts[wanted].as == PicturesAs::AsTheyCame) {
      stream = open_stream();
    } else {
      const auto luma =
          parts[wanted].as == PicturesAs::Lossless ? sources::LumaOf::File : sources::LumaOf::Colours;
      open_video = [file, luma] { return sources::open_seekable_video(file, luma); };
      video = open_video();
    }
  }

  [[nodiscard]] std::unique_ptr<sources::KeptStream> open_stream() const {
    return std::make_unique<sources::KeptStream>(kept_stream_file(folder, parts, part, session->pictures),
                                                 sources::KeptStream::Use::ToLookAt);
  }

  // The one of that packet, which was passed on the way to pictures[number]; null: no frame has it.
  [[nodiscard]] const KeptPicture* passed_before(std::size_t number, std::int64_t packet) const {
    const std::int64_t start = pictures[number].start_packet;
    for (std::size_t i = number; i-- > 0 && pictures[i].start_packet == start;)
      if (pictures[i].packet == packet) return &pictures[i];
    return nullptr;
  }

  camera::FramePtr picture_of(std::size_t number, const sources::OnTheWay& on_the_way) {
    if (!open_if_begun(part_of(parts, static_cast<std::int64_t>(number)))) return nullptr;
    const std::int64_t packet = pictures[number].packet;
    if (stream != nullptr) {
      if (stream_before != nullptr && !stream->remembers(packet) && stream_before->remembers(packet))
        std::swap(stream, stream_before);
      return stream->picture(packet, renamed(on_the_way, [this, number](const camera::Frame& passed) {
                               const KeptPicture* const kept = passed_before(number, passed.packet);
                               return kept == nullptr ? nullptr : with_names(passed, kept->frame, -1);
                             }));
    }
    return picture_at(std::llround(static_cast<double>(packet) / video->info().frames_per_second * 1e9));
  }

  camera::FramePtr picture_at(std::int64_t time_ns, const sources::OnTheWay& on_the_way = {}) {
    if (video_before != nullptr && !video->remembers(time_ns) && video_before->remembers(time_ns))
      std::swap(video, video_before);
    return video->picture_at(time_ns, on_the_way);
  }

  void read_before_stream(const std::function<bool()>& goes_on) {
    const auto first = stream->first_remembered();
    if (!first || *first == 0) return;
    if (stream_before == nullptr) stream_before = open_stream();
    if (stream_before->remembers(*first - 1)) return;
    (void)stream_before->picture(*first - 1, [&goes_on](const auto& /*passed*/) { return goes_on(); });
  }

  void read_before_video(const std::function<bool()>& goes_on) {
    const auto first = video->first_remembered_ns();
    const double rate = video->info().frames_per_second;
    if (!first || rate <= 0) return;
    const std::int64_t wanted = *first - std::llround(1e9 / rate);
    if (wanted < 0) return;
    if (video_before == nullptr) video_before = open_video();
    if (video_before->remembers(wanted)) return;
    (void)video_before->picture_at(wanted, [&goes_on](const auto& /*passed*/) { return goes_on(); });
  }

  std::shared_ptr<const SessionOverview> session;
  std::filesystem::path folder;
  std::vector<VideoPart> parts;           // empty: the source's own video
  std::span<const KeptPicture> pictures;  // of the session, by rising frames
  bool is_cut_short = false;
  std::size_t part = 0;
  // Of the part in hand, or the source's own. `before`: the same file, at what lies before; null: nobody went
  // back.
  std::function<std::unique_ptr<sources::SeekableVideo>()> open_video;
  std::unique_ptr<sources::SeekableVideo> video, video_before;
  std::unique_ptr<sources::KeptStream> stream, stream_before;
};

RecordedPictures::RecordedPictures(SessionOverview session)
    : RecordedPictures(std::make_shared<const SessionOverview>(std::move(session))) {}

RecordedPictures::RecordedPictures(std::shared_ptr<const SessionOverview> of)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.session = std::move(of);
  const SessionOverview& session = *s.session;
  if (session.video().empty()) throw InvalidInput(session.folder, "", "no video was kept of this session");
  s.folder = session.folder;
  s.parts = parts_of(session.header);
  s.pictures = session.pictures;
  s.is_cut_short = !cut_short_in_words(session.was_finished, session.events).empty();
  if (!s.parts.empty()) {
    s.open(0);
    return;
  }
  s.open_video = [whole = s.session] { return open_own(*whole); };
  s.video = s.open_video();
}

RecordedPictures::~RecordedPictures() = default;

camera::FramePtr RecordedPictures::picture(std::int64_t frame_index, std::int64_t timestamp_ns,
                                           const sources::OnTheWay& on_the_way) {
  State& s = *state_;
  camera::FramePtr picture;
  if (s.parts.empty()) {
    picture = s.picture_at(timestamp_ns, renamed(on_the_way, [](const camera::Frame& passed) {
                             return with_names(passed, -1, passed.timestamp_ns);
                           }));
  } else {
    const auto found =
        std::lower_bound(s.pictures.begin(), s.pictures.end(), frame_index,
                         [](const KeptPicture& kept, std::int64_t frame) { return kept.frame < frame; });
    if (found == s.pictures.end() || found->frame != frame_index) return nullptr;
    picture = s.picture_of(static_cast<std::size_t>(found - s.pictures.begin()), on_the_way);
  }
  return picture == nullptr ? nullptr : with_names(*picture, frame_index, timestamp_ns);
}

void RecordedPictures::read_before_remembered(const std::function<bool()>& goes_on) {
  State& s = *state_;
  if (s.stream != nullptr)
    s.read_before_stream(goes_on);
  else if (s.video != nullptr)
    s.read_before_video(goes_on);
}

}  // namespace arthronaut::recording
