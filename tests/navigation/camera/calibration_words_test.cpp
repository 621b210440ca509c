#include "navigation/camera/calibration_words.h"

#include <gtest/gtest.h>

namespace arthronaut::camera {
namespace {

// Who looks at a session reads which scope it was, when it was calibrated, in what and how well.
TEST(CalibrationWords, TellWhatIsKnownAndWhatIsNot) {
  CalibrationRecord record;
  record.calibration.refractive_index = 1;
  EXPECT_EQ(in_words(record), "scope not recorded, calibrated in air, date not recorded, RMS not recorded");
  record.scope_name = "Scope 3";
  record.head_name = "head B";
  record.date_utc = "2026-02-03T10:00:00Z";
  record.rms_px = 0.414;
  EXPECT_EQ(in_words(record), "Scope 3, head B, calibrated 2026-02-03 10:00:00 UTC in air, RMS 0.41 px");
  record.scope_name.clear();
  EXPECT_EQ(scope_in_words(record), "head B");
}

}  // namespace
}  // namespace arthronaut::camera
