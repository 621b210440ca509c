#include "navigation/experiments/registration_trial.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>

#include "planning/geometry/error.h"

namespace arthronaut::experiments {

namespace {

using geometry::kPi;

// The same numbers on every machine, which the library's distributions don't promise.
class Random {
 public:
  explicit Random(std::uint64_t seed) : bits_(seed * 0x9e3779b97f4a7c15ULL + 1) {}
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(bits_() >> 11) * 0x1p-53;
  }
  double normal() { return std::sqrt(-2 * std::log(uniform(1e-12, 1))) * std::cos(uniform(0, 2 * kPi)); }
  std::size_t index(std::size_t count) { return bits_() % count; }
  Eigen::Vector3d direction() { return Eigen::Vector3d(normal(), normal(), normal()).normalized(); }

 private:
  std::mt19937_64 bits_;
};

// A few waves of 12 to 40 mm with random phases; root mean square 1.
class SlowNoise {
 public:
  explicit SlowNoise(Random& random) {
    for (Wave& wave : waves_) {
      wave.per_mm = 2 * kPi / random.uniform(12, 40);
      for (int axis = 0; axis < 3; ++axis) wave.phase[axis] = random.uniform(0, 2 * kPi);
    }
  }
  [[nodiscard]] Eigen::Vector3d at(double path_mm) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Wave& wave : waves_) sum += (path_mm * wave.per_mm + wave.phase.array()).sin().matrix();
    return sum * std::sqrt(2.0 / static_cast<double>(waves_.size()));
  }

 private:
  struct Wave {
    double per_mm = 0;
    Eigen::Vector3d phase = Eigen::Vector3d::Zero();
  };
  std::array<Wave, 4> waves_;
};

// Heights above the bone by sample: bursts of the given length range until their share is reached.
void add_bursts(std::vector<double>& heights_mm, double share, std::array<std::size_t, 2> burst,
                std::array<double, 2> range_mm, Random& random) {
  auto left = static_cast<std::ptrdiff_t>(share * static_cast<double>(heights_mm.size()) + 0.5);
  for (int attempt = 0; left > 0 && attempt < 1000; ++attempt) {
    const std::size_t length = burst[0] + random.index(burst[1] - burst[0] + 1);
    const std::size_t first = random.index(heights_mm.size());
    const double height_mm = random.uniform(range_mm[0], range_mm[1]);
    for (std::size_t i = first; i < std::min(first + length, heights_mm.size()) && left > 0; ++i) {
      if (heights_mm[i] > 0) continue;
      heights_mm[i] = height_mm;
      --left;
    }
  }
}

// A walk over the surface that wanders, and turns back where the area ends.
std::vector<geometry::SurfacePoint> walk(const geometry::Surface& surface, const Eigen::Vector3d& center_mm,
                                         const TrialSetting& setting, Random& random) {
  geometry::SurfacePoint here;
  do {
    here = surface.closest_point(center_mm + random.uniform(0, setting.area_radius_mm) * random.direction());
  } while ((here.point_mm - center_mm).norm() > 0.9 * setting.area_radius_mm);
  const auto count = static_cast<std::size_t>(setting.length_of_each_mm / setting.step_mm) + 1;
  std::vector<geometry::SurfacePoint> path;
  Eigen::Vector3d heading = random.direction();
  while (path.size() < count) {
    path.push_back(here);
    heading += 0.18 * random.normal() * here.normal.cross(heading);
    const Eigen::Vector3d inwards = center_mm - here.point_mm;
    const double excess = inwards.norm() / setting.area_radius_mm - 0.8;
    if (excess > 0) heading += 2.0 * excess * inwards.normalized();
    heading -= heading.dot(here.normal) * here.normal;
    heading.normalize();
    here = surface.closest_point(here.point_mm + setting.step_mm * heading);
  }
  return path;
}

geometry::RigidTransform place_marker(const geometry::TriangleMesh& mesh, const geometry::Surface& surface,
                                      const std::vector<Eigen::Vector3d>& touched_mm, Random& random) {
  constexpr int kTries = 20'000;
  for (int attempt = 0; attempt < kTries; ++attempt) {
    const geometry::SurfacePoint site =
        surface.closest_point(mesh.vertices_mm[random.index(mesh.vertices_mm.size())]);
    double nearest_mm = 1e9;
    for (const Eigen::Vector3d& p : touched_mm) nearest_mm = std::min(nearest_mm, (p - site.point_mm).norm());
    if (nearest_mm < 8 || nearest_mm > 25) continue;
    const Eigen::Quaterniond upright =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), site.normal) *
        Eigen::AngleAxisd(random.uniform(0, 2 * kPi), Eigen::Vector3d::UnitZ());
    const Eigen::Vector3d hinge = site.normal.cross(random.direction()).normalized();
    const double tilt_rad = geometry::rad_from_deg(random.uniform(0, 25));
    geometry::RigidTransform bone_from_marker;
    bone_from_marker.rotation = (Eigen::AngleAxisd(tilt_rad, hinge) * upright).normalized();
    bone_from_marker.translation_mm = site.point_mm + random.uniform(1, 3) * site.normal;
    return bone_from_marker.inverse();
  }
  throw InvalidInput("the bone has no place for a world marker 8 to 25 mm from the digitised area");
}

}  // namespace

