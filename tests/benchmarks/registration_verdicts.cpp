// Whether the verdict on a registration can be relied on, over femora of several people:
//
//   registration_verdicts NOISE TRIALS even|odd ROWS.csv [--only ROW] FEMUR...
//
// NOISE is dry, ex-vivo or hard. Of each FEMUR (a mesh of a right one, LPS, mm) the strokes of so many trials
// are registered to it with and without the world marker's prior, to each of the other femora, and, mirrored,
// to itself. On its own bone a result is right within 2 mm at the target; on the others none is. Thresholds
// are set on trials with even seeds, and those with odd ones are only reported. ROWS.csv gets what each
// verdict rested on. --only leaves out all rows of the table but the one of that name. Times are processor
// time of one thread, the bones made ready.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
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

double processor_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Femur {
  explicit Femur(const std::string& file) : mesh(bones::read_mesh(file)), surface(mesh), prepared(mesh) {
    const auto wall = experiments::find_lateral_notch_wall(mesh, surface, bones::Side::Right);
    if (!wall) throw std::runtime_error(file + ": this bone shows no notch");
    target_mm = *wall;
  }
  geometry::TriangleMesh mesh;
  geometry::Surface surface;
  registration::SurfaceIndex prepared;
  Eigen::Vector3d target_mm;
};

enum class Onto { Own, OwnWithoutPrior, Another, Mirrored };

struct Row {
  const char* name;
  Onto onto;
  int count = 0, right = 0, doubted = 0, reliable_but_wrong = 0;
  std::vector<double> errors_mm = {}, ratios = {}, seconds = {};
};

void add(Row& row, const registration::RegistrationSummary& found, const experiments::Trial& trial,
         const Eigen::Vector3d& target_mm, std::FILE* rows) {
  const bool is_own = row.onto == Onto::Own || row.onto == Onto::OwnWithoutPrior;
  const double error_mm = (found.marker_from_bone * target_mm - trial.marker_from_bone * target_mm).norm();
  const bool is_right = is_own && found.has_pose && error_mm < kSuccess_mm;
  ++row.count;
  row.right += is_right;
  row.doubted += is_right && !found.reliable;
  row.reliable_but_wrong += found.reliable && !is_right;
  if (is_right) {
    row.errors_mm.push_back(error_mm);
    row.ratios.push_back(error_mm / found.predicted_tre_mm);
  }
  const registration::VerdictEvidence& e = found.evidence;
  std::fprintf(rows, "%s,%d,%d,%.3f,%.3f,%.1f,%.4f,%.4f,%.3f,%.3f,%.3f\n", row.name, is_right ? 1 : 0,
               found.reliable ? 1 : 0, is_own ? error_mm : -1.0, found.predicted_tre_mm, e.length_in_use_mm,
               e.white_noise_mm, e.excess_misfit_mm, e.lead, e.log_odds, e.side_lead.value_or(1e3));
}

void run(const std::vector<std::unique_ptr<Femur>>& femora, experiments::TrialNoise noise, int trial_count,
         std::uint64_t parity, const std::string& only, std::FILE* rows) {
  std::vector<Row> table{{"own", Onto::Own},
                         {"own without prior", Onto::OwnWithoutPrior},
                         {"another person's", Onto::Another},
                         {"mirrored", Onto::Mirrored}};
  if (!only.empty()) std::erase_if(table, [&](const Row& row) { return row.name != only; });
  if (table.empty()) throw std::runtime_error("\"" + only + "\" is no row of the table");
  for (std::size_t from = 0; from < femora.size(); ++from) {
    const Femur& femur = *femora[from];
    for (int k = 0; k < trial_count; ++k) {
      const std::uint64_t seed = 1'000'003 * (from + 1) + parity + 2 * static_cast<std::uint64_t>(k);
      const experiments::Trial trial = experiments::make_trial(femur.mesh, femur.surface, femur.target_mm,
                                                               experiments::setting_of(noise), seed);
      strokes::Curves mirrored = trial.curves;
      for (strokes::CurvePoint& point : mirrored) point.position_mm.x() = -point.position_mm.x();
      for (Row& row : table) {
        for (std::size_t to = 0; to < femora.size(); ++to) {
          if ((row.onto == Onto::Another) == (to == from)) continue;
          const double start = processor_seconds();
          const auto found = registration::register_curves(
              femora[to]->prepared, row.onto == Onto::Mirrored ? mirrored : trial.curves,
              {seed, row.onto != Onto::OwnWithoutPrior, femur.target_mm});
          row.seconds.push_back(processor_seconds() - start);
          add(row, found, trial, femur.target_mm, rows);
        }
      }
    }
  }
  std::printf(
      "| bone | right | doubted though right | reliable but wrong | error, median, mm | error / predicted | "
      "ms, median, 90 %% |\n|---|---|---|---|---|---|---|\n");
  for (Row& row : table) {
    std::sort(row.seconds.begin(), row.seconds.end());
    std::printf("| %s | %d of %d | %d | %d | %.3f | %.2f | %.0f, %.0f |\n", row.name, row.right, row.count,
                row.doubted, row.reliable_but_wrong, geometry::median(row.errors_mm, 0),
                geometry::median(row.ratios, 0), 1e3 * row.seconds[row.seconds.size() / 2],
                1e3 * row.seconds[row.seconds.size() * 9 / 10]);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 6 || (std::string(argv[3]) != "even" && std::string(argv[3]) != "odd")) {
    std::fprintf(stderr,
                 "usage: registration_verdicts NOISE TRIALS even|odd ROWS.csv [--only ROW] FEMUR...\n");
    return 2;
  }
  try {
    const bool is_one_row = std::string(argv[5]) == "--only" && argc > 7;
    std::vector<std::unique_ptr<Femur>> femora;
    for (int i = is_one_row ? 7 : 5; i < argc; ++i) femora.push_back(std::make_unique<Femur>(argv[i]));
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> rows(std::fopen(argv[4], "w"), &std::fclose);
    if (!rows) throw std::runtime_error(std::string(argv[4]) + ": cannot be written");
    std::fprintf(rows.get(),
                 "bone,right,reliable,error_mm,predicted_mm,length_mm,white_noise_mm,excess_misfit_mm,lead,"
                 "log_odds,side_lead\n");
    run(femora, experiments::trial_noise_from_text(argv[1]), std::atoi(argv[2]),
        std::string(argv[3]) == "odd" ? 1 : 0, is_one_row ? argv[6] : "", rows.get());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  }
  return 0;
}
