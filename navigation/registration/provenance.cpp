#include "navigation/registration/provenance.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "navigation/camera/medium.h"
#include "planning/files/format.h"
#include "planning/files/sha256.h"

namespace arthronaut::registration {

namespace {

constexpr std::array kAll{Mismatch::Bone,      Mismatch::Mesh,   Mismatch::SourceKind, Mismatch::WorldMarker,
                          Mismatch::Placement, Mismatch::Camera, Mismatch::Tools,      Mismatch::Medium};

// What is not known on one side matches: files of other programs do not say it.
bool differs(const std::string& a, const std::string& b) { return !a.empty() && !b.empty() && a != b; }

bool is_mismatch(Mismatch what, const Provenance& of, const Provenance& now) {
  switch (what) {
    case Mismatch::Bone:
      return of.bone != now.bone;
    case Mismatch::Mesh:
      return differs(of.mesh_sha256, now.mesh_sha256);
    case Mismatch::SourceKind:
      return of.source != now.source;
    case Mismatch::WorldMarker:
      return of.world_marker_id != now.world_marker_id;
    case Mismatch::Placement:
      return of.placement != now.placement;
    case Mismatch::Camera:
      return differs(of.camera, now.camera);
    case Mismatch::Tools:
      return differs(of.tools, now.tools);
    case Mismatch::Medium:
      return std::abs(of.refractive_index - now.refractive_index) > 1e-6;  // files round it
  }
  return true;
}

// Every bit of a number counts.
void add_number(std::string& text, double value) { text += files::format("%.17g ", value); }

void add_vector(std::string& text, const Eigen::Ref<const Eigen::VectorXd>& values) {
  for (Eigen::Index i = 0; i < values.size(); ++i) add_number(text, values[i]);
}

// Nothing for one marker: that of a tool that has never had more stays what it was.
void add_markers(std::string& text, const std::vector<tools::BodyMarker>& markers) {
  for (const tools::BodyMarker& marker : markers) {
    text += "marker " + std::to_string(marker.marker_id) + " ";
    add_number(text, marker.size_mm);
    add_vector(text, marker.body_from_marker.translation_mm);
    add_vector(text, marker.body_from_marker.rotation.coeffs());
  }
}

// What a tool that is seen is known by, but for its axis.
void add_tool(std::string& text, const tools::Tool& tool) {
  text += std::to_string(tool.marker_id) + " ";
  add_number(text, tool.size_mm);
  if (tool.tip_mm) add_vector(text, *tool.tip_mm);
  add_markers(text, tool.markers);
}

// What an outside tracker calls a body's frame is not where a marker has it.
void add_device(std::string& text, const tools::ToolSet& tools, const std::string& body) {
  if (!tools.tracker) return;
  const auto found = tools.tracker->devices.find(body);
  if (found != tools.tracker->devices.end()) text += found->second + " ";
}

}  // namespace

std::string_view to_text(Mismatch mismatch) {
  switch (mismatch) {
    case Mismatch::Bone:
      return "bone";
    case Mismatch::Mesh:
      return "mesh";
    case Mismatch::SourceKind:
      return "source kind";
    case Mismatch::WorldMarker:
      return "world marker";
    case Mismatch::Placement:
      return "marker placement";
    case Mismatch::Camera:
      return "camera";
    case Mismatch::Tools:
      return "tools";
    case Mismatch::Medium:
      return "medium";
  }
  return "unknown";
}

std::string in_words(Mismatch mismatch, const Provenance& of, const Provenance& now) {
  const auto change = [](const std::string& what, std::string_view then, std::string_view today) {
    return what + " was " + std::string(then) + " and is " + std::string(today) + " now";
  };
  switch (mismatch) {
    case Mismatch::Bone:
      return change("the bone", bones::to_text(of.bone), bones::to_text(now.bone));
    case Mismatch::Mesh:
      return "the bone's mesh is another one than it was made on";
    case Mismatch::SourceKind:
      return change("it was found in another kind of pictures: the source", sources::to_text(of.source),
                    sources::to_text(now.source));
    case Mismatch::WorldMarker:
      return change("the world marker", std::to_string(of.world_marker_id),
                    std::to_string(now.world_marker_id));
    case Mismatch::Placement:
      return "the world marker may have been placed anew since";
    case Mismatch::Camera:
      return "the camera's calibration is another one than it was found with";
    case Mismatch::Tools:
      return "the probe or the world marker is another one than it was found with";
    case Mismatch::Medium:
      return change("the medium", camera::medium_to_text(of.refractive_index),
                    camera::medium_to_text(now.refractive_index));
  }
  return "";
}

std::optional<Mismatch> mismatch_of(const Provenance& of, const Provenance& now) {
  const auto found =
      std::find_if(kAll.begin(), kAll.end(), [&](Mismatch what) { return is_mismatch(what, of, now); });
  return found == kAll.end() ? std::nullopt : std::optional(*found);
}

std::optional<Mismatch> mismatch_but_placement(const Provenance& of, const Provenance& now) {
  const auto found = std::find_if(kAll.begin(), kAll.end(), [&](Mismatch what) {
    return what != Mismatch::Placement && is_mismatch(what, of, now);
  });
  return found == kAll.end() ? std::nullopt : std::optional(*found);
}

bool can_be_confirmed(const Provenance& of, const Provenance& now) {
  const bool is_simulated = of.source == sources::SourceKind::Simulation;
  return !is_mismatch(Mismatch::Bone, of, now) && !is_mismatch(Mismatch::Mesh, of, now) &&
         !is_mismatch(Mismatch::WorldMarker, of, now) &&
         is_simulated == (now.source == sources::SourceKind::Simulation);
}

std::string camera_identity(const camera::Calibration& calibration) {
  std::string text;
  add_vector(text, calibration.image_size_px.cast<double>());
  add_number(text, calibration.focal_px);
  add_number(text, calibration.aspect_ratio);
  add_vector(text, calibration.principal_point_px);
  add_number(text, calibration.distortion_xi);
  add_vector(text, calibration.rotation_center_px);
  add_number(text, calibration.reference_mark_angle_deg);
  add_vector(text, calibration.boundary.center_px);
  add_number(text, calibration.boundary.radius_px);
  add_number(text, calibration.refractive_index);
  return files::sha256_of(text);
}

std::string tools_identity(const tools::ToolSet& tools, bones::BoneKind bone, std::string_view probe_name) {
  std::string text;
  if (const tools::WorldMarker* marker = tools.find_world_marker(bone)) {
    text += "world " + std::to_string(marker->marker_id) + " ";
    add_number(text, marker->size_mm);
    add_markers(text, marker->markers);
  }
  if (const tools::Tool* probe = tools.find_tool(std::string(probe_name))) {
    text += "probe ";
    add_tool(text, *probe);
  }
  if (tools.tracker) {
    // Another tracker may have its frame elsewhere under the same names.
    text += "outside " + tools.tracker->address + " ";
    add_device(text, tools, std::string(bones::to_text(bone)));
    add_device(text, tools, std::string(probe_name));
  }
  return files::sha256_of(text);
}

std::string guides_identity(const tools::ToolSet& tools, std::string_view guide_name) {
  std::string text;
  for (const tools::Tool& tool : tools.tools) {
    const bool is_drill = tool.kind == tools::ToolKind::Drill;
    if (!is_drill && tool.name != guide_name) continue;
    text += is_drill ? "drill " : "guide ";
    add_tool(text, tool);
    if (tool.axis) {
      text += "axis ";
      add_vector(text, tool.axis->point_mm);
      add_vector(text, tool.axis->direction);
    }
    add_device(text, tools, tool.name);
  }
  return files::sha256_of(text);
}

}  // namespace arthronaut::registration
