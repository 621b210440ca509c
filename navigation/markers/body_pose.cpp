#include "navigation/markers/body_pose.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>

#include "navigation/markers/planar_pose.h"
#include "navigation/markers/verdict.h"

namespace arthronaut::markers {

namespace {

using geometry::Matrix6d;
using geometry::RigidTransform;
using geometry::Vector6d;
using Vector8d = Eigen::Matrix<double, 8, 1>;
using Matrix8d = Eigen::Matrix<double, 8, 8>;
using Matrix86d = Eigen::Matrix<double, 8, 6>;

constexpr int kMost = tools::kMostMarkersOfBody;
constexpr int kMostAmbiguous = 3;  // of those that are read both ways; further ones are left out
constexpr int kMaxIterations = 20;
constexpr double kSettled_mm = 1e-7, kSettled_rad = 1e-9;
constexpr double kLeastCornerSigma_px = 0.01;  // no pose is better than this tells its corners

// A marker's corners as one of its poses has them, and how much each deviation of them weighs, 1/px^2. Along
// the six directions in which a pose moves corners the weight is the inverse of the pose's covariance, across
// them that of corners which are as good as the pose is: so that the other tilt, which has nearly the same
// corners, costs what it would cost.
struct Reading {
  RigidTransform camera_from_marker;
  Vector8d corners_px = Vector8d::Zero();
  Matrix8d weight = Matrix8d::Zero();
};

struct Sight {
  const tools::BodyMarker* marker = nullptr;
  int place = 0;  // on the body
  std::array<Reading, 2> readings;
  int reading_count = 0;
  [[nodiscard]] bool is_ambiguous() const { return reading_count > 1; }
};

// Corners of a marker on a body and how they move with the body's twist.
bool project_corners(const camera::CameraModel& camera, const RigidTransform& camera_from_body,
                     const tools::BodyMarker& marker, Vector8d& corners_px, Matrix86d& jacobian) {
  const Eigen::Matrix3d rotation = camera_from_body.matrix();
  const auto corners_mm = square_corners_mm(marker.size_mm);
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector3d in_body = marker.body_from_marker * corners_mm[k];
    Eigen::Matrix<double, 2, 3> d_pixel;
    const auto pixel = camera.project(camera_from_body * in_body, d_pixel);
    if (!pixel) return false;
    const Eigen::Matrix<double, 2, 3> d_rotated = d_pixel * rotation;
    corners_px.segment<2>(2 * k) = *pixel;
    jacobian.block<2, 3>(2 * k, 0) = d_rotated;
    jacobian.block<2, 3>(2 * k, 3) = -d_rotated * geometry::cross_matrix(in_body);
  }
  return true;
}

bool add_reading(const camera::CameraModel& camera, const RigidTransform& camera_from_marker,
                 const std::optional<Matrix6d>& covariance, double corner_sigma_px, Sight& sight) {
  Reading& reading = sight.readings[static_cast<std::size_t>(sight.reading_count)];
  tools::BodyMarker alone = *sight.marker;
  alone.body_from_marker = {};
  Matrix86d jacobian;
  if (!project_corners(camera, camera_from_marker, alone, reading.corners_px, jacobian)) return false;
  const Eigen::LDLT<Matrix6d> normal(jacobian.transpose() * jacobian);
  const Eigen::Matrix<double, 6, 8> twist_per_corner = normal.solve(jacobian.transpose());
  const double variance_px2 =
      std::pow(std::max(kLeastCornerSigma_px,
                        covariance ? std::sqrt((jacobian.transpose() * jacobian * *covariance).trace() / 6)
                                   : corner_sigma_px),
               2);
  const Matrix6d own = covariance ? *covariance : Matrix6d(variance_px2 * normal.solve(Matrix6d::Identity()));
  Matrix6d error = own + tools::placement_covariance(*sight.marker);
  error.diagonal().array() += 1e-12;  // a pose that is said to be exact still has an inverse
  reading.camera_from_marker = camera_from_marker;
  reading.weight = twist_per_corner.transpose() * error.ldlt().solve(twist_per_corner) +
                   (Matrix8d::Identity() - jacobian * twist_per_corner) / variance_px2;
  if (!reading.weight.allFinite()) return false;
  ++sight.reading_count;
  return true;
}

bool read(const camera::CameraModel& camera, const MarkerObservation& observation, Sight& sight) {
  if (!add_reading(camera, observation.camera_from_marker, observation.covariance, 0, sight)) return false;
  if (observation.state != MarkerState::Ambiguous) return true;
  // Both poses that the corners allow, as equals: their own tracker could not tell.
  const auto poses = solve_square(camera, observation.corners_px, sight.marker->size_mm);
  if (!poses || !poses->other) return false;
  const bool first_is_known = !are_unlike(observation.camera_from_marker, poses->best.camera_from_marker);
  const SquarePose& other = first_is_known ? *poses->other : poses->best;
  const double corner_sigma_px =
      std::sqrt(std::max(0.0, (poses->best.information * observation.covariance).trace() / 6));
  return add_reading(camera, other.camera_from_marker, std::nullopt, corner_sigma_px, sight);
}

// Some of the sights, each read in one way.
struct Choice {
  std::array<const Sight*, kMost> sights{};
  std::array<int, kMost> readings{};
  int count = 0;
  void add(const Sight& sight, int reading) {
    sights[static_cast<std::size_t>(count)] = &sight;
    readings[static_cast<std::size_t>(count++)] = reading;
  }
  [[nodiscard]] const Sight& sight(int i) const { return *sights[static_cast<std::size_t>(i)]; }
  [[nodiscard]] const Reading& reading(int i) const {
    return sight(i).readings[static_cast<std::size_t>(readings[static_cast<std::size_t>(i)])];
  }
  [[nodiscard]] Choice without(int left_out) const {
    Choice rest;
    for (int i = 0; i < count; ++i)
      if (i != left_out) rest.add(sight(i), readings[static_cast<std::size_t>(i)]);
    return rest;
  }
};

struct Fit {
  RigidTransform camera_from_body;
  Matrix6d information = Matrix6d::Zero();
  double cost = 1e30;
};

bool linearise(const camera::CameraModel& camera, const Choice& choice, const RigidTransform& pose,
               Matrix6d& normal, Vector6d& gradient, double& cost) {
  normal.setZero();
  gradient.setZero();
  cost = 0;
  Vector8d corners_px;
  Matrix86d jacobian;
  for (int i = 0; i < choice.count; ++i) {
    const Reading& reading = choice.reading(i);
    if (!project_corners(camera, pose, *choice.sight(i).marker, corners_px, jacobian)) return false;
    const Vector8d residual = corners_px - reading.corners_px;
    const Matrix86d weighted = reading.weight * jacobian;
    normal.noalias() += jacobian.transpose() * weighted;
    gradient.noalias() += weighted.transpose() * residual;
    cost += residual.dot(reading.weight * residual);
  }
  return true;
}

Fit fit_from(const camera::CameraModel& camera, const Choice& choice, const RigidTransform& start) {
  Fit fit;
  Matrix6d normal, next_normal;
  Vector6d gradient, next_gradient;
  double cost = 0, next_cost = 0;
  RigidTransform pose = start;
  if (!linearise(camera, choice, pose, normal, gradient, cost)) return fit;
  double damping = 1e-4;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    Matrix6d damped = normal;
    damped.diagonal() *= 1 + damping;
    const Vector6d step = -damped.ldlt().solve(gradient);
    if (!step.allFinite()) return fit;
    const RigidTransform next = pose * geometry::exp(step);
    if (linearise(camera, choice, next, next_normal, next_gradient, next_cost) && next_cost <= cost) {
      pose = next;
      normal = next_normal;
      gradient = next_gradient;
      cost = next_cost;
      damping = std::max(1e-9, damping * 0.1);
      if (step.head<3>().norm() < kSettled_mm && step.tail<3>().norm() < kSettled_rad) break;
    } else {
      damping *= 10;
      if (damping > 1e6) break;
    }
  }
  return {pose, normal, cost};
}

