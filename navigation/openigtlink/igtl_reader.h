// OpenIGTLink as it comes from an outside tracker, byte by byte: TRANSFORM, TDATA, QTDATA and STATUS of
// protocol versions 1 to 3. Everything else is passed over, whatever its size; no message makes this take
// more than kMostBody bytes of memory.
//
// What a message says of itself is not believed: its checksum must be right, its lengths must fit into it, a
// pose must be one. One that is not as it must be is told and left out. A header that is none means that
// nobody knows where the next message begins: then the connection is of no use any more.
//
// A TRANSFORM whose metadata say that its tool is not seen ("TransformStatus" of PLUS and 3D Slicer) is told
// as a status of its device, and its pose, the last one, is none.
//
// 3D Slicer and OpenIGTLink keep everything in RAS; poses are handed on in LPS, by ras_from_lps(),
// which turns back what it turned.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "planning/geometry/rigid_transform.h"

namespace arthronaut::openigtlink {

// Who is told. Text is valid during the call.
class MessageListener {
 public:
  virtual ~MessageListener() = default;
  // Of every message, whatever its type, before the rest of it.
  virtual void header(int /*version*/, std::string_view /*type*/) {}
  // LPS, mm; empty: what came is no rigid pose. stamp_utc_s: 0 where the message has none.
  virtual void pose(std::string_view device,
                    const std::optional<geometry::RigidTransform>& target_from_source,
                    double stamp_utc_s) = 0;
  virtual void status(std::string_view device, bool is_ok, std::string_view words) = 0;
  virtual void refused(const std::string& why) = 0;
};

class IgtlReader {
 public:
  static constexpr std::size_t kHeaderSize = 58, kMostBody = 64 * 1024;

  explicit IgtlReader(MessageListener& listener);
  // The next bytes, in pieces of any size. False: they are no OpenIGTLink, and no more is to be taken.
  [[nodiscard]] bool take(std::span<const std::uint8_t> bytes);
  // Some of a message has come and the rest has not.
  [[nodiscard]] bool is_within_message() const { return !header_.empty(); }
  [[nodiscard]] std::uint64_t ended_count() const { return ended_count_; }  // of messages, read or not

 private:
  struct Header {
    int version = 0;
    std::string type, device;
    double stamp_utc_s = 0;
    std::uint64_t body_size = 0, checksum = 0;
  };

  [[nodiscard]] bool begin_body();
  void end_body();
  void read_message(std::span<const std::uint8_t> content);

  MessageListener& listener_;
  std::vector<std::uint8_t> header_, body_;
  Header message_;
  bool has_header_ = false, is_passed_over_ = false;
  std::uint64_t to_come_ = 0;  // of the body
  std::uint64_t ended_count_ = 0;
};

}  // namespace arthronaut::openigtlink
