#include "tests/real_data/marker_clip.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "navigation/camera/medium.h"
#include "navigation/strokes/poses_file.h"
#include "planning/files/csv_table.h"
#include "planning/geometry/error.h"

namespace arthronaut::real_data {

struct MarkerClip::Video {
  cv::VideoCapture capture;
  cv::Mat bgr, gray;
};

MarkerClip::MarkerClip(const std::filesystem::path& folder)
    : folder_(folder),
      tools_(tools::read_tools_file(folder / "tools.json")),
      calibration_(camera::read_camera_file(folder / "camera.json").calibration),
      video_(std::make_unique<Video>()) {
  const auto lens = files::CsvTable::read(folder / "gt/lens.csv", {"frame", "time_s", "mark_angle_deg"});
  frames_.resize(lens.row_count());
  for (std::size_t row = 0; row < lens.row_count(); ++row) {
    TrueFrame& frame = frames_.at(lens.integer(row, "frame"));
    frame.time_s = lens.number(row, "time_s");
    frame.mark_angle_deg = lens.number(row, "mark_angle_deg");
  }
  for (const strokes::PoseRow& row : strokes::read_poses_file(folder / "gt/poses.csv")) {
    frames_.at(row.frame).markers[row.marker_id].camera_from_marker = row.camera_from_marker;
  }
  const auto corners = files::CsvTable::read(folder / "gt/corners.csv", {"frame", "marker_id", "tl_x_px"});
  for (std::size_t row = 0; row < corners.row_count(); ++row) {
    TrueMarker& marker = frames_.at(corners.integer(row, "frame")).markers[corners.integer(row, "marker_id")];
    const char* names[4] = {"tl", "tr", "br", "bl"};
    for (int i = 0; i < 4; ++i) {
      const std::string name = names[i];
      marker.corners_px[i] = {corners.number(row, name + "_x_px"), corners.number(row, name + "_y_px")};
    }
  }
  const auto seen =
      files::CsvTable::read(folder / "gt/visibility.csv", {"frame", "marker_id", "visible_share"});
  for (std::size_t row = 0; row < seen.row_count(); ++row) {
    TrueMarker& marker = frames_.at(seen.integer(row, "frame")).markers[seen.integer(row, "marker_id")];
    marker.in_view = seen.integer(row, "in_view") == 1;
    marker.visible_share = seen.number(row, "visible_share");
    marker.shortest_side_px = seen.number(row, "shortest_side_px");
    marker.motion_px = seen.number(row, "motion_px");
    marker.is_whole =
        marker.in_view && marker.visible_share >= 0.999 && seen.text(row, "corners_free") == "1111";
  }
  rewind();
}

MarkerClip::~MarkerClip() = default;

void MarkerClip::rewind() {
  next_ = 0;
  if (!video_->capture.open((folder_ / "clip.mkv").string()))
    throw IoError(folder_ / "clip.mkv", "cannot be opened");
}

camera::GrayView MarkerClip::next_picture() {
  if (next_ >= frames_.size() || !video_->capture.read(video_->bgr)) return {};
  ++next_;
  cv::cvtColor(video_->bgr, video_->gray, cv::COLOR_BGR2GRAY);
  return {video_->gray.data, video_->gray.cols, video_->gray.rows,
          static_cast<std::ptrdiff_t>(video_->gray.step)};
}

const TrueFrame& MarkerClip::truth() const { return frames_.at(next_ - 1); }

camera::CameraModel MarkerClip::camera() const { return camera(calibration_); }

camera::CameraModel MarkerClip::camera(const camera::Calibration& calibration) const {
  return {calibration, calibration.lens_angle_rad(truth().mark_angle_deg), camera::kSalineIndex};
}

std::int64_t MarkerClip::timestamp_ns() const { return std::llround(truth().time_s * 1e9); }

std::vector<std::vector<std::uint8_t>> MarkerClip::all_pictures() {
  std::vector<std::vector<std::uint8_t>> pictures;
  for (camera::GrayView view = next_picture(); view.data; view = next_picture()) {
    pictures.emplace_back(view.data, view.data + view.stride * view.height);
  }
  rewind();
  return pictures;
}

}  // namespace arthronaut::real_data
