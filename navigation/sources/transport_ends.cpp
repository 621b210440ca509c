#include "navigation/sources/transport_ends.h"

#include <algorithm>

namespace arthronaut::sources {

namespace {

constexpr std::size_t kPacket = 188, kHeader = 4;
constexpr std::uint8_t kSync = 0x47;

int pid_of(const std::uint8_t* packet) { return (packet[1] & 0x1F) << 8 | packet[2]; }
bool begins(const std::uint8_t* packet) { return (packet[1] & 0x40) != 0; }
bool has_adaptation(const std::uint8_t* packet) { return (packet[3] & 0x20) != 0; }
bool has_payload(const std::uint8_t* packet) { return (packet[3] & 0x10) != 0; }

// ISO/IEC 13818-1, 2.4.3.4: the adaptation field is longer than what it says.
bool is_stuffed(const std::uint8_t* packet) {
  if (!has_adaptation(packet) || !has_payload(packet)) return false;
  const std::size_t length = packet[kHeader];
  if (length == 0) return true;
  const std::uint8_t flags = packet[kHeader + 1];
  if (flags == 0) return true;  // there for nothing else
  constexpr std::uint8_t kPcr = 0x10, kOpcr = 0x08, kSplice = 0x04, kPrivate = 0x02, kExtension = 0x01;
  std::size_t used = 1;
  if ((flags & kPcr) != 0) used += 6;
  if ((flags & kOpcr) != 0) used += 6;
  if ((flags & kSplice) != 0) used += 1;
  for (const std::uint8_t part : {kPrivate, kExtension})
    if ((flags & part) != 0 && kHeader + 1 + used < kPacket) used += 1 + packet[kHeader + 1 + used];
  return length > used;
}

// A packetised elementary stream begins, of open length, without a time and without data. It counts as the
// packet before it and says so ("discontinuity"), so that the next one follows on that.
void append_empty_beginning(const std::uint8_t* last, std::vector<std::uint8_t>& to) {
  constexpr std::array<std::uint8_t, 9> kEmpty{0, 0, 1, 0xE0, 0, 0, 0x80, 0, 0};
  constexpr std::size_t kLength = kPacket - kHeader - 1 - kEmpty.size();
  constexpr std::uint8_t kDiscontinuity = 0x80;
  const auto put = [&](auto... bytes) { (to.push_back(static_cast<std::uint8_t>(bytes)), ...); };
  put(kSync, 0x40 | (last[1] & 0x1F), last[2], 0x30 | (last[3] & 0x0F), kLength, kDiscontinuity);
  to.insert(to.end(), kLength - 1, 0xFF);
  to.insert(to.end(), kEmpty.begin(), kEmpty.end());
}

bool are_packets(std::span<const std::uint8_t> data) {
  if (data.size() % kPacket != 0) return false;
  for (std::size_t at = 0; at < data.size(); at += kPacket)
    if (data[at] != kSync) return false;
  return true;
}

}  // namespace

void TransportEnds::pass_on(std::span<const std::uint8_t> came, std::vector<std::uint8_t>& passed_on) {
  const std::size_t before = passed_on.size();
  const auto here = [&] { return passed_ + static_cast<std::int64_t>(passed_on.size() - before); };
  if (pid_ < 0 || !are_packets(came)) {
    passed_on.insert(passed_on.end(), came.begin(), came.end());
    came = {};
  }
  for (; !came.empty(); came = came.subspan(kPacket)) {
    const std::uint8_t* const packet = came.data();
    const bool is_ours = pid_of(packet) == pid_;
    if (is_ours && begins(packet)) began_at_ = here();
    passed_on.insert(passed_on.end(), packet, packet + kPacket);
    if (!is_ours || began_at_ < 0 || !is_stuffed(packet)) continue;
    append_empty_beginning(packet, passed_on);
    ended_at_[ended_count_++ % ended_at_.size()] = began_at_;
    began_at_ = -1;
  }
  passed_ = here();
}

bool TransportEnds::was_ended(std::int64_t began_at) const {
  const std::size_t count = std::min(ended_count_, ended_at_.size());
  return std::find(ended_at_.begin(), ended_at_.begin() + static_cast<std::ptrdiff_t>(count), began_at) !=
         ended_at_.begin() + static_cast<std::ptrdiff_t>(count);
}

}  // namespace arthronaut::sources
