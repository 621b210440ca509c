#include "navigation/sources/kept_stream.h"

#include <algorithm>
#include <deque>
#include <map>
#include <utility>

#include "navigation/sources/libav.h"
#include "navigation/sources/matroska_end.h"
#include "planning/geometry/error.h"

extern "C" {
#include <libavutil/log.h>
}

namespace arthronaut::sources {

namespace {

constexpr std::size_t kRememberedPictures = 16;  // 50 MB at 1080p, and as much of what lies before them
// A picture comes out of a decoder this many packets after its own at the latest: what may be put in order
// (16), and as many threads.
constexpr std::int64_t kLatest = 64;

}  // namespace

struct KeptStream::State {
  State(const KeptStreamFile& of, Use with_use) : kept(of), use(with_use) {
    av_log_set_level(AV_LOG_QUIET);
    AVFormatContext* opened = avformat_alloc_context();
    // Packets as they lie in the file, none split, put together or told anything about.
    opened->flags |= AVFMT_FLAG_NOPARSE | AVFMT_FLAG_NOFILLIN;
    const int error = avformat_open_input(&opened, kept.file.c_str(), nullptr, nullptr);
    container.reset(opened);
    if (error == AVERROR(EACCES)) throw IoError(kept.file, "can't be opened: permission denied");
    if (error < 0)
      throw InvalidInput(kept.file, "", "is not a video that can be read: " + libav_message(error));
    if (container->nb_streams != 1 || stream().codecpar->codec_type != AVMEDIA_TYPE_VIDEO)
      throw InvalidInput(kept.file, "", "holds no video, or more than one");
    const int width = stream().codecpar->width, height = stream().codecpar->height;
    if (width <= 0 || height <= 0 || std::int64_t{width} * height > kMostPixels)
      throw InvalidInput(kept.file, "", "has no size that a picture can have");
    info.name = kept.file.filename().string();
    info.image_size_px = {width, height};
    if (matroska_is_unfinished(kept.file)) add_index();
    open_decoder();
  }

  [[nodiscard]] AVStream& stream() const { return *container->streams[0]; }

  void open_decoder() {
    std::string problem;
    decoder = open_stream_decoder(*stream().codecpar, stream().time_base, problem,
                                  use == Use::ToReplay ? DecoderUse::Live : DecoderUse::Quick);
    if (decoder == nullptr) throw InvalidInput(kept.file, "", problem);
    decoder->has_b_frames = kept.held_back;
  }

  // Each start begins a cluster.
  void add_index() {
    std::map<std::int64_t, std::int64_t> position_at;
    for (const MatroskaCluster& cluster : matroska_clusters(kept.file))
      position_at.emplace(cluster.time, cluster.position);
    for (const StreamStart& start : kept.starts)
      if (const auto at = position_at.find(start.time_ms); at != position_at.end())
        av_add_index_entry(&stream(), at->second, ticks_of(start), 0, 0, AVINDEX_KEYFRAME);
  }

  [[nodiscard]] std::int64_t ticks_of(const StreamStart& start) const {
    return av_rescale_q(start.time_ms, {1, 1000}, stream().time_base);
  }

  // The next whole picture into `decoded`; false at the end and where the file breaks off.
  bool decode() {
    while (true) {
      const int received = avcodec_receive_frame(decoder.get(), decoded.get());
      if (received == 0) {
        if (is_whole(*decoded)) return true;
        continue;
      }
      if (received != AVERROR(EAGAIN) || is_drained) return false;
      feed();
    }
  }

  void feed() {
    const int read = av_read_frame(container.get(), packet.get());
    // What is cut off is not decoded.
    if (read < 0 || (packet->flags & AV_PKT_FLAG_CORRUPT) != 0) {
      is_drained = true;
      (void)avcodec_send_packet(decoder.get(), nullptr);
      av_packet_unref(packet.get());
      return;
    }
    if (awaited != nullptr && std::exchange(awaited, nullptr)->time_ms != file_ms(*packet)) {
      is_drained = true;  // the file's index led somewhere else
      av_packet_unref(packet.get());
      return;
    }
    decoder->reordered_opaque = next_packet++;
    // What a damaged packet makes of a picture is seen when it is decoded.
    (void)avcodec_send_packet(decoder.get(), packet.get());
    av_packet_unref(packet.get());
  }

