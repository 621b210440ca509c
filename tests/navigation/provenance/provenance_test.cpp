#include "navigation/provenance/provenance.h"

#include <gtest/gtest.h>

#include "navigation/camera/camera_file.h"
#include "navigation/tools/tool_set.h"
#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"
#include "tests/message_of.h"
#include "tests/temporary_folder.h"

namespace arthronaut::provenance {
namespace {

class ProvenanceInFiles : public ::testing::Test {
 protected:
  static camera::CalibrationRecord camera_of(Origin origin, const std::string& calibrated_utc) {
    camera::CalibrationRecord record;
    record.calibration.image_size_px = {1920, 1080};
    record.calibration.focal_px = 590;
    record.calibration.boundary = {{960, 540}, 531};
    record.provenance = {origin, calibrated_utc};
    return record;
  }
  // The file with everything from this member's name to the end of its line left out.
  static void forget(const std::filesystem::path& file, const std::string& member) {
    std::string text = files::read_text(file);
    for (auto at = text.find('"' + member + '"'); at != std::string::npos;
         at = text.find('"' + member + '"')) {
      const auto begin = text.rfind(',', at), end = text.find('\n', at);
      text.erase(begin, text.find_first_of(",\n", text.find(':', at)) - begin);
      (void)end;
    }
    files::write_atomically(file, text);
  }
  const test::TemporaryFolder folder_;
  const std::filesystem::path camera_file_ = folder_ / "camera.json", tools_file_ = folder_ / "tools.json";
};

// Each origin and its date survive both files; a simulated one stays simulated through any number of rounds.
TEST_F(ProvenanceInFiles, Hazard6TravelsWithCameraAndTools) {
  for (const Origin origin : {Origin::Measured, Origin::Nominal, Origin::Simulated}) {
    const Provenance expected{origin, "2026-11-21T10:00:00Z"};
    camera::CalibrationRecord camera = camera_of(origin, expected.calibrated_utc);
    tools::ToolSet tools = tools::standard_tools();
    tools.tools.front().provenance = expected;
    for (int round = 0; round < 3; ++round) {
      camera::write_camera_file(camera_file_, camera);
      camera = camera::read_camera_file(camera_file_);
      EXPECT_EQ(camera.provenance, expected);
      tools::write_tools_file(tools_file_, tools);
      tools = tools::read_tools_file(tools_file_);
      EXPECT_EQ(tools.tools.front().provenance, expected);
      EXPECT_EQ(tools.tools.back().provenance, Provenance{});
    }
  }
}

// Files from before the fields: a camera was measured on its date, a tool is nominal.
TEST_F(ProvenanceInFiles, Hazard6OldFilesStayReadable) {
  camera::CalibrationRecord old = camera_of(Origin::Nominal, "");
  old.date_utc = "2026-03-01T08:00:00Z";
  camera::write_camera_file(camera_file_, old);
  forget(camera_file_, "origin");
  forget(camera_file_, "calibrated_utc");
  ASSERT_EQ(files::read_text(camera_file_).find("origin"), std::string::npos);
  EXPECT_EQ(camera::read_camera_file(camera_file_).provenance, (Provenance{Origin::Measured, old.date_utc}));
  tools::ToolSet tools = tools::standard_tools();
  tools.tools.front().provenance = {Origin::Measured, ""};
  tools::write_tools_file(tools_file_, tools);
  forget(tools_file_, "origin");
  EXPECT_EQ(tools::read_tools_file(tools_file_).tools.front().provenance, Provenance{});
}

// What names the simulated arthroscope as its scope is simulated, however it is spelt and whatever else the
// file says: so does the demonstration, and so did files from before the field.
TEST_F(ProvenanceInFiles, Hazard26TheSimulatedScopeIsKnownByItsName) {
  for (const char* name : {"Simulated arthroscope", "simulated arthroscope"}) {
    camera::CalibrationRecord record = camera_of(Origin::Measured, "");
    record.scope_name = name;
    camera::write_camera_file(camera_file_, record);
    EXPECT_EQ(camera::read_camera_file(camera_file_).provenance.origin, Origin::Simulated);
  }
}

TEST_F(ProvenanceInFiles, RefusesOtherWordsAndNoDates) {
  const auto refusal_of = [&](const Provenance& provenance, const std::string& from, const std::string& to) {
    camera::write_camera_file(camera_file_, camera_of(provenance.origin, provenance.calibrated_utc));
    std::string text = files::read_text(camera_file_);
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos);
    files::write_atomically(camera_file_, text.replace(at, from.size(), to));
    return test::message_of<InvalidInput>([&] { (void)camera::read_camera_file(camera_file_); });
  };
  const Provenance good{Origin::Nominal, "2026-11-21T10:00:00Z"};
  EXPECT_NE(refusal_of(good, "\"nominal\"", "\"guessed\"").find("origin: must be measured"),
            std::string::npos);
  for (const char* no_date : {"2026-13-21", "2026-02-30", "21.11.2026", "2026-11-21T25:00:00Z", "yesterday"})
    EXPECT_NE(refusal_of(good, good.calibrated_utc, no_date).find("calibrated_utc"), std::string::npos)
        << no_date;
}

// Found by means of something simulated is simulated.
TEST(Provenance, Hazard26WhatIsFoundWithTheSimulatorIsSimulated) {
  EXPECT_EQ(found_with(Origin::Measured, Origin::Simulated), Origin::Simulated);
  EXPECT_EQ(found_with(Origin::Simulated, Origin::Measured), Origin::Simulated);
  EXPECT_EQ(found_with(Origin::Measured, Origin::Measured), Origin::Measured);
}

// Across the end of a month, a leap day and a year; a date alone is its midnight.
TEST(Provenance, CountsDays) {
  EXPECT_EQ(days_between("2026-11-21", "2026-11-24"), 3);
  EXPECT_EQ(days_between("2028-02-28T12:00:00Z", "2028-03-01T00:00:00Z"), 1.5);
  EXPECT_EQ(days_between("2026-12-31", "2025-12-31"), -365);
  EXPECT_EQ(days_between("", "2026-11-24"), std::nullopt);
}

}  // namespace
}  // namespace arthronaut::provenance
