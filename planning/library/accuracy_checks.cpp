#include "planning/library/accuracy_checks.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "planning/files/format.h"
#include "planning/files/json_document.h"
#include "planning/files/local_time.h"
#include "planning/files/private_folder.h"
#include "planning/files/sha256.h"
#include "planning/geometry/error.h"

namespace arthronaut::library {

namespace {

namespace fs = std::filesystem;

constexpr const char* kChecksFormat = "arthronaut.accuracy";
constexpr int kChecksVersion = 1;

// "2026-11-23T06:15:00Z" as "20261123T061500Z".
std::string compact(const std::string& utc) {
  std::string text;
  for (const char c : utc)
    if (c != '-' && c != ':') text += c;
  return text;
}

std::time_t moment_of(const std::string& utc) {
  std::tm time{};
  const char* const end = ::strptime(utc.c_str(), "%Y-%m-%dT%H:%M:%S", &time);
  if (end == nullptr || std::string_view(end) != "Z")
    throw InvalidInput("\"" + utc + "\" is no time as in 2026-01-31T12:00:00Z");
  return ::timegm(&time);
}

std::tm local_time(const std::string& utc) {
  const std::time_t moment = moment_of(utc);
  std::tm local{};
  ::localtime_r(&moment, &local);
  return local;
}

std::string mm(double value) { return files::format("%.3f mm", value); }

AccuracyCheck read_check(const fs::path& file) {
  const files::JsonObject json = files::read_json(file, kChecksFormat, kChecksVersion);
  AccuracyCheck check;
  check.checked_utc = json.text("checked_utc");
  (void)local_time(check.checked_utc);
  check.device = json.text("device");
  check.medium = json.text("medium");
  check.source = json.text("source");
  check.camera_sha256 = json.text("camera_sha256");
  check.true_mm = json.positive_number("true_mm");
  check.distance_mm = json.positive_number("distance_mm");
  check.spread_mm = json.number("spread_mm");
  check.frame_count = static_cast<std::size_t>(json.integer("frames"));
  check.reasons = json.texts("reasons");
  if (json.has("clip_sha256")) check.clip_sha256 = json.text("clip_sha256");
  check.is_dated = !json.has("is_dated") || json.boolean("is_dated");
  return check;
}

bool is_before(const AccuracyCheck& a, const AccuracyCheck& b) { return a.checked_utc < b.checked_utc; }

bool is_of_future(const AccuracyCheck& check, const std::string& now_utc) {
  return check.is_dated && moment_of(check.checked_utc) > moment_of(now_utc);
}

// In the order of time, those of a known date alone. One of the future, as of a clock that was set wrong
// once, would stand after every one to come.
std::vector<AccuracyCheck> of_device(std::span<const AccuracyCheck> checks, const AccuracyDevice& device,
                                     const std::string& now_utc) {
  std::vector<AccuracyCheck> own;
  for (const AccuracyCheck& check : checks)
    if (check.is_dated && device_of(check) == device && !is_of_future(check, now_utc)) own.push_back(check);
  std::stable_sort(own.begin(), own.end(), is_before);
  return own;
}

// Air and saline bend the light in other ways, and a ruler of another length is another measure.
bool is_comparable(const AccuracyCheck& one, const AccuracyCheck& other) {
  return one.true_mm == other.true_mm && one.medium == other.medium;
}

}  // namespace

fs::path accuracy_folder(const fs::path& data_folder) { return data_folder / "accuracy"; }

fs::path keep_accuracy_check(const fs::path& data_folder, const AccuracyCheck& check) {
  if (check.device.empty()) throw InvalidInput("a check of accuracy does not say of which device it is");
  if (check.frame_count == 0 || !(check.true_mm > 0) || !(check.distance_mm > 0))
    throw InvalidInput("a check of accuracy measured nothing: it is not kept");
  (void)local_time(check.checked_utc);
  if (const std::string why = why_clip_does_not_count(read_accuracy_checks(data_folder), check.clip_sha256);
      !why.empty())
    throw InvalidInput(check.source, "", why);
  nlohmann::ordered_json json;
  json["format"] = kChecksFormat;
  json["version"] = kChecksVersion;
  json["checked_utc"] = check.checked_utc;
  json["device"] = check.device;
  json["medium"] = check.medium;
  json["source"] = check.source;
  json["camera_sha256"] = check.camera_sha256;
  json["true_mm"] = check.true_mm;
  json["distance_mm"] = check.distance_mm;
  json["spread_mm"] = check.spread_mm;
  json["frames"] = check.frame_count;
  json["reasons"] = check.reasons;
  if (!check.clip_sha256.empty()) json["clip_sha256"] = check.clip_sha256;
  if (!check.is_dated) json["is_dated"] = false;
  const fs::path folder = accuracy_folder(data_folder);
  files::create_private_folder(folder);
  const fs::path file =
      folder / (compact(check.checked_utc) + "-" + files::sha256_of(json.dump()).substr(0, 8) + ".json");
  files::write_json(file, json);
  return file;
}

AccuracyChecks read_accuracy_checks(const fs::path& data_folder) {
  AccuracyChecks read;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(accuracy_folder(data_folder), error)) {
    if (entry.path().extension() != ".json") continue;
    try {  // one broken file must not hide the others; that it was passed over is told
      read.checks.push_back(read_check(entry.path()));
    } catch (const InvalidInput& broken) {
      read.problems.emplace_back(broken.what());
    } catch (const IoError& broken) {
      read.problems.emplace_back(broken.what());
    }
  }
  std::sort(read.checks.begin(), read.checks.end(), [](const AccuracyCheck& a, const AccuracyCheck& b) {
    return a.checked_utc != b.checked_utc ? a.checked_utc < b.checked_utc : a.distance_mm < b.distance_mm;
  });
  std::sort(read.problems.begin(), read.problems.end());
  return read;
}

