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

// Which motions over a long exposure may have brought a marker here: that its motion, as far as it is known,
// may be off by so much, and by this share of what it was, in these steps, in cells.
constexpr double kMotionReachCells = 0.5, kMotionReach = 0.5, kMaxMotionReachCells = 2.5,
                 kMotionStepCells = 0.5;
constexpr double kTurnStepRad = 0.1, kTurnStep = 0.5;
// The cosine between the way and the motion at its ends from which on they tell of each other.
constexpr double kAlongWay = 0.9;

// What a smear tells of a motion: along the marker's plane and about its normal.
Vector6d in_plane(const Vector6d& twist) {
  Vector6d seen = Vector6d::Zero();
  for (const int i : {0, 1, 5}) seen[i] = twist[i];
  return seen;
}

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

SeenMotion MarkerTrack::forwards(const TrackedFrame& frame, const ExposedPose& found) const {
  SeenMotion seen{found.velocity, found.change, false};
  if (!motion_.is_known_at(frame.timestamp_ns)) return seen;
  const auto& before = motion_.last()->over_exposure;
  const Vector6d way = motion_to(frame, found.camera_from_marker);
  const double px_per_mm = cell_px(frame, found.camera_from_marker) * cells_ / marker_.size_mm;
  seen.is_sense_known = moved_px(way, px_per_mm) > options_.smeared_px || (before && before->is_sense_known);
  // On the way it moved as it does in the mean of both ends.
  const auto off_mm = [&](double sense, double sense_before) {
    const Vector6d mean = before ? Vector6d(0.5 * (sense_before * before->velocity + sense * seen.velocity))
                                 : Vector6d(sense * seen.velocity);
    return (way - mean).head<3>().squaredNorm();
  };
  const bool is_open = before && !before->is_sense_known;
  const double forwards_mm = is_open ? std::min(off_mm(1, 1), off_mm(1, -1)) : off_mm(1, 1),
               backwards_mm = is_open ? std::min(off_mm(-1, 1), off_mm(-1, -1)) : off_mm(-1, 1);
  if (backwards_mm < forwards_mm) seen.velocity = -seen.velocity;
  return seen;
}

void MarkerTrack::learn_share(const TrackedFrame& frame, const ExposedPose& found) const {
  if (!motion_.is_known_at(frame.timestamp_ns)) return;
  const double px_per_mm = cell_px(frame, found.camera_from_marker) * cells_ / marker_.size_mm;
  const MarkerMotion::Sighting& last = *motion_.last();
  // What was not seen meanwhile may have turned back.
  if (2 * (frame.timestamp_ns - last.timestamp_ns) > 3 * frame.interval_ns) return;
  const Vector6d way = motion_.twist_to(found.camera_from_marker, frame.timestamp_ns, frame.interval_ns);
  double& share = frame.smear.exposure_share;
  if (!last.over_exposure) {
    learn_exposure(share * way, found.velocity, px_per_mm, frame.smear);
    return;
  }
  if (!last.over_exposure->is_sense_known) return;
  // The way by the speeds at both ends and how they change there (Euler and Maclaurin).
  const SeenMotion now = forwards(frame, found);
  const Vector6d mean = 0.5 * (last.over_exposure->velocity + now.velocity) +
                        (last.over_exposure->change - now.change) / (12 * share);
  if (mean.head<3>().dot(way.head<3>()) > kAlongWay * mean.head<3>().norm() * way.head<3>().norm())
    learn_exposure(share * way, mean, px_per_mm, frame.smear);
}

void MarkerTrack::smeared_motions(const TrackedFrame& frame, std::vector<ExposedPose>& motions) const {
  motions.clear();
  const auto& last = motion_.last();
  if (!motion_.is_known_at(frame.timestamp_ns) || frame.timestamp_ns <= last->timestamp_ns) return;
  if (!last->over_exposure) return;
  const double share = frame.smear.exposure_share;
  const double frames = std::max(1.0, static_cast<double>(frame.timestamp_ns - last->timestamp_ns) /
                                          static_cast<double>(frame.interval_ns));
  const RigidTransform& pose = last->camera_from_marker;
  const double cell = cell_px(frame, pose), px_per_mm = cell * cells_ / marker_.size_mm;
  const double step_px = kMotionStepCells * cell;
  const Vector6d change = in_plane(last->over_exposure->change);
  const double way = frames / share;  // in exposures
  for (const double sense : {1.0, -1.0}) {
    if (sense < 0 && last->over_exposure->is_sense_known) break;
    const Vector6d from = sense * in_plane(last->over_exposure->velocity), supposed = from + way * change;
    const double fastest_px = std::max(moved_px(from, px_per_mm), moved_px(supposed, px_per_mm));
    if (fastest_px < options_.max_new_smear_cells * cell) return;
    const double reach_px =
        std::min(kMaxMotionReachCells * cell, kMotionReachCells * cell + kMotionReach * fastest_px);
    const int steps = static_cast<int>(reach_px / step_px);
    const double turn_step = std::max(kTurnStepRad, kTurnStep * std::abs(from[5]));
    for (int turn = -1; turn <= 1; ++turn) {
      for (int y = -steps; y <= steps; ++y) {
        for (int x = -steps; x <= steps; ++x) {
          if (x * x + y * y > steps * steps) continue;
          Vector6d motion = supposed + twist_of({x * step_px, y * step_px}, frame.camera, pose);
          motion[5] += turn * turn_step;
          // Its acceleration changes evenly from what it was, so that it comes to this motion.
          const Vector6d later = 2 / way * (motion - from) - change;
          const RigidTransform here =
              pose * geometry::exp(way / 3 * (2 * from + motion) + way * way / 6 * change);
          motions.push_back({here, motion, later});
        }
      }
    }
  }
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