  [[nodiscard]] std::int64_t file_ms(const AVPacket& of) const {
    return av_rescale_q(of.pts, stream().time_base, {1, 1000});
  }

  bool seek(const StreamStart& start) {
    avcodec_flush_buffers(decoder.get());
    remembered.clear();
    is_drained = av_seek_frame(container.get(), 0, ticks_of(start), AVSEEK_FLAG_BACKWARD) < 0;
    next_packet = start.packet;
    newest = -1;
    awaited = &start;
    return !is_drained;
  }

  [[nodiscard]] camera::FramePtr frame_of(const AVFrame& picture) {
    const std::shared_ptr<camera::Frame> frame = frames.make(picture);
    if (frame != nullptr) frame->packet = static_cast<std::int32_t>(picture.reordered_opaque);
    return frame;
  }

  [[nodiscard]] camera::FramePtr find_remembered(std::int64_t number) {
    for (const LibavPtr<AVFrame>& picture : remembered)
      if (picture->reordered_opaque == number) return frame_of(*picture);
    return nullptr;
  }

  // Null: it is not there, or on_the_way ended it.
  camera::FramePtr read_on_to(std::int64_t number, const OnTheWay& on_the_way) {
    while (next_packet <= number + kLatest && decode()) {
      LibavPtr<AVFrame> picture(av_frame_alloc());
      av_frame_move_ref(picture.get(), decoded.get());
      newest = std::max(newest, picture->reordered_opaque);
      remembered.push_back(std::move(picture));
      if (remembered.size() > kRememberedPictures) remembered.pop_front();
      if (remembered.back()->reordered_opaque == number) return frame_of(*remembered.back());
      if (!on_the_way([this] { return frame_of(*remembered.back()); })) return nullptr;
    }
    return nullptr;
  }

  KeptStreamFile kept;
  Use use;
  SourceInfo info;
  LibavPtr<AVFormatContext> container;
  LibavPtr<AVCodecContext> decoder;
  LibavPtr<AVPacket> packet{av_packet_alloc()};
  LibavPtr<AVFrame> decoded{av_frame_alloc()};
  DecodedFrames frames;
  std::deque<LibavPtr<AVFrame>> remembered;   // those decoded last, since the last seek
  const StreamStart* awaited = nullptr;       // what must be read first after a seek
  std::int64_t next_packet = 0, newest = -1;  // the one to be read; the newest that came out
  bool is_drained = false;
};

KeptStream::KeptStream(const KeptStreamFile& file, Use use) : state_(std::make_unique<State>(file, use)) {}

KeptStream::~KeptStream() = default;

const SourceInfo& KeptStream::info() const { return state_->info; }

camera::FramePtr KeptStream::next() {
  return state_->decode() ? state_->frame_of(*state_->decoded) : nullptr;
}

bool KeptStream::remembers(std::int64_t packet) const {
  const auto& remembered = state_->remembered;
  return std::any_of(remembered.begin(), remembered.end(), [packet](const LibavPtr<AVFrame>& picture) {
    return picture->reordered_opaque == packet;
  });
}

std::optional<std::int64_t> KeptStream::first_remembered() const {
  if (state_->remembered.empty()) return std::nullopt;
  return state_->remembered.front()->reordered_opaque;
}

camera::FramePtr KeptStream::picture(std::int64_t packet, const OnTheWay& on_the_way) {
  State& s = *state_;
  if (const camera::FramePtr known = s.find_remembered(packet)) return known;
  const auto after =
      std::upper_bound(s.kept.starts.begin(), s.kept.starts.end(), packet,
                       [](std::int64_t number, const StreamStart& start) { return number < start.packet; });
  if (after == s.kept.starts.begin()) return nullptr;
  const StreamStart& start = *std::prev(after);
  // Some that have been read may still be in the decoder.
  const bool is_ahead = s.next_packet > start.packet && s.newest >= 0 && s.newest < packet;
  bool is_wanted = true;
  const OnTheWay passing = [&](const auto& passed) {
    return is_wanted = on_the_way == nullptr || on_the_way(passed);
  };
  if (is_ahead)
    if (const camera::FramePtr found = s.read_on_to(packet, passing); found || !is_wanted) return found;
  return s.seek(start) ? s.read_on_to(packet, passing) : nullptr;
}

}  // namespace arthronaut::sources
