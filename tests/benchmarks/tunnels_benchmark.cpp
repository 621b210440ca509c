// What happens on every move of a drag: the tunnel measured anew and every check of it and of the whole knee,
// or a landmark's bone looked at anew, on a femur of 200,000 triangles.
#include <benchmark/benchmark.h>

#include "planning/geometry/surface_patch.h"
#include "planning/norms/footprint.h"
#include "planning/norms/insertion_norms.h"
#include "planning/phantom/phantom_knee.h"
#include "planning/plan_review/plan_review.h"
#include "planning/tunnels/entry_map.h"
#include "planning/tunnels/isometry_map.h"
#include "planning/tunnels/knee_checks.h"

namespace arthronaut {
namespace {

struct KneeAtHand {
  phantom::PhantomKnee knee;
  std::shared_ptr<const geometry::Surface> femur, tibia;
  tunnels::PlanSurroundings of_femur;
  tunnels::KneeSurroundings of_knee;
  tunnels::TunnelGeometry tibial;
};

const KneeAtHand& knee() {
  static const KneeAtHand at_hand = [] {
    KneeAtHand made{phantom::make_phantom_knee({.edge_length_mm = 0.54}), {}, {}, {}, {}, {}};
    made.femur = std::make_shared<geometry::Surface>(made.knee.femur.mesh);
    made.tibia = std::make_shared<geometry::Surface>(made.knee.tibia.mesh);
    made.of_femur = tunnels::surroundings_of(made.knee.femur.mesh, bones::BoneKind::Femur,
                                             made.knee.femur_landmarks, made.knee.side, made.femur);
    tunnels::put_femur(made.of_knee, made.knee.femur.mesh, made.of_femur);
    made.tibial = tunnels::measure(made.knee.tibial_tunnel, *made.tibia);
    return made;
  }();
  return at_hand;
}

// The entry wanders about the planned one, since no two places of a drag are alike.
tunnels::Tunnel dragged(std::size_t step) {
  tunnels::Tunnel tunnel = knee().knee.femoral_tunnel;
  const double angle = 0.7 * static_cast<double>(step), off_mm = 0.25 * static_cast<double>(step % 20);
  tunnel.entry_mm =
      knee()
          .femur
          ->closest_point(tunnel.entry_mm + off_mm * Eigen::Vector3d(0, std::cos(angle), std::sin(angle)))
          .point_mm;
  return tunnel;
}

void all_checks_of_one_drag(benchmark::State& state) {
  (void)knee();
  std::size_t step = 0, checks = 0;
  for (auto _ : state) {
    const tunnels::Tunnel tunnel = dragged(step++);
    const auto measured = tunnels::measure(tunnel, *knee().femur);
    const auto of_bone = tunnels::check_plan(tunnel, measured, knee().of_femur);
    const tunnels::KneePlan plan{&tunnel, &measured, &knee().knee.tibial_tunnel, &knee().tibial};
    const auto of_femur = tunnels::check_knee(bones::BoneKind::Femur, plan, knee().of_knee);
    const auto of_tibia = tunnels::check_knee(bones::BoneKind::Tibia, plan, knee().of_knee);
    checks = of_bone.size() + of_femur.size() + of_tibia.size();
  }
  state.counters["triangles"] = static_cast<double>(knee().femur->mesh().triangles.size());
  state.counters["checks"] = static_cast<double>(checks);
}
BENCHMARK(all_checks_of_one_drag)->Unit(benchmark::kMillisecond);

void measure_alone(benchmark::State& state) {
  (void)knee();
  std::size_t step = 0;
  for (auto _ : state) benchmark::DoNotOptimize(tunnels::measure(dragged(step++), *knee().femur).wall_mm);
}
BENCHMARK(measure_alone)->Unit(benchmark::kMillisecond);

// What every move of a landmark's drag costs beside the checks: the bone's axes, grid and footprints anew.
void a_landmark_dragged(benchmark::State& state) {
  const phantom::PhantomKnee& made = knee().knee;
  for (auto _ : state)
    benchmark::DoNotOptimize(plan_review::review_bone(made.femur.mesh, bones::BoneKind::Femur, made.side,
                                                      made.femur_landmarks, knee().femur)
                                 .footprints.size());
}
BENCHMARK(a_landmark_dragged)->Unit(benchmark::kMillisecond);

// Of that: what the outline of the expected footprint encloses of the surface.
void patch_within_the_footprint(benchmark::State& state) {
  const phantom::PhantomKnee& made = knee().knee;
  const auto footprint = norms::expected_footprint(
      made.femur.mesh, *knee().femur, bones::BoneKind::Femur, made.side, made.femur_landmarks,
      norms::default_norm(bones::BoneKind::Femur, norms::Bundle::Whole));
  double area_mm2 = 0;
  for (auto _ : state) area_mm2 = geometry::patch_within(*knee().femur, footprint->outline_mm).area_mm2;
  state.counters["mm2"] = area_mm2;
}
BENCHMARK(patch_within_the_footprint)->Unit(benchmark::kMillisecond);

// Beside the screen: the wall of the notch once a bone and its landmarks, the map on it once a tibial entry.
void lateral_wall_of_the_notch(benchmark::State& state) {
  std::size_t triangles = 0;
  for (auto _ : state)
    triangles =
        tunnels::lateral_wall(*knee().femur, *knee().of_femur.axes, knee().of_femur.extents).triangles.size();
  state.counters["triangles"] = static_cast<double>(triangles);
}
BENCHMARK(lateral_wall_of_the_notch)->Unit(benchmark::kMillisecond);

void isometry_map_on_the_wall(benchmark::State& state) {
  const auto wall = tunnels::lateral_wall(*knee().femur, *knee().of_femur.axes, knee().of_femur.extents);
  std::size_t bands = 0;
  for (auto _ : state)
    bands = tunnels::isometry_map(wall, knee().tibial.entry_on_surface_mm, *knee().of_knee.axis).bands.size();
  state.counters["bands"] = static_cast<double>(bands);
}
BENCHMARK(isometry_map_on_the_wall)->Unit(benchmark::kMillisecond);

// Once a bone.
void prepare_a_bone(benchmark::State& state) {
  for (auto _ : state)
    benchmark::DoNotOptimize(geometry::Surface(knee().knee.femur.mesh).mesh().triangles.size());
}
BENCHMARK(prepare_a_bone)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace arthronaut
