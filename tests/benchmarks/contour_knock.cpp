// The registered bone against the picture, after a knock: how soon it is told that the bone lies elsewhere,
// or does not look as it did, and how often that is said where nothing but the view was disturbed. Clips as
// contour_drift's; thresholds are set on even seeds. Prints the tables of docs/benchmarks.md.
//
//   contour_knock [--half set|report] [--clips N] [--knocks N] [--rounds N] [--turn DEG] [--cache FOLDER]
//                 [--traced FOLDER] [--guide] [--each]
//
// A knock moves the marker by 1 to 8 mm in a direction drawn by seed and turns it by 1 degree (--turn) about
// another, at once or over 0.3 s. --knocks: of each size and kind a clip. --rounds: how often a clip is shown
// under each obstruction (contour_obstructions.h). --each: a line for every knock that was not told as moved.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>

#include "planning/geometry/error.h"
#include "planning/geometry/quantile.h"
#include "tests/benchmarks/contour_obstructions.h"
#include "tests/benchmarks/contour_showing.h"

namespace arthronaut::contour_clips {
namespace {

using contour::ContourState;

constexpr std::array kSizes_mm{1.0, 2.0, 3.0, 5.0, 8.0};
constexpr std::array kOver_s{0.0, 0.3};
constexpr double kWatched_s = 5;

struct KnockChoice {
  int clips = 4, knocks = 8, rounds = 2;
  double turn_deg = 1;
  std::string half;
  std::filesystem::path cache, traced;
  bool with_guide = false, tells_each = false;
};

struct Told {
  int knocks = 0, in_time = 0, moved_in_time = 0, moved = 0, never = 0, before = 0, held_at_two_s = 0;
  std::vector<double> delays_s, error_mm;
};

struct Disturbed {
  double seconds = 0, holds_s = 0, doubt_s = 0;
  int alarms = 0, doubts = 0;
};

struct Results {
  std::map<std::pair<double, double>, Told> told;  // by size and duration
  std::array<Disturbed, kObstructionKinds> disturbed;
  std::vector<double> ms;
};

struct Knock {
  geometry::Vector6d twist;
  double over_s = 0;
  [[nodiscard]] geometry::RigidTransform at(double since_s) const {
    const double share = over_s > 0 ? std::clamp(since_s / over_s, 0.0, 1.0) : 1.0;
    return geometry::exp(share * twist);
  }
};

Knock drawn_knock(std::mt19937_64& random, double size_mm, double over_s, double turn_deg) {
  geometry::RigidTransform moved;
  moved.translation_mm = size_mm * noise(random, 1, 0).head<3>().normalized();
  moved.rotation =
      Eigen::AngleAxisd(geometry::rad_from_deg(turn_deg), noise(random, 1, 0).head<3>().normalized());
  return {geometry::log(moved), over_s};
}

void tell_each(const Clip& clip, double size_mm, const contour::ContourCheck& check, bool is_in_doubt) {
  const contour::KnockFound& found = check.knock().last_found();
  std::fprintf(
      stderr,
      "%s, %.0f mm: %s; alike %.2f, pieces %d; %d searches, the last: best %.1f of %d, in place %.1f, "
      " elsewhere %.1f, %.1f mm\n",
      clip.name.c_str(), size_mm, is_in_doubt ? "in doubt" : "not told", check.knock().agreement().share,
      check.verdict().surface_pieces, check.knock().search_count(), found.best, found.pieces, found.in_place,
      found.elsewhere, found.offset_in_bone_mm.norm());
}

void run_knock(const Clip& clip, contour::ContourCheck& check, double size_mm, double over_s,
               const KnockChoice& choice, std::uint64_t seed, Results& results) {
  Told& told = results.told[{size_mm, over_s}];
  std::mt19937_64 random(seed);
  contour::CoveredPlaces covered;
  const Showing showing(clip);
  check.begin(geometry::exp(noise(random, 0.3, 0.3)) * clip.world_from_bone);
  const Knock knock = drawn_knock(random, size_mm, over_s, choice.turn_deg);
  const double share = std::uniform_real_distribution<double>(0.3, 0.7)(random);
  const auto from = static_cast<std::size_t>(
      std::max(share * static_cast<double>(clip.looks.size()), 3.0 / showing.step_s()));
  for (std::size_t i = 0; i < from; ++i) {
    const Look& look = showing.look(i);
    if (look_at(check, covered, clip, look, look.luma, showing.time_ns(i), {}, results.ms).state ==
        ContourState::Drifted) {
      ++told.before;
      return;
    }
  }
  ++told.knocks;
  bool is_in_doubt = false;
  ContourState at_two_s = ContourState::NotChecked;
  for (std::size_t i = from; showing.time_ns(i) < showing.time_ns(from) + std::int64_t{1'000'000'000} * 5;
       ++i) {
    const double since_s = 1e-9 * static_cast<double>(showing.time_ns(i) - showing.time_ns(from));
    const Look& look = showing.look(i);
    const contour::ContourVerdict& verdict =
        look_at(check, covered, clip, look, look.luma, showing.time_ns(i), knock.at(since_s), results.ms);
    if (since_s <= 2) at_two_s = verdict.state;
    const bool has_moved = verdict.state == ContourState::Drifted;
    if (!is_in_doubt && (has_moved || verdict.state == ContourState::LooksOtherwise)) {
      is_in_doubt = true;
      told.in_time += since_s <= 2;
      told.delays_s.push_back(since_s);
    }
    if (!has_moved) continue;
    told.moved_in_time += since_s <= 2;
    ++told.moved;
    told.error_mm.push_back(std::abs(verdict.drift_mm - size_mm));
    break;
  }
  told.held_at_two_s += at_two_s == ContourState::Holds;
  told.never += !is_in_doubt;
  if (choice.tells_each && check.verdict().state != ContourState::Drifted)
    tell_each(clip, size_mm, check, is_in_doubt);
}

void run_disturbed(const Clip& clip, contour::ContourCheck& check, Obstruction kind, int rounds,
                   std::uint64_t seed, Results& results) {
  Disturbed& tally = results.disturbed[static_cast<std::size_t>(kind)];
  std::mt19937_64 random(seed);
  contour::CoveredPlaces covered;
  const Showing showing(clip);
  std::vector<std::uint8_t> luma;
  check.begin(geometry::exp(noise(random, 0.3, 0.3)) * clip.world_from_bone);
  bool was_in_doubt = false;
  for (std::size_t i = 0; i < static_cast<std::size_t>(rounds) * clip.looks.size(); ++i) {
    const Look& look = showing.look(i);
    obstruct(kind, seed, 1e-9 * static_cast<double>(showing.time_ns(i)), look.camera.image_size_px(),
             look.luma, luma);
    const ContourState state =
        look_at(check, covered, clip, look, luma, showing.time_ns(i), {}, results.ms).state;
    tally.seconds += showing.step_s();
    tally.holds_s += state == ContourState::Holds ? showing.step_s() : 0;
    tally.doubt_s += state == ContourState::LooksOtherwise ? showing.step_s() : 0;
    tally.doubts += state == ContourState::LooksOtherwise && !was_in_doubt;
    was_in_doubt = state == ContourState::LooksOtherwise;
    if (state != ContourState::Drifted) continue;
    ++tally.alarms;
    std::fprintf(stderr, "false alarm on %s, %s, after %.1f s: %s, %.1f mm\n", clip.name.c_str(),
                 std::string(to_text(kind)).c_str(), 1e-9 * static_cast<double>(showing.time_ns(i)),
                 check.verdict().is_by_outline      ? "outline"
                 : check.knock().verdict().is_found ? "found again"
                                                    : "surface",
                 check.verdict().drift_mm);
    if (check.knock().verdict().is_found) tell_each(clip, 0, check, true);
    check.begin(geometry::exp(noise(random, 0.3, 0.3)) * clip.world_from_bone);
  }
}

void run_clip(const Clip& clip, const KnockChoice& choice, std::uint64_t seed, Results& results) {
  contour::ContourCheck check(clip.mesh);
  check.reserve_for(clip.looks.front().camera.image_size_px());
  std::uint64_t number = 0;
  for (const double over_s : kOver_s)
    for (const double size_mm : kSizes_mm)
      for (int k = 0; k < choice.knocks; ++k)
        run_knock(clip, check, size_mm, over_s, choice, 1'000 * seed + ++number, results);
  for (int kind = 0; kind < kObstructionKinds && choice.rounds > 0; ++kind)
    run_disturbed(clip, check, static_cast<Obstruction>(kind), choice.rounds, seed, results);
}

double quantile_of(const std::vector<double>& values, double share) {
  return values.empty() ? 0.0 : geometry::quantile(values, share);
}

void print(const std::string& name, const Results& results) {
  std::printf("\n%s; ms a frame: median %.2f, 99 %% %.2f, worst %.2f\n\n", name.c_str(),
              quantile_of(results.ms, 0.5), quantile_of(results.ms, 0.99), quantile_of(results.ms, 1));
  std::printf(
      "| knock, mm | over, s | knocks | told within 2 s | as moved within 2 s | as moved within %.0f s | "
      "said to "
      "hold at 2 s | never told | delay s: median, 95 %% | mm off: median | alarms before |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n",
      kWatched_s);
  for (const auto& [what, told] : results.told)
    std::printf("| %.0f | %.1f | %d | %d | %d | %d | %d | %d | %.2f, %.2f | %.1f | %d |\n", what.first,
                what.second, told.knocks, told.in_time, told.moved_in_time, told.moved, told.held_at_two_s,
                told.never, quantile_of(told.delays_s, 0.5), quantile_of(told.delays_s, 0.95),
                quantile_of(told.error_mm, 0.5), told.before);
  std::printf(
      "\n| disturbed by | s | false alarms | doubts | of the time in doubt %% | checked and held %% |\n"
      "|---|---|---|---|---|---|\n");
  for (int kind = 0; kind < kObstructionKinds; ++kind) {
    const Disturbed& tally = results.disturbed[static_cast<std::size_t>(kind)];
    const double percent = tally.seconds > 0 ? 100 / tally.seconds : 0;
    std::printf("| %s | %.0f | %d | %d | %.0f | %.0f |\n",
                std::string(to_text(static_cast<Obstruction>(kind))).c_str(), tally.seconds, tally.alarms,
                tally.doubts, percent * tally.doubt_s, percent * tally.holds_s);
  }
  std::fflush(stdout);
}

int run(const KnockChoice& choice) {
  for (const std::uint64_t odd : {0, 1}) {
    if (!choice.half.empty() && choice.half != (odd ? "report" : "set")) continue;
    for (const bool drills : {false, true}) {
      if (drills && !choice.with_guide) continue;
      Results results;
      for (int k = 1; k <= choice.clips; ++k) {
        ClipRecipe recipe;
        recipe.bone = "phantom";
        recipe.seed = 2 * static_cast<std::uint64_t>(k) + odd;
        recipe.drills = drills;
        try {
          run_clip(simulated_clip(recipe, choice.cache), choice, recipe.seed, results);
        } catch (const InvalidInput& error) {
          std::fprintf(stderr, "seed %d: %s\n", static_cast<int>(recipe.seed), error.what());
        }
      }
      print(std::string(odd ? "report" : "set") + (drills ? ", guide" : ", probe"), results);
    }
  }
  if (choice.traced.empty()) return 0;
  for (const char* name : {"probe_wet", "guide_wet"}) {
    const Clip clip = traced_clip(choice.traced / name);
    Results results;
    run_clip(clip, choice, 1, results);
    print(clip.name, results);
  }
  return 0;
}

}  // namespace
}  // namespace arthronaut::contour_clips

int main(int argc, char** argv) {
  arthronaut::contour_clips::KnockChoice choice;
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    const bool has_value = i + 1 < argc;
    if (option == "--guide") {
      choice.with_guide = true;
    } else if (option == "--each") {
      choice.tells_each = true;
    } else if (option == "--half" && has_value) {
      choice.half = argv[++i];
    } else if (option == "--clips" && has_value) {
      choice.clips = std::atoi(argv[++i]);
    } else if (option == "--knocks" && has_value) {
      choice.knocks = std::atoi(argv[++i]);
    } else if (option == "--rounds" && has_value) {
      choice.rounds = std::atoi(argv[++i]);
    } else if (option == "--turn" && has_value) {
      choice.turn_deg = std::atof(argv[++i]);
    } else if (option == "--cache" && has_value) {
      choice.cache = argv[++i];
    } else if (option == "--traced" && has_value) {
      choice.traced = argv[++i];
    } else {
      std::fprintf(
          stderr,
          "usage: contour_knock [--half set|report] [--clips N] [--knocks N] [--rounds N] [--turn DEG]\n"
          "                     [--cache FOLDER] [--traced FOLDER] [--guide] [--each]\n");
      return 2;
    }
  }
  if (!choice.cache.empty()) std::filesystem::create_directories(choice.cache);
  return arthronaut::contour_clips::run(choice);
}
