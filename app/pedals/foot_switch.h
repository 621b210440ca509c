// Foot switches, read from the kernel's input devices (evdev) beside the screen: plugged in and out at any
// time. A device that is read is taken for this program alone, so that what it types does not reach the
// window a second time.
//
// States of a device: absent -> read -> absent ...; refused (no permission, or another program has it, to
// which all its events go) is told, and tried again. Threads: FootSwitch belongs to one thread, the window's;
// the devices are read by one of its own.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "app/pedals/theatre_settings.h"

namespace arthronaut::pedals {

struct PedalEvent {
  Pedal pedal = Pedal::DoIt;
  bool is_down = true;  // false: let go
  [[nodiscard]] bool operator==(const PedalEvent&) const = default;
};

// Events of one device, from the bytes that it gives. What is cut off waits for the rest; what the kernel
// says was lost is let go of: a pedal whose release nobody saw must not stay down. A foot that slips off and
// on again within kSlip, by the kernel's time of the events, has pressed once: what the first press asked for
// on the screen must not be answered before it could be read.
class PedalDecoder {
 public:
  static constexpr std::chrono::microseconds kSlip{350'000};
  explicit PedalDecoder(std::map<int, Pedal> codes) : codes_(std::move(codes)) {}
  void take(const char* bytes, std::size_t count, std::vector<PedalEvent>& events);
  // The device is gone: whatever is down is let go.
  void end(std::vector<PedalEvent>& events);

 private:
  std::map<int, Pedal> codes_;
  std::vector<char> rest_;
  std::vector<Pedal> down_;
  std::map<Pedal, std::chrono::microseconds> last_up_;  // also of presses that were a slip
  bool is_lost_ = false;                                // until the next report
};

class FootSwitch {
 public:
  struct Status {
    std::vector<std::string> devices;  // that are read, by name
    std::string trouble;               // why one is not ("/dev/input/event5: permission denied"); empty else
  };

  // Takes an open device for this program alone; returns 0 or an errno.
  using Grab = std::function<int(int descriptor)>;
  [[nodiscard]] static int grab(int descriptor);  // as the kernel does it

  // wake: called from the other thread when there is something to take.
  FootSwitch(const TheatreSettings& settings, std::function<void()> wake, Grab grabs = grab);
  ~FootSwitch();
  FootSwitch(const FootSwitch&) = delete;
  FootSwitch& operator=(const FootSwitch&) = delete;

  // Since the last call, in order, at most 64: a pedal that trembles is no reason to grow.
  [[nodiscard]] std::vector<PedalEvent> take();
  [[nodiscard]] Status status() const;

 private:
  struct Reader;
  std::unique_ptr<Reader> reader_;
};

}  // namespace arthronaut::pedals
