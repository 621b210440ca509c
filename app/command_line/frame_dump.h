// What the tracker saw, frame by frame, for whoever asks why a marker was not found: `track --dump FOLDER`.
//
// Of each frame a picture and a JSON file beside it (000123.png, 000123.json). Green: tracked, as measured.
// Blue: a square in which a declared code was read. Yellow: a square and no code. Squares are there only in
// frames in which the tracker had to search: a marker that is followed needs no search.
#pragma once

#include <filesystem>

#include "app/scene/image.h"
#include "navigation/camera/frame.h"
#include "navigation/pipeline/view_tracker.h"

namespace arthronaut::command_line {

// What a frame shows, to be drawn on.
[[nodiscard]] scene::Image image_of(const camera::Frame& frame);

class FrameDump {
 public:
  // Makes the folder. Throws IoError.
  explicit FrameDump(const std::filesystem::path& folder);
  // Throws IoError.
  void add(const camera::Frame& frame, const pipeline::PictureObservation& seen) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace arthronaut::command_line
