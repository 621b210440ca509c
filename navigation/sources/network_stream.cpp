#include "navigation/sources/network_stream.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "navigation/sources/capture_time.h"
#include "navigation/sources/connection_words.h"
#include "navigation/sources/datagram_input.h"
#include "navigation/sources/encoded_packets.h"
#include "navigation/sources/libav.h"
#include "navigation/sources/recovering_source.h"
#include "navigation/sources/rtsp_pictures.h"
#include "planning/geometry/error.h"

extern "C" {
#include <libavutil/log.h>
}

namespace arthronaut::sources {

namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::int64_t kOpensWithin_ns = 10 * kSecond_ns;
// A cable that is plugged in again is not noticed by a connection that was begun without it: TCP asks again
// after 1, 3, 7 s.
constexpr std::int64_t kOpensAgainWithin_ns = 2 * kSecond_ns;
constexpr std::int64_t kSilence_ns = kSecond_ns;  // after so much the connection is made anew
// Data that make no picture for so long are told of: by then everybody waits for one.
constexpr std::int64_t kPictureless_ns = 300'000'000;
// Older than that no picture is worth its decoding: what has waited is passed over, up to the next key frame.
constexpr std::int64_t kBehind_ns = 2 * kSecond_ns, kCaughtUp_ns = 300'000'000;
// x264 gives a key frame every 250 pictures unless it is told otherwise. If none helped by then, a new
// decoder may.
constexpr std::int64_t kKeyFrameWithin_ns = 15 * kSecond_ns;

struct FreeDictionary {
  AVDictionary* entries = nullptr;
  ~FreeDictionary() { av_dict_free(&entries); }
};

bool is_transport(const AVFormatContext& container) {
  return std::string_view(container.iformat->name) == "mpegts";
}

// How many later pictures have begun to arrive when libavformat gives one out. Where a picture ends is told
// by the beginning of the next one alone, in what it parses (all but a codec whose RTP packets say so) and
// once more in the packets of MPEG-TS, whose length senders leave open, where nobody tells it
// (DatagramInput).
std::size_t held_back(const AVFormatContext& container, AVCodecID codec) {
  const bool may_be_parsed = codec == AV_CODEC_ID_H264 || codec == AV_CODEC_ID_HEVC ||
                             codec == AV_CODEC_ID_MPEG2VIDEO || codec == AV_CODEC_ID_MPEG4;
  const bool is_parsed = may_be_parsed && (container.flags & AVFMT_FLAG_NOPARSE) == 0;
  return (is_parsed ? 1 : 0) + (is_transport(container) ? 1 : 0);
}

// One connection: from the address to decoded pictures. What goes wrong in it ends it.
class Connection {
 public:
  // How its packets are cut. AsTheyCome: each is taken for one picture, which saves the wait for the next
  // one. ByParser: libavformat puts pictures together.
  enum class Cut { AsTheyCome, ByParser };

