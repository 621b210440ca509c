#include "app/command_line/frame_dump.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <system_error>

#include "app/scene/image.h"
#include "planning/files/format.h"
#include "planning/files/json_document.h"
#include "planning/geometry/error.h"

namespace arthronaut::command_line {

namespace {

using Corners = std::array<Eigen::Vector2d, 4>;
using Colour = std::array<std::uint8_t, 3>;
constexpr Colour kTracked{40, 230, 70}, kWithCode{60, 140, 255}, kWithoutCode{255, 210, 0};

void paint(scene::Image& image, const Eigen::Vector2d& place_px, const Colour& colour) {
  const long x = std::lround(place_px.x()), y = std::lround(place_px.y());
  if (x < 0 || y < 0 || x >= image.width || y >= image.height) return;
  std::copy(colour.begin(), colour.end(), image.rgb.begin() + 3 * (y * image.width + x));
}

void outline(scene::Image& image, const Corners& corners_px, const Colour& colour) {
  for (std::size_t k = 0; k < 4; ++k) {
    const Eigen::Vector2d &from = corners_px[k], &to = corners_px[(k + 1) % 4];
    // A corner may lie far outside the picture, but not so far that its side has no end.
    const int steps = static_cast<int>(std::min(1e4, std::ceil((to - from).cwiseAbs().maxCoeff())));
    for (int i = 0; i <= steps; ++i)
      paint(image, from + (to - from) * (static_cast<double>(i) / std::max(steps, 1)), colour);
  }
}

nlohmann::ordered_json json_of(const Corners& corners_px) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const Eigen::Vector2d& corner : corners_px) json.push_back(files::to_json(corner));
  return json;
}

nlohmann::ordered_json json_of(const pipeline::PictureObservation& seen) {
  nlohmann::ordered_json json;
  json["format"] = "arthronaut.frame_dump";
  json["version"] = 1;
  json["frame"] = seen.frame_index;
  json["time_s"] = static_cast<double>(seen.timestamp_ns) * 1e-9;
  json["is_frozen"] = seen.is_frozen;
  json["intrinsics_are_known"] = seen.intrinsics_are_known;
  if (seen.lens.has_angle()) json["lens_mark_deg"] = seen.lens.mark_angle_deg;
  json["markers"] = nlohmann::ordered_json::array();
  for (const markers::MarkerObservation& marker : seen.markers) {
    nlohmann::ordered_json one;
    one["id"] = marker.id;
    one["state"] = markers::to_text(marker.state);
    if (marker.is_tracked()) {
      one["corners_px"] = json_of(marker.corners_px);
      one["camera_from_marker"] = files::to_json(marker.camera_from_marker);
      one["rms_px"] = marker.rms_px;
      one["ambiguity_ratio"] = marker.ambiguity_ratio;
    }
    json["markers"].push_back(std::move(one));
  }
  json["candidates"] = nlohmann::ordered_json::array();
  for (const markers::MarkerCandidate& candidate : seen.candidates) {
    nlohmann::ordered_json one;
    if (candidate.id != markers::MarkerCandidate::kNoCode) one["id"] = candidate.id;
    one["corners_px"] = json_of(candidate.corners_px);
    json["candidates"].push_back(std::move(one));
  }
  return json;
}

}  // namespace

scene::Image image_of(const camera::Frame& frame) {
  std::vector<std::uint8_t> made;
  scene::Image image{frame.width, frame.height, camera::bgr_of(frame, made)};
  for (std::size_t i = 0; i + 2 < image.rgb.size(); i += 3) std::swap(image.rgb[i], image.rgb[i + 2]);
  return image;
}

FrameDump::FrameDump(const std::filesystem::path& folder) : folder_(folder) {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (!std::filesystem::is_directory(folder_))
    throw IoError(folder_, error ? error.message() : "is no folder");
}

void FrameDump::add(const camera::Frame& frame, const pipeline::PictureObservation& seen) const {
  const std::string name = files::format("%06lld", static_cast<long long>(frame.index));
  files::write_json(folder_ / (name + ".json"), json_of(seen));
  scene::Image image = image_of(frame);
  for (const markers::MarkerCandidate& candidate : seen.candidates)
    outline(image, candidate.corners_px,
            candidate.id == markers::MarkerCandidate::kNoCode ? kWithoutCode : kWithCode);
  for (const markers::MarkerObservation& marker : seen.markers)
    if (marker.is_tracked()) outline(image, marker.corners_px, kTracked);
  scene::write_png(folder_ / (name + ".png"), image);
}

}  // namespace arthronaut::command_line