AccuracyDevice device_of(const AccuracyCheck& check) { return {check.device, check.camera_sha256}; }

std::string why_clip_does_not_count(const AccuracyChecks& checks, const std::string& clip_sha256) {
  if (clip_sha256.empty()) return "";
  for (const AccuracyCheck& check : checks.checks)
    if (check.clip_sha256 == clip_sha256)
      return "this clip is kept already, as of " +
             (check.is_dated ? files::local_day(check.checked_utc) : "an unknown day") +
             ": a clip counts once, and today's check needs today's pictures";
  return "";
}

std::vector<AccuracyDevice> devices_of(const AccuracyChecks& checks) {
  std::vector<AccuracyDevice> devices;
  for (auto check = checks.checks.rbegin(); check != checks.checks.rend(); ++check)
    if (std::find(devices.begin(), devices.end(), device_of(*check)) == devices.end())
      devices.push_back(device_of(*check));
  return devices;
}

std::string shown_name(std::span<const AccuracyCheck> checks, const AccuracyDevice& device) {
  const bool is_shared = std::any_of(checks.begin(), checks.end(), [&](const AccuracyCheck& check) {
    return check.device == device.name && check.camera_sha256 != device.camera_sha256;
  });
  return is_shared ? device.name + " (camera " + device.camera_sha256.substr(0, 8) + ")" : device.name;
}

bool is_same_day(const std::string& one_utc, const std::string& other_utc) {
  const std::tm one = local_time(one_utc), other = local_time(other_utc);
  return one.tm_year == other.tm_year && one.tm_yday == other.tm_yday;
}

