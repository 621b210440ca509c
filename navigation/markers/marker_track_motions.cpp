// Which motion smears a marker: the one that took it here, or, when nothing is known of it, one of those that
// are tried.
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "navigation/markers/marker_track.h"

namespace arthronaut::markers {
namespace {

using geometry::RigidTransform;
using geometry::Vector6d;

// Motions over the exposure that are tried when none is known.
constexpr double kTriedLengthsPx[] = {8, 18};
constexpr int kTriedDirections = 4;
// How far the edges are looked for, in cells; less than half, or the next edge answers.
constexpr double kReachPredicted = 0.35, kReachFound = 0.45;

// Quick: which of many motions is worth a whole fit.
DirectOptions tried(DirectOptions options) {
  options = unsure(options);
  options.max_iterations = 5;
  options.max_pixels = 300;
  return options;
}

}  // namespace

DirectOptions unsure(DirectOptions options) {
  options.coarse_cells = 0.3;
  options.max_way_cells = 3;
  return options;
}

double MarkerTrack::cell_px(const TrackedFrame& frame, const RigidTransform& pose) const {
  return frame.camera.central_focal_px() * marker_.size_mm / cells_ / std::max(pose.translation_mm.z(), 1.0);
}

int MarkerTrack::edge_search_px(bool is_found, double cell_px) {
  return std::clamp(static_cast<int>(std::lround((is_found ? kReachFound : kReachPredicted) * cell_px)), 2,
                    16);
}

Vector6d MarkerTrack::motion_to(const TrackedFrame& frame, const RigidTransform& pose) const {
  return frame.smear.exposure_share * motion_.twist_to(pose, frame.timestamp_ns, frame.interval_ns);
}

double MarkerTrack::moved_px(const Vector6d& motion, double px_per_mm) const {
  return px_per_mm * std::hypot(motion.head<3>().norm(), 0.5 * marker_.size_mm * motion.tail<3>().norm());
}

bool MarkerTrack::is_calm(const TrackedFrame& frame, const MarkerObservation& observation) const {
  if (!observation.is_tracked() || !stood_lately(frame)) return false;
  const double px_per_mm = cell_px(frame, observation.camera_from_marker) * cells_ / marker_.size_mm;
  return moved_px(motion_to(frame, observation.camera_from_marker), px_per_mm) < options_.smeared_px;
}

bool MarkerTrack::is_fast(const TrackedFrame& frame, const RigidTransform& pose) const {
  const Vector6d twist = motion_.twist_to(pose, frame.timestamp_ns, frame.interval_ns);
  return twist.head<3>().norm() * cells_ > marker_.size_mm;
}

bool MarkerTrack::is_outrun(const TrackedFrame& frame, const RigidTransform& pose) const {
  return motion_.is_known_at(frame.timestamp_ns) &&
         (!motion_.change_to(pose, frame.timestamp_ns, frame.interval_ns) || is_fast(frame, pose));
}

Vector6d MarkerTrack::interval_motion(const TrackedFrame& frame, const RigidTransform& pose) const {
  const Vector6d motion = motion_.twist_to(pose, frame.timestamp_ns, frame.interval_ns);
  const auto change = motion_.change_to(pose, frame.timestamp_ns, frame.interval_ns);
  return change ? Vector6d(motion + 0.5 * *change) : motion;
}

DirectPose MarkerTrack::try_motions(const TrackedFrame& frame, const RigidTransform& start) {
  struct Tried {
    Vector6d motion;
    double likeness = 0;
    std::size_t place = 0;
  };
  std::array<Tried, std::size(kTriedLengthsPx) * kTriedDirections> all;
  std::size_t count = 0;
  const int search_px = edge_search_px(true, cell_px(frame, start));
  for (const double length : kTriedLengthsPx) {
    for (int direction = 0; direction < kTriedDirections; ++direction) {
      const double angle = geometry::kPi * direction / kTriedDirections;
      const Vector6d motion =
          twist_of({length * std::cos(angle), length * std::sin(angle)}, frame.camera, start);
      all[count] = {motion, likeness_of(frame, start, motion, search_px), count};
      ++count;
    }
  }
  std::sort(all.begin(), all.end(), [](const Tried& a, const Tried& b) {
    return a.likeness > b.likeness || (a.likeness == b.likeness && a.place < b.place);
  });
  DirectPose best;
  for (const Tried& motion : std::span(all).first(kFittedMotions)) {
    const DirectPose fit = fit_directly(frame, start, motion.motion, tried(options_.direct));
    if (!fit.is_usable() || (best.is_usable() && fit.noise_grey >= best.noise_grey)) continue;
    best = fit;
  }
  if (!best.is_usable()) return best;
  DirectOptions whole = options_.direct;
  whole.max_way_cells = 2;
  return fit_directly(frame, best.pose.camera_from_marker, best.pose.velocity, whole);
}

double MarkerTrack::likeness_of(const TrackedFrame& frame, const RigidTransform& pose, const Vector6d& motion,
                                int search_px) {
  SmearTrend ignored;
  measure_edges(frame.image, frame.camera, pose, marker_.size_mm, cells_, samples_,
                {frame.smear.sigma_px, motion}, {.search_px = search_px, .stride = 4}, few_, ignored);
  double sum = 0;
  for (const EdgeMeasurement& measurement : few_) sum += std::max(0.0, measurement.likeness - 0.5);
  return sum;
}

Vector6d MarkerTrack::likely_motion(const TrackedFrame& frame, const RigidTransform& pose, int search_px) {
  const auto likeness = [&](const Vector6d& motion) { return likeness_of(frame, pose, motion, search_px); };
  Vector6d best = Vector6d::Zero();
  double most = likeness(best);
  if (most > 0.47 * static_cast<double>(few_.size())) return best;  // sharp
  for (const double length : kTriedLengthsPx) {
    for (int direction = 0; direction < kTriedDirections; ++direction) {
      const double angle = geometry::kPi * direction / kTriedDirections;
      const Vector6d motion =
          twist_of({length * std::cos(angle), length * std::sin(angle)}, frame.camera, pose);
      const double sum = likeness(motion);
      if (sum > most) {
        most = sum;
        best = motion;
      }
    }
  }
  return best;
}

}  // namespace arthronaut::markers
