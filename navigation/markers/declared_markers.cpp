#include <algorithm>
#include <cmath>
#include <string>

#include "navigation/markers/declaration.h"
#include "navigation/markers/marker_tracker.h"
#include "planning/geometry/error.h"

namespace arthronaut::markers {

std::string_view to_text(MarkerState state) {
  switch (state) {
    case MarkerState::Tracked:
      return "tracked";
    case MarkerState::NotSeen:
      return "not seen";
    case MarkerState::OutOfView:
      return "out of view";
    case MarkerState::TooSmall:
      return "too small";
    case MarkerState::TooOblique:
      return "too oblique";
    case MarkerState::Covered:
      return "covered";
    case MarkerState::Glare:
      return "glare";
    case MarkerState::Blur:
      return "blurred";
    case MarkerState::Ambiguous:
      return "ambiguous";
    case MarkerState::Duplicate:
      return "seen twice";
    case MarkerState::Doubtful:
      return "doubtful";
    case MarkerState::Disagreeing:
      return "its markers disagree: bent?";
  }
  return "unknown";
}

std::vector<DeclaredMarker> declared_markers(const tools::ToolSet& tools) {
  std::vector<DeclaredMarker> declared;
  if (tools.tracker) return declared;  // what the pictures would say has no frame in common with it
  const auto add = [&](const auto& body) {
    for (const tools::BodyMarker& marker : tools::markers_of(body))
      declared.push_back({marker.marker_id, marker.size_mm});
  };
  for (const tools::WorldMarker& world : tools.world_markers) add(world);
  for (const tools::Tool& tool : tools.tools) add(tool);
  return declared;
}

void check_declaration(std::span<const DeclaredMarker> declared, int dictionary_size) {
  for (std::size_t i = 0; i < declared.size(); ++i) {
    const DeclaredMarker& marker = declared[i];
    const std::string name = "marker " + std::to_string(marker.id);
    if (marker.id < 0 || marker.id >= dictionary_size) {
      throw InvalidInput(name + ": the id must be 0 to " + std::to_string(kDictionarySize - 1) +
                         " (DICT_4X4_50)");
    }
    if (!(marker.size_mm > 0) || !std::isfinite(marker.size_mm)) {
      throw InvalidInput(name + ": size_mm must be above 0, is " + std::to_string(marker.size_mm));
    }
    const auto same_id = [&](const DeclaredMarker& other) { return other.id == marker.id; };
    if (std::any_of(declared.begin(), declared.begin() + i, same_id)) {
      throw InvalidInput(name + ": is declared twice");
    }
  }
}

void check_frame_size(const camera::GrayView& frame, const camera::CameraModel& camera) {
  const Eigen::Vector2i size = camera.image_size_px();
  if (frame.data && frame.width == size.x() && frame.height == size.y()) return;
  throw InvalidInput("the frame is " + std::to_string(frame.width) + " x " + std::to_string(frame.height) +
                     " pixels, but the camera was calibrated for " + std::to_string(size.x()) + " x " +
                     std::to_string(size.y()));
}

}  // namespace arthronaut::markers
