#include "app/library/daily_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>

#include "navigation/camera/camera_file.h"
#include "navigation/camera/medium.h"
#include "navigation/simulator/simulated_operation.h"
#include "planning/files/utc_clock.h"
#include "tests/temporary_folder.h"

namespace arthronaut::workstation_library {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class DailyCheckTest : public ::testing::Test {
 protected:
  DailyCheckTest() {
    write_camera(provenance::Origin::Measured);
    summary_.distance_mm = 10.01;
    summary_.frame_count = 120;
    summary_.reasons.clear();
  }
  void write_camera(provenance::Origin origin) const {
    camera::CalibrationRecord record;
    record.calibration = simulator::standard_camera();
    record.provenance.origin = origin;
    camera::write_camera_file(folder_ / "camera.json", record);
  }
  [[nodiscard]] DailyKeeping keep(const fs::path& data_folder, bool is_live = true) const {
    return keep_daily_check(data_folder, summary_, look("camera 0"), is_live);
  }
  [[nodiscard]] RulerLook look(const std::string& source,
                               const std::optional<RecordedClip>& clip = {}) const {
    return {.refractive_index = camera::kSalineIndex,
            .camera_file = folder_ / "camera.json",
            .source = source,
            .clip = clip};
  }

  const test::TemporaryFolder folder_;
  calibration::FluidCheckSummary summary_;
};

TEST_F(DailyCheckTest, OfALiveArthroscopeIsKept) {
  const DailyKeeping kept = keep(folder_ / "data");
  EXPECT_TRUE(kept.is_kept);
  EXPECT_EQ(kept.text, "kept: 10.010 of 10.000 mm");
  const auto read = library::read_accuracy_checks(folder_ / "data");
  ASSERT_EQ(read.checks.size(), 1u);
  EXPECT_TRUE(read.checks[0].is_dated);
  EXPECT_EQ(read.checks[0].clip_sha256, "");
  EXPECT_TRUE(library::worst_standing(read, files::utc_now()).is_fine());
}

// Whatever hinders it is said in words of its own and thrown at nobody: the verdict of the fluid stands.
TEST_F(DailyCheckTest, WhatHindersItIsSaidAndNotThrown) {
  EXPECT_THAT(keep(folder_ / "data", false).text, HasSubstr("not kept: of a recording"));
  write_camera(provenance::Origin::Nominal);
  EXPECT_THAT(keep(folder_ / "data").text,
              ::testing::AllOf(StartsWith("not kept: "), HasSubstr("is nominal")));
  write_camera(provenance::Origin::Simulated);
  EXPECT_THAT(keep(folder_ / "data").text, HasSubstr("simulated arthroscope"));
  write_camera(provenance::Origin::Measured);
  std::ofstream(folder_ / "file") << "no folder";
  const DailyKeeping nowhere = keep(folder_ / "file");
  EXPECT_FALSE(nowhere.is_kept);
  EXPECT_THAT(nowhere.text, StartsWith("not kept: "));
  EXPECT_FALSE(fs::exists(folder_ / "data"));
}

TEST_F(DailyCheckTest, AClipIsKnownByItsBytesAndDatedByItsFile) {
  std::ofstream(folder_ / "one.mkv") << "pictures";
  fs::copy_file(folder_ / "one.mkv", folder_ / "two.mkv");
  fs::last_write_time(folder_ / "two.mkv", fs::file_time_type::clock::now() - std::chrono::hours(24 * 31));
  const auto one = recorded_clip(folder_ / "one.mkv"), two = recorded_clip(folder_ / "two.mkv");
  ASSERT_TRUE(one && two);
  EXPECT_EQ(one->sha256, two->sha256);
  EXPECT_LT(two->recorded_utc, one->recorded_utc);
  const auto check = daily_check_of(summary_, look("two.mkv", two));
  EXPECT_EQ(check.checked_utc, two->recorded_utc);
  EXPECT_EQ(check.clip_sha256, two->sha256);
  EXPECT_FALSE(recorded_clip(folder_ / "three.mkv"));
  fs::last_write_time(folder_ / "one.mkv", fs::file_time_type::clock::now() + std::chrono::hours(48));
  const auto undated = recorded_clip(folder_ / "one.mkv");
  ASSERT_TRUE(undated);
  EXPECT_FALSE(daily_check_of(summary_, look("one.mkv", undated)).is_dated);
  // Stills are one clip: another picture among them makes it another one.
  std::ofstream(folder_ / "f_0001.png") << "a";
  const std::string before = recorded_clip(folder_ / "f_%04d.png")->sha256;
  std::ofstream(folder_ / "f_0002.png") << "b";
  EXPECT_NE(recorded_clip(folder_ / "f_%04d.png")->sha256, before);
}

}  // namespace
}  // namespace arthronaut::workstation_library
