// Registration against what else there is, on the phantom's femur (ARTHRONAUT_BENCHMARK_BONE names another mesh, LPS, mm):
// time of one registration, and in the counters the share of successes (target error below 2 mm) and the mean error of
// those. ICP here is point-to-plane against the exact surface with a trimmed tenth, as good as it gets without knowing
// where to start.
#include <benchmark/benchmark.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cstdlib>
#include <random>

#include "navigation/experiments/registration_trial.h"
#include "navigation/registration/online_registration.h"
#include "navigation/registration/registration.h"
#include "planning/bones/mesh_file.h"
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
    prepared = std::make_shared<const registration::PreparedBone>(mesh);
    surface = std::make_unique<geometry::Surface>(mesh);
    target_mm = experiments::find_lateral_notch_wall(mesh, *surface, bones::Side::Right).value();
  }
  geometry::TriangleMesh mesh;
  std::shared_ptr<const registration::PreparedBone> prepared;
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
    const double error_mm = (marker_from_bone * bone().target_mm - trial.marker_from_bone * bone().target_mm).norm();
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

struct IcpResult {
  RigidTransform bone_from_marker;
  double cost = 1e18;  // mean square of the nearer nine tenths
};

IcpResult icp(const std::vector<Eigen::Vector3d>& points, RigidTransform pose, int iterations) {
  IcpResult result;
  std::vector<double> squares(points.size());
  for (int iteration = 0; iteration < iterations; ++iteration) {
    const Eigen::Vector3d pivot = pose * points[points.size() / 2];
    std::vector<geometry::SurfacePoint> nearest(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      nearest[i] = bone().surface->closest_point(pose * points[i]);
      squares[i] = (pose * points[i] - nearest[i].point_mm).squaredNorm();
    }
    std::vector<double> sorted = squares;
    const auto trim = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() * 9 / 10);
    std::nth_element(sorted.begin(), trim, sorted.end());
    result.cost = 0;
    geometry::Matrix6d matrix = 1e-6 * geometry::Matrix6d::Identity();
    geometry::Vector6d right = geometry::Vector6d::Zero();
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (squares[i] > *trim) continue;
      result.cost += squares[i] / static_cast<double>(points.size());
      const Eigen::Vector3d p = pose * points[i];
      geometry::Vector6d row;
      row << nearest[i].normal, (p - pivot).cross(nearest[i].normal);
      matrix += row * row.transpose();
      right -= row * (p - nearest[i].point_mm).dot(nearest[i].normal);
    }
    result.bone_from_marker = pose;
    const geometry::Vector6d twist = matrix.ldlt().solve(right);
    const Eigen::Vector3d turn = twist.tail<3>();
    const Eigen::Quaterniond rotation(Eigen::AngleAxisd(turn.norm(), turn.stableNormalized()));
    pose.translation_mm = rotation * (pose.translation_mm - pivot) + pivot + twist.head<3>();
    pose.rotation = (rotation * pose.rotation).normalized();
  }
  return result;
}

std::vector<Eigen::Vector3d> every(const Trial& trial, std::size_t step) {
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < trial.curves.size(); i += step) points.push_back(trial.curves[i].position_mm);
  return points;
}

void prepare(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(registration::PreparedBone(bone().mesh));
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

// The first 500 points are known; 10 mm more come in.
void update_online(benchmark::State& state) {
  const auto curves = trial_of(state, 1).curves;
  for (auto _ : state) {
    state.PauseTiming();
    registration::OnlineOptions options;
    options.target_in_bone_mm = bone().target_mm;
    registration::OnlineRegistration online(bone().prepared, options);
    for (std::size_t i = 0; i < 500; ++i) {
      online.add_points({&curves[i], 1});
      online.update();
    }
    online.add_points({&curves[500], 40});
    state.ResumeTiming();
    benchmark::DoNotOptimize(online.update());
  }
}

void icp_near_the_truth(benchmark::State& state) {
  Score score;
  std::uint64_t seed = 0;
  for (auto _ : state) {
    const Trial trial = trial_of(state, ++seed);
    std::mt19937_64 random(seed);
    const Eigen::Vector3d axis = Eigen::Vector3d::Random().normalized();
    RigidTransform start = trial.marker_from_bone.inverse();
    const Eigen::Vector3d center = start * trial.curves[trial.curves.size() / 2].position_mm;
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(geometry::rad_from_deg(10), axis));
    start.translation_mm = turn * (start.translation_mm - center) + center + 10 * Eigen::Vector3d::Random().normalized();
    start.rotation = turn * start.rotation;
    score.add(icp(every(trial, 2), start, 60).bone_from_marker.inverse(), trial);
  }
  score.report(state);
}

void icp_from_500_starts(benchmark::State& state) {
  Score score;
  std::uint64_t seed = 0;
  for (auto _ : state) {
    const Trial trial = trial_of(state, ++seed);
    const auto points = every(trial, 12);
    std::mt19937_64 random(seed);
    IcpResult best;
    for (int start = 0; start < 500; ++start) {
      RigidTransform pose;
      pose.rotation = Eigen::Quaterniond::UnitRandom();
      const Eigen::Vector3d anchor = bone().mesh.vertices_mm[random() % bone().mesh.vertices_mm.size()];
      pose.translation_mm = anchor - pose.rotate(points[random() % points.size()]);
      const IcpResult result = icp(points, pose, 25);
      if (result.cost < best.cost) best = result;
    }
    score.add(icp(every(trial, 2), best.bone_from_marker, 40).bone_from_marker.inverse(), trial);
  }
  score.report(state);
}

}  // namespace

BENCHMARK(prepare)->Unit(benchmark::kMillisecond)->Iterations(2);
// First argument: 0 dry, 1 ex vivo, 2 hard; second: with the marker's prior.
BENCHMARK(register_globally)
    ->ArgsProduct({{0, 1, 2}, {1, 0}})
    ->Unit(benchmark::kMillisecond)
    ->Iterations(10);
BENCHMARK(update_online)->Arg(0)->Unit(benchmark::kMillisecond)->Iterations(5);
BENCHMARK(icp_near_the_truth)->DenseRange(0, 2)->Unit(benchmark::kMillisecond)->Iterations(10);
BENCHMARK(icp_from_500_starts)->DenseRange(0, 2)->Unit(benchmark::kMillisecond)->Iterations(3);

}  // namespace arthronaut
