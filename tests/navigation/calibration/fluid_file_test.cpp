#include "navigation/calibration/fluid_file.h"

#include <gtest/gtest.h>

#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"
#include "tests/message_of.h"
#include "tests/temporary_folder.h"

namespace arthronaut::calibration {
namespace {

class FluidFile : public ::testing::Test {
 protected:
  static FluidRecord example() {
    FluidRecord record;
    record.refractive_index = 1.3345;
    record.reasons = {"too few frames", "the ruler comes out wrong"};
    record.best_index = 1.33;
    record.index_sigma = 0.004;
    record.median_mm = 0.25;
    record.median_deg = 1.75;
    record.frame_count = 17;
    record.source = "knee.mkv";
    record.provenance = {provenance::Origin::Simulated, "2026-11-21T10:00:00Z"};
    record.camera_sha256 = std::string(64, 'a');
    return record;
  }
  const test::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "fluid.json";
};

TEST_F(FluidFile, Hazard10KeepsEverythingThroughARoundTrip) {
  write_fluid_file(file_, example());
  const FluidRecord read = read_fluid_file(file_), expected = example();
  EXPECT_EQ(read.refractive_index, expected.refractive_index);
  EXPECT_EQ(read.is_trusted, expected.is_trusted);
  EXPECT_EQ(read.reasons, expected.reasons);
  EXPECT_EQ(read.best_index, expected.best_index);
  EXPECT_EQ(read.index_sigma, expected.index_sigma);
  EXPECT_EQ(read.median_mm, expected.median_mm);
  EXPECT_EQ(read.median_deg, expected.median_deg);
  EXPECT_EQ(read.frame_count, expected.frame_count);
  EXPECT_EQ(read.source, expected.source);
  EXPECT_EQ(read.provenance, expected.provenance);
  EXPECT_EQ(read.camera_sha256, expected.camera_sha256);
}

// A verdict that contradicts itself is none; a newer file is not guessed at.
TEST_F(FluidFile, RefusesWhatCannotBe) {
  const auto refusal = [&](const std::string& from, const std::string& to) {
    write_fluid_file(file_, example());
    std::string text = files::read_text(file_);
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    files::write_atomically(file_, text.replace(at, from.size(), to));
    return test::message_of<InvalidInput>([&] { (void)read_fluid_file(file_); });
  };
  EXPECT_NE(refusal("\"trusted\": false", "\"trusted\": true").find("reasons"), std::string::npos);
  EXPECT_NE(refusal("\"saline\"", "\"milk\"").find("medium"), std::string::npos);
  EXPECT_NE(refusal("\"version\": 1", "\"version\": 2").find("newer"), std::string::npos);
  EXPECT_NE(refusal(": 17", ": -1").find("frame_count"), std::string::npos);
}

// A check says what its record says; one that was not run is not trusted.
TEST_F(FluidFile, TakesTheNumbersOfACheck) {
  FluidCheckSummary summary;
  EXPECT_FALSE(record_of(summary, 1.3345).is_trusted);
  summary.reasons.clear();
  summary.rows = {{FluidHypothesis::NoRefraction, 0.1, 9, 9, 9, 9},
                  {FluidHypothesis::FlatPort, 0.2, 0.03, 0.2, 1, 2}};
  summary.frame_count = 60;
  const FluidRecord record = record_of(summary, 1.3345);
  EXPECT_TRUE(record.is_trusted);
  EXPECT_EQ(record.median_mm, 0.03);
  EXPECT_EQ(record.median_deg, 0.2);
  EXPECT_EQ(record.frame_count, 60U);
}

}  // namespace
}  // namespace arthronaut::calibration
