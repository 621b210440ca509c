#include "navigation/markers/smear_search.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace arthronaut::markers {
namespace {

using geometry::RigidTransform;

constexpr int kMinSmearedPoints = 24;
constexpr double kMinSmearedRange = 8;  // grey levels, of the scatter about their mean
constexpr double kDark = 0.05;          // light of what is dark, of what is bright
// A pixel of the small picture is the mean of a square of its size: sigma of that, in its sizes.
constexpr double kPixelSigma = 0.29;

constexpr double kMomentCells = 0.25;  // moments of the exposure are no nearer to each other
constexpr double kPlaceStep = 0.35;    // of places that are looked at, in cells
// Steps of the search about the best place: of the motion in cells, of the distance in shares of it.
constexpr double kFineStep = 0.25, kFineDistance = 0.03, kFineTurnRad = 0.05;

// To where it is seen so many pixels elsewhere: the camera turned about itself.
bool shift(const camera::CameraModel& camera, const Eigen::Vector2i& by_px, RigidTransform& pose) {
  const auto from = camera.project(pose.translation_mm);
  const auto ray = from ? camera.ray(*from + by_px.cast<double>()) : std::nullopt;
  if (!ray) return false;
  const auto turn = Eigen::Quaterniond::FromTwoVectors(pose.translation_mm, *ray);
  pose = RigidTransform{turn, Eigen::Vector3d::Zero()} * pose;
  return true;
}

}  // namespace

const SmearSearch::Ray& SmearSearch::ray_of(const SquareSearch::SmallPicture& picture,
                                            const camera::CameraModel& camera, const Point& point) {
  Ray& kept = rays_[static_cast<std::size_t>(point.y & (kRaysAcross - 1)) * kRaysAcross +
                    static_cast<std::size_t>(point.x & (kRaysAcross - 1))];
  if (kept.x == point.x && kept.y == point.y) return kept;
  const double middle = 0.5 * (picture.times - 1);
  const auto ray = camera.ray(
      {picture.left + middle + picture.times * point.x, picture.top + middle + picture.times * point.y});
  kept = {point.x, point.y, ray.has_value(),
          ray ? Eigen::Vector3f(ray->cast<float>()) : Eigen::Vector3f::Zero()};
  return kept;
}

bool SmearSearch::place_points(const SquareSearch::SmallPicture& picture, const camera::CameraModel& camera,
                               const MarkerCode& code, double size_mm, const SmearedLook& look,
                               const ExposedPose& motion, ExposedCode& exposed) {
  points_.clear();
  const RigidTransform& pose = motion.camera_from_marker;
  if (!(pose.translation_mm.z() > 0)) return false;
  const int cells = code.cells;
  const double cell_mm = size_mm / cells, known_mm = 0.5 * size_mm + cell_mm;
  const double px_per_mm = camera.central_focal_px() / pose.translation_mm.z();
  const double sigma_cells = std::hypot(look.sigma_px, kPixelSigma * picture.times) / (px_per_mm * cell_mm);
  const double moved_cells =
      (motion.velocity.head<3>().norm() + 0.5 * size_mm * motion.velocity.tail<3>().norm()) / cell_mm;
  exposed.move(motion, static_cast<int>(std::ceil(moved_cells / std::max(kMomentCells, 1.6 * sigma_cells))));
  LookedAt at;
  SeenLevels seen;
  int lanes = 0;
  const auto take = [&] {
    const std::size_t first = points_.size() - static_cast<std::size_t>(lanes);
    for (int k = lanes; k < kPixelsTogether; ++k) {
      at.ray_x[k] = at.ray_x[0], at.ray_y[k] = at.ray_y[0], at.ray_z[k] = at.ray_z[0];
      at.sigma_x[k] = at.sigma_x[0], at.sigma_y[k] = at.sigma_y[0];
    }
    exposed.look_at_level(at, seen);
    for (int k = 0; k < lanes; ++k) {
      const double light = kDark + (1 - kDark) * std::clamp<double>(seen.level[k], 0, 1);
      points_[first + static_cast<std::size_t>(k)].level =
          static_cast<float>(std::pow(light, 1 / look.gamma));
    }
    lanes = 0;
  };
  for (int row = -1; row <= cells; ++row) {
    for (int column = -1; column <= cells; ++column) {
      const Eigen::Vector3d place((column + 0.5) * cell_mm - 0.5 * size_mm,
                                  0.5 * size_mm - (row + 0.5) * cell_mm, 0);
      // What lies beyond the margin is not known.
      const Eigen::Vector3d moved = motion.velocity.head<3>() + motion.velocity.tail<3>().cross(place);
      if ((place.cwiseAbs() + 0.5 * moved.cwiseAbs()).head<2>().maxCoeff() > known_mm) continue;
      const auto pixel = camera.project(pose * place);
      if (!pixel || !camera.is_inside_view(*pixel)) continue;
      const double middle = 0.5 * (picture.times - 1);
      const Eigen::Vector2d small((pixel->x() - picture.left - middle) / picture.times,
                                  (pixel->y() - picture.top - middle) / picture.times);
      Point point;
      point.x = static_cast<int>(std::lround(small.x()));
      point.y = static_cast<int>(std::lround(small.y()));
      const Ray& ray = ray_of(picture, camera, point);
      if (!ray.is_known) continue;
      at.ray_x[lanes] = ray.along.x();
      at.ray_y[lanes] = ray.along.y();
      at.ray_z[lanes] = ray.along.z();
      at.sigma_x[lanes] = at.sigma_y[lanes] = static_cast<float>(sigma_cells);
      points_.push_back(point);
      if (++lanes == kPixelsTogether) take();
    }
  }
  if (lanes > 0) take();
  return static_cast<int>(points_.size()) >= kMinSmearedPoints;
}

