// The marker tracker on clips that are drawn by seed, one kind of hardness after the other, beside OpenCV's
// ArUco. Thresholds are set on even seeds; odd seeds are only ever printed as totals. Prints the tables of
// docs/benchmarks.md.
//
//   hard_tracking [--first CLIP] [--clips N] [--frames N] [--only KIND] [--half set|report] [--cache FOLDER]
//                 [--jobs N]  clips at a time, each on a core of its own
//                 [--rows N]  only clips of no more rows: larger ones take long to draw
//                 [--from FRAME]  the first picture that is tracked: other first sights of the same clips
//                 [--every N]  of the pictures from there on only every N-th is tracked
//                 [--declare ID,ID,...]  these instead of 0, 2, 3 and 4: what is shown is 0, 2 and 3
//                 [--aruco]
//                 [--each]    every lost or wrong marker of the even seeds
#include <Eigen/LU>
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstring>
#include <map>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "planning/geometry/quantile.h"
#include "tests/benchmarks/aruco_tracker.h"
#include "tests/benchmarks/hard_clips/hard_clip.h"
#include "tests/real_data/pose_error.h"

namespace arthronaut::hard_clips {
namespace {

struct Choice {
  int first = 0, clips = 3, frames = 40, jobs = 1, rows = 1 << 20, from = 0, every = 1;
  std::string only, half;
  std::filesystem::path cache;
  bool with_aruco = false, tells_each = false;
  std::vector<int> declared = {0, 2, 3, 4};
};

struct Count {
  int found = 0, shown = 0;
  void add(bool is_found) {
    ++shown;
    found += is_found;
  }
  void operator+=(const Count& other) {
    found += other.found;
    shown += other.shown;
  }
};

std::string percent(const Count& count) {
  if (count.shown == 0) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.1f of %d", 100.0 * count.found / count.shown, count.shown);
  return text;
}

struct Tally {
  Count whole, half_covered, nearly_whole;
  int wrong = 0, poses = 0, markers = 0;
  double squares = 0, half_squares = 0;
  int half_poses = 0;
  std::vector<double> ms, rotation_deg, translation_mm;

