// `arthronaut check-fluid`, run as a user runs it: a simulated ruler in saline, the same behind a port that
// does not refract, and input that is to be refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "navigation/camera/camera_file.h"
#include "navigation/camera/medium.h"
#include "navigation/recording/video_encoder.h"
#include "navigation/simulator/simulated_ruler.h"
#include "planning/files/atomic_file.h"
#include "planning/files/json_document.h"
#include "tests/app/command_line/program.h"
#include "tests/resources/described.h"
#include "tests/temporary_folder.h"

namespace arthronaut {
namespace {

using test::run_program;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class CheckFluidCommand : public ::testing::Test {
 protected:
  CheckFluidCommand() {
    camera::CalibrationRecord record;
    record.calibration = simulator::standard_camera();
    camera::write_camera_file(folder_ / "camera.json", record);
    write_tools(R"({"name": "ruler end", "marker_id": 6, "size_mm": 2.89})");
  }
  void write_tools(const std::string& tools) const {
    test::write_file(folder_ / "tools.json",
                     R"({"format": "arthronaut.tools", "version": 1, "world_markers":
                         [{"bone": "femur", "marker_id": 5, "size_mm": 2.89}], "tools": [)" +
                         tools + "]}");
  }
  void write_clip(double refractive_index, int frame_count) const {
    simulator::RulerOptions scene;
    scene.camera = simulator::standard_camera();
    scene.refractive_index = refractive_index;
    scene.frame_count = frame_count;
    simulator::SimulatedRuler source(scene);
    recording::VideoEncoder encoder(folder_ / "clip.mkv", 1920, 1080, 30);
    while (const camera::FramePtr frame = source.next()) encoder.encode(*frame);
    encoder.finish();
  }
  [[nodiscard]] test::ProgramResult check(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"check-fluid",           "--camera",
                                       folder_ / "camera.json", "--tools",
                                       folder_ / "tools.json",  folder_ / "clip.mkv"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments);
  }

