#include "navigation/sources/video_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <utility>

#include "navigation/sources/libav.h"
#include "navigation/sources/matroska_end.h"
#include "planning/geometry/error.h"

extern "C" {
#include <libavutil/log.h>
}

namespace arthronaut::sources {
namespace {

constexpr double kFallbackFramesPerSecond = 60;
// How much earlier it is tried again where a file's index leads to a key frame behind the wish.
constexpr std::array<double, 4> kSeekBack_s{0, 1, 10, 60};
constexpr std::size_t kRememberedPictures = 16;  // 50 MB at 1080p, and as much of what lies before them

class VideoFile : public FrameSource, public SeekableVideo {
 public:
  VideoFile(const std::filesystem::path& file, LumaOf luma)
      : file_(file), luma_(luma), packet_(av_packet_alloc()), picture_(av_frame_alloc()) {
    // What goes wrong is told once, by exception, with file and frame.
    av_log_set_level(AV_LOG_QUIET);
    if (luma_ == LumaOf::File) converter_.expect_full_range();
    open_container();
    open_decoder();
    info_.name = file.filename().string();
    info_.image_size_px = {decoder_->width, decoder_->height};
    info_.frames_per_second = frames_per_second_of(stream());
    info_.frame_count = stream().nb_frames > 0 ? stream().nb_frames : -1;
    info_.encoded_file = file;
  }

  const SourceInfo& info() const override { return info_; }

  camera::FramePtr next() override {
    if (!decode()) return nullptr;
    if (next_index_ == 0) first_time_s_ = picture_s();
    last_timestamp_ns_ = std::max(timestamp_ns(*picture_, next_index_),
                                  last_timestamp_ns_ + 1);  // some recorders repeat a time
    auto frame = frame_of(*picture_, next_index_, last_timestamp_ns_);
    ++next_index_;
    return frame;
  }

  // To be called once, before any picture_at() and in the place of next().
  void prepare_seeking() {
    is_tolerant_ = true;
    add_missing_index();
    if (decode()) first_time_s_ = picture_s();
    (void)seek(0);      // libavformat reads an index with the first seek: of two hours, a tenth of a second
    is_at_end_ = true;  // the first wish seeks
    most_remembered_ = has_key_frames_alone() ? 1 : kRememberedPictures;
  }

  camera::FramePtr picture_at(std::int64_t time_ns, const OnTheWay& on_the_way) override {
    const double wanted_s = static_cast<double>(time_ns) * 1e-9;
    if (wanted_s < -grace_s()) return nullptr;
    if (const Remembered* const known = find_remembered(wanted_s)) return frame_at(*known);
    bool is_wanted = true;
    const OnTheWay passing = [&](const auto& passed) {
      return is_wanted = on_the_way == nullptr || on_the_way(passed);
    };
    if (is_reached_by_reading_on(wanted_s))
      if (camera::FramePtr found = read_on_to(wanted_s, passing)) return found;
    for (const double back_s : kSeekBack_s) {
      if (!is_wanted || !seek(std::max(wanted_s - back_s, 0.0))) return nullptr;
      if (camera::FramePtr found = read_on_to(wanted_s, passing)) return found;
      if (is_at_end_) return nullptr;
    }
    return nullptr;
  }

  bool remembers(std::int64_t time_ns) const override {
    return find_remembered(static_cast<double>(time_ns) * 1e-9) != nullptr;
  }
  std::optional<std::int64_t> first_remembered_ns() const override {
    if (remembered_.empty() || most_remembered_ == 1) return std::nullopt;
    return std::llround(remembered_.front().at_s * 1e9);
  }

 private:
  struct Remembered {
    double at_s;
    LibavPtr<AVFrame> picture;
  };

