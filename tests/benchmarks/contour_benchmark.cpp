// What it costs in a 1080p frame to hold the registered bone against the picture: all of a frame's work, on
// the path-traced clip where it is there; its folder is named by ARTHRONAUT_TEST_DATA.
#include <benchmark/benchmark.h>

#include "navigation/contour/contour_check.h"
#include "navigation/contour/covered.h"
#include "tests/benchmarks/contour_clips.h"
#include "tests/recorded_data.h"

namespace arthronaut {
namespace {

void check_frame(benchmark::State& state) {
  const auto folder = test::recorded_data() / "arthroscopy/probe_wet";
  if (!std::filesystem::exists(folder)) return state.SkipWithError("needs the recorded data");
  static const contour_clips::Clip clip = contour_clips::traced_clip(folder);
  contour::ContourCheck check(clip.mesh);
  contour::CoveredPlaces covered;
  check.begin(clip.world_from_bone);
  std::size_t index = 0;
  for (auto _ : state) {
    const contour_clips::Look& look = clip.looks[index % clip.looks.size()];
    const Eigen::Vector2i size = look.camera.image_size_px();
    covered.clear();
    covered.add_world_marker(look.camera, look.camera_from_world, clip.tools.world_markers.front());
    for (std::size_t i = 0; i < look.camera_from_tool.size(); ++i)
      if (look.tool_is_tracked[i])
        covered.add_tool(look.camera, look.camera_from_tool[i], clip.tools.tools[i]);
    benchmark::DoNotOptimize(check.look({look.luma.data(), size.x(), size.y(), size.x()}, look.camera,
                                        look.camera_from_world, covered.places(),
                                        static_cast<std::int64_t>(++index) * 1'000'000'000 / 60));
  }
}
BENCHMARK(check_frame)->Unit(benchmark::kMillisecond)->Iterations(960);

}  // namespace
}  // namespace arthronaut
