// What a frame of the slices costs: a pane of a CT of 512 x 512 x 400 voxels, the outline of a bone of
// 200,000 triangles, and the radiograph of that bone.
#include <benchmark/benchmark.h>

#include <Eigen/Geometry>

#include "app/scene/radiograph.h"
#include "app/scene/reslice.h"
#include "tests/planning/geometry/shapes.h"

namespace arthronaut::scene {
namespace {

const images::Volume& volume() {
  static const images::Volume made = [] {
    images::Volume v;
    v.size = {512, 512, 400};
    v.lps_from_index.linear() = Eigen::Vector3d(0.4, 0.4, 0.6).asDiagonal();
    v.values.resize(512UL * 512 * 400);
    for (std::size_t i = 0; i < v.values.size(); ++i) v.values[i] = static_cast<float>(i % 3000) - 1000;
    return v;
  }();
  return made;
}

// range(0): 0 axial, 1 coronal, 2 sagittal, 3 oblique.
void reslice_a_pane(benchmark::State& state) {
  SlicePlane plane;
  plane.center_mm = {102, 102, 120};
  plane.mm_per_px = 0.35;
  if (state.range(0) == 1) plane.down = -Eigen::Vector3d::UnitZ();
  if (state.range(0) == 2) plane.right = Eigen::Vector3d::UnitY(), plane.down = -Eigen::Vector3d::UnitZ();
  if (state.range(0) == 3) {
    plane.right = Eigen::Vector3d(1, 1, 0.4).normalized();
    plane.down = plane.right.unitOrthogonal();
  }
  std::vector<std::uint8_t> grey;
  for (auto _ : state) {
    reslice(volume(), plane, {700, 460}, kBoneWindow, grey);
    benchmark::DoNotOptimize(grey.data());
  }
}
BENCHMARK(reslice_a_pane)->DenseRange(0, 3)->Unit(benchmark::kMillisecond);

const geometry::TriangleMesh& bone() {
  static const geometry::TriangleMesh made = test::ellipsoid({40, 30, 60}, 7);  // 327,680 triangles
  return made;
}

void outline_of_a_bone(benchmark::State& state) {
  for (auto _ : state)
    benchmark::DoNotOptimize(outline_of(bone(), {0, 0, 5}, Eigen::Vector3d(0.1, 0.2, 1).normalized()));
}
BENCHMARK(outline_of_a_bone)->Unit(benchmark::kMillisecond);

void radiograph_of_a_bone(benchmark::State& state) {
  SlicePlane plane;
  plane.mm_per_px = 0.15;
  for (auto _ : state) benchmark::DoNotOptimize(radiograph_from(thickness_along(bone(), plane, {940, 560})));
}
BENCHMARK(radiograph_of_a_bone)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace arthronaut::scene
