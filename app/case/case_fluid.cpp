#include "app/case/case_fluid.h"

#include <cmath>
#include <utility>

#include "app/case/case_calibration.h"
#include "navigation/camera/medium.h"
#include "planning/cases/case.h"
#include "planning/files/local_time.h"
#include "planning/files/sha256.h"
#include "planning/geometry/error.h"

namespace arthronaut::open_case {

namespace {

namespace fs = std::filesystem;

constexpr double kSameMedium = 0.005;  // of the index: water and saline are 0.0015 apart

FluidStanding standing_of(const calibration::FluidRecord& record, double refractive_index, bool is_simulated,
                          const std::string& fingerprint) {
  const bool was_simulated = record.provenance.origin == provenance::Origin::Simulated;
  if (was_simulated && !is_simulated) return FluidStanding::Simulated;
  if (record.camera_sha256 != fingerprint) return FluidStanding::OtherCamera;
  if (std::abs(record.refractive_index - refractive_index) > kSameMedium) return FluidStanding::OtherMedium;
  return record.is_trusted ? FluidStanding::Trusted : FluidStanding::Refused;
}

std::string when(const calibration::FluidRecord& record, const std::optional<double>& age_days) {
  if (record.provenance.calibrated_utc.empty()) return "date not known";
  std::string text = "checked " + files::local_day(record.provenance.calibrated_utc);
  if (record.provenance.origin == provenance::Origin::Simulated) text += " with the simulator";
  if (!age_days || *age_days < 1) return text;
  const long days = std::lround(std::floor(*age_days));
  return text + ", " + std::to_string(days) + (days == 1 ? " day ago" : " days ago");
}

std::string text_of(const FluidState& state, double refractive_index) {
  const calibration::FluidRecord& last = *state.last;
  const std::string now = camera::medium_to_text(refractive_index);
  const std::string then = camera::medium_to_text(last.refractive_index);
  const std::string date = when(last, state.age_days);
  switch (state.standing) {
    case FluidStanding::Trusted:
      return "measures rightly in " + then + ", " + date;
    case FluidStanding::Refused:
      return "not to be trusted in " + then + ", " + date + ": " + last.reasons.front();
    case FluidStanding::OtherMedium:
      return "checked in " + then + ", not in " + now + " (" + date + ")";
    case FluidStanding::OtherCamera:
      return "the camera was calibrated anew since it was checked (" + date + ")";
    case FluidStanding::Simulated:
      return "not checked with a real scope: " + date;
    case FluidStanding::NeverChecked:
    case FluidStanding::Unreadable:
      break;
  }
  return "";
}

}  // namespace

fs::path fluid_file(const fs::path& case_folder) { return case_folder / "fluid.json"; }

std::string camera_fingerprint(const fs::path& case_folder) {
  const fs::path file = cases::camera_file(case_folder);
  std::error_code ignored;
  return fs::exists(file, ignored) ? files::sha256_of_file(file) : "";
}

std::string keep_fluid_verdict(const fs::path& case_folder, calibration::FluidRecord record,
                               bool is_simulated, const std::string& source, const std::string& now_utc) {
  if (is_simulated && has_real_camera(case_folder))
    return "this case has a real scope; what is simulated says nothing about it";
  if (record.camera_sha256 != camera_fingerprint(case_folder)) return "camera.json has changed since";
  // A real picture that was measured with the simulator's camera says nothing of a real scope either.
  record.provenance = {origin_by_camera(is_simulated, case_folder), now_utc};
  record.source = source;
  calibration::write_fluid_file(fluid_file(case_folder), record);
  return "";
}

FluidState fluid_state(const fs::path& case_folder, double refractive_index, bool is_simulated,
                       const std::string& now_utc) {
  FluidState state;
  state.text = "not checked yet";
  std::error_code ignored;
  if (!fs::exists(fluid_file(case_folder), ignored)) return state;
  try {  // a file that somebody broke is a state of the screen
    state.last = calibration::read_fluid_file(fluid_file(case_folder));
    state.standing =
        standing_of(*state.last, refractive_index, is_simulated, camera_fingerprint(case_folder));
  } catch (const std::runtime_error& error) {
    state.last.reset();
    state.standing = FluidStanding::Unreadable;
    state.text = error.what();
    return state;
  }
  state.age_days = provenance::days_between(state.last->provenance.calibrated_utc, now_utc);
  state.text = text_of(state, refractive_index);
  return state;
}

}  // namespace arthronaut::open_case