  void operator+=(const Tally& other) {
    whole += other.whole;
    half_covered += other.half_covered;
    nearly_whole += other.nearly_whole;
    wrong += other.wrong;
    poses += other.poses;
    markers += other.markers;
    squares += other.squares;
    half_squares += other.half_squares;
    half_poses += other.half_poses;
    ms.insert(ms.end(), other.ms.begin(), other.ms.end());
    rotation_deg.insert(rotation_deg.end(), other.rotation_deg.begin(), other.rotation_deg.end());
    translation_mm.insert(translation_mm.end(), other.translation_mm.begin(), other.translation_mm.end());
  }
};

void print_header() {
  std::printf(
      "| half | hardness | tracker | markers shown | whole %% | 90 to 99.9 %% free %% | half covered %% | "
      "wrong | rotation deg, 50 / 95 %% | translation mm | normalised error, half covered | ms: median / 99 "
      "%% |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|\n");
}

void print_row(const char* half, std::string_view hardness, const char* tracker, const Tally& tally) {
  const auto q = [](const std::vector<double>& values, double share) {
    return values.empty() ? 0.0 : geometry::quantile(values, share);
  };
  std::printf(
      "| %s | %.*s | %s | %d | %s | %s | %s | %d | %.3f / %.3f | %.4f / %.4f | %.2f, %.2f | %.2f / %.2f |\n",
      half, static_cast<int>(hardness.size()), hardness.data(), tracker, tally.markers,
      percent(tally.whole).c_str(), percent(tally.nearly_whole).c_str(), percent(tally.half_covered).c_str(),
      tally.wrong, q(tally.rotation_deg, 0.5), q(tally.rotation_deg, 0.95), q(tally.translation_mm, 0.5),
      q(tally.translation_mm, 0.95), tally.squares / std::max(1, tally.poses),
      tally.half_squares / std::max(1, tally.half_poses), q(tally.ms, 0.5), q(tally.ms, 0.99));
  std::fflush(stdout);
}

using TrackerMaker = std::unique_ptr<markers::MarkerTracker> (*)(std::span<const markers::DeclaredMarker>);

void judge(const markers::MarkerObservation& seen, const MarkerTruth* truth, const ClipRecipe& recipe,
           int frame, bool tells, Tally& tally) {
  if (!truth) {  // declared, and not in the scene
    tally.wrong += seen.is_tracked();
    if (tells && recipe.seed % 2 == 0 && seen.is_tracked())
      std::printf("%s %llu frame %2d marker %d: tracked, and not there\n",
                  std::string(to_text(recipe.hardness)).c_str(), static_cast<unsigned long long>(recipe.seed),
                  frame, seen.id);
    return;
  }
  ++tally.markers;
  if (truth->is_whole()) {
    tally.whole.add(seen.is_tracked());
  } else if (truth->is_half_covered()) {
    tally.half_covered.add(seen.is_tracked());
  } else if (truth->visible_share > 0.9) {
    tally.nearly_whole.add(seen.is_tracked());
  }
  real_data::PoseError error;
  double square = 0;
  if (seen.is_tracked()) {
    error = real_data::pose_error(seen.camera_from_marker, truth->camera_from_marker);
    const geometry::Vector6d twist =
        geometry::log(seen.camera_from_marker.inverse() * truth->camera_from_marker);
    square = twist.dot(seen.covariance.inverse() * twist) / 6;
    ++tally.poses;
    tally.squares += square;
    if (truth->is_half_covered()) {
      ++tally.half_poses;
      tally.half_squares += square;
    }
    tally.wrong += error.is_wrong();
    tally.rotation_deg.push_back(error.rotation_deg);
    tally.translation_mm.push_back(error.translation_mm);
  }
  const bool is_lost = !seen.is_tracked() && truth->visible_share >= 0.5;
  if (tells && recipe.seed % 2 == 0 && (is_lost || error.is_wrong() || square > 6)) {
    const auto state = markers::to_text(seen.state);
    std::printf(
        "%s %llu frame %2d marker %d: %.*s, free %.2f, white %.2f, side %.0f px, moved %.1f px, %.2f deg "
        "%.3f mm, square %.1f\n",
        std::string(to_text(recipe.hardness)).c_str(), static_cast<unsigned long long>(recipe.seed), frame,
        seen.id, static_cast<int>(state.size()), state.data(), truth->visible_share, truth->saturated_share,
        truth->side_px, truth->motion_px, error.rotation_deg, error.translation_mm, square);
  }
}

Tally track_clip(const ClipRecipe& recipe, const Choice& choice, TrackerMaker make) {
  HardClip clip(recipe, choice.cache);
  std::vector<markers::DeclaredMarker> declared;
  for (const int id : choice.declared) declared.push_back({id, recipe.marker_size_mm});
  const auto tracker = make(declared);
  Tally tally;
  int frame = 0;
  for (camera::GrayView picture = clip.next(); picture.data; picture = clip.next(), ++frame) {
    if (frame < choice.from || (frame - choice.from) % choice.every != 0) continue;
    const double start = real_data::thread_cpu_ms();
    const auto seen = tracker->track(picture, clip.camera(), clip.timestamp_ns());
    tally.ms.push_back(real_data::thread_cpu_ms() - start);
    for (const auto& marker : seen) {
      const MarkerTruth* truth = nullptr;
      for (const MarkerTruth& candidate : clip.truth()) {
        if (candidate.id == marker.id) truth = &candidate;
      }
      judge(marker, truth, recipe, frame, choice.tells_each, tally);
    }
  }
  return tally;
}

struct Work {
  ClipRecipe recipe;
  Tally tally = {};
};

// The clips of a half, the longest first, by as many threads as there are jobs.
std::vector<Work> track_clips(std::uint64_t odd, const Choice& choice, TrackerMaker make) {
  std::vector<Work> clips;
  for (const Hardness hardness : kAllHardness) {
    if (!choice.only.empty() && choice.only != to_text(hardness)) continue;
    for (int k = choice.first; k < choice.first + choice.clips; ++k) {
      const ClipRecipe recipe = recipe_of(hardness, 2 * static_cast<std::uint64_t>(k) + odd, choice.frames);
      if (recipe.height <= choice.rows) clips.push_back({recipe});
    }
  }
  std::stable_sort(clips.begin(), clips.end(),
                   [](const Work& l, const Work& r) { return l.recipe.height > r.recipe.height; });
  std::atomic<std::size_t> next = 0;
  std::vector<std::jthread> threads;
  for (int job = 0; job < choice.jobs; ++job) {
    threads.emplace_back([&] {
      for (std::size_t at = next++; at < clips.size(); at = next++)
        clips[at].tally = track_clip(clips[at].recipe, choice, make);
    });
  }
  threads.clear();  // joins them
  return clips;
}

void run(const Choice& choice) {
  std::vector<std::pair<const char*, TrackerMaker>> trackers = {{"own", markers::make_tracker}};
  if (choice.with_aruco) trackers.emplace_back("ArUco", markers::make_aruco_tracker);
  print_header();
  for (const std::uint64_t odd : {0, 1}) {
    const char* half = odd ? "report" : "set";
    if (!choice.half.empty() && choice.half != half) continue;
    for (const auto& [name, make] : trackers) {
      const std::vector<Work> clips = track_clips(odd, choice, make);
      Tally all;
      for (const Hardness hardness : kAllHardness) {
        Tally tally;
        for (const Work& clip : clips)
          if (clip.recipe.hardness == hardness) tally += clip.tally;
        if (tally.markers > 0) print_row(half, to_text(hardness), name, tally);
        all += tally;
      }
      print_row(half, "all", name, all);
    }
  }
}

}  // namespace
}  // namespace arthronaut::hard_clips

