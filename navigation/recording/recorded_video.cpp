#include <algorithm>
#include <unordered_map>

#include "navigation/recording/session.h"
#include "planning/geometry/error.h"

namespace arthronaut::recording {

namespace {

// Pictures of the video under the indices and timestamps of the session's frames.
class RecordedVideo : public sources::FrameSource {
 public:
  explicit RecordedVideo(const RecordedSession& session)
      : video_(session.header().video_has_exact_luma ? sources::open_video_with_exact_luma(session.video())
                                                     : sources::open_video(session.video())),
        info_(video_->info()),
        may_break_off_(!session.was_finished() && session.header().video_is_reencoded),
        frame_of_picture_(session.frame_of_picture()) {
    info_.name = session.header().id;
    info_.kind = sources::SourceKind::Recording;
    for (const RecordedFrame& frame : session.frames()) timestamps_[frame.index] = frame.timestamp_ns;
    info_.frame_count = static_cast<std::int64_t>(timestamps_.size());
    if (!frame_of_picture_.empty()) {
      info_.frame_count = std::min(info_.frame_count, static_cast<std::int64_t>(frame_of_picture_.size()));
    }
  }

  const sources::SourceInfo& info() const override { return info_; }

  camera::FramePtr next() override {
    // Counting stops at the last recorded frame: the picture after it may be the one that a crash cut off.
    while (given_ < info_.frame_count) {
      const camera::FramePtr picture = next_picture();
      if (!picture) return nullptr;
      const auto timestamp = timestamps_.find(index_of(*picture));
      if (timestamp == timestamps_.end()) continue;
      ++given_;
      auto frame = std::make_shared<camera::Frame>(*picture);
      frame->index = timestamp->first;
      frame->timestamp_ns = timestamp->second;
      return frame;
    }
    return nullptr;
  }

 private:
  // A crash may cut our own video off in the middle of a picture: what is before it is what there is.
  camera::FramePtr next_picture() {
    if (!may_break_off_) return video_->next();
    try {
      return video_->next();
    } catch (const InvalidInput&) {
      return nullptr;
    }
  }

  [[nodiscard]] std::int64_t index_of(const camera::Frame& picture) const {
    if (frame_of_picture_.empty()) return picture.index;
    const auto i = static_cast<std::size_t>(picture.index);
    return i < frame_of_picture_.size() ? frame_of_picture_[i] : -1;
  }

  std::unique_ptr<sources::FrameSource> video_;
  sources::SourceInfo info_;
  bool may_break_off_;
  std::vector<std::int64_t> frame_of_picture_;
  std::unordered_map<std::int64_t, std::int64_t> timestamps_;
  std::int64_t given_ = 0;
};

}  // namespace

std::unique_ptr<sources::FrameSource> open_recorded_video(const RecordedSession& session) {
  if (session.video().empty()) throw InvalidInput(session.folder(), "", "no video was kept of this session");
  return std::make_unique<RecordedVideo>(session);
}

}  // namespace arthronaut::recording
