#include "navigation/sources/encoded_packets.h"

#include <algorithm>
#include <new>

namespace arthronaut::sources {

namespace {

constexpr std::int64_t kMostBytes = std::int64_t{64} << 20;
constexpr std::int64_t kMostPackets = 4096;
constexpr std::int64_t kLongest_ns = 20'000'000'000;

// Calls visit(first byte of it) for each NAL unit of a packet, until it says true. Units have start codes
// before them, or four bytes of length. What is behind a packet's end can be read, and is 0.
template <typename Visit>
void for_each_unit(const AVPacket& packet, bool has_lengths, const Visit& visit) {
  const std::uint8_t* at = packet.data;
  const std::uint8_t* const end = at + packet.size;
  while (has_lengths && end - at > 4) {
    const std::int64_t size = std::int64_t{at[0]} << 24 | at[1] << 16 | at[2] << 8 | at[3];
    if (visit(at + 4) || size > end - at - 4) return;
    at += 4 + size;
  }
  for (; !has_lengths && end - at > 3; ++at) {
    if (at[0] != 0 || at[1] != 0 || at[2] != 1) continue;
    if (visit(at + 3)) return;
    at += 3;
  }
}

constexpr int type_of(const std::uint8_t* unit, bool is_h264) {
  return is_h264 ? unit[0] & 0x1F : unit[0] >> 1 & 0x3F;
}

}  // namespace

bool is_one_picture(const AVPacket& packet, AVCodecID codec) {
  const bool is_h264 = codec == AV_CODEC_ID_H264;
  if (!is_h264 && codec != AV_CODEC_ID_HEVC) return false;
  int first_slices = 0;
  bool begins_with_one = true;
  for_each_unit(packet, false, [&](const std::uint8_t* unit) {
    constexpr int kSlice = 1, kIdr = 5, kLastPicture = 31;
    const int type = type_of(unit, is_h264);
    if (is_h264 ? type != kSlice && type != kIdr : type > kLastPicture) return false;
    // first_mb_in_slice is 0, coded as one bit; first_slice_segment_in_pic_flag.
    const bool is_first = (unit[is_h264 ? 1 : 2] & 0x80) != 0;
    begins_with_one = begins_with_one && (is_first || first_slices > 0);
    first_slices += is_first ? 1 : 0;
    return false;
  });
  return begins_with_one && first_slices == 1;
}

bool may_begin_at(const AVPacket& packet, const AVCodecParameters& parameters) {
  if ((packet.flags & AV_PKT_FLAG_CORRUPT) != 0) return false;
  const bool is_h264 = parameters.codec_id == AV_CODEC_ID_H264;
  const bool is_hevc = parameters.codec_id == AV_CODEC_ID_HEVC;
  if (!is_h264 && !is_hevc) {
    const AVCodecDescriptor* const codec = avcodec_descriptor_get(parameters.codec_id);
    const bool is_intra = codec != nullptr && (codec->props & AV_CODEC_PROP_INTRA_ONLY) != 0;
    return is_intra || (packet.flags & AV_PKT_FLAG_KEY) != 0;
  }
  // The parameters of either begin with a 1 where units carry their lengths.
  const bool has_lengths = parameters.extradata_size > 0 && parameters.extradata[0] == 1;
  bool found = false;
  for_each_unit(packet, has_lengths, [&](const std::uint8_t* unit) {
    constexpr int kSlice = 1, kIdr = 5, kFirstBla = 16, kLastIdr = 20, kLastPicture = 31;
    const int type = type_of(unit, is_h264);
    found = is_h264 ? type == kIdr : type >= kFirstBla && type <= kLastIdr;
    return is_h264 ? type >= kSlice && type <= kIdr : type <= kLastPicture;
  });
  return found;
}

EncodedPackets::EncodedPackets() : ring_(kMostPackets) {}

void EncodedPackets::begin(const AVStream& stream) {
  auto format = std::make_shared<PacketFormat>();
  format->parameters.reset(avcodec_parameters_alloc());
  if (avcodec_parameters_copy(format->parameters.get(), stream.codecpar) < 0) throw std::bad_alloc();
  format->time_base = stream.time_base;
  format->frames_per_second = frames_per_second_of(stream);
  const std::lock_guard lock(mutex_);
  format_ = std::move(format);
}

std::int64_t EncodedPackets::put(const AVPacket& packet, std::int64_t time_ns, int held_back) {
  const std::shared_ptr<EncodedPacket> kept = recycler_.take();
  kept->time_ns = time_ns;
  kept->held_back = held_back;
  if (av_packet_ref(kept->data.get(), &packet) < 0) throw std::bad_alloc();
  kept->is_start = may_begin_at(packet, *format_->parameters);
  kept->format = format_;
  const std::lock_guard lock(mutex_);
  const auto is_too_much = [&] {
    return next_ - first_ >= kMostPackets || kept_bytes_ + packet.size > kMostBytes ||
           time_ns - this->kept(first_)->time_ns > kLongest_ns;
  };
  while (first_ < next_ && is_too_much()) {
    EncodedPacketPtr& oldest = ring_[static_cast<std::size_t>(first_++ % kMostPackets)];
    kept_bytes_ -= oldest->data->size;
    oldest.reset();
  }
  kept->number = next_++;
  kept_bytes_ += packet.size;
  const std::int64_t number = kept->number;
  ring_[static_cast<std::size_t>(number % kMostPackets)] = kept;
  return number;
}

const EncodedPacketPtr& EncodedPackets::kept(std::int64_t number) const {
  return ring_[static_cast<std::size_t>(number % kMostPackets)];
}

void EncodedPackets::take(std::int64_t from, std::int64_t to, std::vector<EncodedPacketPtr>& packets) const {
  packets.clear();
  const std::lock_guard lock(mutex_);
  for (std::int64_t n = std::max(from, first_); n < next_ && n <= to; ++n) packets.push_back(kept(n));
}

EncodedPacketPtr EncodedPackets::start_of(std::int64_t number) const {
  const std::lock_guard lock(mutex_);
  if (number < first_ || number >= next_) return nullptr;
  for (std::int64_t n = number; n >= first_ && kept(n)->format == kept(number)->format; --n)
    if (kept(n)->is_start) return kept(n);
  return nullptr;
}

std::optional<std::int64_t> EncodedPackets::time_ns_of(std::int64_t number) const {
  const std::lock_guard lock(mutex_);
  if (number < first_ || number >= next_) return std::nullopt;
  return kept(number)->time_ns;
}

std::int64_t EncodedPackets::newest() const {
  const std::lock_guard lock(mutex_);
  return next_ - 1;
}

}  // namespace arthronaut::sources