std::string_view to_text(TrialNoise noise) {
  switch (noise) {
    case TrialNoise::Dry:
      return "dry";
    case TrialNoise::ExVivo:
      return "ex-vivo";
    case TrialNoise::Hard:
      return "hard";
  }
  return "unknown";
}

TrialNoise trial_noise_from_text(std::string_view text) {
  for (const TrialNoise noise : {TrialNoise::Dry, TrialNoise::ExVivo, TrialNoise::Hard}) {
    if (text == to_text(noise)) return noise;
  }
  throw InvalidInput("\"" + std::string(text) + "\" is no kind of noise: dry, ex-vivo or hard");
}

TrialSetting setting_of(TrialNoise noise) {
  TrialSetting setting;
  if (noise == TrialNoise::ExVivo) {
    setting.white_mm = 0.2;
    setting.slow_mm = 0.25;
    setting.lifted_share = 0.10;
    setting.soft_share = 0.15;
  } else if (noise == TrialNoise::Hard) {
    setting.stroke_count = 4;
    setting.length_of_each_mm = 72;
    setting.area_radius_mm = 12;
    setting.white_mm = 0.25;
    setting.slow_mm = 0.3;
    setting.lifted_share = 0.25;
    setting.soft_share = 0.20;
  }
  return setting;
}

Trial make_trial(const geometry::TriangleMesh& mesh, const geometry::Surface& surface,
                 const Eigen::Vector3d& area_center_mm, const TrialSetting& setting, std::uint64_t seed) {
  Random random(seed);
  Trial trial;
  std::vector<Eigen::Vector3d> touched_mm;
  for (int curve = 0; curve < setting.stroke_count; ++curve) {
    const auto path = walk(surface, area_center_mm, setting, random);
    std::vector<double> heights_mm(path.size(), 0.0);
    add_bursts(heights_mm, setting.lifted_share, {8, 18}, {1.0, 6.0}, random);
    add_bursts(heights_mm, setting.soft_share, {15, 40}, {0.3, 1.5}, random);
    const SlowNoise slow(random);
    for (std::size_t i = 0; i < path.size(); ++i) {
      const double path_mm = static_cast<double>(i) * setting.step_mm;
      const Eigen::Vector3d white(random.normal(), random.normal(), random.normal());
      strokes::CurvePoint point;
      point.curve = curve;
      point.time_s =
          (static_cast<double>(curve) * static_cast<double>(path.size() + 60) + static_cast<double>(i)) /
          60.0;
      point.position_mm = path[i].point_mm + heights_mm[i] * path[i].normal + setting.white_mm * white +
                          setting.slow_mm * slow.at(path_mm);
      touched_mm.push_back(path[i].point_mm);
      trial.curves.push_back(point);
    }
  }
  trial.marker_from_bone = place_marker(mesh, surface, touched_mm, random);
  for (strokes::CurvePoint& point : trial.curves)
    point.position_mm = trial.marker_from_bone * point.position_mm;
  return trial;
}

// The notch is where, above the distal end, a place outside the bone has bone to its left, to its right and
// in front.
std::optional<Eigen::Vector3d> find_lateral_notch_wall(const geometry::TriangleMesh& mesh,
                                                       const geometry::Surface& surface, bones::Side side) {
  constexpr double kMaxHalfWidth_mm = 20, kMaxRoof_mm = 25;
  const Eigen::Vector3d right = -Eigen::Vector3d::UnitX();
  const Eigen::Vector3d lateral = side == bones::Side::Right ? right : Eigen::Vector3d(-right);
  const geometry::Bounds bounds = geometry::bounds_of(mesh);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (double z = bounds.min_mm.z() + 8; z <= bounds.min_mm.z() + 20; z += 2) {
    for (double y = bounds.min_mm.y(); y <= bounds.max_mm.y(); y += 2) {
      const Eigen::Vector3d p(bounds.center_mm().x(), y, z);
      if (surface.signed_distance_mm(p) < 2) continue;
      const auto wall = surface.first_hit(p, lateral), other_wall = surface.first_hit(p, -lateral);
      const auto roof = surface.first_hit(p, -Eigen::Vector3d::UnitY());
      if (!wall || !other_wall || !roof || wall->distance_mm > kMaxHalfWidth_mm ||
          other_wall->distance_mm > kMaxHalfWidth_mm || roof->distance_mm > kMaxRoof_mm) {
        continue;
      }
      sum += wall->point_mm;
      ++count;
    }
  }
  if (count < 5) return std::nullopt;
  return surface.closest_point(sum / count).point_mm;
}

}  // namespace arthronaut::experiments
