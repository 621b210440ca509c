// Prints how near tunnels found in a post-operative CT come to those that were drilled in it:
//   postop_accuracy [-n TRIALS] [-s SEED] [-k KIND] [-e] [FEMUR...]
// Femora as meshes, LPS, mm; default: the built-in knee. KIND: the CTs whose name holds this word. -e: each
// trial, too, with what it is off by and what it was said to be known to.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <functional>
#include <random>
#include <string>

#include "planning/bones/mesh_file.h"
#include "planning/bones/mesh_repair.h"
#include "planning/default_plan/default_plan.h"
#include "planning/phantom/phantom_knee.h"
#include "planning/postop/comparison.h"
#include "tests/planning/postop/postop_ct.h"

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

struct Kind {
  const char* name;
  std::function<void(test::Drilled&, test::KnownCtOptions&, std::mt19937_64&)> change;
};

double between(double low, double high, std::mt19937_64& random) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

// Of the head of a bone: thin cortex, marrow that is not even.
void as_in_the_metaphysis(test::KnownCtOptions& ct, std::mt19937_64& random) {
  ct.cortex_hu = between(700, 1300, random);
  ct.marrow_hu = between(120, 220, random);
  ct.blur_mm = between(0.05, 0.5, random);
  ct.operate = test::uneven_marrow(ct.marrow_hu, 35, 1.2, ct.seed);
}

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all{
      {"fine", [](auto&, auto&, auto&) {}},
      {"1 mm slices, blurred",
       [](auto&, auto& ct, auto&) {
         ct.spacing_mm = {0.6, 0.6, 1.0};
         ct.blur_mm = 0.5;
       }},
      {"soft kernel", [](auto&, auto& ct, auto& random) { ct.blur_mm = between(0.6, 1.0, random); }},
      {"graft 40 HU below marrow", [](auto& how, auto&, auto&) { how.content_hu = 110; }},
      {"dense rim, graft as marrow",
       [](auto& how, auto&, auto&) {
         how.content_hu = 150;
         how.rim_hu = 400;
         how.rim_mm = 1.2;
       }},
      {"socket of 22 mm", [](auto& how, auto&, auto&) { how.to_mm = 22; }},
      {"widened by 3 mm at the entry", [](auto& how, auto&, auto&) { how.widened_mm = 3; }},
      {"screw of 7 mm to 16 mm",
       [](auto& how, auto&, auto&) {
         how.screw_diameter_mm = 7;
         how.screw_to_mm = 16;
         how.screw_aside_mm = 0.5;
       }},
      {"metal along all of it but 5 mm",
       [](auto& how, auto& ct, auto& random) {
         ct.blur_mm = 0.5;
         how.screw_diameter_mm = 7;
         how.screw_from_mm = 5;
         how.screw_to_mm = 60;
         how.screw_aside_mm = between(0, 0.5, random) * (how.tunnel.diameter_mm - 7);
       }},
      {"one density, air about it",
       [](auto& how, auto& ct, auto&) {
         ct.marrow_hu = ct.cortex_hu = 800;
         ct.soft_tissue_hu = -1000;
         how.content_hu = -1000;
         ct.noise_hu = 40;
       }},
      {"any rim, uneven marrow",
       [](auto& how, auto& ct, auto& random) {
         as_in_the_metaphysis(ct, random);
         how.content_hu = between(40, 110, random);
         how.rim_hu = between(300, 550, random);
         how.rim_mm = between(0.0, 1.5, random);
       }},
      {"faint graft, uneven marrow",
       [](auto& how, auto& ct, auto& random) {
         as_in_the_metaphysis(ct, random);
         how.content_hu = ct.marrow_hu - between(20, 60, random);
         if (between(0, 1, random) < 0.5) how.to_mm = 25;
       }},
      {"bone plug of 20 mm",
       [](auto& how, auto&, auto& random) {
         how.plug_hu = 450;
         how.plug_diameter_mm = how.tunnel.diameter_mm - between(0.5, 2, random);
         how.plug_from_mm = between(0, 8, random);
         how.plug_to_mm = how.plug_from_mm + 20;
       }},
      {"button and bore of 4.5 mm beyond 25 mm",
       [](auto& how, auto& ct, auto& random) {
         as_in_the_metaphysis(ct, random);
         how.narrow_from_mm = 25;
         how.screw_diameter_mm = 4;
         how.screw_from_mm = 33;
         how.screw_to_mm = 60;
       }},
  };
  return all;
}

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