  camera::FramePtr frame_of(const AVFrame& picture, std::int64_t index, std::int64_t timestamp_ns) {
    auto frame = std::make_shared<camera::Frame>();
    frame->index = index;
    frame->timestamp_ns = timestamp_ns;
    convert(picture, *frame);
    if (luma_ == LumaOf::File) copy_luma(picture, *frame);
    return frame;
  }
  camera::FramePtr frame_at(const Remembered& of) {
    const std::int64_t index = std::llround(of.at_s * rate());
    return frame_of(*of.picture, index, timestamp_ns(*of.picture, index));
  }
  [[nodiscard]] const Remembered* find_remembered(double wanted_s) const {
    const auto found = std::find_if(remembered_.begin(), remembered_.end(), [&](const Remembered& one) {
      return std::abs(one.at_s - wanted_s) <= grace_s();
    });
    return found == remembered_.end() ? nullptr : &*found;
  }

  [[nodiscard]] double rate() const {
    return info_.frames_per_second > 0 ? info_.frames_per_second : kFallbackFramesPerSecond;
  }
  [[nodiscard]] double grace_s() const { return 0.5 / rate(); }
  [[nodiscard]] double picture_s() const {
    if (picture_->best_effort_timestamp == AV_NOPTS_VALUE) return static_cast<double>(next_index_) / rate();
    return static_cast<double>(picture_->best_effort_timestamp) * av_q2d(stream().time_base);
  }
  [[nodiscard]] std::int64_t ticks_of(double time_s) const {
    return std::llround((time_s + first_time_s_) / av_q2d(stream().time_base));
  }

  [[nodiscard]] bool has_key_frames_alone() const {
    const AVCodecDescriptor* const codec = avcodec_descriptor_get(stream().codecpar->codec_id);
    return codec != nullptr && (codec->props & AV_CODEC_PROP_INTRA_ONLY) != 0;
  }

  // A killed recording has no index: libavformat would read all before a picture to come to it. Where every
  // picture is a key frame, each cluster is a place to begin at.
  void add_missing_index() {
    if (!has_key_frames_alone() || !matroska_is_unfinished(file_)) return;
    for (const MatroskaCluster& cluster : matroska_clusters(file_))
      av_add_index_entry(&stream(), cluster.position, cluster.time, 0, 0, AVINDEX_KEYFRAME);
  }

  // Whether no key frame lies between the picture in hand and the wanted one.
  [[nodiscard]] bool is_reached_by_reading_on(double wanted_s) const {
    if (is_at_end_ || wanted_s < decoded_s_) return false;
    const AVIndexEntry* const key =
        avformat_index_get_entry_from_timestamp(&stream(), ticks_of(wanted_s), AVSEEK_FLAG_BACKWARD);
    if (key == nullptr) return wanted_s - decoded_s_ < 1;
    return static_cast<double>(key->timestamp) * av_q2d(stream().time_base) - first_time_s_ <=
           decoded_s_ + 2 * grace_s();
  }

  bool seek(double time_s) {
    is_at_end_ = breaks_off_ = false;
    decoded_s_ = -1;
    remembered_.clear();
    if (av_seek_frame(container_.get(), stream_index_, ticks_of(time_s), AVSEEK_FLAG_BACKWARD) < 0) {
      is_at_end_ = true;
      return false;
    }
    avcodec_flush_buffers(decoder_.get());
    return true;
  }

  // Decodes up to the picture of that time. Null when there is none, it lies behind, or on_the_way ended it.
  camera::FramePtr read_on_to(double wanted_s, const OnTheWay& on_the_way) {
    while (decode()) {
      decoded_s_ = picture_s() - first_time_s_;
      next_index_ = std::llround(decoded_s_ * rate()) + 1;
      const bool is_whole = !is_damaged();
      if (is_whole) remember();
      if (decoded_s_ < wanted_s - grace_s()) {
        if (is_whole && !on_the_way([this] { return frame_at(remembered_.back()); })) return nullptr;
        continue;
      }
      if (decoded_s_ > wanted_s + grace_s() || !is_whole) return nullptr;
      return frame_at(remembered_.back());
    }
    is_at_end_ = true;
    return nullptr;
  }

