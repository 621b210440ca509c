#include <algorithm>
#include <unordered_map>

#include "navigation/recording/cut_short.h"
#include "navigation/recording/kept_pictures.h"
#include "navigation/recording/session.h"
#include "planning/geometry/error.h"

namespace arthronaut::recording {

namespace {

// Pictures under the indices and timestamps of the session's frames.
class FramesOfPictures {
 public:
  explicit FramesOfPictures(const RecordedSession& session) {
    for (const RecordedFrame& frame : session.frames()) timestamps_[frame.index] = frame.timestamp_ns;
  }
  [[nodiscard]] std::int64_t count() const { return static_cast<std::int64_t>(timestamps_.size()); }
  // Null: the record has no such frame.
  [[nodiscard]] camera::FramePtr frame_of(const camera::Frame& picture, std::int64_t index) const {
    const auto timestamp = timestamps_.find(index);
    if (timestamp == timestamps_.end()) return nullptr;
    auto frame = std::make_shared<camera::Frame>(picture);
    frame->index = index;
    frame->timestamp_ns = timestamp->second;
    return frame;
  }

 private:
  std::unordered_map<std::int64_t, std::int64_t> timestamps_;
};

// The source's own video: picture = frame.
class OwnVideo final : public sources::FrameSource {
 public:
  explicit OwnVideo(const RecordedSession& session)
      : video_(sources::open_video(session.video())), info_(video_->info()), frames_(session) {
    info_.name = session.header().id;
    info_.kind = sources::SourceKind::Recording;
    info_.frame_count = frames_.count();
  }
  const sources::SourceInfo& info() const override { return info_; }
  camera::FramePtr next() override {
    while (given_ < info_.frame_count) {
      const camera::FramePtr picture = video_->next();
      if (picture == nullptr) return nullptr;
      camera::FramePtr frame = frames_.frame_of(*picture, picture->index);
      if (frame == nullptr) continue;
      ++given_;
      return frame;
    }
    return nullptr;
  }

 private:
  std::unique_ptr<sources::FrameSource> video_;
  sources::SourceInfo info_;
  FramesOfPictures frames_;
  std::int64_t given_ = 0;
};

// The recorder's video, part after part.
class RecordedVideo final : public sources::FrameSource {
 public:
  explicit RecordedVideo(const RecordedSession& session)
      : folder_(session.folder()),
        parts_(parts_of(session.header())),
        may_break_off_(!cut_short_in_words(session.was_finished(), session.events()).empty()),
        pictures_(session.pictures()),
        frames_(session) {
    open(0);
    info_ = video_->info();
    info_.name = session.header().id;
    info_.kind = sources::SourceKind::Recording;
    info_.encoded_file = session.video();
    info_.frame_count = std::min(frames_.count(), static_cast<std::int64_t>(pictures_.size()));
  }

  const sources::SourceInfo& info() const override { return info_; }

  camera::FramePtr next() override {
    // Counting stops at the last recorded frame: the picture after it may be the one that a crash cut off.
    while (given_ < info_.frame_count) {
      const camera::FramePtr picture = next_picture();
      if (picture == nullptr) {
        if (!open_next()) return nullptr;
        continue;
      }
      const auto index = frame_of_packet_.find(picture->packet);
      if (index == frame_of_packet_.end()) continue;
      camera::FramePtr frame = frames_.frame_of(*picture, index->second);
      if (frame == nullptr) continue;
      ++given_;
      return frame;
    }
    return nullptr;
  }

 private:
  void open(std::size_t part) {
    part_ = part;
    video_ = open_part(folder_, parts_, part);
    frame_of_packet_.clear();
    for (const KeptPicture& picture : pictures_of(parts_, part, pictures_))
      frame_of_packet_[picture.packet] = picture.frame;
  }

  // A crash or a full disk may have left a part behind that was announced and holds nothing yet.
  bool open_next() {
    if (part_ + 1 == parts_.size()) return false;
    try {
      open(part_ + 1);
    } catch (const InvalidInput&) {
      if (!may_break_off_) throw;
      return false;
    }
    return true;
  }

  // They may cut our own video off in the middle of a picture: what is before it is what there is.
  camera::FramePtr next_picture() {
    if (!may_break_off_) return video_->next();
    try {
      return video_->next();
    } catch (const InvalidInput&) {
      return nullptr;
    }
  }

  std::filesystem::path folder_;
  std::vector<VideoPart> parts_;
  bool may_break_off_;
  std::vector<KeptPicture> pictures_;
  FramesOfPictures frames_;
  std::unique_ptr<sources::FrameSource> video_;
  sources::SourceInfo info_;
  std::unordered_map<std::int64_t, std::int64_t> frame_of_packet_;  // of this part
  std::size_t part_ = 0;
  std::int64_t given_ = 0;
};

}  // namespace

std::unique_ptr<sources::FrameSource> open_recorded_video(const RecordedSession& session) {
  if (session.video().empty()) throw InvalidInput(session.folder(), "", "no video was kept of this session");
  if (!session.header().video_is_reencoded) return std::make_unique<OwnVideo>(session);
  return std::make_unique<RecordedVideo>(session);
}

}  // namespace arthronaut::recording
