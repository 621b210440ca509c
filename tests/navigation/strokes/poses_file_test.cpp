#include "navigation/strokes/poses_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "planning/geometry/error.h"
#include "tests/message_of.h"
#include "tests/temporary_folder.h"

namespace arthronaut::strokes {

namespace {

constexpr const char* kHeader =
    "frame,time_s,marker_id,qw,qx,qy,qz,tx_mm,ty_mm,tz_mm,rms_px,mark_angle_deg\n";

// With which a file of this name and text is refused.
std::string error_of(const std::string& name, const std::string& text) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / name) << text;
  return test::message_of<InvalidInput>([&] { (void)read_poses_file(folder / name); });
}

}  // namespace

// What is written is read back: the file's nine digits leave less than 1e-6 mm and 1e-8 rad.
TEST(PosesFile, RoundTripKeepsPosesAndEmptyMarkAngles) {
  PoseRow first, second;
  first.frame = 3;
  first.time_s = 0.05;
  first.marker_id = 2;
  first.camera_from_marker.rotation = Eigen::Quaterniond(0.5, -0.5, 0.5, 0.5);
  first.camera_from_marker.translation_mm = {1.25, -2.5, 30.123456};
  first.rms_px = 0.125;
  second = first;
  second.frame = 4;
  second.mark_angle_deg = 271.3;
  second.size_mm = 2.89;
  const test::TemporaryFolder folder;
  const auto file = folder / "poses.csv";
  write_poses_file(file, {first, second});
  const auto rows = read_poses_file(file);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].frame, 3);
  EXPECT_EQ(rows[0].marker_id, 2);
  EXPECT_FALSE(rows[0].mark_angle_deg.has_value());
  EXPECT_NEAR(rows[1].mark_angle_deg.value(), 271.3, 1e-6);
  EXPECT_FALSE(rows[0].size_mm.has_value());
  EXPECT_EQ(rows[1].size_mm.value(), 2.89);
  EXPECT_LT((rows[0].camera_from_marker.translation_mm - first.camera_from_marker.translation_mm).norm(),
            1e-6);
  EXPECT_LT(rows[0].camera_from_marker.rotation.angularDistance(first.camera_from_marker.rotation), 1e-8);
}

// A number that is no rotation, time that runs backwards, a missing column: each is refused with its place.
TEST(PosesFile, RefusesWhatBreaksTheContract) {
  const std::string row = "0,0,2,1,0,0,0,1,2,3,0.1,\n";
  EXPECT_THAT(error_of("twice.csv", kHeader + row + row),
              testing::AllOf(testing::HasSubstr("line 3"), testing::HasSubstr("second pose")));
  EXPECT_THAT(
      error_of("norm.csv", std::string(kHeader) + "0,0,0,0.9,0,0,0,1,2,3,0.1,\n"),
      testing::AllOf(testing::HasSubstr("norm.csv"), testing::HasSubstr("qw"), testing::HasSubstr("norm")));
  EXPECT_THAT(
      error_of("time.csv", std::string(kHeader) + "0,0.5,0,1,0,0,0,1,2,3,0.1,\n1,0.4,0,1,0,0,0,1,2,3,0.1,\n"),
      testing::HasSubstr("backwards"));
  EXPECT_THAT(error_of("nan.csv", std::string(kHeader) + "0,0,0,1,0,0,0,nan,2,3,0.1,\n"),
              testing::HasSubstr("tx_mm"));
  EXPECT_THAT(error_of("column.csv", "frame,time_s,marker_id\n0,0,0\n"), testing::HasSubstr("qw"));
  for (const char* angle : {"360", "-0.5"})
    EXPECT_THAT(error_of("angle.csv", std::string(kHeader) + "0,0,0,1,0,0,0,1,2,3,0.1," + angle + "\n"),
                testing::HasSubstr("line 2, column mark_angle_deg: is not within [0, 360)"));
  const std::string position = "line 2, column tz_mm: lies more than ten metres off";
  for (const char* off : {"10001", "-1e300"})
    EXPECT_THAT(error_of("far.csv", std::string(kHeader) + "0,0,2,1,0,0,0,1,2," + off + ",0.1,\n"),
                testing::HasSubstr(position));
  for (const auto& [below, column] : {std::pair{"-1,0,2,1,0,0,0,1,2,3,0.1,\n", "frame"},
                                      std::pair{"0,0,-2,1,0,0,0,1,2,3,0.1,\n", "marker_id"},
                                      std::pair{"0,0,2,1,0,0,0,1,2,3,-0.1,\n", "rms_px"}})
    EXPECT_THAT(error_of("below.csv", std::string(kHeader) + below),
                testing::HasSubstr("line 2, column " + std::string(column) + ": must not be negative"));
  // 2^32 + 4 is no marker 4.
  EXPECT_THAT(
      error_of("id.csv", std::string(kHeader) + "0,0,4294967300,1,0,0,0,1,2,3,0.1,\n"),
      testing::AllOf(testing::HasSubstr("line 2, column marker_id"), testing::HasSubstr("out of range")));
  EXPECT_THROW((void)read_poses_file("/nowhere/poses.csv"), IoError);
}

}  // namespace arthronaut::strokes
