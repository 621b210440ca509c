#include "navigation/recording/stream_copy.h"

#include <optional>
#include <utility>
#include <vector>

#include "navigation/recording/packet_file.h"

namespace arthronaut::recording {

namespace {

using sources::EncodedPacket;
using sources::EncodedPacketPtr;
using sources::LibavPtr;

// How many pictures are decoded again, and how long a way to the first of them is gone: what is further from
// its key frame waits for the next one.
constexpr int kCheckedPictures = 5;
constexpr std::int64_t kCheckedWithin = 60;

// Decodes again what was kept, as a replay will.
class SecondDecoder {
 public:
  explicit SecondDecoder(const EncodedPacketPtr& start) : next_(start->number) {
    std::string problem;
    decoder_ = sources::open_stream_decoder(*start->format->parameters, start->format->time_base, problem);
    if (decoder_ != nullptr) decoder_->has_b_frames = start->held_back;
  }

  // nullopt: it does not come out.
  [[nodiscard]] std::optional<std::uint64_t> digest_of(std::int64_t number,
                                                       const sources::EncodedPackets& packets) {
    if (decoder_ == nullptr) return std::nullopt;
    if (const auto found = received(number)) return found;
    packets.take(next_, packets.newest(), batch_);
    for (const EncodedPacketPtr& packet : batch_) {
      if (packet->number != next_) return std::nullopt;
      ++next_;
      decoder_->reordered_opaque = packet->number;
      (void)avcodec_send_packet(decoder_.get(), packet->data.get());
      if (const auto found = received(number)) return found;
    }
    return std::nullopt;
  }

 private:
  std::optional<std::uint64_t> received(std::int64_t number) {
    while (avcodec_receive_frame(decoder_.get(), picture_.get()) == 0) {
      if (!sources::is_whole(*picture_) || picture_->reordered_opaque != number) continue;
      const auto frame = frames_.make(*picture_);
      if (frame == nullptr) return std::nullopt;
      return digest_of_luma(camera::luma_of(*frame, gray_));
    }
    return std::nullopt;
  }

  LibavPtr<AVCodecContext> decoder_;
  LibavPtr<AVFrame> picture_{av_frame_alloc()};
  sources::DecodedFrames frames_;
  std::vector<EncodedPacketPtr> batch_;
  std::vector<std::uint8_t> gray_;
  std::int64_t next_;
};

struct WrittenStart {
  std::int64_t number = -1, time_ms = 0;
};

}  // namespace

struct StreamCopy::State {
  State(const std::filesystem::path& to, std::shared_ptr<const sources::EncodedPackets> from,
        EncodedPacketPtr begin, const camera::Frame& picture)
      : file(to, *begin, picture), packets(std::move(from)), first(std::move(begin)), next(first->number) {}

  bool refuse(const char* why) {
    refusal = why;
    return false;
  }

  bool write_up_to(std::int64_t number) {
    if (next > number) return true;
    packets->take(next, number, batch);
    for (const EncodedPacketPtr& packet : batch) {
      if (packet->number != next) return refuse("the disk could not keep up with the stream");
      if (packet->format != first->format) return refuse("the stream came back after a break");
      const std::int64_t time_ms = file.write(*packet);
      ++next;
      if (!packet->is_start) continue;
      before = std::exchange(start, {packet->number, time_ms});
      if (checks_left > 0) second.reset();
      newest_start = packet;
    }
    return next > number || refuse("the disk could not keep up with the stream");
  }

  // Whether what is kept gives the picture that was seen.
  bool is_seen_again(std::int64_t number, std::uint64_t digest) {
    if (checks_left == 0 || (!second && number - newest_start->number > kCheckedWithin)) return true;
    // One that was decoded before its start, and is shown after it.
    if (number < newest_start->number) return true;
    if (!second) second.emplace(newest_start);
    const auto again = second->digest_of(number, *packets);
    if (--checks_left == 0 && again) second.reset();
    return again == digest;
  }

  PacketFile file;
  std::shared_ptr<const sources::EncodedPackets> packets;
  EncodedPacketPtr first, newest_start;
  std::int64_t next;
  WrittenStart start, before;  // the last two that were written
  std::vector<EncodedPacketPtr> batch;
  std::vector<std::uint8_t> gray;
  std::optional<SecondDecoder> second;
  int checks_left = kCheckedPictures;
  std::string refusal;
  bool is_hopeless = false;
};

StreamCopy::StreamCopy(const std::filesystem::path& file,
                       std::shared_ptr<const sources::EncodedPackets> packets, EncodedPacketPtr first,
                       const camera::Frame& picture)
    : state_(std::make_unique<State>(file, std::move(packets), std::move(first), picture)) {}

StreamCopy::~StreamCopy() = default;

bool StreamCopy::take(const camera::Frame& picture, KeptPicture& kept) {
  State& s = *state_;
  const std::int64_t number = picture.packet;
  if (number < s.first->number) return s.refuse("a picture came without its packet");
  if (!s.write_up_to(number)) return false;
  const WrittenStart& start = s.start.number <= number ? s.start : s.before;
  if (start.number < 0 || start.number > number) return s.refuse("a picture came long after its packet");
  const std::uint64_t digest = digest_of_luma(camera::luma_of(picture, s.gray));
  if (!s.is_seen_again(number, digest)) {
    s.is_hopeless = true;
    return s.refuse("decoded again, it does not give the pictures that were seen");
  }
  const std::int64_t first = s.first->number;
  kept = {picture.index, number - first, start.number - first, start.time_ms, digest};
  return true;
}

void StreamCopy::finish() { state_->file.finish(); }
const std::string& StreamCopy::refusal() const { return state_->refusal; }
bool StreamCopy::is_hopeless() const { return state_->is_hopeless; }
const std::shared_ptr<const sources::PacketFormat>& StreamCopy::format() const {
  return state_->first->format;
}
std::string StreamCopy::codec() const { return avcodec_get_name(format()->parameters->codec_id); }
int StreamCopy::held_back() const { return state_->first->held_back; }

}  // namespace arthronaut::recording