RigidTransform body_from_one(const Choice& choice, int i) {
  return choice.reading(i).camera_from_marker * choice.sight(i).marker->body_from_marker.inverse();
}

// From each marker's own pose: a marker that is bent away may lead astray.
Fit fit(const camera::CameraModel& camera, const Choice& choice) {
  Fit best;
  for (int i = 0; i < choice.count; ++i) {
    const Fit from = fit_from(camera, choice, body_from_one(choice, i));
    if (from.cost < best.cost) best = from;
  }
  return best;
}

int degrees_of_freedom(const Choice& choice) { return 6 * (choice.count - 1); }

double most_cost(const Choice& choice, const BodyPoseOptions& options) {
  return options.max_disagreement * (1 + (choice.count - 2) / 3.0);
}

// How near to a pose a marker came, for what to say of a body that has none.
int nearness(MarkerState state) {
  switch (state) {
    case MarkerState::NotSeen:
      return 0;
    case MarkerState::OutOfView:
      return 1;
    case MarkerState::TooSmall:
      return 2;
    case MarkerState::TooOblique:
      return 3;
    case MarkerState::Covered:
      return 4;
    case MarkerState::Glare:
      return 5;
    case MarkerState::Blur:
      return 6;
    case MarkerState::Doubtful:
      return 7;
    case MarkerState::Duplicate:
      return 8;
    case MarkerState::Ambiguous:
      return 9;
    case MarkerState::Tracked:
    case MarkerState::Disagreeing:
      return 10;
  }
  return 0;
}

