// Keeps the pictures of a session in a thread of its own, as PicturesAs says: a stream as it came, else
// encoded (video_encoder.h). The files are readable up to the last half second when the program is killed.
//
// What cannot be kept as it came is encoded without loss, for as long as that lasts: pictures before the
// first that decoding may begin at, those of a stream that is not the same when it is decoded again, and
// those of a source that is none.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "navigation/camera/frame.h"
#include "navigation/recording/kept_video.h"
#include "navigation/sources/frame_source.h"

namespace arthronaut::recording {

struct PictureWriterOptions {
  PicturesAs as = PicturesAs::Lossless;
  std::shared_ptr<const sources::EncodedPackets> packets = nullptr;  // for AsTheyCame
  // Of the source, which encoded files say for their players; 0: unknown. Pictures that were left out make
  // it go faster than it was.
  double frames_per_second = 0;
};

// Told in the writer's thread, in order; they must not call back.
struct PictureNews {
  // A part's file is there, before its first picture. `why`: why it is not kept as it was asked for; empty:
  // it is.
  std::function<void(const VideoPart& part, const camera::Frame& first, const std::string& why)> begun = {};
  std::function<void(const KeptPicture& picture)> kept = {};
  std::function<void(const VideoPart& part)> ended = {};  // its file is whole
};

// Threads: one thread at a time calls it. States: writing -> finished.
class PictureWriter {
 public:
  // Parts are files of the folder: video.mkv, video_2.mkv, ... The first begins with the first picture; of a
  // part that is encoded all pictures must have one size.
  PictureWriter(const std::filesystem::path& folder, const PictureWriterOptions& options,
                const PictureNews& news = {});
  ~PictureWriter();  // finish(); errors are then lost

  // Hands over; waits while too many are waiting. Throws IoError when the encoder or the disk failed, and
  // InvalidInput for another size.
  void write(const camera::FramePtr& picture);
  // The same, but false at once when too many are waiting.
  [[nodiscard]] bool try_write(const camera::FramePtr& picture);
  // Nothing of what comes between the last picture and the next one is kept. Never waits for the disk; throws
  // as write() does.
  void end_part();
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace arthronaut::recording
