#include "navigation/strokes/body_rows.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <string>
#include <utility>

#include "navigation/markers/marker_tracker.h"
#include "navigation/markers/planar_pose.h"
#include "navigation/markers/seen_bodies.h"
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

// The rows of one frame after the other.
class FrameRows {
 public:
  explicit FrameRows(const tools::ToolSet& tools)
      : seen_bodies_(tools), observations_(markers::declared_markers(tools).size()) {
    const std::size_t worlds = tools.world_markers.size();
    for (std::size_t i = 0; i < seen_bodies_.declared().size(); ++i) {
      const auto& listed = i < worlds ? tools.world_markers[i].markers : tools.tools[i - worlds].markers;
      if (!listed.empty()) of_several_.push_back(i);
    }
  }

  void append(std::span<const PoseRow> rows, std::vector<PoseRow>& result) {
    for (const PoseRow& row : rows)
      if (!is_of_several(row)) result.push_back(row);
    std::fill(observations_.begin(), observations_.end(), markers::MarkerObservation{});
    for (const std::size_t index : of_several_) {
      const markers::Body& body = declared(index);
      for (std::size_t i = 0; i < body.markers.size(); ++i)
        if (const PoseRow* const row = find(rows, body.markers[i].marker_id))
          observations_[body.first + i] = observation_of(*row, body.markers[i].size_mm, camera_);
    }
    seen_bodies_.observe(observations_, camera_, seen_);
    for (const std::size_t index : of_several_)
      if (const auto row = row_of(index, rows)) result.push_back(*row);
  }

 private:
  static const PoseRow* find(std::span<const PoseRow> rows, int marker_id) {
    const auto row = std::ranges::find(rows, marker_id, &PoseRow::marker_id);
    return row == rows.end() ? nullptr : &*row;
  }
  [[nodiscard]] const markers::Body& declared(std::size_t index) const {
    return seen_bodies_.declared()[index];
  }
  [[nodiscard]] bool is_of_several(const PoseRow& row) const {
    return std::ranges::any_of(of_several_, [&](std::size_t index) {
      return std::ranges::find(declared(index).markers, row.marker_id, &tools::BodyMarker::marker_id) !=
             declared(index).markers.end();
    });
  }
  // nullopt where the body has no pose.
  [[nodiscard]] std::optional<PoseRow> row_of(std::size_t index, std::span<const PoseRow> rows) const {
    const markers::Body& body = declared(index);
    const markers::BodyObservation& found = seen_[index];
    if (!found.is_tracked()) return std::nullopt;
    PoseRow row;
    bool is_first = true;
    double squares_px2 = 0;
    for (std::size_t i = 0; i < body.markers.size(); ++i) {
      const PoseRow* const seen = find(rows, body.markers[i].marker_id);
      if (seen != nullptr && std::exchange(is_first, false)) row = *seen;
      if (found.used & (1U << i)) squares_px2 += seen->rms_px * seen->rms_px;
    }
    row.marker_id = body.id;
    row.camera_from_marker = found.camera_from_body;
    row.rms_px = std::sqrt(squares_px2 / found.used_count());
    return row;
  }

  const camera::CameraModel camera_ = plain_camera();
  markers::SeenBodies seen_bodies_;
  std::vector<std::size_t> of_several_;  // which of the declared bodies
  std::vector<markers::MarkerObservation> observations_;
  std::vector<markers::BodyObservation> seen_;
};

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
  FrameRows frames(tools);
  std::vector<PoseRow> result;
  result.reserve(rows.size());
  for (std::size_t first = 0; first < rows.size();) {
    std::size_t end = first;
    while (end < rows.size() && rows[end].frame == rows[first].frame) ++end;
    frames.append(std::span(rows).subspan(first, end - first), result);
    first = end;
  }
  return result;
}

}  // namespace arthronaut::strokes
