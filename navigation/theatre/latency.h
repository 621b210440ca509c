// How long a picture takes from its capture to what is shown of it, stage by stage: the age that no screen
// may hide.
//
//   captured --Capture--> data there --Decode--> can be looked at --Queue--> taken --Tracking--> poses
//            --Operation--> guidance known --Publish--> can be shown --Display--> on the screen
//
// Of live sources, on the steady clock; captured is what the driver or the stream says
// (camera::CaptureClock).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "navigation/camera/frame.h"

namespace arthronaut::theatre {

enum class Stage { Capture, Decode, Queue, Tracking, Operation, Publish, Display, ToGuidance, ToScreen };
inline constexpr std::size_t kStageCount = 9;
// "capture", ..., "to guidance", "to screen".
[[nodiscard]] std::string_view to_text(Stage stage);

// Of one picture, ms; below 0: not known.
struct FrameLatency {
  std::int64_t frame = 0;
  double capture_ms = -1, decode_ms = -1, queue_ms = -1, tracking_ms = -1, operation_ms = -1,
         guidance_ms = -1;
};

struct StageLatency {
  std::uint64_t count = 0;
  double median_ms = 0, p99_ms = 0, worst_ms = 0;  // 0 without a picture
};
using LatencyReport = std::array<StageLatency, kStageCount>;
[[nodiscard]] inline const StageLatency& of(const LatencyReport& report, Stage stage) {
  return report[static_cast<std::size_t>(stage)];
}

// Counts in steps of an eighth of a millisecond up to half a second and of a tenth of itself beyond that; the
// worst is kept as it is. Allocates nothing; one thread at a time.
class LatencyMeter {
 public:
  void add(Stage stage, double ms);  // what is not known (below 0) is left out
  void add(const FrameLatency& frame);
  // Median and 99 % are the upper end of their step. Walks all steps: for once a second.
  [[nodiscard]] LatencyReport report() const;
  void clear() { *this = LatencyMeter(); }

 private:
  static constexpr std::size_t kEvenSteps = 4000, kSteps = kEvenSteps + 100;  // to an hour and more
  [[nodiscard]] static std::size_t step_of(double ms);
  [[nodiscard]] static double end_of_ms(std::size_t step);
  struct Counts {
    std::array<std::uint32_t, kSteps> at{};
    std::uint64_t all = 0;
    double worst_ms = 0;
  };
  std::array<Counts, kStageCount> stages_{};
};

}  // namespace arthronaut::theatre
