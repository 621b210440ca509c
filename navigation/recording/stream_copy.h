// Inner header: one part of a video whose pictures are kept as they came: the packets from one that decoding
// may begin at, without a gap, and of every picture that was seen where it lies among them.
//
// That a decoder which begins there gives the pictures that were seen is not taken for granted: the first
// ones are decoded again, as they will be, and compared.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "navigation/recording/kept_video.h"
#include "navigation/sources/encoded_packets.h"

namespace arthronaut::recording {

class StreamCopy {
 public:
  // Throws IoError.
  StreamCopy(const std::filesystem::path& file, std::shared_ptr<const sources::EncodedPackets> packets,
             sources::EncodedPacketPtr first, const camera::Frame& picture);
  ~StreamCopy();

  // Writes what came up to the picture's packet; says where the picture lies. False: it cannot be kept in
  // this part, which ends before it; refusal() says why. Throws IoError.
  [[nodiscard]] bool take(const camera::Frame& picture, KeptPicture& kept);
  // Throws IoError.
  void finish();

  [[nodiscard]] const std::string& refusal() const;
  // Nothing of this connection can be kept as it came.
  [[nodiscard]] bool is_hopeless() const;
  [[nodiscard]] const std::shared_ptr<const sources::PacketFormat>& format() const;
  // libavcodec's name of the stream's codec; and what its decoder needs to know (KeptStreamFile).
  [[nodiscard]] std::string codec() const;
  [[nodiscard]] int held_back() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace arthronaut::recording
