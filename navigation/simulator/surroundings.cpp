#include "navigation/simulator/surroundings.h"

#include <algorithm>
#include <cmath>

#include "navigation/simulator/random.h"

namespace arthronaut::simulator {
namespace {

using Eigen::Vector3d;
using geometry::kPi;

constexpr int kFronds = 14, kFoldFronds = 5, kMotes = 30;
// Fronds grow in a ring about the place of work, and not where the world marker stands.
constexpr double kGrownFrom_mm = 7, kGrownTo_mm = 15, kFreeOfMarker_mm = 7;
constexpr double kBox_mm = 22;  // edge of what the motes drift through
constexpr double kFade_mm = 2;  // within that of its faces they grow and vanish
constexpr double kAsShownFrom_mm = 0.02;

const Skin kSynovium{{0.14f, 0.15f, 0.42f}, 0.5f, 5};
const Skin kFat{{0.13f, 0.36f, 0.55f}, 0.4f, 4};
const Skin kDebris{{0.5f, 0.55f, 0.58f}, 0.1f, 3};

// A unit vector across `axis`, turned by so much about it.
Vector3d across(const Vector3d& axis, double turn_rad) {
  return Eigen::AngleAxisd(turn_rad, axis) * axis.unitOrthogonal();
}

double turn_at(double time_s, double period_s, double phase) { return 2 * kPi * time_s / period_s + phase; }

}  // namespace

std::vector<std::string_view> words_of(const SurroundingsOptions& options) {
  std::vector<std::string_view> words;
  if (options.soft_tissue) words.emplace_back("soft tissue");
  if (options.motes) words.emplace_back("motes");
  if (options.other_hand) words.emplace_back("other hand");
  return words;
}

Surroundings::Surroundings(const SurroundingsOptions& options, const geometry::Surface& bone,
                           const SurroundedPlace& place, std::uint64_t seed) {
  // Each draws of its own: with one more option the others stay as they are.
  if (options.soft_tissue) grow(bone, place, seed * 193 + 7);
  if (options.motes) strew(place, seed * 193 + 11);
  if (options.other_hand) bring_shaver(bone, place, seed * 193 + 13);
}

void Surroundings::grow(const geometry::Surface& bone, const SurroundedPlace& place, std::uint64_t seed) {
  Random random(seed);
  const Vector3d forward = place.bone_from_camera.rotate(Vector3d::UnitZ());
  const auto sway = [&] { return 0.2 + 0.25 * random.between(0, 1); };
  for (int attempt = 0; attempt < 20 * kFronds && std::ssize(fronds_) < kFronds; ++attempt) {
    const Vector3d near = place.worked_at_mm + random.between(kGrownFrom_mm, kGrownTo_mm) *
                                                   across(forward, random.between(0, 2 * kPi));
    const geometry::SurfacePoint root = bone.closest_point(near);
    if ((root.point_mm - place.worked_at_mm).norm() < kGrownFrom_mm) continue;
    if ((root.point_mm - place.kept_free_mm).norm() < kFreeOfMarker_mm) continue;
    // Flat on the bone they would be a stain; straight up, a brush.
    const Vector3d leaning =
        (root.normal + 0.7 * across(root.normal, random.between(0, 2 * kPi))).normalized();
    fronds_.push_back({.root_mm = root.point_mm,
                       .direction = leaning,
                       .sway = sway() * across(leaning, random.between(0, 2 * kPi)),
                       .length_mm = random.between(2.5, 5.5),
                       .radius_mm = random.between(0.5, 1.0),
                       .period_s = random.between(1.6, 3.5),
                       .phase = random.between(0, 2 * kPi),
                       .skin = random.between(0, 1) < 0.7 ? kSynovium : kFat});
  }
  // The fold hangs into the view from one side, a little way before the lens.
  const Vector3d side = across(forward, random.between(0, 2 * kPi)), along = forward.cross(side);
  for (int i = 0; i < kFoldFronds; ++i) {
    const double place_mm = 2.2 * (i - 0.5 * (kFoldFronds - 1)), ahead_mm = random.between(8, 10);
    fronds_.push_back(
        {.root_mm = place.bone_from_camera.translation_mm + ahead_mm * forward + 10 * side + place_mm * along,
         .direction = -side,
         .sway = sway() * forward,
         .length_mm = random.between(2.5, 4.5),
         .radius_mm = random.between(1.2, 1.7),
         .period_s = random.between(2.5, 4.5),
         .phase = 0.6 * i,
         .skin = kFat});
  }
}

void Surroundings::strew(const SurroundedPlace& place, std::uint64_t seed) {
  Random random(seed);
  const auto any = [&] {
    return Vector3d(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
  };
  box_middle_mm_ =
      place.bone_from_camera.translation_mm + 14 * place.bone_from_camera.rotate(Vector3d::UnitZ());
  const Vector3d flow_mm_s = 1.5 * any();
  for (int i = 0; i < kMotes; ++i)
    motes_.push_back({.start_mm = 0.5 * kBox_mm * (any() + Vector3d::Ones()),
                      .speed_mm_s = flow_mm_s + 0.6 * any(),
                      .radius_mm = random.between(0.05, 0.18)});
}

void Surroundings::bring_shaver(const geometry::Surface& bone, const SurroundedPlace& place,
                                std::uint64_t seed) {
  Random random(seed);
  const Vector3d forward = place.bone_from_camera.rotate(Vector3d::UnitZ());
  const Vector3d& eye = place.bone_from_camera.translation_mm;
  // On the other side of the entry than the marker.
  const Vector3d from_marker = place.worked_at_mm - place.kept_free_mm;
  const Vector3d aside = from_marker - from_marker.dot(forward) * forward;
  const Vector3d side = aside.norm() > 0.1 ? Vector3d(aside.normalized()) : across(forward, 0);
  const geometry::SurfacePoint under = bone.closest_point(place.worked_at_mm + 8 * side);
  shavers_.push_back({.portal_mm = eye - 5 * forward + 24 * side + 6 * forward.cross(side),
                      .tip_mm = under.point_mm + 4 * (eye - under.point_mm).normalized(),
                      .side = side,
                      .up = forward.cross(side),
                      .phase = random.between(0, 2 * kPi)});
}

void Surroundings::add(double time_s, const geometry::RigidTransform& camera_from_bone,
                       Solids& solids) const {
  const auto add_rod = [&](const Vector3d& from_mm, const Vector3d& to_mm, double radius_mm,
                           const Skin& skin) {
    solids.push_back(make_rod(camera_from_bone * from_mm, camera_from_bone * to_mm, radius_mm, skin));
  };
  for (const Frond& frond : fronds_) {
    // Three joints, each thinner and later in its sway than the one before.
    Vector3d from_mm = frond.root_mm;
    for (int joint = 0; joint < 3; ++joint) {
      const double swayed = std::sin(turn_at(time_s, frond.period_s, frond.phase - 0.7 * joint));
      const Vector3d direction = (frond.direction + (1 + joint) * swayed * frond.sway).normalized();
      const Vector3d to_mm = from_mm + frond.length_mm / 3 * direction;
      add_rod(from_mm, to_mm, (1 - 0.25 * joint) * frond.radius_mm, frond.skin);
      from_mm = to_mm;
    }
  }
  for (const Mote& mote : motes_) {
    const Vector3d drifted_mm = mote.start_mm + time_s * mote.speed_mm_s;
    Vector3d in_box_mm;
    double shown = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const double at = drifted_mm[axis] - kBox_mm * std::floor(drifted_mm[axis] / kBox_mm);
      shown = std::min({shown, at / kFade_mm, (kBox_mm - at) / kFade_mm});
      in_box_mm[axis] = at - 0.5 * kBox_mm;
    }
    const double radius_mm = shown * mote.radius_mm;
    if (radius_mm < kAsShownFrom_mm) continue;
    const Vector3d at_mm = box_middle_mm_ + in_box_mm;
    add_rod(at_mm, at_mm + 1.5 * radius_mm * mote.speed_mm_s.normalized(), radius_mm, kDebris);
  }
  for (const Shaver& shaver : shavers_) {
    const Vector3d tip_mm = shaver.tip_mm + 2.2 * std::sin(turn_at(time_s, 4.3, shaver.phase)) * shaver.side +
                            1.8 * std::sin(turn_at(time_s, 2.9, 2 * shaver.phase)) * shaver.up;
    const Vector3d back = (shaver.portal_mm - tip_mm).normalized();
    constexpr double kWindow_mm = 3.5;
    add_rod(tip_mm, tip_mm + kWindow_mm * back, 1.6, {{0.03f, 0.03f, 0.03f}, 0.6f, 4});
    add_rod(tip_mm + kWindow_mm * back, shaver.portal_mm, 1.9, steel());
  }
}

}  // namespace arthronaut::simulator
