// Registration beside what else a user could run, on the very same trials in one run:
//
//   registration_comparison FEMUR [TRIALS [TRIALS_OF_500_STARTS]]
//
// FEMUR is a mesh of a right femur (LPS, mm). Ours starts from nothing, with and without the world marker's
// prior. ICP is point-to-plane with the farthest tenth of the points trimmed, nearest points on the exact
// surface; it starts at the true pose disturbed by 10 mm and 10 degrees, or from 500 random poses that put a
// touched point on the bone, the best fit taken. Times are processor time of one thread, the bone made ready.
// Other programs get the same trials from `arthronaut experiment registration --write-trials`.
#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <random>
#include <string>

#include "navigation/experiments/trial_series.h"
#include "navigation/registration/registration.h"
#include "planning/bones/mesh_file.h"

namespace {

using namespace arthronaut;
using experiments::Trial;
using experiments::TrialNoise;
using geometry::RigidTransform;
using Points = std::vector<Eigen::Vector3d>;

double processor_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double median(std::vector<double> values) {
  if (values.empty()) return std::nan("");
  std::sort(values.begin(), values.end());
  return 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
}

class Random {
 public:
  explicit Random(std::uint64_t seed) : bits_(seed) {}
  double uniform() { return static_cast<double>(bits_() >> 11) * 0x1p-53; }
  std::size_t index(std::size_t count) { return bits_() % count; }
  Eigen::Vector3d direction() {
    const double z = 2 * uniform() - 1, turn = 2 * geometry::kPi * uniform(), across = std::sqrt(1 - z * z);
    return {across * std::cos(turn), across * std::sin(turn), z};
  }
  // Evenly over all rotations (Shoemake).
  Eigen::Quaterniond rotation() {
    const double u = uniform(), a = 2 * geometry::kPi * uniform(), b = 2 * geometry::kPi * uniform();
    return {std::sqrt(1 - u) * std::sin(a), std::sqrt(1 - u) * std::cos(a), std::sqrt(u) * std::sin(b),
            std::sqrt(u) * std::cos(b)};
  }

 private:
  std::mt19937_64 bits_;
};

void turn_about(RigidTransform& pose, const Eigen::Quaterniond& turn, const Eigen::Vector3d& pivot_mm,
                const Eigen::Vector3d& move_mm) {
  pose.translation_mm = turn * (pose.translation_mm - pivot_mm) + pivot_mm + move_mm;
  pose.rotation = (turn * pose.rotation).normalized();
}

struct IcpResult {
  RigidTransform bone_from_marker;
  double cost_mm2 = 1e18;  // mean square of the nearer nine tenths
};

IcpResult run_icp(const geometry::Surface& surface, const Points& points, RigidTransform pose,
                  int max_iterations) {
  IcpResult result;
  std::vector<double> squares(points.size());
  std::vector<geometry::SurfacePoint> nearest(points.size());
  for (int iteration = 0;; ++iteration) {
    Eigen::Vector3d pivot = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3d p = pose * points[i];
      nearest[i] = surface.closest_point(p);
      squares[i] = (p - nearest[i].point_mm).squaredNorm();
      pivot += p / static_cast<double>(points.size());
    }
    std::vector<double> sorted = squares;
    const auto trim = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() * 9 / 10);
    std::nth_element(sorted.begin(), trim, sorted.end());
    geometry::Matrix6d matrix = 1e-6 * geometry::Matrix6d::Identity();
    geometry::Vector6d right = geometry::Vector6d::Zero();
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (squares[i] > *trim) continue;
      sum += squares[i];
      ++count;
      const Eigen::Vector3d p = pose * points[i];
      geometry::Vector6d row;
      row << nearest[i].normal, (p - pivot).cross(nearest[i].normal);
      matrix += row * row.transpose();
      right -= row * (p - nearest[i].point_mm).dot(nearest[i].normal);
    }
    result = {pose, sum / count};
    if (iteration == max_iterations) return result;
    const geometry::Vector6d twist = matrix.ldlt().solve(right);
    const Eigen::Vector3d turn = twist.tail<3>();
    turn_about(pose, Eigen::Quaterniond(Eigen::AngleAxisd(turn.norm(), turn.stableNormalized())), pivot,
               twist.head<3>());
    if (twist.head<3>().norm() < 1e-4 && turn.norm() < 1e-5) return result;
  }
}