  void remember() {
    remembered_.push_back({decoded_s_, LibavPtr<AVFrame>(av_frame_alloc())});
    av_frame_move_ref(remembered_.back().picture.get(), picture_.get());
    if (remembered_.size() > most_remembered_) remembered_.pop_front();
  }

  [[nodiscard]] bool is_damaged() const {
    return picture_->decode_error_flags != 0 || (picture_->flags & AV_FRAME_FLAG_CORRUPT) != 0;
  }

  AVStream& stream() const { return *container_->streams[stream_index_]; }

  [[noreturn]] void fail(const std::string& reason) const { fail_at(next_index_, reason); }
  [[noreturn]] void fail_at(std::int64_t index, const std::string& reason) const {
    throw InvalidInput(file_, "frame " + std::to_string(index), reason);
  }

  void open_container() {
    AVFormatContext* opened = nullptr;
    const int error = avformat_open_input(&opened, file_.c_str(), nullptr, nullptr);
    container_.reset(opened);
    if (error == AVERROR(EACCES)) throw IoError(file_, "can't be opened: permission denied");
    if (error < 0) throw InvalidInput(file_, "", "is not a video that can be read: " + libav_message(error));
    if (const int e = avformat_find_stream_info(opened, nullptr); e < 0) {
      throw InvalidInput(file_, "", "holds no readable stream: " + libav_message(e));
    }
    stream_index_ = av_find_best_stream(opened, AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
    if (stream_index_ < 0) throw InvalidInput(file_, "", "holds no video");
    for (unsigned i = 0; i < opened->nb_streams; ++i) {
      if (static_cast<int>(i) != stream_index_) opened->streams[i]->discard = AVDISCARD_ALL;
    }
  }

  void open_decoder() {
    const AVCodec* codec = avcodec_find_decoder(stream().codecpar->codec_id);
    if (!codec) throw InvalidInput(file_, "", "no decoder for its video");
    decoder_.reset(avcodec_alloc_context3(codec));
    avcodec_parameters_to_context(decoder_.get(), stream().codecpar);
    decoder_->thread_count = 2;
    decoder_->max_pixels = kMostPixels;
    decoder_->pkt_timebase = stream().time_base;
    if (const int error = avcodec_open2(decoder_.get(), codec, nullptr); error < 0) {
      throw InvalidInput(file_, "", "its video can't be decoded: " + libav_message(error));
    }
    if (decoder_->width <= 0 || decoder_->height <= 0) {
      throw InvalidInput(file_, "frame 0", "is missing: the file breaks off before it");
    }
  }

  // Puts the next decoded picture into picture_. False at the file's proper end.
  bool decode() {
    while (true) {
      const int received = avcodec_receive_frame(decoder_.get(), picture_.get());
      if (received == 0) {
        if (!is_tolerant_ && is_damaged()) fail("is damaged");
        return true;
      }
      if (received == AVERROR_EOF) {
        if (!is_tolerant_) check_end();
        return false;
      }
      if (received != AVERROR(EAGAIN) && !is_tolerant_) fail("can't be decoded: " + libav_message(received));
      feed_decoder();
    }
  }

  // A packet that is cut off is not decoded: the pictures before it still come out, then check_end() tells.
  void feed_decoder() {
    const int read = breaks_off_ ? AVERROR_EOF : av_read_frame(container_.get(), packet_.get());
    if (read < 0) {
      if (read != AVERROR_EOF) breaks_off_ = true;
      avcodec_send_packet(decoder_.get(), nullptr);
      return;
    }
    int sent = 0;
    if (packet_->stream_index == stream_index_) {
      if (packet_->flags & AV_PKT_FLAG_CORRUPT) {
        breaks_off_ = true;
      } else {
        sent = avcodec_send_packet(decoder_.get(), packet_.get());
      }
    }
    av_packet_unref(packet_.get());
    if (sent < 0 && !is_tolerant_) fail("can't be decoded: " + libav_message(sent));
  }

  void check_end() const {
    const bool frames_are_missing = info_.frame_count > 0 && next_index_ < info_.frame_count;
    if (breaks_off_ || matroska_breaks_off(file_)) fail("is cut off: the file ends half-way through it");
    // Counts in AVI headers may be a few off; a file that lost its second half is told from that.
    if (frames_are_missing && next_index_ < info_.frame_count - 2) {
      fail("is missing: the file ends here and should hold " + std::to_string(info_.frame_count) + " frames");
    }
    if (next_index_ == 0) fail("is missing: the video is empty");
  }

  // From the first picture on; where the file's clock counts no finer, by the frame rate.
  [[nodiscard]] std::int64_t timestamp_ns(const AVFrame& picture, std::int64_t index) const {
    const double by_rate_s = static_cast<double>(index) / rate();
    double time_s = by_rate_s;
    if (picture.best_effort_timestamp != AV_NOPTS_VALUE) {
      const double tick_s = av_q2d(stream().time_base);
      time_s = static_cast<double>(picture.best_effort_timestamp) * tick_s - first_time_s_;
      if (std::abs(time_s - by_rate_s) <= tick_s) time_s = by_rate_s;
    }
    return std::llround(time_s * 1e9);
  }

  void convert(const AVFrame& picture, camera::Frame& frame) {
    if (picture.width != info_.image_size_px.x() || picture.height != info_.image_size_px.y()) {
      fail_at(frame.index, "has another size than the frames before it");
    }
    frame.width = picture.width;
    frame.height = picture.height;
    if (!converter_.convert(picture, frame.bgr))
      fail_at(frame.index, "has a pixel format that can't be converted");
  }

  void copy_luma(const AVFrame& picture, camera::Frame& frame) const {
    if (picture.format != AV_PIX_FMT_YUV420P && picture.format != AV_PIX_FMT_YUV444P) {
      fail_at(frame.index, "has no luma plane of its own");
    }
    frame.luma.resize(static_cast<std::size_t>(frame.width) * frame.height);
    for (int y = 0; y < frame.height; ++y) {
      const std::uint8_t* const row = picture.data[0] + static_cast<std::ptrdiff_t>(y) * picture.linesize[0];
      std::copy(row, row + frame.width, frame.luma.data() + static_cast<std::ptrdiff_t>(y) * frame.width);
    }
  }

  std::filesystem::path file_;
  LumaOf luma_;
  LibavPtr<AVFormatContext> container_;
  LibavPtr<AVCodecContext> decoder_;
  LibavPtr<AVPacket> packet_;
  LibavPtr<AVFrame> picture_;
  BgrConverter converter_;
  SourceInfo info_;
  int stream_index_ = -1;
  std::int64_t next_index_ = 0;
  std::int64_t last_timestamp_ns_ = -1;
  double first_time_s_ = 0;
  bool breaks_off_ = false;  // the demuxer met a cut-off packet or a read error
  // Of picture_at(): what is broken is passed over; the time of the picture that was decoded last, and those
  // that were decoded since the last seek.
  bool is_tolerant_ = false, is_at_end_ = false;
  double decoded_s_ = -1;
  std::size_t most_remembered_ = 1;
  std::deque<Remembered> remembered_;
};

}  // namespace

std::unique_ptr<SeekableVideo> open_seekable_video(const std::filesystem::path& file, LumaOf luma) {
  auto video = std::make_unique<VideoFile>(file, luma);
  video->prepare_seeking();
  return video;
}

std::unique_ptr<FrameSource> open_video_file(const std::filesystem::path& file, LumaOf luma) {
  return std::make_unique<VideoFile>(file, luma);
}

}  // namespace arthronaut::sources
