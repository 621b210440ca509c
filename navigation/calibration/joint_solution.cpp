#include "navigation/calibration/joint_solution.h"

#include <algorithm>
#include <cmath>

#include "navigation/calibration/closed_form.h"

namespace arthronaut::calibration {
namespace {

// A mark off by so much, or a circle's centre, is worth the time to try without each of the marks.
constexpr double kSuspiciousMark_deg = 0.6, kSuspiciousCircle_px = 1.2;
// What leaving out a mark must take off the cost before the mark is disbelieved. One more free angle is worth
// half a unit by chance; a mark in a wrong place costs thousands.
constexpr double kLeastGain = 100, kLeastGainShare = 0.05;

AdjustmentResult solve_from_nothing(std::span<const Sighting> sightings, const Eigen::Vector2i& size_px,
                                    const AdjustmentOptions& options) {
  AdjustmentResult best;
  for (const Estimate& start : closed_form_starts(sightings, size_px, options.turns)) {
    AdjustmentResult result = adjust(sightings, start, options);
    if (result.rms_px >= 0 && (best.rms_px < 0 || result.rms_px < best.rms_px)) best = std::move(result);
    if (best.rms_px >= 0 && best.rms_px < 0.5) break;
  }
  return best;
}

// The lens angle of a picture without a mark, the camera held: the least cost over a whole turn, of which one
// start may find the wrong half.
void find_angle(const Sighting& unmarked, const AdjustmentResult& camera, std::size_t at, Estimate& all) {
  AdjustmentOptions options;
  options.fix_intrinsics = true;
  options.corner_scale = camera.corner_scale;
  Estimate one = camera.estimate;
  double least = 1e300;
  for (int step = 0; step < 8; ++step) {
    one.lens_angle_rad = {all.lens_angle_rad[at] + step * geometry::kPi / 4};
    one.camera_from_board = {all.camera_from_board[at]};
    const AdjustmentResult result = adjust(std::span(&unmarked, 1), one, options);
    if (result.rms_px < 0 || result.cost >= least) continue;
    least = result.cost;
    all.lens_angle_rad[at] = result.estimate.lens_angle_rad.front();
    all.camera_from_board[at] = result.estimate.camera_from_board.front();
  }
}

// All pictures once more, the angles of those without a mark looked for with the camera that the others give.
AdjustmentResult place_unmarked(std::span<const Sighting> sightings, AdjustmentResult joint,
                                const AdjustmentOptions& options) {
  std::vector<Sighting> marked;
  Estimate of_marked = joint.estimate, all = joint.estimate;
  of_marked.lens_angle_rad.clear();
  of_marked.camera_from_board.clear();
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    if (!sightings[i].has_angle) continue;
    marked.push_back(sightings[i]);
    of_marked.lens_angle_rad.push_back(joint.estimate.lens_angle_rad[i]);
    of_marked.camera_from_board.push_back(joint.estimate.camera_from_board[i]);
  }
  const AdjustmentResult camera = adjust(marked, of_marked, options);
  if (camera.rms_px < 0) return joint;
  for (std::size_t i = 0; i < sightings.size(); ++i)
    if (!sightings[i].has_angle) find_angle(sightings[i], camera, i, all);
  AdjustmentResult placed = adjust(sightings, all, options);
  return placed.rms_px >= 0 && placed.rms_px <= joint.rms_px ? placed : joint;
}

AdjustmentResult solve(std::span<const Sighting> sightings, const Eigen::Vector2i& size_px,
                       const AdjustmentOptions& options) {
  AdjustmentResult result = solve_from_nothing(sightings, size_px, options);
  const bool all_marked =
      std::all_of(sightings.begin(), sightings.end(), [](const Sighting& s) { return s.has_angle; });
  if (result.rms_px < 0 || !options.turns || all_marked) return result;
  return place_unmarked(sightings, std::move(result), options);
}

bool is_suspicious(std::span<const Sighting> sightings, const Estimate& e) {
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    const Sighting& seen = sightings[i];
    const double mark_deg = e.reference_mark_angle_deg + geometry::deg_from_rad(e.lens_angle_rad[i]);
    if (seen.has_angle &&
        std::abs(std::remainder(seen.mark_angle_deg - mark_deg, 360.0)) > kSuspiciousMark_deg)
      return true;
    const Eigen::Vector2d circle =
        turned_about(e.rotation_center_px, e.circle_center_px, e.lens_angle_rad[i]);
    if (seen.has_circle && (seen.circle_center_px - circle).norm() > kSuspiciousCircle_px) return true;
  }
  return false;
}

long marked_count(std::span<const Sighting> sightings) {
  return std::count_if(sightings.begin(), sightings.end(), [](const Sighting& s) { return s.has_angle; });
}

// The cost of a solution at a given scale of the corners' noise: costs compare at one scale only.
double cost_at(double corner_scale, const JointSolution& joint) {
  AdjustmentOptions options = joint.options;
  options.corner_scale = corner_scale;
  const AdjustmentResult result = adjust(joint.sightings, joint.result.estimate, options);
  return result.rms_px < 0 ? 1e300 : result.cost;
}

// Takes back the mark whose absence explains most, if it explains enough. False when all marks may stay.
bool disbelieve_one(JointSolution& joint, const Eigen::Vector2i& size_px) {
  std::vector<JointSolution> without_one;
  double scale = joint.result.corner_scale;
  for (std::size_t i = 0; i < joint.sightings.size(); ++i) {
    if (!joint.sightings[i].has_angle) continue;
    JointSolution without = joint;
    without.sightings[i].has_angle = false;
    if (measured_turn_deg(without.sightings) < kLeastMeasurableTurn_deg) continue;
    without.result = solve(without.sightings, size_px, without.options);
    if (without.result.rms_px < 0) continue;
    scale = std::min(scale, without.result.corner_scale);
    without_one.push_back(std::move(without));
  }
  const double with_all = cost_at(scale, joint);
  double least = 1e300;
  for (JointSolution& without : without_one) {
    const double cost = cost_at(scale, without);
    if (cost > least || with_all - cost < kLeastGain + kLeastGainShare * cost) continue;
    least = cost;
    joint = std::move(without);
  }
  return least < 1e300;
}

}  // namespace

double measured_turn_deg(std::span<const Sighting> sightings) {
  double widest = 0;
  for (const Sighting& a : sightings)
    for (const Sighting& b : sightings)
      if (a.has_angle && b.has_angle)
        widest = std::max(widest, std::abs(std::remainder(a.mark_angle_deg - b.mark_angle_deg, 360.0)));
  return widest;
}

JointSolution solve_jointly(std::span<const Sighting> sightings, const Eigen::Vector2i& size_px) {
  JointSolution joint;
  joint.sightings.assign(sightings.begin(), sightings.end());
  joint.options.turns = measured_turn_deg(sightings) > kLeastMeasurableTurn_deg;
  joint.result = solve(joint.sightings, size_px, joint.options);
  if (joint.result.rms_px < 0) return joint;
  while (joint.options.turns && marked_count(joint.sightings) >= 3 &&
         is_suspicious(joint.sightings, joint.result.estimate) && disbelieve_one(joint, size_px)) {
  }
  AdjustmentOptions last = joint.options;
  last.corner_scale = joint.result.corner_scale;
  last.with_covariance = true;
  AdjustmentResult result = adjust(joint.sightings, joint.result.estimate, last);
  if (result.rms_px >= 0) joint.result = std::move(result);
  return joint;
}

}  // namespace arthronaut::calibration
