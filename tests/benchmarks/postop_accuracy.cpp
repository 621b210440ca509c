// Prints how near tunnels found in a post-operative CT come to those that were drilled in it:
//   postop_accuracy [-n TRIALS] [-s SEED] [-k KIND] [-e] [FEMUR...]
// Femora as meshes, LPS, mm; default: the built-in knee. KIND: the CTs whose name holds this word. -e: each
// trial, too, with what it is off by and what it was said to be known to.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <filesystem>
#include <memory>
#include <optional>
#include <random>
#include <string>

#include "planning/bones/mesh_file.h"
#include "planning/bones/mesh_repair.h"
#include "planning/bones/unit_unknown.h"
#include "planning/default_plan/default_plan.h"
#include "planning/phantom/phantom_knee.h"
#include "planning/postop/achieved_place.h"
#include "planning/postop/comparison.h"
#include "tests/benchmarks/postop_kinds.h"

namespace arthronaut {
namespace {

double processor_seconds() {
  timespec now{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Subject {
  std::string name;
  geometry::TriangleMesh mesh;
  tunnels::Tunnel plan;
};

struct Figures {
  std::vector<double> entry_mm, angle_deg, diameter_mm, length_mm, seconds;
  int trials = 0, found = 0, reliable = 0, wrong = 0;
};

double worst(const std::vector<double>& v) { return v.empty() ? 0 : *std::max_element(v.begin(), v.end()); }
double middle(std::vector<double> v) {
  if (v.empty()) return 0;
  std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
  return v[v.size() / 2];
}

// What one comparison is off by.
struct Off {
  double entry_mm = 0, angle_deg = 0, diameter_mm = 0, length_mm = 0, wall_mm = 0, wall_sigma_mm = 0,
         true_wall_mm = 0, width_mm = 0, widths_times = 0;
};

Off off_by(const postop::AchievedTunnel& found, const test::Drilled& how, const tunnels::Tunnel& plan,
           const std::shared_ptr<const geometry::Surface>& surface) {
  const geometry::Surface& bone = *surface;
  Off off;
  off.entry_mm = (found.tunnel.entry_mm - how.tunnel.entry_mm).norm();
  off.angle_deg =
      geometry::deg_from_rad(geometry::angle_between_rad(found.tunnel.direction, how.tunnel.direction));
  off.diameter_mm = found.tunnel.diameter_mm - how.tunnel.diameter_mm;
  const auto truth = tunnels::measure(how.tunnel, bone);
  off.length_mm = found.length_mm - std::min({how.to_mm, how.narrow_from_mm, truth.length_mm});
  off.true_wall_mm = truth.wall_mm;
  off.wall_mm = tunnels::measure(found.tunnel, bone).wall_mm - truth.wall_mm;
  tunnels::PlanSurroundings surroundings;
  surroundings.surface = surface;
  off.wall_sigma_mm =
      postop::place_of(found, plan, surroundings, landmarks::LandmarkState::Confirmed).wall_sigma_mm;
  for (const postop::Width& width : found.widths) {
    const double wide_mm = how.tunnel.diameter_mm +
                           how.widened_mm * std::clamp(1 - width.from_entry_mm / how.widened_to_mm, 0.0, 1.0),
                 off_mm = std::abs(width.diameter_mm - wide_mm);
    off.width_mm = std::max(off.width_mm, off_mm);
    off.widths_times = std::max(off.widths_times, off_mm / width.sigma_mm);
  }
  return off;
}

void print_trial(const Subject& subject, const test::DrilledKind& kind, const postop::AchievedTunnel& found,
                 const Off& off, const test::Drilled& how, const test::KnownCtOptions& ct) {
  std::fprintf(
      stderr,
      "%s, %s: %s, off by %.2f mm (%.2f), %.2f deg (%.2f), diameter %+.2f of %.1f mm (%.2f), length %+.2f of "
      "%.1f mm (%.2f), wall %+.2f of %.1f mm (%.2f), widths %.2f mm, %.1f times; %s; %.2f x %.2f x %.2f mm, "
      "blur "
      "%.2f, noise "
      "%.0f, marrow %.0f, graft %.0f HU\n",
      kind.name, subject.name.c_str(), found.reliable ? "reliable" : "refused", off.entry_mm,
      found.entry_sigma_mm, off.angle_deg, geometry::deg_from_rad(found.direction_sigma_rad), off.diameter_mm,
      how.tunnel.diameter_mm, found.diameter_sigma_mm, off.length_mm, found.length_mm, found.length_sigma_mm,
      off.wall_mm, off.true_wall_mm, off.wall_sigma_mm, off.width_mm, off.widths_times,
      !found.end_is_seen ? "no end"
      : found.comes_out  ? "comes out"
                         : "socket",
      ct.spacing_mm.x(), ct.spacing_mm.y(), ct.spacing_mm.z(), ct.blur_mm, ct.noise_hu, ct.marrow_hu,
      how.content_hu);
}

// `only`: the trial alone that is looked at; the random numbers of those before it are drawn.
void try_one(const Subject& subject, const test::DrilledKind& kind, bool prints, bool is_drawn_alone,
             std::mt19937_64& random, Figures& figures) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> even(-1, 1);
  const auto surface = std::make_shared<const geometry::Surface>(subject.mesh);
  const geometry::Surface& bone = *surface;
  test::Drilled how;
  test::KnownCtOptions ct;
  ct.seed = random();
  const auto each_way = [&](double most) {
    return Eigen::Vector2d{most * even(random), most * even(random)};
  };
  const Eigen::Vector2d tilt_deg = each_way(kind.most_tilt_deg), shift_mm = each_way(kind.most_off_mm);
  how.tunnel = test::moved_tunnel(subject.plan, bone, shift_mm, tilt_deg);
  how.tunnel.diameter_mm = 0.5 * (kind.least_diameter_mm + kind.most_diameter_mm) +
                           0.5 * (kind.most_diameter_mm - kind.least_diameter_mm) * even(random);
  kind.change(how, ct, random);
  const Eigen::Vector3d lies_mm{40 * even(random), 40 * even(random), 40 * even(random)},
      axis{normal(random), normal(random), normal(random)};
  const double turn_deg = 90 * even(random);
  if (is_drawn_alone) return;
  const auto volume = test::postop_ct({subject.mesh}, {how}, test::lying(turn_deg, axis, lies_mm), ct);
  const double start = processor_seconds();
  const auto found = postop::PostopImages(volume).compare(subject.mesh, subject.plan).tunnel;
  figures.seconds.push_back(processor_seconds() - start);
  ++figures.trials;
  for (const std::string& reason : found.reasons)
    std::fprintf(stderr, "%s, %s: %s\n", kind.name, subject.name.c_str(), reason.c_str());
  if (!found.is_found) return;
  ++figures.found;
  const Off off = off_by(found, how, subject.plan, surface);
  if (prints) print_trial(subject, kind, found, off, how, ct);
  if (!found.reliable) return;
  ++figures.reliable;
  const bool has_metal = how.screw_diameter_mm > 0;
  const bool is_wrong = off.entry_mm > (has_metal ? 0.6 : 0.3) || off.angle_deg > (has_metal ? 1 : 0.5) ||
                        (how.widened_mm == 0 && std::abs(off.diameter_mm) > 0.3);
  figures.wrong += is_wrong ? 1 : 0;
  if (is_wrong)
    std::fprintf(stderr, "%s, %s: wrong by %.2f mm, %.2f deg, diameter %.2f mm\n", kind.name,
                 subject.name.c_str(), off.entry_mm, off.angle_deg, off.diameter_mm);
  figures.entry_mm.push_back(off.entry_mm);
  figures.angle_deg.push_back(off.angle_deg);
  figures.length_mm.push_back(std::abs(off.length_mm));
  if (how.widened_mm == 0) figures.diameter_mm.push_back(std::abs(off.diameter_mm));
}

geometry::TriangleMesh mesh_of(const std::string& file) {
  try {
    return bones::mend_mesh(bones::read_mesh(file)).mesh;
  } catch (const bones::UnitUnknown& unknown) {
    return bones::mend_mesh(bones::read_mesh(file, {.space = {}, .unit = unknown.fitting_units().at(0)}))
        .mesh;
  }
}

// A file whose name holds "tibia" is one, else a femur.
std::optional<Subject> subject_of(const std::string& file, bool is_left) {
  const auto kind = file.find("tibia") != std::string::npos ? bones::BoneKind::Tibia : bones::BoneKind::Femur;
  bones::Bone bone{kind, mesh_of(file), file};
  if (is_left) {
    for (auto& vertex : bone.mesh.vertices_mm) vertex.x() = -vertex.x();
    for (auto& triangle : bone.mesh.triangles) std::swap(triangle[1], triangle[2]);
  }
  const geometry::Surface surface(bone.mesh);
  default_plan::BoneInput input;
  input.bone = &bone;
  input.surface = &surface;
  const auto plan = default_plan::plan_bone(input, is_left ? bones::Side::Left : bones::Side::Right);
  if (!plan.is_usable()) {
    std::fprintf(stderr, "%s: %s\n", file.c_str(), plan.message.c_str());
    return std::nullopt;
  }
  return Subject{std::filesystem::path(file).filename(), bone.mesh, plan.tunnel};
}

std::vector<Subject> subjects_of(const std::vector<std::string>& files, bool is_left) {
  std::vector<Subject> subjects;
  for (const std::string& file : files)
    if (auto subject = subject_of(file, is_left)) subjects.push_back(std::move(*subject));
  if (!files.empty()) return subjects;
  const auto knee = phantom::make_phantom_knee({.side = is_left ? bones::Side::Left : bones::Side::Right});
  return {{"femur", knee.femur.mesh, knee.femoral_tunnel}, {"tibia", knee.tibia.mesh, knee.tibial_tunnel}};
}

int run(int argc, char** argv) {
  int trials = 6;
  std::uint64_t seed = 1;
  bool prints = false;
  bool is_left = false;
  int only = -1;
  std::string kind_word;
  std::vector<std::string> files;
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "-n" && i + 1 < argc) {
      trials = std::atoi(argv[++i]);
    } else if (std::string(argv[i]) == "-k" && i + 1 < argc) {
      kind_word = argv[++i];
    } else if (std::string(argv[i]) == "-s" && i + 1 < argc) {
      seed = std::strtoull(argv[++i], nullptr, 10);
    } else if (std::string(argv[i]) == "-t" && i + 1 < argc) {
      only = std::atoi(argv[++i]);
    } else if (std::string(argv[i]) == "-e") {
      prints = true;
    } else if (std::string(argv[i]) == "-l") {
      is_left = true;
    } else {
      files.emplace_back(argv[i]);
    }
  }
  const auto subjects = subjects_of(files, is_left);
  std::printf(
      "| CT | trials | found | reliable | of those wrong | entry mm | angle deg | diameter mm | length mm | "
      "s "
      "|\n|---|---|---|---|---|---|---|---|---|---|\n");
  for (const test::DrilledKind& kind : test::drilled_kinds()) {
    if (std::string(kind.name).find(kind_word) == std::string::npos) continue;
    std::mt19937_64 random(seed);
    Figures f;
    for (int trial = 0; trial < trials; ++trial)
      try_one(subjects[static_cast<std::size_t>(trial) % subjects.size()], kind, prints,
              only >= 0 && only != trial, random, f);
    std::printf("| %s | %d | %d | %d | %d | %.2f / %.2f | %.2f / %.2f | %.2f / %.2f | %.2f / %.2f | %.1f |\n",
                kind.name, f.trials, f.found, f.reliable, f.wrong, middle(f.entry_mm), worst(f.entry_mm),
                middle(f.angle_deg), worst(f.angle_deg), middle(f.diameter_mm), worst(f.diameter_mm),
                middle(f.length_mm), worst(f.length_mm), middle(f.seconds));
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace
}  // namespace arthronaut

int main(int argc, char** argv) {
  try {
    return arthronaut::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "postop_accuracy: %s\n", error.what());
    return 1;
  }
}
