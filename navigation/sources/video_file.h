// A video file, decoded with libavformat and libavcodec.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "navigation/sources/frame_source.h"
#include "navigation/sources/on_the_way.h"

namespace arthronaut::sources {

// What Frame::luma is.
enum class LumaOf {
  Colours,  // left empty: users compute it
  File,     // the file's own plane, which must be 8-bit 4:2:0 or 4:4:4 in full range
};

// Any picture of a file, by its time. From the key frame before it on everything is decoded: a file of which
// every picture is a key frame gives each at once, one with a key frame in every n pictures decodes up to n.
// Of the latter the last 32 pictures are remembered, so that going back by one decodes nothing.
//
// Threads: one at a time.
class SeekableVideo {
 public:
  virtual ~SeekableVideo() = default;
  [[nodiscard]] virtual const SourceInfo& info() const = 0;
  // The picture that is shown time_ns after the first one, with half a picture's time of grace for files
  // whose clock is coarse. Null before the first, beyond the last and where the file is broken: what is whole
  // before and after is given all the same. Its index counts by the frame rate. Null, too, where on_the_way
  // said that it is not wanted: asked for again, decoding goes on from there.
  [[nodiscard]] virtual camera::FramePtr picture_at(std::int64_t time_ns,
                                                    const OnTheWay& on_the_way = {}) = 0;
  // Whether picture_at() would decode nothing, and the time of the first of those; nullopt: none is, or each
  // picture is a key frame.
  [[nodiscard]] virtual bool remembers(std::int64_t /*time_ns*/) const { return false; }
  [[nodiscard]] virtual std::optional<std::int64_t> first_remembered_ns() const { return std::nullopt; }
};

// The file's own index of key frames is used. A Matroska file that a crash left without one, all of whose
// pictures are key frames, is walked through from cluster to cluster, without reading the pictures. Luma as
// in open_video_file(). Throws IoError or InvalidInput.
[[nodiscard]] std::unique_ptr<SeekableVideo> open_seekable_video(const std::filesystem::path& file,
                                                                 LumaOf luma);

// See open_video() and open_video_with_exact_luma().
[[nodiscard]] std::unique_ptr<FrameSource> open_video_file(const std::filesystem::path& file, LumaOf luma);

}  // namespace arthronaut::sources
