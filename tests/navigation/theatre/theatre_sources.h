// Sources for an operation's tests: small pictures that show nothing, until they end or fail.
#pragma once

#include <atomic>
#include <chrono>
#include <thread>

#include "navigation/theatre/operation_run.h"
#include "planning/geometry/error.h"
#include "tests/navigation/operation/phantom_operation.h"

namespace arthronaut::test {

class PlainSource : public sources::FrameSource {
 public:
  // After so many frames it ends, or throws.
  PlainSource(std::int64_t count, bool fails, double frames_per_second = 0)
      : count_(count), fails_(fails), frames_per_second_(frames_per_second) {
    info_.name = "plain";
    info_.image_size_px = {160, 120};
  }
  [[nodiscard]] const sources::SourceInfo& info() const override { return info_; }
  [[nodiscard]] camera::FramePtr next() override {
    if (next_ == count_ && fails_) throw DeviceError("the camera was unplugged");
    if (next_ == count_) return nullptr;
    if (frames_per_second_ > 0)
      std::this_thread::sleep_for(std::chrono::duration<double>(1 / frames_per_second_));
    const std::int64_t index = next_++;
    return std::make_shared<const camera::Frame>(plain_frame(index, static_cast<std::uint8_t>(index % 200)));
  }

 private:
  sources::SourceInfo info_;
  std::int64_t count_, next_ = 0;
  bool fails_;
  double frames_per_second_;
};

inline theatre::TheatreSource plain_source(std::int64_t count, bool fails = false,
                                           sources::SourceKind kind = sources::SourceKind::Recording,
                                           double frames_per_second = 0) {
  theatre::TheatreSource source;
  source.setup = scripted_source(kind);
  source.open = [=] { return std::make_unique<PlainSource>(count, fails, frames_per_second); };
  return source;
}

inline std::unique_ptr<theatre::RegistrationService> at_once(const operation::OperationSetup& setup) {
  return theatre::registration_at_once([] { return registration::phantom_bone().prepared; },
                                       operation::work_options(setup));
}

}  // namespace arthronaut::test
