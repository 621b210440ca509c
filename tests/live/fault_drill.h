// A whole operation on a live source that guides, and faults put into the source: how long after each the
// screen guides no more, says what is wrong, and guides again when the source is well.
//
// What the screen shows is what LiveState allows: guidance of a picture that is not older than stale_after_s.
#pragma once

#include <memory>
#include <string>

#include "navigation/theatre/live_operation.h"
#include "tests/live/sender_process.h"

namespace arthronaut::test {

enum class Fault { Killed, Hangs, Stalled, OtherCodec, OtherSize, Black, Frozen, Torn, Repeated };
inline constexpr int kFaultCount = 9;
[[nodiscard]] std::string to_text(Fault fault);

struct FaultOutcome {
  Fault fault = Fault::Killed;
  // Seconds; below 0: it never came to it. Guidance gone and told: after the fault; back: after the source
  // was well. Torn and repeated pictures take no guidance away for long: gone is not asked of them.
  double gone_s = -1, told_s = -1, back_s = -1;
  std::string words;  // as they were told
};

class FaultDrill {
 public:
  // Sends, connects, registers and waits until it guides. Throws std::runtime_error when that takes a minute.
  // codec: of what is sent, see stream_sender.cpp.
  explicit FaultDrill(const std::string& codec = "jpeg");
  ~FaultDrill();
  // Waits no longer than patience_s for each of the three.
  [[nodiscard]] FaultOutcome run(Fault fault, double lasts_s, double patience_s);
  [[nodiscard]] theatre::LiveOperation& live() { return *live_; }

 private:
  [[nodiscard]] bool guides() const;
  template <typename Condition>
  [[nodiscard]] double seconds_until(double from_s, double patience_s, const Condition& condition) const;
  void begin(Fault fault);
  void end(Fault fault);

  int port_;
  std::string codec_;
  std::unique_ptr<SenderProcess> sender_;
  std::unique_ptr<theatre::LiveOperation> live_;
};

}  // namespace arthronaut::test
