// Inner header: where a picture ends in MPEG-TS, told as soon as its last byte is there.
//
// Senders leave the length of a picture's data open, so libavformat gives a picture out when the next one
// begins: at 30 a second 33 ms late. But each packet of the transport holds 184 bytes, and what the last one
// of a picture does not need is stuffed. Behind a stuffed packet an empty beginning is put in, which ends
// what was before and holds nothing itself: no byte of a picture is another one. A last packet that happens
// to be full (one in 184) is not told, and its picture comes as late as before. Pure; one thread.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace arthronaut::sources {

class TransportEnds {
 public:
  // From here on of the stream with this packet identifier; below 0: of none.
  void follow(int pid) { pid_ = pid; }
  // Appends what came, with the ends put in. Data that are no whole packets are passed on as they are.
  void pass_on(std::span<const std::uint8_t> came, std::vector<std::uint8_t>& passed_on);
  // Whether what began at this byte of all that was passed on was ended by its own last packet. False also
  // when that is too long ago.
  [[nodiscard]] bool was_ended(std::int64_t began_at) const;

 private:
  int pid_ = -1;
  std::int64_t passed_ = 0, began_at_ = -1;  // bytes; where the newest picture began
  std::array<std::int64_t, 64>
      ended_at_{};  // beginnings of those that were ended, the newest over the oldest
  std::size_t ended_count_ = 0;
};

}  // namespace arthronaut::sources
