#include "navigation/sources/network_stream.h"

#include <chrono>
#include <thread>
#include <utility>

#include "navigation/sources/capture_time.h"
#include "navigation/sources/libav.h"
#include "planning/geometry/error.h"
#include "planning/log/log.h"

extern "C" {
#include <libavutil/log.h>
}

namespace arthronaut::sources {

namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::int64_t kOpensWithin_ns = 10 * kSecond_ns, kGivesUpAfter_ns = 15 * kSecond_ns;
constexpr std::int64_t kSilence_ns = kSecond_ns;  // after so much the connection is made anew
constexpr auto kBeforeAgain = std::chrono::milliseconds(200);

struct FreeDictionary {
  AVDictionary* entries = nullptr;
  ~FreeDictionary() { av_dict_free(&entries); }
};

// One connection: from the address to decoded pictures. What goes wrong in it ends it.
class Connection {
 public:
  // Throws DeviceError.
  Connection(const std::string& address, std::int64_t deadline_ns)
      : packet_(av_packet_alloc()), picture_(av_frame_alloc()), deadline_ns_(deadline_ns) {
    AVFormatContext* opening = avformat_alloc_context();
    opening->interrupt_callback = {[](void* self) { return static_cast<Connection*>(self)->is_late(); },
                                   this};
    FreeDictionary options;
    // Nothing is held back for what may come late, and a loss is a lost picture, never a wait.
    av_dict_set(&options.entries, "fflags", "nobuffer", 0);
    av_dict_set(&options.entries, "rtsp_flags", "prefer_tcp", 0);
    av_dict_set(&options.entries, "max_delay", "100000", 0);
    av_dict_set(&options.entries, "analyzeduration", "500000", 0);
    av_dict_set(&options.entries, "fifo_size", "200000", 0);
    av_dict_set(&options.entries, "overrun_nonfatal", "1", 0);
    av_dict_set(&options.entries, "buffer_size", "8388608", 0);
    const int error = avformat_open_input(&opening, address.c_str(), nullptr, &options.entries);
    container_.reset(opening);
    if (error < 0) fail(address, libav_message(is_late() ? AVERROR(ETIMEDOUT) : error));
    if (avformat_find_stream_info(container_.get(), nullptr) < 0)
      fail(address, "no video was found in it in time");
    stream_index_ = av_find_best_stream(container_.get(), AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
    if (stream_index_ < 0) fail(address, "holds no video");
    open_decoder(address);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  // The next whole picture; null when the connection has ended or nothing came until then.
  const AVFrame* next(std::int64_t deadline_ns) {
    deadline_ns_ = deadline_ns;
    for (;;) {
      const int received = avcodec_receive_frame(decoder_.get(), picture_.get());
      if (received == 0) {
        const bool is_whole =
            picture_->decode_error_flags == 0 && (picture_->flags & AV_FRAME_FLAG_CORRUPT) == 0;
        if (is_whole) return picture_.get();
        continue;
      }
      if (received != AVERROR(EAGAIN) || !feed()) return nullptr;
    }
  }

  // A bare stream of pictures has no stamps: then it is now.
  std::int64_t captured_ns() const {
    const std::int64_t ticks = picture_->best_effort_timestamp;
    return ticks == AV_NOPTS_VALUE ? steady_now_ns() : clock_.captured_ns(stamp_ns(ticks));
  }
  double frames_per_second() const {
    const AVRational rate = stream().avg_frame_rate.num > 0 ? stream().avg_frame_rate : stream().r_frame_rate;
    return rate.num > 0 && rate.den > 0 ? av_q2d(rate) : 0;
  }

 private:
  AVStream& stream() const { return *container_->streams[stream_index_]; }
  int is_late() const { return steady_now_ns() > deadline_ns_ ? 1 : 0; }
  std::int64_t stamp_ns(std::int64_t ticks) const {
    return av_rescale_q(ticks, stream().time_base, {1, static_cast<int>(kSecond_ns)});
  }
  [[noreturn]] static void fail(const std::string& address, const std::string& reason) {
    throw DeviceError(shown_address(address) + ": " + reason);
  }

  void open_decoder(const std::string& address) {
    const AVCodec* codec = avcodec_find_decoder(stream().codecpar->codec_id);
    if (codec == nullptr) fail(address, "no decoder for its video");
    decoder_.reset(avcodec_alloc_context3(codec));
    avcodec_parameters_to_context(decoder_.get(), stream().codecpar);
    // Threads by frames would hold back as many pictures as there are threads.
    decoder_->thread_count = 2;
    decoder_->thread_type = FF_THREAD_SLICE;
    decoder_->flags |= AV_CODEC_FLAG_LOW_DELAY;
    decoder_->max_pixels = kMostPixels;
    decoder_->pkt_timebase = stream().time_base;
    if (const int error = avcodec_open2(decoder_.get(), codec, nullptr); error < 0)
      fail(address, "its video can't be decoded: " + libav_message(error));
  }

  bool feed() {
    if (av_read_frame(container_.get(), packet_.get()) < 0) return false;
    const bool is_video = packet_->stream_index == stream_index_;
    if (is_video && packet_->pts != AV_NOPTS_VALUE) clock_.arrived(stamp_ns(packet_->pts), steady_now_ns());
    // What a damaged packet makes of a picture is seen when it is decoded.
    if (is_video) (void)avcodec_send_packet(decoder_.get(), packet_.get());
    av_packet_unref(packet_.get());
    return true;
  }

  LibavPtr<AVFormatContext> container_;
  LibavPtr<AVCodecContext> decoder_;
  LibavPtr<AVPacket> packet_;
  LibavPtr<AVFrame> picture_;
  StreamClock clock_;
  std::int64_t deadline_ns_;
  int stream_index_ = -1;
};

class NetworkStream final : public FrameSource {
 public:
  explicit NetworkStream(const std::string& address) : address_(address) {
    info_.name = shown_address(address_);
    av_log_set_level(AV_LOG_QUIET);
    avformat_network_init();
    const std::int64_t deadline_ns = steady_now_ns() + kOpensWithin_ns;
    connection_ = std::make_unique<Connection>(address_, deadline_ns);
    const AVFrame* const picture = connection_->next(deadline_ns);
    if (picture == nullptr) throw DeviceError(info_.name + ": gives no picture");
    info_.image_size_px = {picture->width, picture->height};
    info_.frames_per_second = connection_->frames_per_second();
    info_.kind = SourceKind::Live;
    started_at_ns_ = connection_->captured_ns();
    first_ = frame_of(*picture);
  }

  const SourceInfo& info() const override { return info_; }

  camera::FramePtr next() override {
    if (first_) return std::exchange(first_, nullptr);
    const std::int64_t give_up_ns = steady_now_ns() + kGivesUpAfter_ns;
    while (steady_now_ns() < give_up_ns) {
      if (!connection_ && !connect_again(give_up_ns)) continue;
      if (const AVFrame* const picture = connection_->next(steady_now_ns() + kSilence_ns))
        return frame_of(*picture);
      log::warning("stream broke off: " + info_.name);
      connection_.reset();
    }
    throw DeviceError(info_.name + ": has given no picture for 15 s");
  }

 private:
  bool connect_again(std::int64_t give_up_ns) {
    try {
      connection_ = std::make_unique<Connection>(address_, give_up_ns);
      log::info("stream taken up again: " + info_.name);
      return true;
    } catch (const DeviceError&) {  // told when it lasts
      std::this_thread::sleep_for(kBeforeAgain);
      return false;
    }
  }

  camera::FramePtr frame_of(const AVFrame& picture) {
    if (picture.width != info_.image_size_px.x() || picture.height != info_.image_size_px.y()) {
      throw DeviceError(info_.name + ": gives pictures of " + std::to_string(picture.width) + " x " +
                        std::to_string(picture.height) + " now, and gave such of " +
                        std::to_string(info_.image_size_px.x()) + " x " +
                        std::to_string(info_.image_size_px.y()));
    }
    auto frame = std::make_shared<camera::Frame>();
    if (!converter_.convert(picture, *frame))
      throw DeviceError(info_.name + ": has a pixel format that can't be converted");
    frame->index = next_index_++;
    frame->captured_ns = connection_->captured_ns();
    last_timestamp_ns_ = std::max(frame->captured_ns - started_at_ns_, last_timestamp_ns_ + 1);
    frame->timestamp_ns = last_timestamp_ns_;
    frame->capture_clock = camera::CaptureClock::Network;
    return frame;
  }

  std::string address_;
  std::unique_ptr<Connection> connection_;
  BgrConverter converter_;
  SourceInfo info_;
  camera::FramePtr first_;
  std::int64_t started_at_ns_ = 0, last_timestamp_ns_ = -1, next_index_ = 0;
};

}  // namespace

std::unique_ptr<FrameSource> open_network_stream(const std::string& address) {
  return std::make_unique<NetworkStream>(address);
}

}  // namespace arthronaut::sources
