#include "tests/benchmarks/aruco_tracker.h"

#include <algorithm>
#include <cmath>
#include <opencv2/aruco.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "navigation/markers/declaration.h"
#include "navigation/markers/planar_pose.h"

namespace arthronaut::markers {
namespace {

// A corner of OpenCV's sub-pixel refinement on blurred, coded video; measured on path-traced clips.
constexpr double kCornerSigmaPx = 0.2;
// A square whose corners fit no pose better than this has a corner that is not its own.
constexpr double kMaxRmsPx = 0.8;
constexpr double kMinSidePx = 16;
// The other planar solution must be this much worse, unless the two are nearly the same pose.
constexpr double kMinAmbiguityRatio = 1.7;
constexpr double kHarmlessFlipRad = 3 * geometry::kPi / 180;

double shortest_side_px(const Corners& corners) {
  double shortest = (corners[0] - corners[3]).norm();
  for (int i = 0; i < 3; ++i) shortest = std::min(shortest, (corners[i + 1] - corners[i]).norm());
  return shortest;
}

class ArucoTracker final : public MarkerTracker {
 public:
  explicit ArucoTracker(std::span<const DeclaredMarker> declared)
      : declared_(declared.begin(), declared.end()),
        dictionary_(cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50)),
        parameters_(cv::aruco::DetectorParameters::create()) {
    check_declaration(declared);
    // With the default a white margin of one cell swallows the black square inside it.
    parameters_->minMarkerDistanceRate = 0.02;
    parameters_->cornerRefinementMethod = cv::aruco::CORNER_REFINE_NONE;
    // The video threads of the program own the cores; a second pool would only add jitter.
    cv::setNumThreads(1);
    reset();
  }

  std::span<const MarkerObservation> track(const camera::GrayView& frame, const camera::CameraModel& camera,
                                           std::int64_t /*timestamp_ns*/) override {
    check_frame_size(frame, camera);
    const cv::Mat image(frame.height, frame.width, CV_8UC1, const_cast<std::uint8_t*>(frame.data),
                        static_cast<std::size_t>(frame.stride));
    cv::aruco::detectMarkers(image, dictionary_, quads_, ids_, parameters_);
    for (std::size_t i = 0; i < declared_.size(); ++i) observe(declared_[i], image, camera, observations_[i]);
    return observations_;
  }

  void reset() override {
    observations_.assign(declared_.size(), MarkerObservation());
    for (std::size_t i = 0; i < declared_.size(); ++i) observations_[i].id = declared_[i].id;
  }

 private:
  void observe(const DeclaredMarker& marker, const cv::Mat& image, const camera::CameraModel& camera,
               MarkerObservation& observation) {
    const MarkerObservation before = observation;
    observation = MarkerObservation();
    observation.id = marker.id;
    std::vector<cv::Point2f>* quad = nullptr;
    for (std::size_t i = 0; i < ids_.size(); ++i) {
      if (ids_[i] != marker.id) continue;
      if (quad && !is_same_square(*quad, quads_[i])) {
        observation.state = MarkerState::Duplicate;
        return;
      }
      if (!quad || cv::contourArea(quads_[i]) > cv::contourArea(*quad)) quad = &quads_[i];
    }
    if (!quad) {
      observation.state = reason_not_found(before, camera);
      observation.corners_px = before.corners_px;
      return;
    }
    measure(marker, *quad, image, camera, observation);
  }

  // The thresholds of several window sizes, and the inside and outside of the black border, find one square
  // repeatedly.
  static bool is_same_square(const std::vector<cv::Point2f>& a, const std::vector<cv::Point2f>& b) {
    const cv::Point2f between = 0.25 * (a[0] + a[1] + a[2] + a[3] - b[0] - b[1] - b[2] - b[3]);
    return cv::norm(between) < 0.25 * cv::norm(a[2] - a[0]);
  }

  void measure(const DeclaredMarker& marker, std::vector<cv::Point2f>& quad, const cv::Mat& image,
               const camera::CameraModel& camera, MarkerObservation& observation) {
    for (int i = 0; i < 4; ++i) observation.corners_px[i] = {quad[i].x, quad[i].y};
    const double side_px = shortest_side_px(observation.corners_px);
    if (side_px < kMinSidePx) {
      observation.state = MarkerState::TooSmall;
      return;
    }
    // The window stays clear of the code's own corners, one cell away.
    const int window = std::clamp(static_cast<int>(std::lround(0.3 * side_px / 6)), 2, 8);
    cv::cornerSubPix(image, quad, {window, window}, {-1, -1},
                     {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 30, 0.005});
    for (int i = 0; i < 4; ++i) observation.corners_px[i] = {quad[i].x, quad[i].y};

    const auto poses = solve_square(camera, observation.corners_px, marker.size_mm);
    if (!poses) {
      observation.state = MarkerState::Doubtful;
      return;
    }
    observation.camera_from_marker = poses->best.camera_from_marker;
    observation.rms_px = poses->best.rms_px;
    observation.ambiguity_ratio = poses->ambiguity_ratio;
    observation.covariance = square_covariance(poses->best, std::max(kCornerSigmaPx, poses->best.rms_px));
    observation.state = judge(*poses);
  }

  static MarkerState judge(const SquarePoses& poses) {
    if (poses.best.rms_px > kMaxRmsPx) return MarkerState::Doubtful;
    // The printed face looks back at the camera: its normal runs against the line of sight.
    const auto& pose = poses.best.camera_from_marker;
    if (pose.rotate(Eigen::Vector3d::UnitZ()).dot(pose.translation_mm) >= 0) return MarkerState::Doubtful;
    if (poses.other && poses.ambiguity_ratio < kMinAmbiguityRatio) {
      const double flip_rad =
          geometry::rotation_angle_rad(pose.rotation.conjugate() * poses.other->camera_from_marker.rotation);
      if (flip_rad > kHarmlessFlipRad) return MarkerState::Ambiguous;
    }
    return MarkerState::Tracked;
  }

  // OpenCV does not say why it rejects; the place where the marker was last seen is all there is to go by.
  static MarkerState reason_not_found(const MarkerObservation& before, const camera::CameraModel& camera) {
    if (before.state != MarkerState::Tracked && before.state != MarkerState::OutOfView)
      return MarkerState::NotSeen;
    const auto near_edge = [&](const Eigen::Vector2d& corner) {
      return !camera.is_inside_view(corner + 0.04 * (corner - camera.boundary().center_px));
    };
    return std::any_of(before.corners_px.begin(), before.corners_px.end(), near_edge) ? MarkerState::OutOfView
                                                                                      : MarkerState::NotSeen;
  }

  std::vector<DeclaredMarker> declared_;
  cv::Ptr<cv::aruco::Dictionary> dictionary_;
  cv::Ptr<cv::aruco::DetectorParameters> parameters_;
  std::vector<std::vector<cv::Point2f>> quads_;
  std::vector<int> ids_;
  std::vector<MarkerObservation> observations_;
};

}  // namespace

std::unique_ptr<MarkerTracker> make_aruco_tracker(std::span<const DeclaredMarker> declared) {
  return std::make_unique<ArucoTracker>(declared);
}

}  // namespace arthronaut::markers
