#include "app/library/daily_check.h"

#include <algorithm>
#include <vector>

#include "navigation/camera/camera_file.h"
#include "navigation/camera/medium.h"
#include "navigation/sources/recording_time.h"
#include "planning/files/format.h"
#include "planning/files/sha256.h"
#include "planning/files/utc_clock.h"
#include "planning/geometry/error.h"

namespace arthronaut::workstation_library {

namespace {

namespace fs = std::filesystem;

// A video file itself; of a printf pattern every still in the order of their names.
std::vector<fs::path> files_of(const fs::path& video_or_pattern) {
  std::error_code ignored;
  if (fs::is_regular_file(video_or_pattern, ignored)) return {video_or_pattern};
  const std::string pattern = video_or_pattern.filename().string();
  const std::size_t begin = pattern.find('%');
  const std::size_t end = pattern.find('d', begin == std::string::npos ? 0 : begin);
  if (begin == std::string::npos || end == std::string::npos) return {};
  const std::string head = pattern.substr(0, begin), tail = pattern.substr(end + 1);
  std::vector<fs::path> stills;
  const fs::path folder = video_or_pattern.parent_path();
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.empty() ? "." : folder, ignored)) {
    const std::string name = entry.path().filename().string();
    if (entry.is_regular_file(ignored) && name.starts_with(head) && name.ends_with(tail))
      stills.push_back(entry.path());
  }
  std::sort(stills.begin(), stills.end());
  return stills;
}

}  // namespace

std::optional<RecordedClip> recorded_clip(const std::filesystem::path& video_or_pattern) {
  const std::string now_utc = files::utc_now();
  RecordedClip clip;
  std::string hashes;
  std::optional<std::string> earliest;
  for (const fs::path& file : files_of(video_or_pattern)) {
    const std::string hash = files::sha256_of_file(file);
    clip.sha256 = hashes.empty() ? hash : files::sha256_of(hashes + hash);
    hashes += hash;
    const std::optional<std::string> recorded = sources::recorded_utc(file, now_utc);
    if (recorded) earliest = earliest ? std::min(*earliest, *recorded) : *recorded;
  }
  if (hashes.empty()) return std::nullopt;
  clip.recorded_utc = earliest.value_or("");
  return clip;
}

library::AccuracyCheck daily_check_of(const calibration::FluidCheckSummary& summary, const RulerLook& look) {
  const camera::CalibrationRecord camera = camera::read_camera_file(look.camera_file);
  if (camera.provenance.origin != provenance::Origin::Measured)
    throw InvalidInput(look.camera_file, "origin",
                       camera.provenance.origin == provenance::Origin::Simulated
                           ? "is of a simulated arthroscope, whose accuracy says nothing of a real one"
                           : "is nominal, of no arthroscope that was calibrated: its accuracy is nobody's");
  library::AccuracyCheck check;
  check.checked_utc = files::utc_now();
  if (look.clip) {
    check.clip_sha256 = look.clip->sha256;
    check.is_dated = !look.clip->recorded_utc.empty();
    if (check.is_dated) check.checked_utc = look.clip->recorded_utc;
  }
  check.device = look.device;
  if (check.device.empty())
    check.device = camera.scope_name + (camera.head_name.empty() ? "" : ", " + camera.head_name);
  if (check.device.empty()) check.device = "arthroscope";
  check.medium = camera::medium_to_text(look.refractive_index);
  check.source = look.source;
  check.camera_sha256 = files::sha256_of_file(look.camera_file);
  check.true_mm = look.ruler.first_from_second.translation_mm.norm();
  check.distance_mm = summary.distance_mm;
  check.spread_mm = summary.distance_spread_mm;
  check.frame_count = summary.frame_count;
  check.reasons = summary.reasons;
  return check;
}

DailyKeeping keep_daily_check(const std::filesystem::path& data_folder,
                              const calibration::FluidCheckSummary& summary, const RulerLook& look,
                              bool is_live) {
  if (!(summary.distance_mm > 0)) return {false, "not kept: the ruler was not measured"};
  if (!is_live) return {false, "not kept: of a recording, not of today's arthroscope"};
  try {
    const library::AccuracyCheck check = daily_check_of(summary, look);
    (void)library::keep_accuracy_check(data_folder, check);
    return {true, files::format("kept: %.3f of %.3f mm", check.distance_mm, check.true_mm)};
  } catch (const InvalidInput& error) {
    return {false, std::string("not kept: ") + error.what()};
  } catch (const IoError& error) {
    return {false, std::string("not kept: ") + error.what()};
  }
}

}  // namespace arthronaut::workstation_library
