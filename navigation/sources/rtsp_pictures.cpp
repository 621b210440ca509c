#include "navigation/sources/rtsp_pictures.h"

#include <gst/app/gstappsink.h>
#include <gst/sdp/gstsdpmessage.h>

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "navigation/sources/capture_time.h"

namespace arthronaut::sources {

namespace {

constexpr unsigned kMostWaiting = 600;  // packets; a reader that is this late lets the sender wait

struct FreeParser {
  void operator()(AVCodecParserContext* p) const { av_parser_close(p); }
};

struct Depayloader {
  std::string_view encoding;
  const char *element, *caps;
  AVCodecID codec;
};
// Units carry their lengths, and the parameters come apart from them.
constexpr Depayloader kDepayloaders[]{
    {"H264", "rtph264depay", "video/x-h264,stream-format=avc,alignment=au", AV_CODEC_ID_H264},
    {"H265", "rtph265depay", "video/x-h265,stream-format=hvc1,alignment=au", AV_CODEC_ID_HEVC}};

std::string_view text_of(const GstStructure* structure, const char* field) {
  const char* const text = gst_structure_get_string(structure, field);
  return text != nullptr ? text : "";
}

}  // namespace

RtspPictures::RtspPictures(const std::string& address, std::int64_t deadline_ns) {
  gst_init(nullptr, nullptr);
  pipeline_.reset(GST_ELEMENT(gst_object_ref_sink(gst_pipeline_new(nullptr))));
  GstElement* const source = gst_element_factory_make("rtspsrc", nullptr);
  GstElement* const sink = gst_element_factory_make("appsink", nullptr);
  for (GstElement* const part : {source, sink})
    if (part != nullptr) gst_bin_add(GST_BIN(pipeline_.get()), part);
  if (source == nullptr || sink == nullptr) return;
  sink_.reset(GST_ELEMENT(gst_object_ref(sink)));
  g_object_set(sink, "sync", FALSE, "max-buffers", kMostWaiting, nullptr);
  // Nothing waits for what may come late, and stamps are the sender's. No report (RTCP) goes
  // back: after each, every five seconds, pictures stood still for 40 ms on the loopback, as a sender does
  // that waits for TCP's late acknowledgement.
  g_object_set(source, "location", address.c_str(), "latency", 0U, "do-rtcp", FALSE, nullptr);
  gst_util_set_object_arg(G_OBJECT(source), "buffer-mode", "none");
  gst_util_set_object_arg(G_OBJECT(source), "protocols", "tcp");
  g_signal_connect(source, "on-sdp", G_CALLBACK(&RtspPictures::on_sdp), this);
  g_signal_connect(source, "pad-added", G_CALLBACK(&RtspPictures::on_pad), this);
  gst_element_set_state(pipeline_.get(), GST_STATE_PLAYING);
  first_ = pull(deadline_ns);
  if (first_ == nullptr) return;
  LibavPtr<AVFormatContext> container(avformat_alloc_context());
  AVStream* const stream = avformat_new_stream(container.get(), nullptr);
  stream->time_base = {1, static_cast<int>(GST_SECOND)};
  if (describe(*stream, *first_)) container_ = std::move(container);
}

void RtspPictures::on_sdp(GstElement*, void* description, RtspPictures* self) {
  const char* const name = gst_sdp_message_get_session_name(static_cast<GstSDPMessage*>(description));
  self->title_ = name != nullptr ? name : "";
}

// Of several videos the first is taken; sound and the like lead nowhere.
void RtspPictures::on_pad(GstElement*, GstPad* pad, RtspPictures* self) {
  const GstPtr<GstCaps> caps(gst_pad_get_current_caps(pad));
  if (caps == nullptr) return;
  const GstStructure* const sent = gst_caps_get_structure(caps.get(), 0);
  const GstPtr<GstPad> end(gst_element_get_static_pad(self->sink_.get(), "sink"));
  if (text_of(sent, "media") != "video" || gst_pad_is_linked(end.get()) != 0) return;
  const auto* const known =
      std::find_if(std::begin(kDepayloaders), std::end(kDepayloaders),
                   [&](const Depayloader& one) { return one.encoding == text_of(sent, "encoding-name"); });
  GstElement* const depayloader =
      known != std::end(kDepayloaders) ? gst_element_factory_make(known->element, nullptr) : nullptr;
  if (depayloader == nullptr) {
    self->is_other_ = true;
    return;
  }
  gst_bin_add(GST_BIN(self->pipeline_.get()), depayloader);
  const GstPtr<GstCaps> wanted(gst_caps_from_string(known->caps));
  gst_app_sink_set_caps(GST_APP_SINK(self->sink_.get()), wanted.get());
  const GstPtr<GstPad> begin(gst_element_get_static_pad(depayloader, "sink"));
  if (gst_element_link(depayloader, self->sink_.get()) == 0 ||
      gst_element_sync_state_with_parent(depayloader) == 0 ||
      gst_pad_link(pad, begin.get()) != GST_PAD_LINK_OK)
    self->is_other_ = true;
}

// In short waits: what ends a connection does not always end a wait for its pictures.
GstPtr<GstSample> RtspPictures::pull(std::int64_t until_ns) {
  constexpr std::int64_t kLook_ns = 20'000'000;
  const GstPtr<GstBus> bus(gst_element_get_bus(pipeline_.get()));
  GstAppSink* const sink = GST_APP_SINK(sink_.get());
  for (std::int64_t left_ns = until_ns - steady_now_ns();; left_ns = until_ns - steady_now_ns()) {
    const auto wait = static_cast<GstClockTime>(std::clamp<std::int64_t>(left_ns, 0, kLook_ns));
    if (GstSample* const sample = gst_app_sink_try_pull_sample(sink, wait)) return GstPtr<GstSample>(sample);
    const GstPtr<GstMessage> error(gst_bus_pop_filtered(bus.get(), GST_MESSAGE_ERROR));
    if (left_ns <= 0 || error != nullptr || is_other_ || gst_app_sink_is_eos(sink) != 0) return nullptr;
  }
}

bool RtspPictures::describe(AVStream& stream, GstSample& sample) {
  caps_.reset(gst_caps_ref(gst_sample_get_caps(&sample)));
  const GstStructure* const described = gst_caps_get_structure(caps_.get(), 0);
  const GValue* const given = gst_structure_get_value(described, "codec_data");
  GstMapInfo parameters, picture;
  if (given == nullptr || gst_buffer_map(gst_value_get_buffer(given), &parameters, GST_MAP_READ) == 0)
    return false;
  AVCodecParameters& codec = *stream.codecpar;
  codec.codec_type = AVMEDIA_TYPE_VIDEO;
  codec.codec_id =
      gst_structure_has_name(described, "video/x-h264") != 0 ? AV_CODEC_ID_H264 : AV_CODEC_ID_HEVC;
  av_freep(&codec.extradata);
  codec.extradata = static_cast<std::uint8_t*>(av_mallocz(parameters.size + AV_INPUT_BUFFER_PADDING_SIZE));
  std::copy_n(parameters.data, parameters.size, codec.extradata);
  codec.extradata_size = static_cast<int>(parameters.size);
  gst_buffer_unmap(gst_value_get_buffer(given), &parameters);

  // The size of its pictures stands in the parameters, and which of them count in a picture.
  const std::unique_ptr<AVCodecParserContext, FreeParser> parser(av_parser_init(codec.codec_id));
  LibavPtr<AVCodecContext> context(avcodec_alloc_context3(nullptr));
  avcodec_parameters_to_context(context.get(), &codec);
  if (parser == nullptr || gst_buffer_map(gst_sample_get_buffer(&sample), &picture, GST_MAP_READ) == 0)
    return false;
  std::vector<std::uint8_t> padded(picture.data, picture.data + picture.size);
  gst_buffer_unmap(gst_sample_get_buffer(&sample), &picture);
  const int size = static_cast<int>(padded.size());
  padded.resize(padded.size() + AV_INPUT_BUFFER_PADDING_SIZE);
  parser->flags |= PARSER_FLAG_COMPLETE_FRAMES;
  std::uint8_t* parsed = nullptr;
  int parsed_size = 0;
  av_parser_parse2(parser.get(), context.get(), &parsed, &parsed_size, padded.data(), size, AV_NOPTS_VALUE,
                   AV_NOPTS_VALUE, -1);
  codec.width = parser->width;
  codec.height = parser->height;
  codec.format = parser->format;
  stream.avg_frame_rate = context->framerate;
  return codec.width > 0 && codec.height > 0;
}

bool RtspPictures::read(AVStream& stream, AVPacket& packet, std::int64_t until_ns) {
  const GstPtr<GstSample> sample = first_ != nullptr ? std::exchange(first_, nullptr) : pull(until_ns);
  if (sample == nullptr) return false;
  GstBuffer* const data = gst_sample_get_buffer(sample.get());
  const std::size_t size = gst_buffer_get_size(data);
  if (av_new_packet(&packet, static_cast<int>(size)) < 0) return false;
  gst_buffer_extract(data, 0, packet.data, size);
  packet.stream_index = stream.index;
  if (GST_BUFFER_PTS_IS_VALID(data)) packet.pts = static_cast<std::int64_t>(GST_BUFFER_PTS(data));
  if (GST_BUFFER_FLAG_IS_SET(data, GST_BUFFER_FLAG_DELTA_UNIT) == 0)
    packet.flags |= AV_PKT_FLAG_KEY;
  else if (GST_BUFFER_FLAG_IS_SET(data, GST_BUFFER_FLAG_DISCONT))  // what it rests on was lost
    packet.flags |= AV_PKT_FLAG_CORRUPT;
  if (gst_caps_is_equal(caps_.get(), gst_sample_get_caps(sample.get())) != 0) return true;
  if (!describe(stream, *sample)) return false;
  const auto parameters_size = static_cast<std::size_t>(stream.codecpar->extradata_size);
  std::uint8_t* const parameters =
      av_packet_new_side_data(&packet, AV_PKT_DATA_NEW_EXTRADATA, parameters_size);
  if (parameters == nullptr) return false;
  std::copy_n(stream.codecpar->extradata, parameters_size, parameters);
  return true;
}

}  // namespace arthronaut::sources