double SmearSearch::score_at(const SquareSearch::SmallPicture& picture, int dx, int dy) const {
  float count = 0, sum = 0, squares = 0, level = 0, level_squares = 0, both = 0;
  for (const Point& point : points_) {
    const int x = point.x + dx, y = point.y + dy;
    if (x < 0 || y < 0 || x >= picture.view.width || y >= picture.view.height) continue;
    const int seen = picture.view.row(y)[x];
    if (seen >= SquareSearch::kWhite) continue;
    const auto grey = static_cast<float>(seen);
    count += 1;
    sum += grey;
    squares += grey * grey;
    level += point.level;
    level_squares += point.level * point.level;
    both += grey * point.level;
  }
  if (count < kMinSmearedPoints) return -1;
  const float spread = squares - sum * sum / count, level_spread = level_squares - level * level / count;
  if (!(spread > count * kMinSmearedRange * kMinSmearedRange) || !(level_spread > 0.001F * count)) return -1;
  return (both - sum * level / count) / std::sqrt(spread * level_spread);
}

SmearedPlace SmearSearch::find(const SquareSearch::SmallPicture& picture, const camera::CameraModel& camera,
                               const MarkerCode& code, double size_mm, const SmearedLook& look,
                               std::span<const ExposedPose> motions, double reach_px) {
  SmearedPlace best;
  if (picture.view.width <= 0) return best;
  std::fill(rays_.begin(), rays_.end(), Ray());  // of another lens angle, or another part of the frame
  ExposedCode exposed(code, size_mm);
  Eigen::Vector2i best_shift(0, 0);
  const auto take = [&](const ExposedPose& motion, int reach, int step) {
    if (!place_points(picture, camera, code, size_mm, look, motion, exposed)) return;
    for (int dy = -reach; dy <= reach; dy += step) {
      for (int dx = -reach; dx <= reach; dx += step) {
        const double score = score_at(picture, dx, dy);
        if (score <= best.score) continue;
        best = {motion, score};
        best_shift = {dx, dy};
      }
    }
  };
  const double cell_px = motions.empty() ? 0
                                         : camera.central_focal_px() * size_mm / code.cells /
                                               motions.front().camera_from_marker.translation_mm.z();
  const int step = std::max(1, static_cast<int>(std::lround(kPlaceStep * cell_px / picture.times)));
  const int reach = static_cast<int>(std::ceil(reach_px / picture.times));
  for (const ExposedPose& motion : motions) take(motion, reach / step * step, step);
  if (best.score < 0 || !shift(camera, picture.times * best_shift, best.exposed.camera_from_marker))
    return SmearedPlace();
  // Finer, about the best: in its motion, and as it is nearer or farther and turned.
  const ExposedPose coarse = best.exposed;
  const double step_mm = kFineStep * size_mm / code.cells;
  best_shift.setZero();
  for (int k = 0; k < 81; ++k) {
    const int x = k % 3 - 1, y = k / 3 % 3 - 1, turned = k / 9 % 3 - 1, farther = k / 27 - 1;
    ExposedPose motion = coarse;
    motion.velocity[0] += x * step_mm;
    motion.velocity[1] += y * step_mm;
    RigidTransform& pose = motion.camera_from_marker;
    pose.translation_mm *= 1 + kFineDistance * farther;
    pose.rotation = pose.rotation *
                    Eigen::Quaterniond(Eigen::AngleAxisd(kFineTurnRad * turned, Eigen::Vector3d::UnitZ()));
    take(motion, std::max(1, step / 2), 1);
  }
  return shift(camera, picture.times * best_shift, best.exposed.camera_from_marker) ? best : SmearedPlace();
}

}  // namespace arthronaut::markers
