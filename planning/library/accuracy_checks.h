// The daily check of accuracy: a ruler with two markers at a known distance is held before the arthroscope,
// and what comes out is kept, one file a check, so that it can be seen over the days.
//
//   accuracy/20261123T061500Z-0f3a9c1e.json     format "arthronaut.accuracy", version 1, in the library's
//                                               data folder; the name's end tells checks of one second apart
//
// A recorded clip counts once, and as of the time it was recorded at; where that is not known it counts for
// no day. A device is a name together with its camera.json: two arthroscopes of one model, or without a name,
// are two, and so is one that was calibrated anew.
//
// It tells of camera, lens, fluid and marker tracking together, in that position of the ruler; nothing of the
// tools' tips and axes, and nothing of a registration.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "planning/library/trends.h"

namespace arthronaut::library {

struct AccuracyCheck {
  std::string checked_utc;  // ISO 8601: of the pictures; of the look at them where that is not known
  std::string device;       // the arthroscope: names of scope and head, or what the user calls it
  std::string medium;       // "saline"
  std::string source;       // where the pictures came from
  std::string camera_sha256;
  double true_mm = 0;      // between the markers' centres, as the ruler was made
  double distance_mm = 0;  // as it was measured, median over the frames
  double spread_mm = 0;    // half of what 68 % of the frames lie within
  std::size_t frame_count = 0;
  std::vector<std::string> reasons;  // why it is not to be relied on; empty: it is
  std::string clip_sha256 = {};      // of a recorded clip; empty: of a live arthroscope
  bool is_dated = true;              // false: of a recorded clip, and nobody knows when it was recorded

  [[nodiscard]] double error_mm() const { return distance_mm - true_mm; }
};

struct AccuracyDevice {
  std::string name, camera_sha256;
  friend bool operator==(const AccuracyDevice&, const AccuracyDevice&) = default;
};
[[nodiscard]] AccuracyDevice device_of(const AccuracyCheck& check);

// A check that is off by more than this is outside, whatever the other days say.
inline constexpr double kMostDistanceError_mm = 0.1;

[[nodiscard]] std::filesystem::path accuracy_folder(const std::filesystem::path& data_folder);
// The file that was written. Throws IoError; InvalidInput for a check without date, device, frames or a
// distance, and for a recorded clip that is kept already.
std::filesystem::path keep_accuracy_check(const std::filesystem::path& data_folder,
                                          const AccuracyCheck& check);

struct AccuracyChecks {
  std::vector<AccuracyCheck> checks;  // in the order of time
  std::vector<std::string> problems;  // files that cannot be read, with the reason
};
// None where there is no folder.
[[nodiscard]] AccuracyChecks read_accuracy_checks(const std::filesystem::path& data_folder);
// Empty, or that this recorded clip is kept already, with the date.
[[nodiscard]] std::string why_clip_does_not_count(const AccuracyChecks& checks,
                                                  const std::string& clip_sha256);
// The devices, by the time of their last check, newest first.
[[nodiscard]] std::vector<AccuracyDevice> devices_of(const AccuracyChecks& checks);
// "scope A", or "scope A (camera 1f3a9c0e)" where another camera.json has the same name.
[[nodiscard]] std::string shown_name(std::span<const AccuracyCheck> checks, const AccuracyDevice& device);

// The files that cannot be read, and which devices have checks that are dated in the future.
[[nodiscard]] std::vector<std::string> problems_of(const AccuracyChecks& checks, const std::string& now_utc);

// How one device stands today: its last check against its own earlier ones. One that is dated in the future
// counts for nothing.
struct AccuracyStanding {
  enum class Outcome {
    NeverChecked,
    MissingToday,   // the last check is of another day, by this machine's calendar, or of an unknown one
    NotReliable,    // checked today, with reasons
    OutsideLimits,  // checked today, and off by more than kMostDistanceError_mm or outside of its limits
    Fine,
  } outcome = Outcome::NeverChecked;
  std::string text = "accuracy was never checked";  // with device, date and figures
  // Of the reliable checks of a known date before the last one, with a ruler of the same length in the same
  // medium, in mm of the measured distance.
  ControlLimits limits;
  double true_mm = 0;  // of the last check's ruler; 0: none
  [[nodiscard]] bool is_fine() const { return outcome == Outcome::Fine; }
};
// Of those checks that are the device's.
[[nodiscard]] AccuracyStanding accuracy_standing(std::span<const AccuracyCheck> checks,
                                                 const AccuracyDevice& device, const std::string& now_utc);
// The worst of the devices that were checked in the last kKnownDays, or of the one checked last where none
// was: what is off comes before what is missing. Its text says how many others are not fine.
inline constexpr int kKnownDays = 30;
[[nodiscard]] AccuracyStanding worst_standing(const AccuracyChecks& checks, const std::string& now_utc);
// Whether both moments are of one day by this machine's calendar. Throws InvalidInput for what is no ISO
// 8601.
[[nodiscard]] bool is_same_day(const std::string& one_utc, const std::string& other_utc);

// The checks of a device as points of a chart: the measured distance, with the ruler's length and in the
// medium of the last one. Those that are not reliable are in it: they were measured. Those of an unknown
// date, or one in the future, have no place in it.
struct AccuracyTrend {
  std::vector<TrendPoint> points;
  int left_out = 0;  // of another medium or another ruler
};
[[nodiscard]] AccuracyTrend accuracy_trend(std::span<const AccuracyCheck> checks,
                                           const AccuracyDevice& device, const std::string& now_utc);

}  // namespace arthronaut::library
