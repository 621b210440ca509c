// Where pictures come from: a video file, still images, a camera device or the simulator, all alike.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "navigation/camera/frame.h"
#include "navigation/sources/source_kind.h"
#include "navigation/sources/source_line.h"

namespace arthronaut::sources {

class EncodedPackets;  // encoded_packets.h

struct SourceInfo {
  std::string name;  // for screen and record
  Eigen::Vector2i image_size_px{0, 0};
  double frames_per_second = 0;   // 0 when unknown
  std::int64_t frame_count = -1;  // -1 when unknown or endless
  SourceKind kind = SourceKind::Recording;
  [[nodiscard]] bool is_live() const { return kind == SourceKind::Live; }
  std::filesystem::path
      encoded_file;  // the video as it came, to be copied instead of encoded again; empty when there is none
  // Of a live source that comes back by itself: why no picture comes, and how it is told to end. Null else.
  std::shared_ptr<SourceLine> line = nullptr;
  bool ends = true;  // false: an end is a fault, and the source is to be taken up again
  // Its pictures are of the size that was agreed on when it was opened (a camera's mode): where that is not
  // the right one, no other comes before it is opened anew. A stream changes by itself.
  bool keeps_size = false;
  // Of a live source whose pictures came encoded: what they were decoded from. Null else.
  std::shared_ptr<EncodedPackets> packets = nullptr;
};

class FrameSource {
 public:
  virtual ~FrameSource() = default;
  [[nodiscard]] virtual const SourceInfo& info() const = 0;
  // The next frame; null at the end. Throws InvalidInput when a file ends half-way through a frame or cannot
  // be decoded (it names file and frame), DeviceError when a device is gone.
  [[nodiscard]] virtual camera::FramePtr next() = 0;
};

// A video file, or a printf pattern of still images ("f_%04d.png", counted from the first that exists; a
// number missing in between is refused), or one still image. Throws IoError or InvalidInput; a pipe, a device
// file and an address ("rtsp://...") are refused at once, with the reason, and never waited for. Timestamps:
// the file's, else frame / fps, else frame / 60. Where the file's clock is too coarse for its constant frame
// rate (Matroska counts in ms), frame / fps. Colours are converted by the BT.601 matrix whatever the file is
// tagged with, as OpenCV does: the luma that camera::gray_from() computes is then the luma that was encoded.
[[nodiscard]] std::unique_ptr<FrameSource> open_video(const std::filesystem::path& video_or_pattern);
// A video whose luma plane is, byte for byte, what was tracked when it was recorded: frames carry it as
// Frame::luma. Full range, as recording::VideoEncoder writes it.
[[nodiscard]] std::unique_ptr<FrameSource> open_video_with_exact_luma(const std::filesystem::path& video);
// Frames carry the time of their capture: the driver's (V4L2, on the monotonic clock) where it can be true,
// else the moment it handed the picture over. One that is pulled out, or has no signal, is opened again when
// it is back, as with open_stream(); the mode is that of choose_mode(). Throws DeviceError.
[[nodiscard]] std::unique_ptr<FrameSource> open_device(int device_index);

// A stream over the network, as it comes: "rtsp://...", "rtsps://...", "udp://HOST:PORT" (MPEG-TS; the host
// is the interface or multicast group to listen on, "@" for any), "srt://...", "tcp://HOST:PORT", or any
// other address that libavformat opens live; or "gst:PIPELINE ! appsink", what a GStreamer pipeline gives.
// Live: frames carry the time when their data came (CaptureClock::Network; a pipeline's own stamps where they
// can be true).
//
// What an encoder holds back counts: with B-frames a picture is some frames old before it is sent, too old to
// guide. Encoders of live pictures go without them.
//
// A stream that breaks off, falls silent for a second or gives pictures of another size is taken up again by
// itself, for as long as it takes, and pictures that came damaged are left out, as is what comes before the
// first key frame; meanwhile nothing is given, and info().line says why, within 0.3 s where data come all the
// same. Only a pipeline that is not live comes to an end, and gives null then. Opening
// throws DeviceError when no picture comes within 10 s, and InvalidInput for a pipeline that is none.
[[nodiscard]] std::unique_ptr<FrameSource> open_stream(const std::string& address);
// Whether text names a stream, by its form alone.
[[nodiscard]] bool is_stream_address(std::string_view text);
// As addresses are kept and compared: what stands before "://", or "gst:", in small letters, since a phone
// and a manual write "Rtsp://" and mean the same. Other text as it is.
[[nodiscard]] std::string with_small_scheme(std::string address);
// Why no stream can be opened by this address, without opening anything: nobody knows its kind ("rstp://").
// Empty where somebody does.
[[nodiscard]] std::string why_no_stream(const std::string& address);

// As an address or a pipeline may stand on a screen, in a message and in a record: of
// "rtsp://user:password@host/scope" without what is before the "@", and "***" for a password that is given by
// name ("user-pw=...").
[[nodiscard]] std::string shown_address(const std::string& address);

// What a user names: "/dev/videoN?size=1920x1080" (camera_modes.h), a stream, or what open_video() opens.
[[nodiscard]] std::unique_ptr<FrameSource> open_source(const std::string& name);
// Live for a device and a stream, else a recording. By its form alone.
[[nodiscard]] SourceKind kind_of_source(std::string_view name);

// One still picture (PNG, JPEG, BMP, TIFF, WebP, PNM) as a frame. Grey pictures become BGR, alpha is dropped;
// pictures of more than 8 bits, cut-off files and pictures whose header claims more than 64 million pixels
// are refused, the last before anything is decoded. Throws IoError or InvalidInput.
[[nodiscard]] camera::Frame read_picture(const std::filesystem::path& file);

}  // namespace arthronaut::sources
