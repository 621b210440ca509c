// The registered bone against the picture: how soon a bone that moved against its marker is told, and how
// often one that did not. On clips of the simulator by seed, even ones to set thresholds on and odd ones to
// report, and on the path-traced clips, which nothing was set on. Prints the tables of docs/benchmarks.md.
//
//   contour_drift [--half set|report] [--clips N] [--rounds N] [--drifts N] [--cache FOLDER] [--traced
//   FOLDER]
//                 [--bone MESH]... [--guide] [--size MM]
//
// --bone: a mesh of a right femur beside the phantoms. --rounds: how often a clip is shown, one after the
// other, in its clean run, forwards and backwards in turn, so that no jump is in it. --drifts: runs with a
// drift a clip. --guide: the guide's phase of each clip as well. Every run has a registration that is off by
// 0.3 mm and 0.3 degrees a coordinate. A drift is 1 mm (--size: 2, 3, 5) in a direction drawn by seed, with 1
// degree about another, from the middle of the clip on.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>
#include <string>

#include "navigation/contour/contour_check.h"
#include "planning/geometry/error.h"
#include "planning/geometry/quantile.h"
#include "tests/benchmarks/contour_showing.h"

namespace arthronaut::contour_clips {
namespace {

struct Choice {
  int clips = 4, rounds = 4, drifts = 6;
  std::string half;
  std::filesystem::path cache, traced;
  std::vector<std::string> bones{"phantom"};
  bool with_guide = false;
  double size_mm = 1;
};

struct Tally {
  double clean_s = 0, checked_s = 0;
  int clean_runs = 0, false_alarms = 0, drifts = 0, told = 0, told_in_time = 0, not_checked = 0, before = 0;
  // By how far the drift lies along the line of sight: within 30 degrees of it, or further from it.
  int along = 0, along_told = 0;
  std::vector<double> delays_s, ms;
  double outline_lead = -1e9, surface_lead = -1e9;  // the largest of a drift, without one, while it holds

