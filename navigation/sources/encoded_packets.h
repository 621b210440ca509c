// Inner header: a stream's packets as they came, before they were decoded, for whoever records them: what is
// decoded from them again, from one that decoding may begin at, are the pictures that were seen.
//
// The source puts every packet in, in the order in which its decoder gets them; a frame says which packet it
// was made of (camera::Frame::packet). The last 20 s are kept, and no more than 64 MiB: whoever falls further
// behind, or comes later, begins anew at the next packet that decoding may begin at.
//
// Threads: the source's puts in, any other takes out.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "navigation/sources/libav.h"

namespace arthronaut::sources {

struct FreeParameters {
  void operator()(AVCodecParameters* p) const { avcodec_parameters_free(&p); }
};

// What a decoder is opened with; of one connection.
struct PacketFormat {
  std::unique_ptr<AVCodecParameters, FreeParameters> parameters;
  AVRational time_base{1, 1000};
  double frames_per_second = 0;  // 0: not known
};

struct EncodedPacket {
  std::int64_t number = -1;  // counts from 0 over all connections
  std::int64_t time_ns = 0;  // when its picture was captured; of one without a stamp: when it came
  // Everything after it is decoded without anything before it. A key frame alone is not enough: after some
  // (recovery points, H.265's open groups of pictures) come pictures that need what was before.
  bool is_start = false;
  int held_back = 0;  // pictures that the decoder put in order by then; a decoder that begins here needs it
  std::shared_ptr<const PacketFormat> format;
  LibavPtr<AVPacket> data{av_packet_alloc()};
};
using EncodedPacketPtr = std::shared_ptr<const EncodedPacket>;

// Whether decoding may begin at this packet of that format.
[[nodiscard]] bool may_begin_at(const AVPacket& packet, const AVCodecParameters& parameters);

// Whether it holds a whole picture and nothing of another one: what a stream of these codecs may be decoded
// by without its units being put together anew. False for other codecs.
[[nodiscard]] bool is_one_picture(const AVPacket& packet, AVCodecID codec);

class EncodedPackets {
 public:
  EncodedPackets();
  // A new connection, whose packets have nothing to do with those before.
  void begin(const AVStream& stream);
  // Gives its number. Precondition: begin().
  std::int64_t put(const AVPacket& packet, std::int64_t time_ns, int held_back);

  // What is kept of those in [from, to], in order. One that is missing was let go.
  void take(std::int64_t from, std::int64_t to, std::vector<EncodedPacketPtr>& packets) const;
  // The packet that decoding must begin at to come to this one; null: it was let go, or there was none.
  [[nodiscard]] EncodedPacketPtr start_of(std::int64_t number) const;
  // Empty: it was let go, or there was none.
  [[nodiscard]] std::optional<std::int64_t> time_ns_of(std::int64_t number) const;
  // The number of the newest; -1 before the first.
  [[nodiscard]] std::int64_t newest() const;

 private:
  mutable std::mutex mutex_;
  worker::Recycler<EncodedPacket> recycler_{[](EncodedPacket& packet) {
    packet.format.reset();
    av_packet_unref(packet.data.get());
  }};
  [[nodiscard]] const EncodedPacketPtr& kept(std::int64_t number) const;
  std::shared_ptr<const PacketFormat> format_;
  std::vector<EncodedPacketPtr> ring_;  // those in [first_, next_), each at the rest of its number
  std::int64_t first_ = 0, next_ = 0, kept_bytes_ = 0;
};

}  // namespace arthronaut::sources
