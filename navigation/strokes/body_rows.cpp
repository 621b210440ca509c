#include "navigation/strokes/body_rows.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "navigation/markers/body_pose.h"
#include "navigation/markers/marker_tracker.h"
#include "navigation/markers/planar_pose.h"
#include "planning/files/format.h"
#include "planning/geometry/error.h"

namespace arthronaut::strokes {

namespace {

// Far below what a printed marker can be measured to.
constexpr double kSameSize_mm = 1e-6;
constexpr double kFocal_px = 600, kCornerSigma_px = 0.15;

camera::CameraModel plain_camera() {
  camera::Calibration calibration;
  calibration.image_size_px = {1200, 1200};
  calibration.focal_px = kFocal_px;
  calibration.principal_point_px = calibration.rotation_center_px = {600, 600};
  calibration.distortion_xi = 0;
  return camera::CameraModel(calibration, 0, 1.0);
}

markers::MarkerObservation observation_of(const PoseRow& row, double size_mm,
                                          const camera::CameraModel& camera) {
  markers::MarkerObservation observation;
  observation.id = row.marker_id;
  observation.camera_from_marker = row.camera_from_marker;
  observation.rms_px = row.rms_px;
  const auto corners_mm = markers::square_corners_mm(size_mm);
  for (std::size_t k = 0; k < 4; ++k) {
    const auto pixel = camera.project(row.camera_from_marker * corners_mm[k]);
    if (!pixel) return observation;  // behind the camera: no pose of a picture
    observation.corners_px[k] = *pixel;
  }
  const auto pose =
      markers::refine_square_pose(camera, observation.corners_px, size_mm, row.camera_from_marker);
  if (!pose) return observation;
  observation.covariance = markers::square_covariance(*pose, kCornerSigma_px);
  observation.state = markers::MarkerState::Tracked;
  return observation;
}

// The row of the body in the frame whose rows are these; nullopt where it has no pose.
std::optional<PoseRow> row_of(const markers::Body& body, const PoseRow* first, const PoseRow* end,
                              const camera::CameraModel& camera) {
  std::vector<markers::MarkerObservation> observations(body.markers.size());
  std::optional<PoseRow> row;
  double squares_px2 = 0;
  for (std::size_t i = 0; i < body.markers.size(); ++i) {
    const PoseRow* seen = std::find_if(
        first, end, [&](const PoseRow& one) { return one.marker_id == body.markers[i].marker_id; });
    if (seen == end) continue;
    observations[i] = observation_of(*seen, body.markers[i].size_mm, camera);
    if (!row) row = *seen;
  }
  if (!row) return std::nullopt;
  const markers::BodyObservation found = markers::observe_body(body, observations, camera);
  if (!found.is_tracked()) return std::nullopt;
  for (std::size_t i = 0; i < observations.size(); ++i)
    if (found.used & (1U << i)) squares_px2 += observations[i].rms_px * observations[i].rms_px;
  row->marker_id = body.id;
  row->camera_from_marker = found.camera_from_body;
  row->rms_px = std::sqrt(squares_px2 / found.used_count());
  return row;
}

}  // namespace

int body_id_of(int marker_id, const tools::ToolSet& tools) {
  for (const markers::Body& body : markers::declared_bodies(tools))
    for (const tools::BodyMarker& marker : body.markers)
      if (marker.marker_id == marker_id) return body.id;
  return marker_id;
}

void require_sizes(const std::vector<PoseRow>& rows, const tools::ToolSet& tools,
                   const std::filesystem::path& file) {
  std::map<int, double> said_mm;
  for (const markers::DeclaredMarker& marker : markers::declared_markers(tools))
    said_mm[marker.id] = marker.size_mm;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto said = said_mm.find(rows[i].marker_id);
    if (!rows[i].size_mm || said == said_mm.end()) continue;
    if (std::abs(*rows[i].size_mm - said->second) > kSameSize_mm)
      throw InvalidInput(file, "line " + std::to_string(i + 2) + ", column size_mm",
                         files::format("marker %d was taken for %g mm, the tools say %g mm", said->first,
                                       *rows[i].size_mm, said->second));
  }
}

std::vector<PoseRow> body_rows(const std::vector<PoseRow>& rows, const tools::ToolSet& tools) {
  if (!tools.has_bodies_of_several()) return rows;
  const camera::CameraModel camera = plain_camera();
  std::vector<markers::Body> bodies = markers::declared_bodies(tools);
  std::erase_if(bodies, [&](const markers::Body& body) {
    const auto is_it = [&](const auto& one) { return one.marker_id == body.id && one.markers.empty(); };
    return std::any_of(tools.tools.begin(), tools.tools.end(), is_it) ||
           std::any_of(tools.world_markers.begin(), tools.world_markers.end(), is_it);
  });
  const auto is_of_several = [&](const PoseRow& row) {
    return std::any_of(bodies.begin(), bodies.end(), [&](const markers::Body& body) {
      return std::any_of(body.markers.begin(), body.markers.end(),
                         [&](const tools::BodyMarker& marker) { return marker.marker_id == row.marker_id; });
    });
  };
  std::vector<PoseRow> result;
  result.reserve(rows.size());
  for (std::size_t first = 0; first < rows.size();) {
    std::size_t end = first;
    while (end < rows.size() && rows[end].frame == rows[first].frame) ++end;
    for (std::size_t i = first; i < end; ++i)
      if (!is_of_several(rows[i])) result.push_back(rows[i]);
    for (const markers::Body& body : bodies)
      if (auto row = row_of(body, rows.data() + first, rows.data() + end, camera)) result.push_back(*row);
    first = end;
  }
  return result;
}

}  // namespace arthronaut::strokes