int main(int argc, char** argv) {
  arthronaut::hard_clips::Choice choice;
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    const bool has_value = i + 1 < argc;
    if (option == "--aruco") {
      choice.with_aruco = true;
    } else if (option == "--each") {
      choice.tells_each = true;
    } else if (option == "--first" && has_value) {
      choice.first = std::atoi(argv[++i]);
    } else if (option == "--declare" && has_value) {
      choice.declared.clear();
      std::istringstream ids(argv[++i]);
      for (std::string id; std::getline(ids, id, ',');) choice.declared.push_back(std::stoi(id));
    } else if (option == "--jobs" && has_value) {
      choice.jobs = std::atoi(argv[++i]);
    } else if (option == "--rows" && has_value) {
      choice.rows = std::atoi(argv[++i]);
    } else if (option == "--from" && has_value) {
      choice.from = std::atoi(argv[++i]);
    } else if (option == "--every" && has_value) {
      choice.every = std::max(1, std::atoi(argv[++i]));
    } else if (option == "--clips" && has_value) {
      choice.clips = std::atoi(argv[++i]);
    } else if (option == "--frames" && has_value) {
      choice.frames = std::atoi(argv[++i]);
    } else if (option == "--only" && has_value) {
      choice.only = argv[++i];
    } else if (option == "--half" && has_value) {
      choice.half = argv[++i];
    } else if (option == "--cache" && has_value) {
      choice.cache = argv[++i];
    } else {
      std::fprintf(stderr,
                   "usage: hard_tracking [--first CLIP] [--clips N] [--frames N] [--only KIND] "
                   "[--half set|report] [--cache FOLDER] [--jobs N] [--rows N] [--from FRAME] [--every N] "
                   "[--declare ID,ID,...] [--aruco] [--each]\n");
      return 2;
    }
  }
  if (!choice.cache.empty()) std::filesystem::create_directories(choice.cache);
  arthronaut::hard_clips::run(choice);
  return 0;
}
