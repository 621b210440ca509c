#include "tests/planning/postop/postop_ct.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace arthronaut::test {

namespace {

using Eigen::Vector3d;

// Along the axis and off it; off the screw's axis.
struct Place {
  double along_mm, off_mm, off_screw_mm;
};

Place place_of(const Drilled& drilled, const Vector3d& p) {
  const Vector3d from_entry = p - drilled.tunnel.entry_mm, d = drilled.tunnel.direction;
  const double along = from_entry.dot(d);
  const Vector3d off = from_entry - along * d;
  return {along, off.norm(), (off - drilled.screw_aside_mm * d.unitOrthogonal()).norm()};
}

void drill(images::Volume& volume, const Drilled& drilled, const geometry::RigidTransform& postop_from_plan,
           double soft_hu) {
  constexpr int kSub = 3;
  const geometry::RigidTransform plan_from_postop = postop_from_plan.inverse();
  const Eigen::Affine3d plan_from_index = Eigen::Translation3d(plan_from_postop.translation_mm) *
                                          plan_from_postop.rotation * volume.lps_from_index;
  const double reach = 0.5 * drilled.tunnel.diameter_mm + drilled.widened_mm + drilled.rim_mm + 2;
  std::size_t v = 0;
  for (int k = 0; k < volume.size.z(); ++k) {
    for (int j = 0; j < volume.size.y(); ++j) {
      for (int i = 0; i < volume.size.x(); ++i, ++v) {
        const auto place_at = [&](const Vector3d& index) {
          return place_of(drilled, plan_from_index * index);
        };
        const Vector3d from_entry = plan_from_index * Vector3d(i, j, k) - drilled.tunnel.entry_mm;
        const double along_mm = from_entry.dot(drilled.tunnel.direction);
        if (along_mm < drilled.from_mm - 1 || along_mm > drilled.to_mm + 1 ||
            from_entry.squaredNorm() - along_mm * along_mm > reach * reach)
          continue;
        const float before = volume.values[v];
        double sum = 0;
        for (int s = 0; s < kSub * kSub * kSub; ++s) {
          const auto part = [](int n) { return (n + 0.5) / kSub - 0.5; };
          const Place at =
              place_at(Vector3d(i + part(s % kSub), j + part(s / kSub % kSub), k + part(s / kSub / kSub)));
          const double fading = std::clamp(1 - at.along_mm / drilled.widened_to_mm, 0.0, 1.0),
                       widened = drilled.tunnel.diameter_mm + drilled.widened_mm * fading,
                       radius = 0.5 * (at.along_mm > drilled.narrow_from_mm ? drilled.narrow_mm : widened);
          const bool is_along = at.along_mm > drilled.from_mm && at.along_mm < drilled.to_mm;
          if (drilled.screw_diameter_mm > 0 && at.off_screw_mm < 0.5 * drilled.screw_diameter_mm &&
              at.along_mm > drilled.screw_from_mm && at.along_mm < drilled.screw_to_mm) {
            sum += drilled.screw_hu;
          } else if (at.off_mm < 0.5 * drilled.plug_diameter_mm && at.along_mm > drilled.plug_from_mm &&
                     at.along_mm < drilled.plug_to_mm) {
            sum += drilled.plug_hu;
          } else if (is_along && at.off_mm < radius) {
            // In the open it is what was there before.
            sum += before > soft_hu + 5 ? drilled.content_hu : std::min<double>(before, drilled.content_hu);
          } else if (is_along && drilled.rim_hu > 0 && at.off_mm < radius + drilled.rim_mm &&
                     before > soft_hu + 5) {
            sum += std::max<double>(before, drilled.rim_hu);
          } else {
            sum += before;
          }
        }
        volume.values[v] = static_cast<float>(sum / (kSub * kSub * kSub));
      }
    }
  }
}

}  // namespace

KnownCtOptions half_fine() {
  KnownCtOptions options;
  options.spacing_mm = {0.6, 0.6, 0.8};
  return options;
}

images::Volume postop_ct(const std::vector<geometry::TriangleMesh>& bones_in_plan,
                         const std::vector<Drilled>& drilled,
                         const geometry::RigidTransform& postop_from_plan, KnownCtOptions options) {
  auto bones = bones_in_plan;
  for (auto& bone : bones)
    for (auto& p : bone.vertices_mm) p = postop_from_plan * p;
  const auto before = options.operate;
  options.operate = [&](images::Volume& volume) {
    if (before) before(volume);
    for (const Drilled& one : drilled) drill(volume, one, postop_from_plan, options.soft_tissue_hu);
  };
  return known_ct(bones, options);
}

std::function<void(images::Volume&)> uneven_marrow(double marrow_hu, double sigma_hu, double grain_mm,
                                                   std::uint64_t seed) {
  return [=](images::Volume& volume) {
    constexpr std::size_t kWaves = 48;
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal(0, M_SQRT1_2 / grain_mm);
    std::uniform_real_distribution<double> turn(0, 2 * M_PI);
    std::array<std::pair<Vector3d, double>, kWaves> waves;
    for (auto& [wave, phase] : waves) {
      wave = {normal(random), normal(random), normal(random)};
      phase = turn(random);
    }
    std::size_t v = 0;
    for (int k = 0; k < volume.size.z(); ++k) {
      for (int j = 0; j < volume.size.y(); ++j) {
        for (int i = 0; i < volume.size.x(); ++i, ++v) {
          if (std::abs(volume.values[v] - marrow_hu) > 1) continue;
          const Vector3d p = volume.lps_from_index * Vector3d(i, j, k);
          double sum = 0;
          for (const auto& [wave, phase] : waves) sum += std::cos(wave.dot(p) + phase);
          volume.values[v] += static_cast<float>(sigma_hu * std::sqrt(2.0 / kWaves) * sum);
        }
      }
    }
  };
}

geometry::RigidTransform lying(double turn_deg, const Vector3d& axis, const Vector3d& shift_mm) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(geometry::rad_from_deg(turn_deg), axis.normalized())),
          shift_mm};
}

tunnels::Tunnel moved_tunnel(const tunnels::Tunnel& plan, const geometry::Surface& bone,
                             const Eigen::Vector2d& shift_mm, const Eigen::Vector2d& tilt_deg) {
  const Vector3d u = plan.direction.unitOrthogonal(), v = plan.direction.cross(u);
  tunnels::Tunnel moved = plan;
  moved.direction = (plan.direction + std::tan(geometry::rad_from_deg(tilt_deg.x())) * u +
                     std::tan(geometry::rad_from_deg(tilt_deg.y())) * v)
                        .normalized();
  const Vector3d through = plan.entry_mm + shift_mm.x() * u + shift_mm.y() * v;
  double nearest = 1e9;
  for (const auto& hit : bone.all_hits(through - 20 * moved.direction, moved.direction)) {
    if (hit.normal.dot(moved.direction) >= 0 || std::abs(hit.distance_mm - 20) >= nearest) continue;
    nearest = std::abs(hit.distance_mm - 20);
    moved.entry_mm = hit.point_mm;
  }
  return moved;
}

}  // namespace arthronaut::test
