// What a look at the ruler with two markers says of an arthroscope's accuracy, as the library keeps it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "navigation/calibration/fluid_check.h"
#include "planning/library/accuracy_checks.h"

namespace arthronaut::workstation_library {

struct RecordedClip {
  std::string sha256;        // of the file, or of the stills' hashes one after the other
  std::string recorded_utc;  // empty: not known
};
// Of a video file or a printf pattern of stills; nullopt where there is no such file. Throws IoError.
[[nodiscard]] std::optional<RecordedClip> recorded_clip(const std::filesystem::path& video_or_pattern);

// By what the ruler was looked at.
struct RulerLook {
  calibration::Ruler ruler = {};
  double refractive_index = 1;
  std::filesystem::path camera_file;
  std::string source = {};                // "camera 0", "clip.mkv"
  std::optional<RecordedClip> clip = {};  // whose time is the check's; empty: a live arthroscope, now
  std::string device = {};  // what the arthroscope is called; empty: scope and head of the camera's file
};

// Throws IoError or InvalidInput: a simulated arthroscope's, or a nominal one's, says nothing of a real one.
[[nodiscard]] library::AccuracyCheck daily_check_of(const calibration::FluidCheckSummary& summary,
                                                    const RulerLook& look);

struct DailyKeeping {
  bool is_kept = false;
  std::string text;  // "kept: 9.998 mm of 10.000 mm", or "not kept: " and why
};
// Keeps the check of a look at a live arthroscope; where it cannot be kept it says so, and throws nothing.
// What was recorded earlier is not today's, and is not kept.
[[nodiscard]] DailyKeeping keep_daily_check(const std::filesystem::path& data_folder,
                                            const calibration::FluidCheckSummary& summary,
                                            const RulerLook& look, bool is_live);

}  // namespace arthronaut::workstation_library
