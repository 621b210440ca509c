// Inner header: a stream's packets as they came, in a Matroska file. H.264 and H.265 get their units' lengths
// in the place of start codes, as Matroska has it; nothing else is changed, and nothing is encoded.
#pragma once

#include <filesystem>
#include <memory>

#include "navigation/sources/encoded_packets.h"

namespace arthronaut::recording {

class PacketFile {
 public:
  // Whether a file can begin with this packet: Matroska has a place for such a stream, and its parameter sets
  // are known.
  [[nodiscard]] static bool takes(const sources::EncodedPacket& first);
  // `first` is the packet that the file begins with, where decoding may begin; `picture` one of the stream,
  // whose size a stream that was connected to again has not said. Throws IoError.
  // Precondition: takes(first).
  PacketFile(const std::filesystem::path& file, const sources::EncodedPacket& first,
             const camera::Frame& picture);
  ~PacketFile();

  // The first one, and those after it in order. Every packet that decoding may begin at begins a cluster,
  // and a cluster, the unit that reaches the disk, is no longer than a quarter of a second. Gives the
  // packet's time in the file, ms, which is one of its own where decoding may begin. Throws IoError.
  std::int64_t write(const sources::EncodedPacket& packet);
  // The file's end. Throws IoError.
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace arthronaut::recording
