// The last verdict of the check in fluid that a case keeps (fluid.json), and what it says about a medium and
// the camera.json of now. Set up writes it and shows it; Navigate does not ask for it, but looks at the
// medium in its own pictures (navigation/pipeline/medium_check.h).
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "navigation/calibration/fluid_file.h"

namespace arthronaut::open_case {

[[nodiscard]] std::filesystem::path fluid_file(const std::filesystem::path& case_folder);

// Of the case's camera.json; empty without one: the built-in camera. Throws IoError.
[[nodiscard]] std::string camera_fingerprint(const std::filesystem::path& case_folder);

// Keeps what a check found, with the time and where it was seen. record.camera_sha256 is the fingerprint of
// the camera that it was measured through: where camera.json has changed since, or in a case with a real
// scope where the pictures were simulated, this writes nothing and says why. Empty when it was kept. Throws
// IoError.
[[nodiscard]] std::string keep_fluid_verdict(const std::filesystem::path& case_folder,
                                             calibration::FluidRecord record, bool is_simulated,
                                             const std::string& source, const std::string& now_utc);

enum class FluidStanding {
  NeverChecked,
  Trusted,      // in this medium, with this camera.json
  Refused,      // in this medium the camera did not measure rightly
  OtherMedium,  // checked, but in another one: nothing is known of this
  OtherCamera,  // camera.json has changed since
  Simulated,    // checked with the simulator, which says nothing of a real scope
  Unreadable,   // fluid.json is broken
};

struct FluidState {
  FluidStanding standing = FluidStanding::NeverChecked;
  std::optional<calibration::FluidRecord> last;  // empty: NeverChecked or Unreadable
  std::optional<double> age_days;                // of the check; empty: not known
  std::string text;  // "measures rightly in saline, checked 2026-11-21, 3 days ago"
  [[nodiscard]] bool is_trusted() const { return standing == FluidStanding::Trusted; }
};

// is_simulated: of the pictures that are to be measured now. Water and saline count as one medium (they
// differ by a tenth of a percent). Never throws for what the file holds.
[[nodiscard]] FluidState fluid_state(const std::filesystem::path& case_folder, double refractive_index,
                                     bool is_simulated, const std::string& now_utc);

}  // namespace arthronaut::open_case
