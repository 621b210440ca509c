#include "navigation/camera/camera_file.h"

#include <gtest/gtest.h>

#include <fstream>

#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"
#include "tests/message_of.h"
#include "tests/temporary_folder.h"

namespace arthronaut::camera {

namespace {

class CameraFile : public ::testing::Test {
 protected:
  std::filesystem::path file() const { return folder_ / "camera.json"; }

  // The message of the InvalidInput that reading `text` must throw.
  std::string refusal(const std::string& text) const {
    std::ofstream(file()) << text;
    return test::message_of<InvalidInput>([&] { (void)read_camera_file(file()); });
  }

  static CalibrationRecord example() {
    CalibrationRecord record;
    record.calibration = {.image_size_px = {1920, 1080},
                          .focal_px = 590.25,
                          .aspect_ratio = 1.001,
                          .principal_point_px = {962, 541.5},
                          .distortion_xi = -0.3,
                          .rotation_center_px = {958, 538},
                          .reference_mark_angle_deg = 271.3,
                          .boundary = {{960.5, 540.2}, 531},
                          .refractive_index = 1.0};
    record.calibration.covariance = CameraCovariance::Identity();
    record.rms_px = 0.2;
    record.scope_name = "4 mm, 30 degrees";
    return record;
  }

 private:
  const test::TemporaryFolder folder_;
};

std::string with(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

}  // namespace

// A file that does not say how well its camera is known is not taken for exact.
TEST_F(CameraFile, Hazard6ACameraWithoutCovarianceIsNotExact) {
  CalibrationRecord record = example();
  record.calibration.covariance.reset();
  write_camera_file(file(), record);
  const Calibration read = read_camera_file(file()).calibration;
  EXPECT_FALSE(read.covariance);
  const CameraCovariance taken = covariance_of(read);
  EXPECT_NEAR(std::sqrt(taken(0, 0)), 0.005 * read.focal_px, 1e-9);
  EXPECT_GT(taken.diagonal().minCoeff(), 0);
  EXPECT_EQ(covariance_of(example().calibration), *example().calibration.covariance);
}

TEST_F(CameraFile, RoundTripKeepsEveryNumber) {
  write_camera_file(file(), example());
  const auto read = read_camera_file(file());
  const auto expected = example();
  EXPECT_EQ(read.calibration.image_size_px, expected.calibration.image_size_px);
  EXPECT_EQ(read.calibration.focal_px, expected.calibration.focal_px);
  EXPECT_EQ(read.calibration.aspect_ratio, expected.calibration.aspect_ratio);
  EXPECT_EQ(read.calibration.principal_point_px, expected.calibration.principal_point_px);
  EXPECT_EQ(read.calibration.distortion_xi, expected.calibration.distortion_xi);
  EXPECT_EQ(read.calibration.rotation_center_px, expected.calibration.rotation_center_px);
  EXPECT_EQ(read.calibration.reference_mark_angle_deg, expected.calibration.reference_mark_angle_deg);
  EXPECT_EQ(read.calibration.boundary.center_px, expected.calibration.boundary.center_px);
  EXPECT_EQ(read.calibration.boundary.radius_px, expected.calibration.boundary.radius_px);
  EXPECT_EQ(read.calibration.refractive_index, expected.calibration.refractive_index);
  EXPECT_EQ(read.calibration.covariance, expected.calibration.covariance);
  EXPECT_EQ(read.rms_px, expected.rms_px);
  EXPECT_EQ(read.scope_name, expected.scope_name);
}

// Each refusal names the file, the place and the reason.
TEST_F(CameraFile, RefusalsNameThePlace) {
  write_camera_file(file(), example());
  const std::string good = files::read_text(file());
  const auto expect = [&](const std::string& text, const std::string& place) {
    const std::string message = refusal(text);
    EXPECT_NE(message.find("camera.json"), std::string::npos) << message;
    EXPECT_NE(message.find(place), std::string::npos) << message;
  };
  expect(with(good, "\"focal_px\"", "\"focal\""), "focal_px: is missing");
  expect(with(good, "590.25", "-1"), "focal_px");
  expect(with(good, "590.25", "\"wide\""), "focal_px: must be a number");
  expect(with(good, "590.25", "1e999"), "out of range");
  expect(with(good, "590.25", "1e300"), "focal_px: must lie between a twentieth");
  expect(with(good, "590.25", "0.59025"), "focal_px: must lie between a twentieth");
  expect(with(good, "1.001", "1001"), "aspect_ratio: must lie in");
  expect(with(good, "962", "962000"), "principal_point_px: must lie no further");
  expect(with(good, "958", "-95800"), "rotation_center_px: must lie no further");
  expect(with(good, "\"version\": 1", "\"version\": 2"), "newer");
  expect(with(good, "arthronaut.camera", "arthronaut.tools"), "format");
  expect(with(good, "\"radius_px\"", "\"radius\""), "boundary.radius_px: is missing");
  expect(with(good, "960.5", "9605"), "boundary.center_px: must lie in the image");
  expect(with(good, "540.2", "-0.2"), "boundary.center_px: must lie in the image");
  expect(with(good, "\"air\"", "\"milk\""), "medium");
  expect(with(good, "\"air\"", "\"1.3\""), "medium: must be air, water, saline or a number");
  expect(with(good, "1920", "1920.5"), "image_size_px");
  expect(with(good, "1920", "1e304"), "image_size_px");  // beyond every whole number
  expect(good.substr(0, good.size() / 2), "line");
}

TEST_F(CameraFile, AMissingFileIsAnIoError) { EXPECT_THROW((void)read_camera_file(file()), IoError); }

}  // namespace arthronaut::camera
