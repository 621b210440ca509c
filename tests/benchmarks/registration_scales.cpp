// Whether an error of scale is told: strokes that are larger or smaller than the bone, as markers of another
// size than stated make them, registered to femora of several people.
//
//   registration_scales NOISE TRIALS even|odd ROWS.csv FEMUR...
//
// NOISE is dry, ex-vivo or hard. Of each FEMUR (a mesh of a right one, LPS, mm) the strokes of so many trials
// are scaled about their world marker by 0.95 to 1.05. Wrong is off by 2 mm or more at the target. ROWS.csv
// gets a row a trial.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "navigation/experiments/trial_series.h"
#include "navigation/registration/registration.h"
#include "planning/bones/mesh_file.h"
#include "planning/geometry/quantile.h"

namespace {

using namespace arthronaut;

constexpr double kSuccess_mm = 2;
constexpr std::array kScales{0.95, 0.97, 0.98, 0.99, 1.0, 1.01, 1.02, 1.03, 1.05};

struct Row {
  double scale = 1;
  int count = 0, right = 0, doubted = 0, told = 0, reliable_but_wrong = 0;
  std::vector<double> errors_mm = {}, predicted_mm = {}, ratios = {}, estimates = {}, sigmas = {};
};

void add(Row& row, const registration::RegistrationSummary& found, double error_mm, std::FILE* rows) {
  ++row.count;
  const bool is_right = found.has_pose && error_mm < kSuccess_mm;
  row.right += is_right;
  row.doubted += is_right && !found.reliable;
  row.reliable_but_wrong += !is_right && found.reliable;
  row.told += std::any_of(found.reasons.begin(), found.reasons.end(), [](const std::string& reason) {
    return reason.find("the strokes are") != std::string::npos;
  });
  std::fprintf(rows, "%.3f,%d,%d,%.3f,%.3f,%.5f,%.5f,%.3f,%.3f\n", row.scale, is_right ? 1 : 0,
               found.reliable ? 1 : 0, error_mm, found.predicted_tre_mm, found.stroke_scale.ratio,
               found.stroke_scale.sigma, found.evidence.excess_misfit_mm, found.rms_mm);
  if (!is_right) return;
  row.errors_mm.push_back(error_mm);
  row.predicted_mm.push_back(found.predicted_tre_mm);
  row.ratios.push_back(error_mm / found.predicted_tre_mm);
  row.estimates.push_back(found.stroke_scale.ratio);
  row.sigmas.push_back(found.stroke_scale.sigma);
}

void run(int argc, char** argv, std::FILE* rows) {
  const auto setting = experiments::setting_of(experiments::trial_noise_from_text(argv[1]));
  const int trial_count = std::atoi(argv[2]);
  const std::uint64_t parity = std::string(argv[3]) == "odd" ? 1 : 0;
  std::vector<Row> table;
  for (const double scale : kScales) table.push_back({scale});
  for (int k = 5; k < argc; ++k) {
    const geometry::TriangleMesh mesh = bones::read_mesh(argv[k]);
    const geometry::Surface surface(mesh);
    const registration::SurfaceIndex prepared(mesh);
    const auto wall = experiments::find_lateral_notch_wall(mesh, surface, bones::Side::Right);
    if (!wall) throw std::runtime_error(std::string(argv[k]) + ": this bone shows no notch");
    for (int trial_index = 0; trial_index < trial_count; ++trial_index) {
      const std::uint64_t seed = 1'000'003 * static_cast<std::uint64_t>(k - 4) + parity +
                                 2 * static_cast<std::uint64_t>(trial_index);
      const experiments::Trial trial = experiments::make_trial(mesh, surface, *wall, setting, seed);
      for (Row& row : table) {
        strokes::Curves curves = trial.curves;
        for (strokes::CurvePoint& point : curves) point.position_mm *= row.scale;
        const auto found = registration::register_curves(prepared, curves, {seed, true, *wall});
        add(row, found, (found.marker_from_bone * *wall - trial.marker_from_bone * *wall).norm(), rows);
      }
    }
  }
  std::printf(
      "| strokes scaled by | right | doubted though right | scale told | reliable but wrong | error, "
      "median, mm | predicted, median, mm | error / predicted, median | scale found, median | its sigma |\n"
      "|---|---|---|---|---|---|---|---|---|---|\n");
  for (const Row& row : table) {
    const auto median = [](const std::vector<double>& values) { return geometry::median(values, 0); };
    std::printf("| %.2f | %d of %d | %d | %d | %d | %.2f | %.2f | %.1f | %.4f | %.4f |\n", row.scale,
                row.right, row.count, row.doubted, row.told, row.reliable_but_wrong, median(row.errors_mm),
                median(row.predicted_mm), median(row.ratios), median(row.estimates), median(row.sigmas));
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 6 || (std::string(argv[3]) != "even" && std::string(argv[3]) != "odd")) {
    std::fprintf(stderr, "usage: registration_scales NOISE TRIALS even|odd ROWS.csv FEMUR...\n");
    return 2;
  }
  try {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> rows(std::fopen(argv[4], "w"), &std::fclose);
    if (!rows) throw std::runtime_error(std::string(argv[4]) + ": cannot be written");
    std::fprintf(rows.get(),
                 "scale,right,reliable,error_mm,predicted_mm,stroke_scale,stroke_scale_sigma,"
                 "excess_misfit_mm,rms_mm\n");
    run(argc, argv, rows.get());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  }
  return 0;
}
