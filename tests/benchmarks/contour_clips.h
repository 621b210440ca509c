// Clips for the picture against the model: what the tracker sees of them, with the true place of the bone.
// Rendered and tracked once, then kept in a folder, since rendering takes most of the time.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "navigation/pipeline/navigation_pipeline.h"
#include "planning/geometry/triangle_mesh.h"

namespace arthronaut::contour_clips {

// One tracked picture. The poses are the tracker's, not the truth.
struct Look {
  std::int64_t timestamp_ns = 0;
  bool is_valid = false;  // the bone's marker was tracked in a picture that may be trusted
  camera::CameraModel camera;
  geometry::RigidTransform camera_from_world;
  std::vector<std::uint8_t> tool_is_tracked;
  std::vector<geometry::RigidTransform> camera_from_tool;
  std::vector<std::uint8_t> luma;  // rows packed, of the camera's size
};

struct Clip {
  std::string name;
  tools::ToolSet tools;
  geometry::TriangleMesh mesh;
  geometry::RigidTransform world_from_bone;  // true
  std::vector<Look> looks;
};

struct ClipRecipe {
  std::string bone;  // "phantom", or a mesh file of a right femur
  std::uint64_t seed = 1;
  bool drills = false;  // else the probe scratches
  int frames_per_second = 15;
  double scale = 0.6;  // of 1920 x 1080
};
[[nodiscard]] Clip simulated_clip(const ClipRecipe& recipe, const std::filesystem::path& cache);
// A folder of the path-traced clips: clip.mkv, camera.json, tools.json, bone.stl, gt/registration_gt.json.
[[nodiscard]] Clip traced_clip(const std::filesystem::path& folder);

}  // namespace arthronaut::contour_clips
