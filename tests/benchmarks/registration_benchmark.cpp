// Registration on the phantom's femur (ARTHRONAUT_BENCHMARK_BONE names another mesh, LPS, mm): time of one
// registration, and in the counters the share of successes (target error below 2 mm) and the mean error of
// those; time of one update while the surgeon scratches. Other methods: registration_comparison.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <utility>
#include <vector>

#include "navigation/experiments/registration_trial.h"
#include "navigation/registration/online/online_registration.h"
#include "navigation/registration/registration.h"
#include "planning/bones/mesh_file.h"
#include "planning/geometry/quantile.h"
#include "planning/phantom/phantom_knee.h"

namespace arthronaut {

namespace {

using experiments::Trial;
using experiments::TrialNoise;
using geometry::RigidTransform;

struct Bone {
  Bone() {
    const char* file = std::getenv("ARTHRONAUT_BENCHMARK_BONE");
    mesh = file != nullptr ? bones::read_mesh(file) : phantom::make_phantom_knee().femur.mesh;
    prepared = std::make_shared<const registration::SurfaceIndex>(mesh);
    surface = std::make_unique<geometry::Surface>(mesh);
    target_mm = experiments::find_lateral_notch_wall(mesh, *surface, bones::Side::Right).value();
  }
  geometry::TriangleMesh mesh;
  std::shared_ptr<const registration::SurfaceIndex> prepared;
  std::unique_ptr<geometry::Surface> surface;
  Eigen::Vector3d target_mm;
};

const Bone& bone() {
  static const Bone kBone;
  return kBone;
}

Trial trial_of(const benchmark::State& state, std::uint64_t seed) {
  return experiments::make_trial(bone().mesh, *bone().surface, bone().target_mm,
                                 experiments::setting_of(static_cast<TrialNoise>(state.range(0))), seed);
}

// Keeps count of successes over the iterations of a benchmark.
class Score {
 public:
  void add(const RigidTransform& marker_from_bone, const Trial& trial) {
    const double error_mm =
        (marker_from_bone * bone().target_mm - trial.marker_from_bone * bone().target_mm).norm();
    ++count_;
    if (error_mm >= 2) return;
    ++successes_;
    error_sum_mm_ += error_mm;
  }
  void report(benchmark::State& state) const {
    state.counters["success"] = successes_ / std::max(1.0, count_);
    state.counters["error_mm"] = error_sum_mm_ / std::max(1.0, successes_);
  }

 private:
  double count_ = 0, successes_ = 0, error_sum_mm_ = 0;
};

void prepare(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(registration::SurfaceIndex(bone().mesh));
}

void register_globally(benchmark::State& state) {
  Score score;
  std::uint64_t seed = 0;
  for (auto _ : state) {
    state.PauseTiming();
    const Trial trial = trial_of(state, ++seed);
    state.ResumeTiming();
    const auto found = registration::register_curves(*bone().prepared, trial.curves,
                                                     {seed, state.range(1) != 0, bone().target_mm});
    score.add(found.marker_from_bone, trial);
  }
  score.report(state);
}

double processor_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// The updates from the 500th point on, each with 10 mm more of stroke: the time is the median's, of the
// processor; the counter tells the longest, in which the bone of the other side is tried too.
void update_online(benchmark::State& state) {
  const auto curves = trial_of(state, 1).curves;
  for (auto _ : state) {
    registration::OnlineOptions options;
    options.target_in_bone_mm = bone().target_mm;
    registration::OnlineRegistration online(bone().prepared, options);
    std::vector<double> seconds;
    std::uint64_t revision = 0;
    for (std::size_t i = 0; i < curves.size(); ++i) {
      online.add_points({&curves[i], 1});
      const double begin_s = processor_seconds();
      const bool is_solved = online.update().revision != std::exchange(revision, online.result().revision);
      const double taken_s = processor_seconds() - begin_s;
      if (is_solved && i >= 500) seconds.push_back(taken_s);
    }
    state.SetIterationTime(geometry::median(seconds));
    state.counters["longest_ms"] = 1e3 * *std::max_element(seconds.begin(), seconds.end());
  }
}

}  // namespace

BENCHMARK(prepare)->Unit(benchmark::kMillisecond)->Iterations(2);
// First argument: 0 dry, 1 ex vivo, 2 hard; second: with the marker's prior.
BENCHMARK(register_globally)->ArgsProduct({{0, 1, 2}, {1, 0}})->Unit(benchmark::kMillisecond)->Iterations(10);
BENCHMARK(update_online)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond)->UseManualTime()->Iterations(3);
}  // namespace arthronaut