AccuracyStanding accuracy_standing(std::span<const AccuracyCheck> checks, const AccuracyDevice& device,
                                   const std::string& now_utc) {
  using Outcome = AccuracyStanding::Outcome;
  AccuracyStanding standing;
  const std::string name = shown_name(checks, device);
  const std::vector<AccuracyCheck> own = of_device(checks, device, now_utc);
  if (own.empty()) {
    const auto has = [&](const auto& is_such) {
      return std::any_of(checks.begin(), checks.end(), [&](const AccuracyCheck& check) {
        return device_of(check) == device && is_such(check);
      });
    };
    const bool has_undated = has([](const AccuracyCheck& check) { return !check.is_dated; });
    if (!has_undated && !has([](const AccuracyCheck&) { return true; })) return standing;
    standing.outcome = Outcome::MissingToday;
    standing.text = name + ": accuracy not checked today; " +
                    (has_undated ? "last that of a recorded clip, when recorded unknown"
                                 : "what there is, is dated in the future");
    return standing;
  }
  const AccuracyCheck& last = own.back();
  standing.true_mm = last.true_mm;
  std::vector<double> before;
  for (std::size_t i = 0; i + 1 < own.size(); ++i)
    if (own[i].reasons.empty() && is_comparable(own[i], last)) before.push_back(own[i].distance_mm);
  standing.limits = control_limits(before);
  const std::string figures = mm(last.distance_mm) + " of " + mm(last.true_mm);
  if (!is_same_day(last.checked_utc, now_utc)) {
    standing.outcome = Outcome::MissingToday;
    standing.text =
        name + ": accuracy not checked today; last on " + files::local_day(last.checked_utc) + ", " + figures;
    return standing;
  }
  standing.text = name + ": accuracy checked today, " + figures;
  const bool is_outside = standing.limits.is_known && (last.distance_mm < standing.limits.lower ||
                                                       last.distance_mm > standing.limits.upper);
  if (!last.reasons.empty()) {
    standing.outcome = Outcome::NotReliable;
    standing.text += ", not reliable: " + last.reasons.front();
  } else if (std::abs(last.error_mm()) > kMostDistanceError_mm) {
    standing.outcome = Outcome::OutsideLimits;
    standing.text += ", off by more than " + mm(kMostDistanceError_mm);
  } else if (is_outside) {
    standing.outcome = Outcome::OutsideLimits;
    standing.text +=
        ", outside of its usual " + mm(standing.limits.lower) + " to " + mm(standing.limits.upper);
  } else {
    standing.outcome = Outcome::Fine;
    standing.text += standing.limits.is_known ? ", within its limits" : "";
  }
  return standing;
}

AccuracyStanding worst_standing(const AccuracyChecks& checks, const std::string& now_utc) {
  using Outcome = AccuracyStanding::Outcome;
  const auto badness = [](const AccuracyStanding& standing) {
    return standing.is_fine() ? 0 : standing.outcome == Outcome::MissingToday ? 1 : 2;
  };
  constexpr double kDay_s = 86400;
  const std::time_t now = moment_of(now_utc);
  const auto is_known = [&](const AccuracyDevice& device) {
    return std::any_of(checks.checks.begin(), checks.checks.end(), [&](const AccuracyCheck& check) {
      return device_of(check) == device &&
             std::difftime(now, moment_of(check.checked_utc)) <= kKnownDays * kDay_s;
    });
  };
  const std::vector<AccuracyDevice> devices = devices_of(checks);
  std::optional<AccuracyStanding> worst;
  int others = -1;
  for (const AccuracyDevice& device : devices) {
    if (device != devices.front() && !is_known(device)) continue;
    AccuracyStanding standing = accuracy_standing(checks.checks, device, now_utc);
    others += standing.is_fine() ? 0 : 1;
    if (!worst || badness(standing) > badness(*worst)) worst = std::move(standing);
  }
  if (!worst) return {};
  if (others > 0)
    worst->text += files::format("; %d other %s not fine either", others,
                                 others == 1 ? "arthroscope is" : "arthroscopes are");
  return *worst;
}

std::vector<std::string> problems_of(const AccuracyChecks& checks, const std::string& now_utc) {
  std::vector<std::string> problems = checks.problems;
  for (const AccuracyDevice& device : devices_of(checks)) {
    int count = 0;
    std::string day;
    for (const AccuracyCheck& check : checks.checks) {
      if (device_of(check) != device || !is_of_future(check, now_utc)) continue;
      ++count;
      day = files::local_day(check.checked_utc);
    }
    if (count == 0) continue;
    problems.push_back(
        shown_name(checks.checks, device) +
        files::format(": %d %s dated in the future, up to ", count, count == 1 ? "check is" : "checks are") +
        day + ": not counted; this machine's clock is wrong, or was");
  }
  return problems;
}

AccuracyTrend accuracy_trend(std::span<const AccuracyCheck> checks, const AccuracyDevice& device,
                             const std::string& now_utc) {
  AccuracyTrend trend;
  const std::vector<AccuracyCheck> own = of_device(checks, device, now_utc);
  for (const AccuracyCheck& check : own) {
    if (is_comparable(check, own.back()))
      trend.points.push_back({check.checked_utc, check.distance_mm, check.device, "", {}});
    else
      ++trend.left_out;
  }
  return trend;
}

}  // namespace arthronaut::library
