// Of which camera a report tells: of a session the one that it was navigated with, whatever came later.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "navigation/camera/camera_file.h"
#include "tests/app/report/reported_case.h"

namespace arthronaut::report {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// A case that was calibrated with the camera that its session has.
class ReportedCamera : public Report {
 protected:
  void calibrate(double focal_px) const {
    camera::CalibrationRecord record;
    record.calibration = {.image_size_px = {1920, 1080}, .focal_px = focal_px, .boundary = {{960, 540}, 520}};
    record.rms_px = 0.41;
    record.date_utc = "2026-02-03T10:00:00Z";
    record.scope_name = "Tower 3";
    camera::write_camera_file(cases::camera_file(knee_folder()), record);
  }
  std::string told(const ReportOptions& options = {}) const {
    write(pdf(), options);
    return pdf_text();
  }
};

TEST_F(ReportedCamera, OfASessionIsTheOneThatItWasNavigatedWith) {
  calibrate(600);
  (void)text_of_session("live", {});
  EXPECT_THAT(told(), AllOf(HasSubstr("Camera of the session"), HasSubstr("600.00 px"), HasSubstr("0.41 px"),
                            HasSubstr("2026-02-03"), HasSubstr("Tower 3"), Not(HasSubstr("is another one"))));
  EXPECT_THAT(told({.is_deidentified = true}), AllOf(HasSubstr("600.00 px"), Not(HasSubstr("2026-02-03"))));
  calibrate(777);  // a month later
  EXPECT_THAT(told(),
              AllOf(HasSubstr("600.00 px"), HasSubstr("The case's camera.json is another one"),
                    Not(HasSubstr("777.00 px")), Not(HasSubstr("0.41 px")), Not(HasSubstr("Tower 3"))));
  // What is wrong with the case's camera by now takes nothing away from the session's.
  files::write_atomically(cases::camera_file(knee_folder()), "{");
  EXPECT_THAT(told(), AllOf(HasSubstr("600.00 px"), Not(HasSubstr("NOT READABLE"))));
}

// The case was calibrated anew: of the session's own calibration nobody knew any more when and of which
// scope.
TEST_F(ReportedCamera, OfASessionIsToldWithItsDateAndScope) {
  (void)text_of_session("live", {});
  const auto session = cases::session_folders(knee_folder()).back();
  camera::CalibrationRecord own = camera::read_camera_file(session / "camera.json");
  own.date_utc = "2026-01-07T08:00:00Z";
  own.scope_name = "Scope 12";
  own.rms_px = 0.33;
  camera::write_camera_file(session / "camera.json", own);
  calibrate(777);
  EXPECT_THAT(told(), AllOf(HasSubstr("600.00 px"), HasSubstr("0.33 px"), HasSubstr("2026-01-07"),
                            HasSubstr("Scope 12"), HasSubstr("The case's camera.json is another one")));
  const auto camera_in = [&](const ReportOptions& options) {
    write(pdf().replace_extension(".json"), options);
    return nlohmann::json::parse(files::read_text(pdf().replace_extension(".json")))
        .at("session")
        .at("camera");
  };
  EXPECT_EQ(camera_in({}), nlohmann::json::parse(R"({"scope": "Scope 12", "head": null,
      "date_utc": "2026-01-07T08:00:00Z", "medium": "air", "rms_px": 0.33, "origin": "measured"})"));
  EXPECT_EQ(camera_in({.is_deidentified = true}).at("date_utc"), nullptr);
}

TEST_F(ReportedCamera, WithoutASessionIsTheCasesOfNow) {
  calibrate(777);
  EXPECT_THAT(told(), AllOf(HasSubstr("The case's camera now"), HasSubstr("777.00 px")));
  files::write_atomically(cases::camera_file(knee_folder()), "{");
  EXPECT_THAT(told(), AllOf(HasSubstr("NOT READABLE: camera.json: "), HasSubstr("Versions")));
}

}  // namespace
}  // namespace arthronaut::report
