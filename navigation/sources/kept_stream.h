// A stream that was kept as it came (EncodedPackets), in a Matroska file: decoded again, each picture by the
// number that its packet has in the file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "navigation/sources/frame_source.h"
#include "navigation/sources/on_the_way.h"

namespace arthronaut::sources {

// Where decoding may begin in such a file.
struct StreamStart {
  std::int64_t packet = 0;   // counts from 0 in the file
  std::int64_t time_ms = 0;  // what the file says of it
};

struct KeptStreamFile {
  std::filesystem::path file;
  int held_back = 0;  // EncodedPacket::held_back of its first packet
  // In the order of the file. A file that was never finished has no index: it is made of these.
  std::vector<StreamStart> starts = {};
};

// Threads: one at a time.
class KeptStream {
 public:
  // ToReplay: by the same decoder in the same way as when it came, so that pictures are the same to the last
  // bit. ToLookAt: as quickly as this machine can.
  enum class Use { ToReplay, ToLookAt };
  // Throws IoError or InvalidInput.
  KeptStream(const KeptStreamFile& file, Use use);
  ~KeptStream();

  // Its name and size; the rate is not known.
  [[nodiscard]] const SourceInfo& info() const;
  // The next whole picture, as the decoder gives them out; Frame::packet is its number. Null at the end, and
  // where the file breaks off.
  [[nodiscard]] camera::FramePtr next();
  // The picture of that packet. Decodes from the last start before it, unless it lies shortly behind what was
  // decoded, or was decoded lately: the last 32 pictures are remembered. Null where the file is broken there,
  // and where on_the_way said that it is not wanted: asked for again, decoding goes on from there.
  [[nodiscard]] camera::FramePtr picture(std::int64_t packet, const OnTheWay& on_the_way = {});
  [[nodiscard]] bool remembers(std::int64_t packet) const;
  // The first of those that are remembered; nullopt: none is.
  [[nodiscard]] std::optional<std::int64_t> first_remembered() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace arthronaut::sources
