#include "navigation/sources/recovering_source.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "navigation/sources/camera_modes.h"
#include "planning/geometry/error.h"
#include "planning/log/log.h"

namespace arthronaut::sources {

namespace {

// A server that is there again is found within this; more often would be a load on a network that has
// trouble.
constexpr auto kBeforeAgain = std::chrono::milliseconds(100);
// Another camera is opened to be asked, and closed again.
constexpr auto kBeforeAsking = std::chrono::seconds(1);
// A source whose pictures are dated back by more goes on from there: its time would stand still until the
// dates are where they were, and with it all that looks for a picture that is frozen, or a mark that is lost.
constexpr std::int64_t kStandsAtMost_ns = 1'000'000'000;

class RecoveringSource final : public FrameSource {
 public:
  explicit RecoveringSource(LiveOpener opener) : opener_(std::move(opener)) {
    source_ = opener_({stamps_, false, {0, 0}, identity_, remark_});
    info_ = source_->info();
    info_.line = line_;
  }

  [[nodiscard]] const SourceInfo& info() const override { return info_; }

  [[nodiscard]] camera::FramePtr next() override {
    while (!line_->ends()) {
      if (source_ == nullptr && !open_again()) {
        line_->rest(is_other_ ? kBeforeAsking : kBeforeAgain);
        continue;
      }
      camera::FramePtr frame = take();
      if (frame == nullptr) {
        if (has_ended_) return nullptr;
        continue;
      }
      if (frame->width == info_.image_size_px.x() && frame->height == info_.image_size_px.y()) {
        line_->pictures_come();
        tell_of_pictures();
        return frame;
      }
      tell_size({frame->width, frame->height});
    }
    return nullptr;
  }

 private:
  void tell_size(const Eigen::Vector2i& now_px) {
    tell(info_.name + ": the source's format changed to " + size_in_words(now_px) +
             ": set the processor back to " + size_in_words(info_.image_size_px) +
             ", or choose the camera again",
         now_px);
  }

  camera::FramePtr take() {
    try {
      camera::FramePtr frame = source_->next();
      if (frame != nullptr) return frame;
      if (!remark_.empty()) {
        tell(remark_);
        return nullptr;
      }
      has_ended_ = source_->info().ends;
      if (!has_ended_) tell(info_.name + ": has ended; waiting for it to come back");
    } catch (const DeviceError& error) {
      if (source_->info().ends) throw;  // anew it would begin at its beginning
      tell(error.what());
    }
    source_.reset();
    remark_.clear();
    return nullptr;
  }

  bool open_again() {
    try {
      std::string identity;
      std::unique_ptr<FrameSource> source = opener_({stamps_, true, info_.image_size_px, identity, remark_});
      is_other_ = !identity_.empty() && identity != identity_;
      if (is_other_) {
        tell(info_.name + ": another camera is there (" +
             (identity.empty() ? "it does not say which" : identity) +
             "), and the calibration is of the first one (" + identity_ +
             "): connect that one, or start anew");
        return false;
      }
      is_other_ = source->info().keeps_size && source->info().image_size_px != info_.image_size_px;
      if (is_other_) {
        tell_size(source->info().image_size_px);
        return false;
      }
      source_ = std::move(source);
      log::info("source taken up again: " + info_.name);
      return true;
    } catch (const DeviceError& error) {
      is_other_ = false;
      tell(std::string("connecting again: ") + error.what());
    } catch (const InvalidInput& error) {  // a plug-in that is gone meanwhile
      tell(error.what());
    }
    return false;
  }

  void tell_of_pictures() {
    if (remark_ == told_of_pictures_) return;
    if (told_of_pictures_.empty()) log::warning("source: " + remark_);  // and not with every count of it
    told_of_pictures_ = remark_;
    line_->say_of_pictures(remark_);
  }

  void tell(const std::string& trouble, const std::optional<Eigen::Vector2i>& changed_to_px = std::nullopt) {
    if (trouble != line_->trouble()) log::warning("source: " + trouble);
    line_->say(trouble, changed_to_px);
  }

  LiveOpener opener_;
  LiveStamps stamps_;
  std::shared_ptr<SourceLine> line_ = std::make_shared<SourceLine>();
  SourceInfo info_;
  std::string identity_;                 // as it said first
  std::string remark_;                   // on what source_ gives
  std::string told_of_pictures_;         // of it, while pictures come
  std::unique_ptr<FrameSource> source_;  // null: broken
  bool has_ended_ = false;
  bool is_other_ = false;  // what was there last: another camera, or one in another format
};

}  // namespace

void LiveStamps::put_on(camera::Frame& frame, std::int64_t captured_ns, camera::CaptureClock clock,
                        std::int64_t lost_before) {
  if (last_timestamp_ns_ < 0) started_at_ns_ = captured_ns;
  frame.index = next_index_ + lost_before;
  next_index_ = frame.index + 1;
  // A clock that changes over (a driver's stamp that is missing once) must not run backwards.
  const std::int64_t next_ns = last_timestamp_ns_ + 1;
  if (captured_ns - started_at_ns_ < next_ns - kStandsAtMost_ns) started_at_ns_ = captured_ns - next_ns;
  last_timestamp_ns_ = std::max(captured_ns - started_at_ns_, next_ns);
  frame.timestamp_ns = last_timestamp_ns_;
  frame.captured_ns = captured_ns;
  frame.capture_clock = clock;
}

std::unique_ptr<FrameSource> recovering(LiveOpener opener) {
  return std::make_unique<RecoveringSource>(std::move(opener));
}

}  // namespace arthronaut::sources