void take_one(const Body& body, int place, const MarkerObservation& seen, BodyObservation& observation) {
  const tools::BodyMarker& marker = body.markers[static_cast<std::size_t>(place)];
  observation.state = MarkerState::Tracked;
  observation.used = 1U << place;
  observation.camera_from_body = seen.camera_from_marker;
  observation.covariance = seen.covariance;
  const RigidTransform& at = marker.body_from_marker;
  if (at.translation_mm.isZero(0) && at.rotation.vec().isZero(0) && !marker.sigma_mm && !marker.sigma_deg)
    return;
  observation.camera_from_body = seen.camera_from_marker * at.inverse();
  const Matrix6d to_body = geometry::adjoint(at);
  observation.covariance =
      to_body * (seen.covariance + tools::placement_covariance(marker)) * to_body.transpose();
}

void take(const Choice& choice, const Fit& fitted, BodyObservation& observation) {
  observation.camera_from_body = fitted.camera_from_body;
  observation.covariance = fitted.information.ldlt().solve(Matrix6d::Identity());
  observation.misfit = fitted.cost / degrees_of_freedom(choice);
  // Markers that agree less than predicted tell less than predicted.
  observation.covariance *= std::max(1.0, observation.misfit);
  observation.used = 0;
  observation.state = MarkerState::Doubtful;
  for (int i = 0; i < choice.count; ++i) {
    observation.used |= 1U << choice.sight(i).place;
    // How well a pose is known depends on where one asks: at a marker, as it is asked of one alone.
    const Matrix6d to_marker = geometry::adjoint(choice.sight(i).marker->body_from_marker.inverse());
    if (is_known_well_enough(to_marker * observation.covariance * to_marker.transpose()))
      observation.state = MarkerState::Tracked;
  }
}

// The markers disagree: without the one that is wrong, where it is clear which.
void take_without_odd_one(const camera::CameraModel& camera, Choice choice, const BodyPoseOptions& options,
                          BodyObservation& observation) {
  observation.state = MarkerState::Disagreeing;
  if (choice.count < 3) return;
  Fit best, second;
  int odd = 0;
  for (int i = 0; i < choice.count; ++i) {
    const Fit rest = fit(camera, choice.without(i));
    if (rest.cost < best.cost) {
      second = best;
      best = rest;
      odd = i;
    } else if (rest.cost < second.cost) {
      second = rest;
    }
  }
  observation.odd_marker = choice.sight(odd).marker->marker_id;
  const Choice rest = choice.without(odd);
  if (best.cost <= most_cost(rest, options) && second.cost - best.cost > options.clear_odd_one)
    take(rest, best, observation);
}