Points every(const Trial& trial, std::size_t step) {
  Points points;
  for (std::size_t i = 0; i < trial.curves.size(); i += step) points.push_back(trial.curves[i].position_mm);
  return points;
}

RigidTransform icp_near_truth(const geometry::Surface& surface, const Trial& trial, std::uint64_t seed) {
  constexpr double kMove_mm = 10, kTurn_deg = 10;
  const Points points = every(trial, 2);
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points) middle += p / static_cast<double>(points.size());
  Random random(seed);
  RigidTransform start = trial.marker_from_bone.inverse();
  const Eigen::AngleAxisd turn(geometry::rad_from_deg(kTurn_deg), random.direction());
  turn_about(start, Eigen::Quaterniond(turn), start * middle, kMove_mm * random.direction());
  return run_icp(surface, points, start, 100).bone_from_marker.inverse();
}

RigidTransform icp_from_500_starts(const geometry::Surface& surface, const geometry::TriangleMesh& mesh,
                                   const Trial& trial, std::uint64_t seed) {
  const Points few = every(trial, 12);
  Random random(seed);
  IcpResult best;
  for (int start = 0; start < 500; ++start) {
    RigidTransform pose;
    pose.rotation = random.rotation();
    const Eigen::Vector3d anchor = mesh.vertices_mm[random.index(mesh.vertices_mm.size())];
    pose.translation_mm = anchor - pose.rotate(few[random.index(few.size())]);
    const IcpResult result = run_icp(surface, few, pose, 30);
    if (result.cost_mm2 < best.cost_mm2) best = result;
  }
  return run_icp(surface, every(trial, 2), best.bone_from_marker, 60).bone_from_marker.inverse();
}

// One row of the table.
void compare(const char* name, const experiments::TrialSeries& series, int trial_count,
             const std::function<RigidTransform(const Trial&, std::uint64_t)>& find_marker_from_bone) {
  constexpr double kSuccess_mm = 2;
  std::vector<double> seconds, errors_mm, good_errors_mm;
  for (int k = 0; k < trial_count; ++k) {
    const Trial trial = series.make(k);
    const double start = processor_seconds();
    const RigidTransform found = find_marker_from_bone(trial, series.seed_of(k));
    seconds.push_back(processor_seconds() - start);
    errors_mm.push_back((found * series.target_mm() - trial.marker_from_bone * series.target_mm()).norm());
    if (errors_mm.back() < kSuccess_mm) good_errors_mm.push_back(errors_mm.back());
  }
  std::printf("| %s | %s | %zu of %d | %.2f | %.2f | %.3g |\n", std::string(to_text(series.noise())).c_str(),
              name, good_errors_mm.size(), trial_count, median(errors_mm), median(good_errors_mm),
              1e3 * median(seconds));
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: registration_comparison FEMUR [TRIALS [TRIALS_OF_500_STARTS]]\n");
    return 2;
  }
  const int trial_count = argc > 2 ? std::atoi(argv[2]) : 20,
            slow_trial_count = argc > 3 ? std::atoi(argv[3]) : 5;
  try {
    const geometry::TriangleMesh mesh = bones::read_mesh(argv[1]);
    const geometry::Surface surface(mesh);
    const registration::SurfaceIndex bone(mesh);
    std::printf(
        "| noise | method | success | median error, mm | of the successes | ms, median "
        "|\n|---|---|---|---|---|---|\n");
    for (const TrialNoise noise : {TrialNoise::Dry, TrialNoise::ExVivo, TrialNoise::Hard}) {
      const experiments::TrialSeries series(
          mesh, {.noise = noise, .seed = 1, .side = bones::Side::Right, .area_center_mm = {}});
      const auto ours = [&](bool use_marker_prior) {
        return [&, use_marker_prior](const Trial& trial, std::uint64_t seed) {
          return registration::register_curves(bone, trial.curves,
                                               {seed, use_marker_prior, series.target_mm()})
              .marker_from_bone;
        };
      };
      compare("ours, with the marker's prior", series, trial_count, ours(true));
      compare("ours, without", series, trial_count, ours(false));
      compare("ICP, 10 mm and 10 degrees from the truth", series, trial_count,
              [&](const Trial& trial, std::uint64_t seed) { return icp_near_truth(surface, trial, seed); });
      compare("ICP, 500 starts", series, slow_trial_count, [&](const Trial& trial, std::uint64_t seed) {
        return icp_from_500_starts(surface, mesh, trial, seed);
      });
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  }
  return 0;
}
