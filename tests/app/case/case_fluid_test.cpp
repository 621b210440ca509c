#include "app/case/case_fluid.h"

#include <gtest/gtest.h>

#include <fstream>

#include "navigation/camera/camera_file.h"
#include "navigation/camera/medium.h"
#include "navigation/simulator/simulated_operation.h"
#include "planning/cases/case.h"
#include "planning/files/atomic_file.h"
#include "tests/temporary_folder.h"

namespace arthronaut::open_case {
namespace {

using camera::kAirIndex;
using camera::kSalineIndex;
using camera::kWaterIndex;

constexpr bool kSimulated = true, kReal = false;
constexpr const char* kThen = "2026-11-21T10:00:00Z";
constexpr const char* kNow = "2026-11-24T11:00:00Z";

class CaseFluid : public ::testing::Test {
 protected:
  void adopt_camera(const std::string& scope_name, double focal_px = 600) const {
    camera::CalibrationRecord record;
    record.calibration = simulator::standard_camera();
    record.calibration.focal_px = focal_px;
    record.scope_name = scope_name;
    camera::write_camera_file(cases::camera_file(folder_), record);
  }
  // Measured through the camera that the case has now.
  [[nodiscard]] calibration::FluidRecord verdict(double index, std::vector<std::string> reasons = {}) const {
    calibration::FluidRecord record;
    record.camera_sha256 = camera_fingerprint(folder_);
    record.refractive_index = index;
    record.is_trusted = reasons.empty();
    record.reasons = std::move(reasons);
    record.frame_count = 60;
    return record;
  }
  [[nodiscard]] FluidState state(double index, bool is_simulated = kReal) const {
    return fluid_state(folder_, index, is_simulated, kNow);
  }
  const test::TemporaryFolder temporary_;
  const std::filesystem::path& folder_ = temporary_.path();
};

// With its date, its medium and where it was seen, for whoever asks later.
TEST_F(CaseFluid, Hazard10TheVerdictIsKept) {
  adopt_camera("Scope 30");
  EXPECT_EQ(state(kSalineIndex).standing, FluidStanding::NeverChecked);
  EXPECT_EQ(keep_fluid_verdict(folder_, verdict(kSalineIndex), kReal, "HD camera", kThen), "");
  const FluidState kept = state(kSalineIndex);
  EXPECT_TRUE(kept.is_trusted());
  ASSERT_TRUE(kept.last.has_value());
  EXPECT_EQ(kept.last->source, "HD camera");
  EXPECT_EQ(kept.last->provenance, (provenance::Provenance{provenance::Origin::Measured, kThen}));
  EXPECT_NEAR(kept.age_days.value_or(-1), 3.04, 0.01);
  EXPECT_EQ(kept.text, "measures rightly in saline, checked 2026-11-21, 3 days ago");
}

// Water and saline are one medium; air is another, of which the check says nothing.
TEST_F(CaseFluid, Hazard10AnotherMediumIsNotChecked) {
  adopt_camera("Scope 30");
  (void)keep_fluid_verdict(folder_, verdict(kSalineIndex), kReal, "HD camera", kThen);
  EXPECT_TRUE(state(kWaterIndex).is_trusted());
  const FluidState air = state(kAirIndex);
  EXPECT_EQ(air.standing, FluidStanding::OtherMedium);
  EXPECT_NE(air.text.find("checked in saline, not in air"), std::string::npos) << air.text;
}

TEST_F(CaseFluid, Hazard10ARefusedMediumStaysRefusedWithItsReason) {
  adopt_camera("Scope 30");
  (void)keep_fluid_verdict(folder_, verdict(kAirIndex, {"the pictures are of saline, not of air"}), kReal,
                           "HD camera", kThen);
  const FluidState refused = state(kAirIndex);
  EXPECT_EQ(refused.standing, FluidStanding::Refused);
  EXPECT_NE(refused.text.find("the pictures are of saline"), std::string::npos) << refused.text;
}

// A verdict is of one camera.json: another one, or none any more, has not been checked.
TEST_F(CaseFluid, Hazard10ACameraCalibratedAnewIsNotChecked) {
  adopt_camera("Scope 30", 600);
  (void)keep_fluid_verdict(folder_, verdict(kSalineIndex), kReal, "HD camera", kThen);
  adopt_camera("Scope 30", 601);
  EXPECT_EQ(state(kSalineIndex).standing, FluidStanding::OtherCamera);
}

// Nor does a case keep the verdict on a camera that it has no more: it would stand for the new one.
TEST_F(CaseFluid, Hazard10AVerdictOnAnotherCameraIsNotKept) {
  adopt_camera("Scope 30", 600);
  const calibration::FluidRecord of_the_old = verdict(kSalineIndex);
  adopt_camera("Scope 30", 601);
  EXPECT_EQ(keep_fluid_verdict(folder_, of_the_old, kReal, "HD camera", kThen),
            "camera.json has changed since");
  EXPECT_EQ(state(kSalineIndex).standing, FluidStanding::NeverChecked);
}

// A real case keeps no simulated verdict; one from before the real camera was calibrated is worth nothing.
TEST_F(CaseFluid, Hazard26ASimulatedVerdictIsNoneOfARealScope) {
  adopt_camera("Scope 30");
  EXPECT_NE(keep_fluid_verdict(folder_, verdict(kSalineIndex), kSimulated, "Simulated arthroscope", kThen),
            "");
  EXPECT_FALSE(std::filesystem::exists(fluid_file(folder_)));

  adopt_camera("Simulated arthroscope");
  EXPECT_EQ(keep_fluid_verdict(folder_, verdict(kSalineIndex), kSimulated, "Simulated arthroscope", kThen),
            "");
  EXPECT_TRUE(state(kSalineIndex, kSimulated).is_trusted());
  EXPECT_NE(state(kSalineIndex, kSimulated).text.find("simulator"), std::string::npos);
  adopt_camera("Scope 30");
  EXPECT_EQ(state(kSalineIndex).standing, FluidStanding::Simulated);
}

TEST_F(CaseFluid, ABrokenFileIsAState) {
  std::ofstream(fluid_file(folder_)) << "x";
  EXPECT_EQ(state(kSalineIndex).standing, FluidStanding::Unreadable);
  EXPECT_NE(state(kSalineIndex).text.find("fluid.json"), std::string::npos);
}

}  // namespace
}  // namespace arthronaut::open_case
