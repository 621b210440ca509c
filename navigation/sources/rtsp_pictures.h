// Inner header: H.264 and H.265 by RTSP, a packet a picture, each given out with the RTP packet that is
// marked as its last (RFC 6184, 5.1). libavformat passes that mark on to nobody and gives a picture out when
// the next one begins, so GStreamer's rtspsrc reads here. By TCP alone. One thread.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "navigation/sources/gstreamer_owned.h"
#include "navigation/sources/libav.h"

namespace arthronaut::sources {

class RtspPictures {
 public:
  // Connects and waits for the first picture. Check container() before anything else.
  RtspPictures(const std::string& address, std::int64_t deadline_ns);
  RtspPictures(const RtspPictures&) = delete;
  RtspPictures& operator=(const RtspPictures&) = delete;

  // Describes its one stream as libavformat would. Null: nothing came of it, whatever the reason: no server,
  // another codec, no TCP, a part of GStreamer that is missing. libavformat reads what this can't, or says
  // what is wrong.
  [[nodiscard]] LibavPtr<AVFormatContext> take_container() { return std::move(container_); }
  // What it sends is not for this to read, nor will be.
  [[nodiscard]] bool is_other() const { return is_other_; }
  // The session's name, as the server gives it.
  [[nodiscard]] const std::string& title() const { return title_; }
  // The next picture's data, stamped in the stream's time base. Where its parameters are other than those
  // before it carries them (AV_PKT_DATA_NEW_EXTRADATA), and `stream` is brought up to date. False: the
  // connection ended, or nothing came in time.
  [[nodiscard]] bool read(AVStream& stream, AVPacket& packet, std::int64_t until_ns);

 private:
  static void on_sdp(GstElement* source, void* description, RtspPictures* self);
  static void on_pad(GstElement* source, GstPad* pad, RtspPictures* self);
  [[nodiscard]] GstPtr<GstSample> pull(std::int64_t until_ns);
  [[nodiscard]] bool describe(AVStream& stream, GstSample& sample);

  std::string title_;  // written before the first picture comes
  std::atomic<bool> is_other_ = false;
  GstPtr<GstElement> sink_;
  RunningPipeline pipeline_;  // stopped before what it writes is gone
  GstPtr<GstSample> first_;
  GstPtr<GstCaps> caps_;  // of the picture before
  LibavPtr<AVFormatContext> container_;
};

}  // namespace arthronaut::sources