  // Where it finds that they do not come so, cut says it. Throws DeviceError.
  Connection(const std::string& address, std::int64_t deadline_ns, bool is_again, Cut& cut,
             EncodedPackets& packets)
      : packets_(packets),
        packet_(av_packet_alloc()),
        pieces_(av_packet_alloc()),
        picture_(av_frame_alloc()),
        data_by_ns_(deadline_ns) {
    if (cut == Cut::AsTheyCome && address.starts_with("rtsp://")) open_by_picture(address, cut);
    if (container_ == nullptr) open_by_libavformat(address, is_again, cut);
    std::string problem;
    decoder_ = open_stream_decoder(*stream().codecpar, stream().time_base, problem);
    if (decoder_ == nullptr) fail(address, problem);
    packets_.begin(stream());
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  // The next whole picture. Null: data came and made none until picture_by_ns, or none came until data_by_ns.
  // The latter ends the connection, since libavformat does not go on after a wait that was interrupted.
  const AVFrame* next(std::int64_t picture_by_ns, std::int64_t data_by_ns) {
    data_by_ns_ = data_by_ns;
    for (;;) {
      const int received = avcodec_receive_frame(decoder_.get(), picture_.get());
      if (received == 0) {
        if (is_whole(*picture_)) return picture_.get();
        begin_anew();
        continue;
      }
      has_ended_ = received != AVERROR(EAGAIN);
      if (has_ended_ || steady_now_ns() > picture_by_ns) return nullptr;
      has_ended_ = !feed();
      if (has_ended_) return nullptr;
    }
  }
  // Sound and the like do not count.
  [[nodiscard]] bool gives_data() const {
    return !has_ended_ && received_ns_ > 0 && steady_now_ns() - received_ns_ < kSilence_ns;
  }
  // Its packets are not a picture each: nothing more comes of it, and it has to be opened anew.
  [[nodiscard]] bool needs_parser() const { return odd_packets_ >= kOddPackets; }
  // What waited too long is passed over.
  [[nodiscard]] bool is_behind() const { return is_behind_; }
  // Since the connection was made: pictures that came, and were left out.
  [[nodiscard]] long damaged_count() const { return damaged_count_; }
  [[nodiscard]] std::int64_t received_ns() const { return received_ns_; }  // the newest of its data

  // By its stamp, if any, and no later than its own packet was dated: the sender may have begun anew since.
  std::int64_t captured_ns() const {
    const std::int64_t ticks = picture_->best_effort_timestamp;
    const std::int64_t latest_ns = packets_.time_ns_of(picture_->reordered_opaque).value_or(received_ns_);
    return ticks == AV_NOPTS_VALUE ? latest_ns : std::min(latest_ns, clock_.captured_ns(stamp_ns(ticks)));
  }
  // The session's name as an RTSP server gives it, before any picture. (What MPEG-TS says of its programs
  // comes now and then, and may not have come yet.)
  [[nodiscard]] std::string identity() const {
    if (pictures_ != nullptr) return pictures_->title();
    if (std::string_view(container_->iformat->name) != "rtsp") return "";
    const AVDictionaryEntry* const title = av_dict_get(container_->metadata, "title", nullptr, 0);
    return title != nullptr ? title->value : "";
  }
  double frames_per_second() const { return frames_per_second_of(stream()); }

 private:
  // Half of the time is left to libavformat. No container: it is to try.
  void open_by_picture(const std::string& address, Cut& cut) {
    const std::int64_t now_ns = steady_now_ns();
    auto pictures = std::make_unique<RtspPictures>(address, now_ns + (data_by_ns_ - now_ns) / 2);
    container_ = pictures->take_container();
    if (pictures->is_other()) cut = Cut::ByParser;
    if (container_ == nullptr) return;
    stream_index_ = 0;
    pictures_ = std::move(pictures);
  }

  void open_by_libavformat(const std::string& address, bool is_again, Cut cut) {
    AVFormatContext* opening = avformat_alloc_context();
    opening->interrupt_callback = {[](void* self) { return static_cast<Connection*>(self)->is_late(); },
                                   this};
    FreeDictionary options;
    // Nothing is held back for what may come late, and a loss is a lost picture, never a wait.
    av_dict_set(&options.entries, "fflags", "nobuffer", 0);
    av_dict_set(&options.entries, "rtsp_flags", "prefer_tcp", 0);
    av_dict_set(&options.entries, "max_delay", "100000", 0);
    av_dict_set(&options.entries, "analyzeduration", "500000", 0);
    // How many pictures a second come is known from before.
    if (is_again) av_dict_set(&options.entries, "fpsprobesize", "0", 0);
    av_dict_set(&options.entries, "fifo_size", "200000", 0);
    av_dict_set(&options.entries, "overrun_nonfatal", "1", 0);
    av_dict_set(&options.entries, "buffer_size", "8388608", 0);
    if (cut == Cut::AsTheyCome && address.starts_with("udp://"))
      datagrams_ = std::make_unique<DatagramInput>(address, opening->interrupt_callback, &options.entries);
    int error = datagrams_ != nullptr ? datagrams_->error() : 0;
    if (error == 0) {
      if (datagrams_ != nullptr) opening->pb = datagrams_->context();
      error = avformat_open_input(&opening, address.c_str(), nullptr, &options.entries);
    }
    container_.reset(opening);
    if (error < 0) fail(address, connection_words(is_late() ? AVERROR(ETIMEDOUT) : error, address));
    if (datagrams_ != nullptr && is_transport(*container_))
      container_->flags |= AVFMT_FLAG_NOPARSE | AVFMT_FLAG_NOFILLIN;
    // A server that has said what it sends (RTSP) is believed: looking into it costs half a second.
    stream_index_ = is_again ? video_in_container() : -1;
    if (stream_index_ < 0) {
      if (avformat_find_stream_info(container_.get(), nullptr) < 0)
        fail(address, "no video was found in it in time");
      stream_index_ = video_in_container();
    }
    if (stream_index_ < 0) fail(address, "holds no video");
    held_back_ = held_back(*container_, stream().codecpar->codec_id);
    if (is_cut_by_packets()) datagrams_->ends().follow(stream().id);
  }

  // Below 0: none that is known.
  [[nodiscard]] int video_in_container() const {
    const int index = av_find_best_stream(container_.get(), AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
    const bool is_known = index >= 0 && container_->streams[index]->codecpar->codec_id != AV_CODEC_ID_NONE;
    return is_known ? index : -1;
  }
  AVStream& stream() const { return *container_->streams[stream_index_]; }
  int is_late() const { return steady_now_ns() > data_by_ns_ ? 1 : 0; }
  std::int64_t stamp_ns(std::int64_t ticks) const {
    return av_rescale_q(ticks, stream().time_base, {1, static_cast<int>(kSecond_ns)});
  }
  [[noreturn]] static void fail(const std::string& address, const std::string& reason) {
    throw DeviceError(shown_address(address) + ": " + reason);
  }

  // Of MPEG-TS, with the ends of pictures told.
  [[nodiscard]] bool is_cut_by_packets() const { return (container_->flags & AVFMT_FLAG_NOPARSE) != 0; }
  // One that lost something on its way is no sign.
  void judge_cut(const AVPacket& packet) {
    if (!is_cut_by_packets() || (packet.flags & AV_PKT_FLAG_CORRUPT) != 0) return;
    odd_packets_ = is_one_picture(packet, stream().codecpar->codec_id) ? 0 : odd_packets_ + 1;
  }

  bool feed() {
    if (needs_parser() || !read()) return false;
    const bool is_video = packet_->stream_index == stream_index_;
    if (is_video) join(*packet_);
    av_packet_unref(packet_.get());
    return true;
  }

  // Unparsed, libavformat gives a picture of more than 200 KiB (MAX_PES_PAYLOAD) in pieces, of which the
  // first alone has a time. Each by itself would be a picture whose lower part is missing, and another one
  // without its beginning.
  void join(AVPacket& packet) {
    constexpr int kFull = 200 * 1024 - 184;  // less than a packet of the transport is left of it
    if (!is_cut_by_packets()) return take(packet);
    const bool is_piece = packet.pts == AV_NOPTS_VALUE && packet.dts == AV_NOPTS_VALUE;
    if (pieces_->size > 0 && is_piece) {
      const int before = pieces_->size;
      if (av_grow_packet(pieces_.get(), packet.size) < 0) return;
      std::copy_n(packet.data, packet.size, pieces_->data + before);
      pieces_->flags |= packet.flags & AV_PKT_FLAG_CORRUPT;
      if (packet.size <= kFull) take_joined();
      return;
    }
    take_joined();  // it was as large as that by chance
    if (packet.size <= kFull) return take(packet);
    av_packet_move_ref(pieces_.get(), &packet);
  }
  void take_joined() {
    if (pieces_->size > 0) take(*pieces_);
    av_packet_unref(pieces_.get());
  }

  bool read() {
    if (pictures_ == nullptr) return av_read_frame(container_.get(), packet_.get()) == 0;
    if (!pictures_->read(stream(), *packet_, data_by_ns_)) return false;
    if (av_packet_get_side_data(packet_.get(), AV_PKT_DATA_NEW_EXTRADATA, nullptr) != nullptr)
      packets_.begin(stream());
    return true;
  }

  void take(AVPacket& packet) {
    received_ns_ = steady_now_ns();
    std::shift_right(given_out_ns_.begin(), given_out_ns_.end(), 1);
    given_out_ns_[0] = received_ns_;
    judge_cut(packet);
    // It was there already when the one that was held back for it was given out.
    const bool was_ended = datagrams_ != nullptr && datagrams_->ends().was_ended(packet.pos);
    const std::size_t held = was_ended ? 0 : held_back_;
    const std::int64_t there_ns = given_out_ns_[held] > 0 ? given_out_ns_[held] : received_ns_;
    if (packet.pts != AV_NOPTS_VALUE) clock_.arrived(stamp_ns(packet.pts), there_ns);
    const std::int64_t time_ns =
        packet.pts == AV_NOPTS_VALUE ? received_ns_ : clock_.captured_ns(stamp_ns(packet.pts));
    decoder_->reordered_opaque = packets_.put(packet, time_ns, decoder_->has_b_frames);
    if (passes_over(packet, received_ns_ - time_ns)) return;
    if ((packet.flags & AV_PKT_FLAG_CORRUPT) != 0) return begin_anew();
    if (waits_for_start_ && !may_begin_at(packet, *stream().codecpar)) return;
    waits_for_start_ = false;
    (void)avcodec_send_packet(decoder_.get(), &packet);
  }

  // Pictures that rest on one that lost something on its way look whole, and show what is not there: none is
  // given before one begins anew. H.264's decoder knows by itself when that is, also where a sender repeats
  // every part in turn and sends no key frame.
  void begin_anew() {
    ++damaged_count_;
    avcodec_flush_buffers(decoder_.get());
    waits_for_start_ = decoder_->codec_id != AV_CODEC_ID_H264;
  }

  // A machine that decodes more slowly than pictures come would be ever further behind.
  bool passes_over(const AVPacket& packet, std::int64_t age_ns) {
    if (age_ns > kBehind_ns) is_behind_ = true;
    if (!is_behind_) return false;
    if (age_ns > kCaughtUp_ns || !may_begin_at(packet, *stream().codecpar)) return true;
    is_behind_ = false;
    avcodec_flush_buffers(decoder_.get());
    return false;
  }

  static constexpr int kOddPackets = 3;  // on end: no accident
  EncodedPackets& packets_;
  std::unique_ptr<DatagramInput> datagrams_;  // of a UDP port; else null
  std::unique_ptr<RtspPictures> pictures_;    // of RTSP, where it gives them; else null
  LibavPtr<AVFormatContext> container_;
  LibavPtr<AVCodecContext> decoder_;
  LibavPtr<AVPacket> packet_;
  LibavPtr<AVPacket> pieces_;  // of a picture that is larger than libavformat gives at once
  LibavPtr<AVFrame> picture_;
  StreamClock clock_;
  std::int64_t data_by_ns_, received_ns_ = 0;
  std::array<std::int64_t, 3> given_out_ns_{};  // the newest packets, the newest first; 0: none
  std::size_t held_back_ = 0;                   // see there
  int odd_packets_ = 0;                         // on end, that are not one picture each
  long damaged_count_ = 0;
  bool has_ended_ = false, is_behind_ = false, waits_for_start_ = false;
  int stream_index_ = -1;
};

// One connection as a source; whoever opened it opens another one when it breaks.
class NetworkStream final : public FrameSource {
 public:
  // cut: as it was found to be, also for the next connection.
  NetworkStream(const std::string& address, const Opening& opening,
                const std::shared_ptr<EncodedPackets>& packets, std::shared_ptr<Connection::Cut> cut)
      : stamps_(opening.stamps), remark_(opening.remark), cut_(std::move(cut)) {
    info_.name = shown_address(address);
    info_.kind = SourceKind::Live;
    info_.ends = false;
    info_.packets = packets;
    av_log_set_level(AV_LOG_QUIET);
    avformat_network_init();
    const std::int64_t deadline_ns =
        steady_now_ns() + (opening.is_again ? kOpensAgainWithin_ns : kOpensWithin_ns);
    const auto first_picture = [&] {
      connection_.reset();  // a port can be listened to once
      connection_ = std::make_unique<Connection>(address, deadline_ns, opening.is_again, *cut_, *packets);
      last_picture_ns_ = steady_now_ns();
      return connection_->next(opening.is_again ? last_picture_ns_ + kPictureless_ns : deadline_ns,
                               deadline_ns);
    };
    const AVFrame* picture = first_picture();
    if (picture == nullptr && learns_cut()) picture = first_picture();
    opening.identity = connection_->identity();
    // One that is taken up between two key frames is kept: connecting anew might miss every one of them.
    if (picture == nullptr && opening.is_again && connection_->gives_data()) return;
    if (picture == nullptr) throw DeviceError(why_no_picture("gives no picture"));
    info_.image_size_px = {picture->width, picture->height};
    info_.frames_per_second = connection_->frames_per_second();
    first_ = frame_of(*picture);
  }

  const SourceInfo& info() const override { return info_; }

  camera::FramePtr next() override {
    if (first_) return std::exchange(first_, nullptr);
    remark_.clear();
    const std::int64_t now_ns = steady_now_ns();
    if (const AVFrame* const picture = connection_->next(now_ns + kPictureless_ns, now_ns + kSilence_ns))
      return frame_of(*picture);
    (void)learns_cut();
    const std::string why = why_no_picture("broke off; connecting again");
    if (!connection_->gives_data() || steady_now_ns() - last_picture_ns_ > kKeyFrameWithin_ns)
      throw DeviceError(why);
    remark_ = why;
    return nullptr;
  }

 private:
  camera::FramePtr frame_of(const AVFrame& picture) {
    const std::shared_ptr<camera::Frame> frame = frames_.make(picture);
    if (frame == nullptr) throw DeviceError(info_.name + ": has a pixel format that can't be converted");
    last_picture_ns_ = steady_now_ns();
    damaged_before_ = connection_->damaged_count();
    stamps_.put_on(*frame, connection_->captured_ns(), camera::CaptureClock::Network);
    frame->received_ns = connection_->received_ns();
    frame->decoded_ns = last_picture_ns_;
    frame->packet = static_cast<std::int32_t>(picture.reordered_opaque);
    return frame;
  }

  // True: its packets are other than they were taken for.
  bool learns_cut() {
    if (connection_->needs_parser()) *cut_ = Connection::Cut::ByParser;
    return connection_->needs_parser();
  }

  // Since the last one; without_data: when nothing came.
  [[nodiscard]] std::string why_no_picture(const char* without_data) const {
    if (connection_->damaged_count() > damaged_before_)
      return info_.name + ": every picture comes damaged: check cable and network";
    if (connection_->is_behind())
      return info_.name + ": was more than 2 s behind; goes on with the next key frame";
    if (connection_->gives_data())
      return info_.name + ": gives data without a key frame, and no picture can begin without one";
    return info_.name + ": " + without_data;
  }

  LiveStamps& stamps_;
  std::string& remark_;
  std::shared_ptr<Connection::Cut> cut_;
  std::unique_ptr<Connection> connection_;
  DecodedFrames frames_;
  SourceInfo info_;
  camera::FramePtr first_;
  std::int64_t last_picture_ns_ = 0;  // or since when one is waited for
  long damaged_before_ = 0;           // that one
};

}  // namespace

std::unique_ptr<FrameSource> open_network_stream(const std::string& address) {
  return recovering(
      [address, packets = std::make_shared<EncodedPackets>(),
       cut = std::make_shared<Connection::Cut>(Connection::Cut::AsTheyCome)](const Opening& opening) {
        return std::make_unique<NetworkStream>(address, opening, packets, cut);
      });
}

}  // namespace arthronaut::sources