  void operator+=(const Tally& other) {
    clean_s += other.clean_s;
    checked_s += other.checked_s;
    for (int Tally::*count :
         {&Tally::clean_runs, &Tally::false_alarms, &Tally::drifts, &Tally::told, &Tally::told_in_time,
          &Tally::not_checked, &Tally::before, &Tally::along, &Tally::along_told})
      this->*count += other.*count;
    delays_s.insert(delays_s.end(), other.delays_s.begin(), other.delays_s.end());
    ms.insert(ms.end(), other.ms.begin(), other.ms.end());
    outline_lead = std::max(outline_lead, other.outline_lead);
    surface_lead = std::max(surface_lead, other.surface_lead);
  }
};

Tally run_clean(const Clip& clip, contour::ContourCheck& check, int rounds, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  contour::CoveredPlaces covered;
  Tally tally;
  const Showing showing(clip);
  check.begin(geometry::exp(noise(random, 0.3, 0.3)) * clip.world_from_bone);
  ++tally.clean_runs;
  for (std::size_t i = 0; i < static_cast<std::size_t>(rounds) * clip.looks.size(); ++i) {
    const auto& verdict = look_at(check, covered, clip, showing.look(i), showing.look(i).luma,
                                  showing.time_ns(i), {}, tally.ms);
    tally.clean_s += showing.step_s();
    tally.checked_s += verdict.state == contour::ContourState::Holds ? showing.step_s() : 0;
    if (verdict.state == contour::ContourState::Holds) {
      if (verdict.outline_pieces >= 8)
        tally.outline_lead = std::max(tally.outline_lead, check.outline_test().verdict().lead);
      if (verdict.surface_pieces >= 5)
        tally.surface_lead = std::max(tally.surface_lead, check.surface_test().verdict().lead);
    }
    if (verdict.state != contour::ContourState::Drifted) continue;
    std::fprintf(stderr, "false alarm on %s after %.1f s, by the %s: %.2f mm\n", clip.name.c_str(),
                 1e-9 * static_cast<double>(showing.time_ns(i)),
                 verdict.is_by_outline ? "outline" : "surface", verdict.drift_mm);
    ++tally.false_alarms;
    check.begin(geometry::exp(noise(random, 0.3, 0.3)) * clip.world_from_bone);
  }
  return tally;
}

// How far what is seen of the surface moved across the line of sight, where a drift was not told.
void tell_missed(const Clip& clip, const contour::ContourCheck& check, const Look& look,
                 const geometry::RigidTransform& moved) {
  std::vector<double> across_mm;
  for (const std::int32_t index : check.visible().places_seen()) {
    const Eigen::Vector3d in_world =
        clip.world_from_bone * check.visible().places()[static_cast<std::size_t>(index)].in_bone_mm;
    const Eigen::Vector3d before = look.camera_from_world * in_world,
                          after = look.camera_from_world * (moved * in_world);
    const Eigen::Vector3d ray = before.normalized();
    across_mm.push_back((after - before - ray * ray.dot(after - before)).norm());
  }
  const auto& surface = check.surface_test().verdict();
  std::fprintf(
      stderr,
      "not told on %s: what is seen moved by %.2f mm in the median, %.2f to %.2f, across the line of "
      "sight; surface: lead %.2f, %.2f mm, share %.2f\n",
      clip.name.c_str(), across_mm.empty() ? 0 : geometry::median(across_mm),
      across_mm.empty() ? 0 : geometry::quantile(across_mm, 0),
      across_mm.empty() ? 0 : geometry::quantile(across_mm, 1), surface.lead, surface.from_reference_mm,
      surface.share_seen);
}

// The clip once; from the drift on there and back, until five seconds have passed.
void run_drift(const Clip& clip, contour::ContourCheck& check, double size_mm, std::uint64_t seed,
               Tally& tally) {
  std::mt19937_64 random(seed);
  contour::CoveredPlaces covered;
  const Showing showing(clip);
  check.begin(geometry::exp(noise(random, 0.3, 0.3)) * clip.world_from_bone);
  geometry::RigidTransform moved;
  moved.translation_mm = size_mm * noise(random, 1, 0).head<3>().normalized();
  // About the marker, so that it moves what is seen of the bone beside it by little more.
  const Eigen::Vector3d axis = noise(random, 1, 0).head<3>().normalized();
  moved.rotation = Eigen::AngleAxisd(geometry::rad_from_deg(1), axis);
  const auto from = static_cast<std::size_t>(
      std::max<double>(static_cast<double>(clip.looks.size()) / 2, 3.0 / showing.step_s()));
  const Eigen::Vector3d in_camera = showing.look(from).camera_from_world.rotate(moved.translation_mm);
  const bool is_along = std::abs(in_camera.z()) > size_mm * std::cos(geometry::rad_from_deg(30));
  ++tally.drifts;
  tally.along += is_along;
  for (std::size_t i = 0; i < from; ++i) {
    if (look_at(check, covered, clip, showing.look(i), showing.look(i).luma, showing.time_ns(i), {}, tally.ms)
            .state != contour::ContourState::Drifted)
      continue;
    std::fprintf(stderr, "false alarm on %s before the drift, after %.1f s, by the %s: %.2f mm\n",
                 clip.name.c_str(), 1e-9 * static_cast<double>(showing.time_ns(i)),
                 check.verdict().is_by_outline ? "outline" : "surface", check.verdict().drift_mm);
    ++tally.before;
    return;
  }
  bool was_checked = check.verdict().state == contour::ContourState::Holds;
  for (std::size_t i = from; showing.time_ns(i) < showing.time_ns(from) + 5'000'000'000; ++i) {
    const auto& verdict = look_at(check, covered, clip, showing.look(i), showing.look(i).luma,
                                  showing.time_ns(i), moved, tally.ms);
    const double delay_s = 1e-9 * static_cast<double>(showing.time_ns(i) - showing.time_ns(from));
    was_checked = was_checked || (verdict.state == contour::ContourState::Holds && delay_s < 2);
    if (verdict.state != contour::ContourState::Drifted) continue;
    ++tally.told;
    tally.along_told += is_along;
    tally.told_in_time += delay_s <= 2;
    tally.delays_s.push_back(delay_s);
    return;
  }
  tally.not_checked += !was_checked;
  tell_missed(clip, check, showing.look(from), moved);
}

void print_header() {
  std::printf(
      "| half | clips | clean, s | of it checked %% | false alarms | drifts | told within 2 s | told "
      "within 5 s "
      "| not told, and said to be not checked | delay s: median, 95 %% | along the line of sight: told | "
      "largest lead without a drift: outline, surface | ms: "
      "median, "
      "99 %%, worst |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
}

void print_row(const char* half, const std::string& name, const Tally& t) {
  const auto q = [](const std::vector<double>& values, double share) {
    return values.empty() ? 0.0 : geometry::quantile(values, share);
  };
  std::printf(
      "| %s | %s | %.0f | %.0f | %d | %d | %d | %d | %d | %.2f, %.2f | %d of %d | %.1f, %.1f | %.2f, %.2f, "
      "%.2f |\n",
      half, name.c_str(), t.clean_s, t.clean_s > 0 ? 100 * t.checked_s / t.clean_s : 0.0,
      t.false_alarms + t.before, t.drifts, t.told_in_time, t.told, t.not_checked, q(t.delays_s, 0.5),
      q(t.delays_s, 0.95), t.along_told, t.along, t.outline_lead, t.surface_lead, q(t.ms, 0.5), q(t.ms, 0.99),
      q(t.ms, 1));
  std::fflush(stdout);
}

Tally run_clip(const Clip& clip, const Choice& choice, std::uint64_t seed) {
  contour::ContourCheck check(clip.mesh);
  Tally tally = run_clean(clip, check, choice.rounds, seed);
  for (int k = 0; k < choice.drifts; ++k)
    run_drift(clip, check, choice.size_mm, 1'000 * seed + 7 * static_cast<std::uint64_t>(k) + 1, tally);
  return tally;
}

void run_simulated(const Choice& choice, std::uint64_t odd) {
  const char* half = odd ? "report" : "set";
  for (const std::string& bone : choice.bones) {
    for (const bool drills : {false, true}) {
      if (drills && !choice.with_guide) continue;
      Tally all;
      for (int k = 1; k <= choice.clips; ++k) {
        ClipRecipe recipe;
        recipe.bone = bone;
        recipe.seed = 2 * static_cast<std::uint64_t>(k) + odd;
        recipe.drills = drills;
        try {
          all += run_clip(simulated_clip(recipe, choice.cache), choice, recipe.seed);
        } catch (const InvalidInput& error) {
          std::fprintf(stderr, "%s, seed %d: %s\n", bone.c_str(), static_cast<int>(recipe.seed),
                       error.what());
        }
      }
      const std::string name = bone == "phantom" ? bone : std::filesystem::path(bone).stem().string();
      print_row(half, name + (drills ? ", guide" : ", probe"), all);
    }
  }
}

int run(const Choice& choice) {
  print_header();
  for (const std::uint64_t odd : {0, 1})
    if (choice.half.empty() || choice.half == (odd ? "report" : "set")) run_simulated(choice, odd);
  if (choice.traced.empty()) return 0;
  for (const char* name : {"probe_wet", "guide_wet"}) {
    const Clip clip = traced_clip(choice.traced / name);
    print_row("report", clip.name, run_clip(clip, choice, 1));
  }
  return 0;
}

}  // namespace
}  // namespace arthronaut::contour_clips

int main(int argc, char** argv) {
  arthronaut::contour_clips::Choice choice;
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    const bool has_value = i + 1 < argc;
    if (option == "--guide") {
      choice.with_guide = true;
    } else if (option == "--half" && has_value) {
      choice.half = argv[++i];
    } else if (option == "--clips" && has_value) {
      choice.clips = std::atoi(argv[++i]);
    } else if (option == "--rounds" && has_value) {
      choice.rounds = std::atoi(argv[++i]);
    } else if (option == "--drifts" && has_value) {
      choice.drifts = std::atoi(argv[++i]);
    } else if (option == "--size" && has_value) {
      choice.size_mm = std::atof(argv[++i]);
    } else if (option == "--cache" && has_value) {
      choice.cache = argv[++i];
    } else if (option == "--traced" && has_value) {
      choice.traced = argv[++i];
    } else if (option == "--bone" && has_value) {
      choice.bones.emplace_back(argv[++i]);
    } else {
      std::fprintf(
          stderr,
          "usage: contour_drift [--half set|report] [--clips N] [--rounds N] [--drifts N] [--cache FOLDER] "
          "[--traced FOLDER] [--bone MESH]... [--guide] [--size MM]\n");
      return 2;
    }
  }
  if (!choice.cache.empty()) std::filesystem::create_directories(choice.cache);
  return arthronaut::contour_clips::run(choice);
}
