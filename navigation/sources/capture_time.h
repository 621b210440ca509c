// When a picture of a device was taken: the driver's stamp where it can be true.
//
// V4L2 drivers stamp a picture on the monotonic clock, which is std::chrono::steady_clock on Linux, and say
// whether they did; GStreamer's stamps are on it because its pipeline is given that clock. Some stamp
// nothing. A stamp of the past is believed, however old it is: what waited in a queue for seconds must never
// be dated as taken when it came out. (One of another clock that gets here all the same is at worst an old
// picture, and nothing guides by it.) One of the future is none.
#pragma once

#include <cstdint>
#include <optional>

#include "navigation/camera/frame.h"

namespace arthronaut::sources {

struct CaptureTime {
  std::int64_t ns = 0;  // on std::chrono::steady_clock
  camera::CaptureClock clock = camera::CaptureClock::HandedOver;
};

// driver_ms: what the driver says, on the steady clock, 0 when it says nothing. handed_over_ns: when the
// picture came, on the steady clock.
[[nodiscard]] CaptureTime capture_time(double driver_ms, std::int64_t handed_over_ns);

[[nodiscard]] std::int64_t steady_now_ns();

// Puts the time stamps of a stream (MPEG-TS, RTP) on the steady clock. A stream stamps its pictures by the
// sender's clock, evenly; they arrive unevenly, and never earlier than they were sent. So the quickest
// arrival of the last seconds tells how far the two clocks stand apart, and a picture that waited in a socket
// or a decoder is seen to be as old as it is. What the quickest one took on its way is not seen.
class StreamClock {
 public:
  // Both of one piece of data; stamps need not come quite in order. One that lies half a second before the
  // one before it is of a sender that was started again, and begins anew. A sender's count that went back by
  // less is known once the stamps are where they were before, having come there picture by picture; not in a
  // stream whose pictures are put in order by its decoder. What only comes late begins never anew, however
  // late it is.
  void arrived(std::int64_t stamp_ns, std::int64_t arrived_ns);
  // On the steady clock, of a picture with this stamp. Precondition: something has arrived.
  [[nodiscard]] std::int64_t captured_ns(std::int64_t stamp_ns) const { return stamp_ns + apart_ns_; }

 private:
  // Stamps that went back.
  struct Step {
    std::int64_t from_ns, to_ns;  // the newest before, the first after
    std::int64_t behind_ns;       // how old the youngest of the last pictures before was
    std::int64_t newest_ns, least_apart_ns, count = 0;  // since
  };
  void follow_step(std::int64_t stamp_ns, std::int64_t apart_ns);

  bool has_begun_ = false;
  std::int64_t apart_ns_ = 0, at_ns_ = 0, stamp_ns_ = 0;
  std::int64_t first_ns_ = 0, newest_ns_ = 0, count_ = 0;  // stamps
  std::int64_t in_order_ = 0;                              // since one went back
  // The least age of this quarter of a second, and of the one before.
  std::int64_t quarter_ns_ = 0, least_age_ns_ = 0, least_age_before_ns_ = 0;
  std::optional<Step> step_;
};

}  // namespace arthronaut::sources
