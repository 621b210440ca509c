// Inner header: a Matroska file with one stream of video, written so that a program which ends at any moment
// leaves a file that is whole but for its last quarter of a second.
#pragma once

#include <filesystem>
#include <string>

#include "navigation/sources/libav.h"

namespace arthronaut::recording {

// stream() is described, begin(), write() in order, finish(). Members throw IoError.
class MatroskaWriter {
 public:
  explicit MatroskaWriter(const std::filesystem::path& file);

  [[nodiscard]] AVStream& stream() { return *stream_; }
  void begin();
  // The packet is let go. Its times are in `time_base`.
  void write(AVPacket& packet, AVRational time_base);
  // What follows begins a new cluster, which can be found by its time.
  void end_cluster();
  // Once: after a failure, too, there is nothing more to finish, and a second call does nothing.
  void finish();
  // Throws where a function of libav failed.
  void check(int result, const std::string& what) const;

 private:
  std::filesystem::path file_;
  sources::LibavOutput container_;
  AVStream* stream_ = nullptr;
  bool is_begun_ = false;  // and not finished
};

}  // namespace arthronaut::recording
