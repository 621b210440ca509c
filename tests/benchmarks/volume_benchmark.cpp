// What a picture of a volume in 3D costs: made ready from a CT of 512 x 512 x 400 voxels, and drawn in a pane
// as the window has it, while the view turns and when it rests.
#include <benchmark/benchmark.h>

#include <Eigen/Geometry>
#include <cmath>

#include "app/scene/drawn_volume.h"
#include "app/scene/offscreen_context.h"
#include "app/scene/scene_view.h"

namespace arthronaut::scene {
namespace {

// Two bones within soft tissue within air, with noise.
const images::Volume& ct() {
  static const images::Volume made = [] {
    images::Volume v;
    v.modality = images::Modality::Ct;
    v.size = {512, 512, 400};
    v.lps_from_index.linear() = Eigen::Vector3d(0.35, 0.35, 0.5).asDiagonal();
    v.lps_from_index.translation() = Eigen::Vector3d(-90, -90, -100);
    v.values.reserve(512UL * 512 * 400);
    unsigned random = 1;
    for (int k = 0; k < 400; ++k) {
      for (int j = 0; j < 512; ++j) {
        for (int i = 0; i < 512; ++i) {
          const Eigen::Vector3d at = v.lps_from_index * Eigen::Vector3d(i, j, k);
          const double radius = std::hypot(at.x(), at.y()), wave = 22 + 12 * std::exp(-std::abs(at.z()) / 25);
          const bool is_gap = std::abs(at.z()) < 3;
          random = random * 1664525U + 1013904223U;
          const double noise = static_cast<double>(random >> 24) / 5 - 25;
          const double tissue = radius > 70                                 ? -1000
                                : is_gap || radius > wave                   ? 40
                                : radius > wave - 3 || std::abs(at.z()) < 5 ? 1200
                                                                            : 120;
          v.values.push_back(static_cast<float>(tissue + noise));
        }
      }
    }
    return v;
  }();
  return made;
}
const geometry::Bounds kJoint{{-60, -60, -80}, {60, 60, 80}};

void make_it_ready(benchmark::State& state) {
  ct();
  for (auto _ : state) benchmark::DoNotOptimize(drawn_volume(ct(), kJoint));
}
BENCHMARK(make_it_ready)->Unit(benchmark::kMillisecond);

// range(0): preset; range(1): 0 turns, 1 rests. The second has four times the pixels, as the window has it.
void draw_it(benchmark::State& state) {
  const OffscreenContext context;
  SceneView view([&] { context.make_current(); });
  const bool is_still = state.range(1) == 1;
  view.resize(is_still ? 1400 : 700, is_still ? 1000 : 500);
  view.set_still(is_still);
  SceneContent content;
  VolumeItem item{drawn_volume(ct(), kJoint)};
  item.preset = static_cast<VolumePreset>(state.range(0));
  content.volume = std::make_shared<VolumeItem>(item);
  view.show(content);
  SceneCamera camera = look_along(Eigen::Vector3d::UnitY(), {0, 0, 0}, 420, Eigen::Vector3d::UnitZ());
  const auto turn = [&] {
    camera = orbited(camera, {4, 1}, 500);
    view.look(camera);
    view.render_if_dirty();
    benchmark::DoNotOptimize(view.texture());
  };
  for (int i = 0; i < 6; ++i) turn();  // how coarse it is to be is learnt
  for (auto _ : state) turn();
}
BENCHMARK(draw_it)
    ->ArgsProduct({{0, 1}, {0, 1}})
    ->ArgNames({"soft_tissue", "still"})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace arthronaut::scene