struct Decision {
  Choice choice;
  Fit fitted;
  bool is_clear = false;
};

// Of all ways to read the ambiguous ones, the one that fits best.
Decision decide(const camera::CameraModel& camera, std::span<const Sight> sights,
                const BodyPoseOptions& options) {
  int ways = 1;
  for (const Sight& sight : sights) ways *= sight.reading_count;
  Decision decision;
  double second_cost = 1e30;
  for (int way = 0; way < ways; ++way) {
    Choice choice;
    int rest = way;
    for (const Sight& sight : sights) {
      choice.add(sight, rest % sight.reading_count);
      rest /= sight.reading_count;
    }
    const Fit fitted = fit(camera, choice);
    const bool is_alike =
        decision.choice.count > 0 && !are_unlike(fitted.camera_from_body, decision.fitted.camera_from_body);
    if (fitted.cost < decision.fitted.cost) {
      if (!is_alike) second_cost = std::min(second_cost, decision.fitted.cost);
      decision.choice = choice;
      decision.fitted = fitted;
    } else if (!is_alike) {
      second_cost = std::min(second_cost, fitted.cost);
    }
  }
  decision.is_clear = second_cost - decision.fitted.cost > options.clear_difference;
  return decision;
}

}  // namespace

int BodyObservation::used_count() const { return std::popcount(used); }

std::vector<Body> declared_bodies(const tools::ToolSet& tools) {
  std::vector<Body> bodies;
  std::size_t first = 0;
  const auto add = [&](const auto& of) {
    bodies.push_back({of.marker_id, first, tools::markers_of(of)});
    first += bodies.back().markers.size();
  };
  for (const tools::WorldMarker& world : tools.world_markers) add(world);
  for (const tools::Tool& tool : tools.tools) add(tool);
  return bodies;
}

BodyObservation observe_body(const Body& body, std::span<const MarkerObservation> observations,
                             const camera::CameraModel& camera, const BodyPoseOptions& options) {
  BodyObservation observation;
  observation.id = body.id;
  std::array<Sight, kMost> sights;
  int count = 0, tracked_sights = 0, last_tracked = -1;
  // Those that stand by themselves come first, so that they can be had without the others.
  for (const MarkerState wanted : {MarkerState::Tracked, MarkerState::Ambiguous}) {
    for (int i = 0; i < static_cast<int>(observations.size()); ++i) {
      const MarkerObservation& seen = observations[static_cast<std::size_t>(i)];
      if (!seen.is_tracked() && nearness(seen.state) > nearness(observation.state))
        observation.state = seen.state;
      if (seen.state != wanted) continue;
      if (seen.is_tracked()) last_tracked = i;
      if (observations.size() == 1 || count - tracked_sights == kMostAmbiguous) continue;
      Sight& sight = sights[static_cast<std::size_t>(count)];
      sight = Sight();
      sight.marker = &body.markers[static_cast<std::size_t>(i)];
      sight.place = i;
      if (!read(camera, seen, sight)) continue;
      ++count;
      tracked_sights += seen.is_tracked() ? 1 : 0;
    }
  }
  const auto take_last = [&] {
    if (last_tracked >= 0)
      take_one(body, last_tracked, observations[static_cast<std::size_t>(last_tracked)], observation);
    return observation;
  };
  if (count < 2) return take_last();
  Decision decision = decide(camera, {sights.data(), static_cast<std::size_t>(count)}, options);
  if (!decision.is_clear && count > tracked_sights) {  // the ambiguous ones stay so
    count = tracked_sights;
    if (count < 2) return take_last();
    decision = decide(camera, {sights.data(), static_cast<std::size_t>(count)}, options);
  }
  if (decision.fitted.cost <= most_cost(decision.choice, options))
    take(decision.choice, decision.fitted, observation);
  else
    take_without_odd_one(camera, decision.choice, options, observation);
  return observation;
}

}  // namespace arthronaut::markers
