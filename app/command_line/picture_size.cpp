#include "app/command_line/picture_size.h"

#include "planning/files/format.h"
#include "planning/geometry/error.h"

namespace arthronaut::command_line {

void refuse_other_size(const std::string& video, const sources::FrameSource& source,
                       const camera::Calibration& calibration) {
  const sources::SourceInfo& info = source.info();
  if (info.is_live() || info.image_size_px == calibration.image_size_px) return;
  throw InvalidInput(
      video, "frame 0",
      files::format("is %d x %d pixels, but the camera was calibrated at %d x %d", info.image_size_px.x(),
                    info.image_size_px.y(), calibration.image_size_px.x(), calibration.image_size_px.y()));
}

}  // namespace arthronaut::command_line