void try_one(const Subject& subject, const Kind& kind, bool prints, std::mt19937_64& random,
             Figures& figures) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> even(-1, 1);
  const geometry::Surface bone(subject.mesh);
  test::Drilled how;
  test::KnownCtOptions ct;
  ct.seed = random();
  how.tunnel = test::moved_tunnel(subject.plan, bone, {5 * even(random), 5 * even(random)},
                                  {10 * even(random), 10 * even(random)});
  how.tunnel.diameter_mm = 8.5 + 1.5 * even(random);
  kind.change(how, ct, random);
  const auto lying = test::lying(90 * even(random), {normal(random), normal(random), normal(random)},
                                 {40 * even(random), 40 * even(random), 40 * even(random)});
  const auto volume = test::postop_ct({subject.mesh}, {how}, lying, ct);
  const double start = processor_seconds();
  const auto found = postop::PostopImages(volume).compare(subject.mesh, subject.plan).tunnel;
  figures.seconds.push_back(processor_seconds() - start);
  ++figures.trials;
  for (const std::string& reason : found.reasons)
    std::fprintf(stderr, "%s, %s: %s\n", kind.name, subject.name.c_str(), reason.c_str());
  if (!found.is_found) return;
  ++figures.found;
  const double entry = (found.tunnel.entry_mm - how.tunnel.entry_mm).norm(),
               angle = geometry::deg_from_rad(
                   geometry::angle_between_rad(found.tunnel.direction, how.tunnel.direction));
  const double off_mm = std::abs(found.tunnel.diameter_mm - how.tunnel.diameter_mm);
  if (prints)
    std::fprintf(
        stderr, "%s, %s: %s, off by %.2f mm (%.2f), %.2f deg (%.2f), diameter %.2f mm; %.0f mm long\n",
        kind.name, subject.name.c_str(), found.reliable ? "reliable" : "refused", entry, found.entry_sigma_mm,
        angle, geometry::deg_from_rad(found.direction_sigma_rad), off_mm, found.length_mm);
  if (!found.reliable) return;
  ++figures.reliable;
  const bool has_metal = how.screw_diameter_mm > 0;
  const bool is_wrong = entry > (has_metal ? 0.6 : 0.3) || angle > (has_metal ? 1 : 0.5) ||
                        (how.widened_mm == 0 && off_mm > 0.3);
  figures.wrong += is_wrong ? 1 : 0;
  if (is_wrong)
    std::fprintf(stderr, "%s, %s: wrong by %.2f mm, %.2f deg, diameter %.2f mm\n", kind.name,
                 subject.name.c_str(), entry, angle, found.tunnel.diameter_mm - how.tunnel.diameter_mm);
  figures.entry_mm.push_back(entry);
  figures.angle_deg.push_back(angle);
  const double drilled_mm =
      std::min({how.to_mm, how.narrow_from_mm, tunnels::measure(how.tunnel, bone).length_mm});
  figures.length_mm.push_back(std::abs(found.length_mm - drilled_mm));
  if (how.widened_mm == 0) figures.diameter_mm.push_back(off_mm);
}

std::vector<Subject> subjects_of(const std::vector<std::string>& files) {
  std::vector<Subject> subjects;
  for (const std::string& file : files) {
    const bones::Bone bone{bones::BoneKind::Femur, bones::mend_mesh(bones::read_mesh(file)).mesh, file};
    const geometry::Surface surface(bone.mesh);
    default_plan::BoneInput input;
    input.bone = &bone;
    input.surface = &surface;
    const auto plan = default_plan::plan_bone(input, bones::Side::Right);
    if (plan.is_usable()) subjects.push_back({file, bone.mesh, plan.tunnel});
  }
  if (subjects.empty()) {
    const auto knee = phantom::make_phantom_knee();
    subjects = {{"femur", knee.femur.mesh, knee.femoral_tunnel},
                {"tibia", knee.tibia.mesh, knee.tibial_tunnel}};
  }
  return subjects;
}

int run(int argc, char** argv) {
  int trials = 6;
  std::uint64_t seed = 1;
  bool prints = false;
  std::string kind_word;
  std::vector<std::string> files;
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "-n" && i + 1 < argc) {
      trials = std::atoi(argv[++i]);
    } else if (std::string(argv[i]) == "-k" && i + 1 < argc) {
      kind_word = argv[++i];
    } else if (std::string(argv[i]) == "-s" && i + 1 < argc) {
      seed = std::strtoull(argv[++i], nullptr, 10);
    } else if (std::string(argv[i]) == "-e") {
      prints = true;
    } else {
      files.emplace_back(argv[i]);
    }
  }
  const auto subjects = subjects_of(files);
  std::printf(
      "| CT | trials | found | reliable | of those wrong | entry mm | angle deg | diameter mm | length mm | "
      "s "
      "|\n|---|---|---|---|---|---|---|---|---|---|\n");
  for (const Kind& kind : kinds()) {
    if (std::string(kind.name).find(kind_word) == std::string::npos) continue;
    std::mt19937_64 random(seed);
    Figures f;
    for (int trial = 0; trial < trials; ++trial)
      try_one(subjects[static_cast<std::size_t>(trial) % subjects.size()], kind, prints, random, f);
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
