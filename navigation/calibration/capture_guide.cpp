#include "navigation/calibration/capture_guide.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "navigation/calibration/conformal_map.h"
#include "planning/files/format.h"
#include "planning/geometry/error.h"
#include "planning/geometry/quantile.h"

namespace arthronaut::calibration {
namespace {

// Cells of a grid over the round view that have a corner in them or beside them.
double coverage_of(const CalibrationPicture& picture) {
  constexpr int kCells = 9;
  const Eigen::Vector2d center = picture.lens.circle_found
                                     ? picture.lens.circle.center_px
                                     : Eigen::Vector2d(0.5 * picture.size_px.cast<double>());
  const double radius =
      picture.lens.circle_found ? picture.lens.circle.radius_px : 0.5 * picture.size_px.cast<double>().norm();
  const double cell_px = 2 * radius / kCells;
  int inside = 0, covered = 0;
  for (int cy = 0; cy < kCells; ++cy)
    for (int cx = 0; cx < kCells; ++cx) {
      const Eigen::Vector2d middle =
          center + cell_px * (Eigen::Vector2d(cx, cy).array() + 0.5 - 0.5 * kCells).matrix();
      const bool in_picture = middle.x() > 0 && middle.y() > 0 && middle.x() < picture.size_px.x() &&
                              middle.y() < picture.size_px.y();
      if ((middle - center).norm() > radius || !in_picture) continue;
      ++inside;
      covered += std::any_of(picture.board.corners.begin(), picture.board.corners.end(),
                             [&](const BoardCorner& corner) {
                               return (corner.pixel - middle).squaredNorm() < cell_px * cell_px;
                             });
    }
  return inside > 0 ? static_cast<double>(covered) / inside : 0;
}

// From black to white across the edge half way between two corners: contrast over the steepest slope.
std::optional<double> edge_width_at(const camera::GrayView& frame, const Eigen::Vector2d& a,
                                    const Eigen::Vector2d& b) {
  constexpr int kReach = 7;
  const Eigen::Vector2d along = b - a;
  if (along.norm() < 2.5 * kReach) return std::nullopt;
  const Eigen::Vector2d across = Eigen::Vector2d(-along.y(), along.x()).normalized();
  std::array<double, 2 * kReach + 1> profile;
  for (int k = -kReach; k <= kReach; ++k) {
    const Eigen::Vector2d p = 0.5 * (a + b) + k * across;
    const int x = static_cast<int>(std::lround(p.x())), y = static_cast<int>(std::lround(p.y()));
    if (x < 0 || y < 0 || x >= frame.width || y >= frame.height) return std::nullopt;
    profile[static_cast<std::size_t>(k + kReach)] = frame.row(y)[x];
  }
  double steepest = 0;
  for (std::size_t k = 1; k < profile.size(); ++k)
    steepest = std::max(steepest, std::abs(profile[k] - profile[k - 1]));
  const double contrast =
      std::abs(profile.front() + profile[1] - profile.back() - profile[profile.size() - 2]) / 2;
  if (contrast < 15 || steepest < 1) return std::nullopt;
  return contrast / steepest;
}

double edge_width_of(const camera::GrayView& frame, const CalibrationPicture& picture) {
  std::map<std::pair<int, int>, Eigen::Vector2d> at;
  for (const BoardCorner& corner : picture.board.corners)
    at[{corner.lattice.x(), corner.lattice.y()}] = corner.pixel;
  std::vector<double> widths;
  for (const auto& [node, pixel] : at)
    for (const auto& next : {std::pair{node.first + 1, node.second}, std::pair{node.first, node.second + 1}})
      if (const auto other = at.find(next); other != at.end())
        if (const auto width = edge_width_at(frame, pixel, other->second)) widths.push_back(*width);
  return widths.size() < 8 ? 0 : geometry::median(widths);
}

double saturated_share(const camera::GrayView& frame, const CalibrationPicture& picture) {
  long inside = 0, saturated = 0;
  const camera::Boundary& circle = picture.lens.circle;
  for (int y = 0; y < frame.height; y += 4)
    for (int x = 0; x < frame.width; x += 4) {
      if (picture.lens.circle_found && (Eigen::Vector2d(x, y) - circle.center_px).norm() > circle.radius_px)
        continue;
      ++inside;
      saturated += frame.row(y)[x] >= 252;
    }
  return inside > 0 ? static_cast<double>(saturated) / static_cast<double>(inside) : 0;
}

std::optional<double> tilt_of(const CalibrationPicture& picture) {
  std::vector<Eigen::Vector2d> pixels, plane;
  for (const BoardCorner& corner : picture.board.corners) {
    pixels.push_back(corner.pixel);
    plane.push_back(corner.lattice.cast<double>());
  }
  const auto map = fit_conformal_map(pixels, plane);
  const auto camera = map ? camera_of(*map) : std::nullopt;
  if (!camera) return std::nullopt;
  // A board that faces the lens holds no focal length; then that of a usual field of view shows that it does.
  const double usual_px =
      picture.lens.circle_found ? 1.1 * picture.lens.circle.radius_px : 0.5 * picture.size_px.x();
  const double focal_px = focal_from_homographies(std::span(&camera->homography, 1)).value_or(usual_px);
  const bool is_plausible = focal_px > 0.4 * usual_px && focal_px < 4 * usual_px;
  const geometry::RigidTransform pose =
      pose_from_homography(camera->homography, is_plausible ? focal_px : usual_px);
  const double angle =
      geometry::angle_between_rad(pose.rotate(Eigen::Vector3d::UnitZ()), Eigen::Vector3d::UnitZ());
  return geometry::deg_from_rad(std::min(angle, geometry::kPi - angle));
}

// Median distance from each corner to the nearest one of the picture before; no more than half a square can
// be told.
std::optional<double> motion_between(const CalibrationPicture& before, const CalibrationPicture& now) {
  if (!before.board.found() || !now.board.found()) return std::nullopt;
  std::vector<double> shifts;
  for (std::size_t k = 0; k < now.board.corners.size(); k += 1 + now.board.corners.size() / 100) {
    double nearest = 1e9;
    for (const BoardCorner& other : before.board.corners)
      nearest = std::min(nearest, (other.pixel - now.board.corners[k].pixel).squaredNorm());
    shifts.push_back(std::sqrt(nearest));
  }
  return geometry::median(shifts);
}

bool has_mark(const CalibrationPicture& picture) { return picture.lens.mark == lens::MarkState::Found; }

double turn_between(const CalibrationPicture& a, const CalibrationPicture& b) {
  return std::abs(std::remainder(a.lens.mark_angle_deg - b.lens.mark_angle_deg, 360.0));
}

}  // namespace

CaptureQuality measure_quality(const camera::GrayView& frame, const CalibrationPicture& picture) {
  CaptureQuality quality;
  quality.corner_count = picture.board.corners.size();
  quality.saturated = saturated_share(frame, picture);
  if (!picture.board.found()) return quality;
  quality.coverage = coverage_of(picture);
  quality.edge_width_px = edge_width_of(frame, picture);
  quality.tilt_deg = tilt_of(picture);
  return quality;
}

const CaptureAdvice& CaptureGuide::look(const camera::GrayView& frame) {
  const CalibrationPicture before = std::move(advice_.picture);
  advice_.picture = observe_picture("", frame);
  advice_.quality = measure_quality(frame, advice_.picture);
  advice_.quality.motion_px = motion_between(before, advice_.picture);
  if (has_mark(advice_.picture))
    for (const CalibrationPicture& other : taken_)
      advice_.quality.turn_deg =
          std::min(advice_.quality.turn_deg.value_or(360), turn_between(advice_.picture, other));
  judge();
  advise();
  return advice_;
}

void CaptureGuide::judge() {
  const CalibrationPicture& picture = advice_.picture;
  const CaptureQuality& quality = advice_.quality;
  std::vector<std::string>& reasons = advice_.rejections;
  reasons.clear();
  if (!taken_.empty() && taken_.front().size_px != picture.size_px)
    reasons.push_back("the picture has another size than those taken");
  if (!picture.lens.circle_found)
    reasons.push_back("the round image border is not seen");
  else if (!has_mark(picture))
    reasons.push_back("the lens mark is not seen: " + std::string(lens::to_text(picture.lens.mark)));
  if (!picture.board.found()) {
    reasons.push_back("no checkerboard is seen: hold one 12 to 22 mm before the lens");
    return;
  }
  if (quality.corner_count < limits_.fewest_corners)
    reasons.push_back(files::format("only %.0f corners are seen (needs %.0f)",
                                    static_cast<double>(quality.corner_count),
                                    static_cast<double>(limits_.fewest_corners)));
  if (quality.coverage < limits_.least_coverage)
    reasons.push_back(files::format("the board covers %.0f %% of the view (needs %.0f %%)",
                                    100 * quality.coverage, 100 * limits_.least_coverage));
  if (quality.edge_width_px > limits_.widest_edge_px)
    reasons.push_back(files::format("blurred: edges are %.1f px wide (at most %.1f)", quality.edge_width_px,
                                    limits_.widest_edge_px));
  if (quality.saturated > limits_.most_saturated)
    reasons.push_back(files::format("glare: %.0f %% of the view is white (at most %.0f %%)",
                                    100 * quality.saturated, 100 * limits_.most_saturated));
  if (quality.motion_px && *quality.motion_px > limits_.most_motion_px)
    reasons.push_back(files::format("it moves: %.1f px since the last look", *quality.motion_px));
  if (quality.turn_deg && *quality.turn_deg < limits_.least_turn_deg)
    reasons.push_back(files::format("the lens stands %.0f degrees from a picture taken (needs %.0f)",
                                    *quality.turn_deg, limits_.least_turn_deg));
}

double CaptureGuide::span_deg(const CalibrationPicture* with) const {
  double widest = 0;
  for (const CalibrationPicture& a : taken_) {
    for (const CalibrationPicture& b : taken_) widest = std::max(widest, turn_between(a, b));
    if (with && has_mark(*with)) widest = std::max(widest, turn_between(a, *with));
  }
  return widest;
}

void CaptureGuide::advise() {
  const bool has_tilt = std::any_of(tilts_deg_.begin(), tilts_deg_.end(),
                                    [&](double tilt) { return tilt >= limits_.wanted_tilt_deg; });
  const int missing = limits_.fewest_pictures - static_cast<int>(taken_.size());
  advice_.is_complete = missing <= 0 && has_tilt && span_deg(nullptr) >= limits_.least_span_deg;
  if (advice_.is_complete)
    advice_.wanted = "Enough pictures: calibrate";
  else if (!taken_.empty() && advice_.quality.turn_deg.value_or(360) < limits_.least_turn_deg)
    advice_.wanted = "Turn the lens";
  else if (!advice_.is_good())
    advice_.wanted = "Not yet: " + advice_.rejections.front();
  else if (missing <= 1 && !has_tilt && advice_.quality.tilt_deg.value_or(90) < limits_.wanted_tilt_deg)
    advice_.wanted = "Tilt the board";
  else if (missing <= 1 && span_deg(&advice_.picture) < limits_.least_span_deg)
    advice_.wanted = "Turn the lens further";
  else
    advice_.wanted = "Hold still and take the picture";
}

void CaptureGuide::take() {
  if (!advice_.picture.board.found())
    throw InvalidInput("calibration: there is no checkerboard in the picture");
  taken_.push_back(advice_.picture);
  taken_.back().name = "picture " + std::to_string(taken_.size());
  tilts_deg_.push_back(advice_.quality.tilt_deg.value_or(-1));
  if (has_mark(advice_.picture)) advice_.quality.turn_deg = 0;
  judge();
  advise();
}

void CaptureGuide::drop_last() {
  if (taken_.empty()) return;
  taken_.pop_back();
  tilts_deg_.pop_back();
  advice_.quality.turn_deg.reset();
  judge();
  advise();
}

}  // namespace arthronaut::calibration
