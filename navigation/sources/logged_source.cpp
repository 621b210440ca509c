#include "navigation/sources/logged_source.h"

#include <string>
#include <utility>

#include "navigation/sources/camera_modes.h"
#include "planning/log/log.h"

namespace arthronaut::sources {

namespace {

class LoggedSource final : public FrameSource {
 public:
  explicit LoggedSource(std::unique_ptr<FrameSource> source) : source_(std::move(source)) {
    const SourceInfo& opened = source_->info();
    log::info("source opened: " + opened.name + ", " + size_in_words(opened.image_size_px) + ", " +
              std::to_string(opened.frames_per_second) + " frames/s" + (opened.is_live() ? ", live" : ""));
  }
  ~LoggedSource() override {
    if (!has_ended_) log::info("source closed: " + told());
  }
  [[nodiscard]] const SourceInfo& info() const override { return source_->info(); }
  [[nodiscard]] camera::FramePtr next() override {
    camera::FramePtr frame = source_->next();
    if (frame) {
      ++count_;
    } else if (!std::exchange(has_ended_, true)) {
      log::info("source ended: " + told());
    }
    return frame;
  }

 private:
  [[nodiscard]] std::string told() const {
    return source_->info().name + " after " + std::to_string(count_) + " frames";
  }

  std::unique_ptr<FrameSource> source_;
  long count_ = 0;
  bool has_ended_ = false;
};

}  // namespace

std::unique_ptr<FrameSource> logged(std::unique_ptr<FrameSource> source) {
  if (!log::takes(log::Level::Info)) return source;
  return std::make_unique<LoggedSource>(std::move(source));
}

}  // namespace arthronaut::sources
