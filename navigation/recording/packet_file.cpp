#include "navigation/recording/packet_file.h"

#include <algorithm>
#include <cstring>
#include <new>

#include "navigation/recording/matroska_writer.h"
#include "planning/geometry/error.h"

extern "C" {
#include <libavcodec/bsf.h>
}

namespace arthronaut::recording {

namespace {

struct FreeFilter {
  void operator()(AVBSFContext* p) const { av_bsf_free(&p); }
};

bool needs_parameter_sets(const AVCodecParameters& parameters) {
  return parameters.codec_id == AV_CODEC_ID_H264 || parameters.codec_id == AV_CODEC_ID_HEVC;
}

// Where nobody has said the parameter sets of a stream they lie before its first picture.
void add_parameter_sets(AVCodecParameters& parameters, const AVPacket& first) {
  if (!needs_parameter_sets(parameters) || parameters.extradata_size > 0) return;
  AVBSFContext* made = nullptr;
  if (av_bsf_alloc(av_bsf_get_by_name("extract_extradata"), &made) < 0) return;
  const std::unique_ptr<AVBSFContext, FreeFilter> filter(made);
  const sources::LibavPtr<AVPacket> packet(av_packet_alloc());
  if (avcodec_parameters_copy(filter->par_in, &parameters) < 0 || av_bsf_init(made) < 0 ||
      av_packet_ref(packet.get(), &first) < 0 || av_bsf_send_packet(made, packet.get()) < 0 ||
      av_bsf_receive_packet(made, packet.get()) < 0)
    return;
  std::size_t size = 0;
  const std::uint8_t* const found = av_packet_get_side_data(packet.get(), AV_PKT_DATA_NEW_EXTRADATA, &size);
  if (found == nullptr) return;
  auto* const kept = static_cast<std::uint8_t*>(av_mallocz(size + AV_INPUT_BUFFER_PADDING_SIZE));
  if (kept == nullptr) throw std::bad_alloc();
  std::memcpy(kept, found, size);
  parameters.extradata = kept;
  parameters.extradata_size = static_cast<int>(size);
}

}  // namespace

struct PacketFile::State {
  State(const std::filesystem::path& file, const sources::EncodedPacket& first, const camera::Frame& picture)
      : writer(file), begins_ns(first.time_ns) {
    AVCodecParameters& parameters = *writer.stream().codecpar;
    if (avcodec_parameters_copy(&parameters, first.format->parameters.get()) < 0) throw std::bad_alloc();
    parameters.codec_tag = 0;  // of the container that it came in
    add_parameter_sets(parameters, *first.data);
    if (parameters.width <= 0 || parameters.height <= 0) {
      parameters.width = picture.width;
      parameters.height = picture.height;
    }
    writer.stream().time_base = {1, 1000};
    if (first.format->frames_per_second > 0)
      writer.stream().avg_frame_rate = av_d2q(first.format->frames_per_second, 100'000);
    writer.begin();
  }

  MatroskaWriter writer;
  sources::LibavPtr<AVPacket> packet{av_packet_alloc()};
  std::int64_t begins_ns, newest_ms = -1;
};

bool PacketFile::takes(const sources::EncodedPacket& first) {
  const AVCodecParameters& as_said = *first.format->parameters;
  const AVOutputFormat* const matroska = av_guess_format("matroska", nullptr, nullptr);
  if (matroska == nullptr || avformat_query_codec(matroska, as_said.codec_id, FF_COMPLIANCE_NORMAL) != 1)
    return false;
  const std::unique_ptr<AVCodecParameters, sources::FreeParameters> parameters(avcodec_parameters_alloc());
  if (avcodec_parameters_copy(parameters.get(), &as_said) < 0) throw std::bad_alloc();
  add_parameter_sets(*parameters, *first.data);
  return !needs_parameter_sets(*parameters) || parameters->extradata_size > 0;
}

PacketFile::PacketFile(const std::filesystem::path& file, const sources::EncodedPacket& first,
                       const camera::Frame& picture)
    : state_(std::make_unique<State>(file, first, picture)) {}

PacketFile::~PacketFile() = default;

std::int64_t PacketFile::write(const sources::EncodedPacket& packet) {
  State& s = *state_;
  std::int64_t time_ms = std::max<std::int64_t>((packet.time_ns - s.begins_ns) / 1'000'000, 0);
  if (packet.is_start) {
    time_ms = std::max(time_ms, s.newest_ms + 1);
    s.writer.end_cluster();
  }
  s.newest_ms = std::max(s.newest_ms, time_ms);
  if (av_packet_ref(s.packet.get(), packet.data.get()) < 0) throw std::bad_alloc();
  s.packet->pts = time_ms;
  s.packet->dts = 0;  // Matroska keeps none, and pictures that are put in order have no rising time
  s.packet->duration = 0;
  s.packet->flags = packet.is_start ? AV_PKT_FLAG_KEY : 0;
  s.writer.write(*s.packet, {1, 1000});
  return time_ms;
}

void PacketFile::finish() { state_->writer.finish(); }

}  // namespace arthronaut::recording