  test::TemporaryFolder folder_;
};

// The flat port in saline fits, the index comes back to a hundredth, and the file says the same as the table.
TEST_F(CheckFluidCommand, TrustsSaline) {
  write_clip(camera::kSalineIndex, 24);
  const auto result = check({"-o", folder_ / "check.json"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.output, AllOf(HasSubstr("flat port"), HasSubstr("focal length times index"),
                                   HasSubstr("no refraction"), HasSubstr("can be trusted")));
  const auto document = files::read_json(folder_ / "check.json", "arthronaut.fluid_check", 1);
  EXPECT_EQ(test::undescribed(nlohmann::json::parse(files::read_text(folder_ / "check.json")), "fluid_check"),
            "");
  EXPECT_NEAR(document.number("best_index"), camera::kSalineIndex, 0.01);
  EXPECT_EQ(document.objects("models").front().text("model"), "flat port");

  // Half the spacing is another ruler: told, as nothing fits it.
  const auto other = check({"--spacing-mm", "5"});
  EXPECT_EQ(other.exit_code, 4);
  EXPECT_THAT(other.errors, HasSubstr("the ruler comes out wrong"));
}

// No refraction though saline is stated: not trusted, with what fits instead; standard output is the result
// alone.
TEST_F(CheckFluidCommand, DoubtsAPortThatDoesNotRefract) {
  write_clip(camera::kAirIndex, 24);
  const auto result = check({"--medium", "saline", "-o", "-"});
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_THAT(result.errors, HasSubstr("no refraction explains the frames better"));
  EXPECT_THAT(result.output, AllOf(HasSubstr("\"reliable\": false"), Not(HasSubstr("markers 5"))));
}

// Too short a clip is no check.
TEST_F(CheckFluidCommand, DoubtsAFewFrames) {
  write_clip(camera::kSalineIndex, 3);
  const auto result = check();
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_THAT(result.errors, HasSubstr("needs 20"));
}

// Which two markers are the ruler's must be clear, and they must be of one size.
TEST_F(CheckFluidCommand, RefusesToolsThatAreNoRuler) {
  test::write_file(folder_ / "clip.mkv", "never read");
  write_tools(R"({"name": "ruler end", "marker_id": 6, "size_mm": 4})");
  auto result = check();
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.errors, AllOf(HasSubstr("tools.json"), HasSubstr("marker 6"), HasSubstr("size")));

  write_tools(R"({"name": "ruler end", "marker_id": 6, "size_mm": 2.89},
                 {"name": "probe", "marker_id": 2, "size_mm": 4})");
  result = check();
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.errors, AllOf(HasSubstr("tools.json"), HasSubstr("3 markers")));
  result = check({"--markers", "5,9"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.errors, HasSubstr("marker 9"));
  EXPECT_EQ(check({"--markers", "5"}).exit_code, 2);
}

// The day's check: the ruler measured (to 0.05 mm, what the product asks of the median), kept in the library,
// listed with its standing; another ruler than the stated one is off, and what is simulated is not kept.
TEST_F(CheckFluidCommand, AccuracyIsMeasuredKeptAndListed) {
  write_clip(camera::kSalineIndex, 24);
  const auto accuracy = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "accuracy");
    return run_program(arguments, {.data_home = folder_ / "home"});
  };
  const std::vector<std::string> look{
      "check", "--camera", folder_ / "camera.json", "--tools", folder_ / "tools.json", folder_ / "clip.mkv"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), look.begin(), look.end());
    return more;
  };
  EXPECT_EQ(accuracy({"list"}).exit_code, 4);
  EXPECT_THAT(accuracy({"list"}).errors, HasSubstr("never checked"));
  EXPECT_EQ(accuracy(with({"--no-keep"})).exit_code, 0);
  EXPECT_EQ(accuracy({"list"}).exit_code, 4);

  const auto first = accuracy(with({"--device", "scope 4"}));
  ASSERT_EQ(first.exit_code, 0) << first.errors;
  EXPECT_THAT(first.output, AllOf(HasSubstr("scope 4, in saline: 24 frames"), HasSubstr("checked today")));
  const auto listed = accuracy({"list", "--json"});
  EXPECT_EQ(listed.exit_code, 0) << listed.errors;
  const auto json = nlohmann::json::parse(listed.output);
  EXPECT_EQ(test::undescribed(json, "accuracy_list"), "");
  ASSERT_EQ(json.at("checks").size(), 1u);
  EXPECT_NEAR(json["checks"][0].at("distance_mm").get<double>(), 10.0, 0.05);
  EXPECT_EQ(json["checks"][0].at("frames"), 24);
  EXPECT_EQ(json.at("devices").at(0).at("fine"), true);

  // The same clip under another name and a month later is the same measurement.
  std::filesystem::copy_file(folder_ / "clip.mkv", folder_ / "again.mkv");
  auto again = look;
  again.back() = folder_ / "again.mkv";
  const auto twice = accuracy(again);
  EXPECT_EQ(twice.exit_code, 3);
  EXPECT_THAT(twice.errors, AllOf(HasSubstr("again.mkv"), HasSubstr("kept already")));
  EXPECT_EQ(nlohmann::json::parse(accuracy({"list", "--json"}).output).at("checks").size(), 1u);

  // Last month's clip is last month's check, and one that says it comes from the future is of no day.
  write_clip(camera::kSalineIndex, 26);
  const auto now = std::filesystem::file_time_type::clock::now();
  std::filesystem::last_write_time(folder_ / "clip.mkv", now - std::chrono::hours(24 * 31));
  const auto old = accuracy(with({"--device", "scope 5"}));
  EXPECT_EQ(old.exit_code, 4);
  EXPECT_THAT(old.output, HasSubstr("scope 5: accuracy not checked today"));
  write_clip(camera::kSalineIndex, 27);
  std::filesystem::last_write_time(folder_ / "clip.mkv", now + std::chrono::hours(24));
  const auto unknown = accuracy(with({"--device", "scope 6"}));
  EXPECT_EQ(unknown.exit_code, 4);
  EXPECT_THAT(unknown.output, HasSubstr("when recorded unknown"));

  write_clip(camera::kSalineIndex, 25);
  const auto off = accuracy(with({"--device", "scope 4", "--spacing-mm", "10.5"}));
  EXPECT_EQ(off.exit_code, 4);
  EXPECT_THAT(off.errors, HasSubstr("the ruler comes out wrong"));
  EXPECT_EQ(accuracy({"list"}).exit_code, 4);

  camera::CalibrationRecord simulated;
  simulated.calibration = simulator::standard_camera();
  simulated.provenance.origin = provenance::Origin::Simulated;
  camera::write_camera_file(folder_ / "camera.json", simulated);
  const auto refused = accuracy(look);
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_THAT(refused.errors, HasSubstr("kept already"));
  const auto simulated_scope = accuracy(with({"--no-keep"}));
  EXPECT_EQ(simulated_scope.exit_code, 3);
  EXPECT_THAT(simulated_scope.errors, HasSubstr("simulated arthroscope"));
}

}  // namespace
}  // namespace arthronaut
