// `arthronaut calibrate`, run as a user runs it: pictures of the simulator whose camera is known, and every
// kind of picture that must be refused or doubted.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "navigation/camera/camera_file.h"
#include "navigation/simulator/simulated_operation.h"
#include "planning/files/atomic_file.h"
#include "tests/app/command_line/program.h"
#include "tests/navigation/calibration/board_scene.h"
#include "tests/temporary_folder.h"

namespace arthronaut {
namespace {

using calibration::board_pose;
using test::run_program;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kSquare_mm = 1.5;

// The simulator's stills, rendered once for all tests: lens at -100, -50, 0, 50 and 100 degrees.
const std::vector<cv::Mat>& simulated_stills() {
  static const std::vector<cv::Mat> stills = [] {
    simulator::SimulationOptions options;
    options.knee = phantom::make_phantom_knee();
    options.camera = simulator::standard_camera();
    options.tools = tools::standard_tools();
    options.plan = options.knee.femoral_tunnel;
    options.square_mm = kSquare_mm;
    simulator::SimulatedOperation source(options, simulator::Phase::Calibrate);
    std::vector<cv::Mat> list;
    while (const camera::FramePtr frame = source.next()) {
      cv::Mat still(frame->height, frame->width, CV_8UC3);
      std::copy(frame->bgr.begin(), frame->bgr.end(), still.data);
      list.push_back(still);
    }
    return list;
  }();
  return stills;
}

// Half the size, for pictures that are drawn here.
camera::Calibration small_scope() {
  camera::Calibration scope;
  scope.image_size_px = {960, 540};
  scope.focal_px = 295;
  scope.principal_point_px = {481, 270.5};
  scope.distortion_xi = -0.30;
  scope.rotation_center_px = {477, 266};
  scope.reference_mark_angle_deg = 271.3;
  scope.boundary = {{480, 269.8}, 262};
  return scope;
}

class CalibrateCommand : public ::testing::Test {
 protected:
  void write(const std::string& name, const cv::Mat& picture) const { cv::imwrite(folder_ / name, picture); }
  void write_stills() const {
    write("a.png", simulated_stills()[0]);
    write("b.png", simulated_stills()[2]);
    write("c.png", simulated_stills()[4]);
  }
  void write_drawn(const std::string& name, const calibration::BoardView& view, unsigned seed) const {
    calibration::GrayPicture drawn = calibration::draw_board(small_scope(), view, 3, 1.0, seed);
    write(name, cv::Mat(drawn.height, drawn.width, CV_8UC1, drawn.gray.data()));
  }
  [[nodiscard]] test::ProgramResult calibrate(const std::string& square_mm,
                                              const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"calibrate",   "--square-mm",     square_mm,        "-o",
                                       camera_file(), folder_ / "a.png", folder_ / "b.png"};
    if (std::filesystem::exists(folder_ / "c.png")) arguments.push_back(folder_ / "c.png");
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments);
  }
  [[nodiscard]] std::string camera_file() const { return folder_ / "camera.json"; }
  void expect_refused(const test::ProgramResult& result) const {
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_EQ(result.output, "");
    EXPECT_FALSE(std::filesystem::exists(camera_file()));
  }
  // Done, written, and not to be relied upon.
  void expect_doubted(const test::ProgramResult& result) const {
    EXPECT_EQ(result.exit_code, 4) << result.errors;
    // The file says so too, and why: it is what goes on to others.
    std::ifstream stream(camera_file());
    const auto camera = nlohmann::json::parse(stream);
    EXPECT_EQ(camera.at("reliable"), false);
    ASSERT_FALSE(camera.at("reasons").empty());
    for (const std::string reason : camera.at("reasons")) EXPECT_THAT(result.errors, HasSubstr(reason));
  }

  test::TemporaryFolder folder_;
};

// The known camera comes back, with everything asked for; one of the pictures is a grey one, which is as
// good.
TEST_F(CalibrateCommand, FindsTheSimulatorsCamera) {
  write_stills();
  cv::Mat gray;
  cv::cvtColor(simulated_stills()[2], gray, cv::COLOR_BGR2GRAY);
  write("b.png", gray);
  const auto result = calibrate("1.5", {"--plot", folder_ / "plot.png", "--scope", "S1", "--head", "H1"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.output,
              AllOf(HasSubstr("b.png"), HasSubstr("focal length"), HasSubstr("mm from the lens")));
  const camera::CalibrationRecord record = camera::read_camera_file(camera_file());
  const camera::Calibration &found = record.calibration, truth = simulator::standard_camera();
  EXPECT_NEAR(found.focal_px / truth.focal_px, 1, 0.003);
  EXPECT_NEAR(found.distortion_xi, truth.distortion_xi, 0.006);
  EXPECT_LT((found.rotation_center_px - truth.rotation_center_px).norm(), 1.5);
  EXPECT_TRUE(record.calibration.covariance);
  EXPECT_EQ(record.scope_name, "S1");
  EXPECT_EQ(record.head_name, "H1");
  EXPECT_FALSE(record.date_utc.empty());
  const cv::Mat plot = cv::imread(folder_ / "plot.png");
  EXPECT_EQ(plot.cols, 1600);
}

// Standard output is the file alone.
TEST_F(CalibrateCommand, WritesToStandardOutput) {
  write_stills();
  const auto result = run_program({"calibrate", "--square-mm", "1.5", "-o", "-", folder_ / "a.png",
                                   folder_ / "b.png", folder_ / "c.png"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  test::write_file(camera_file(), result.output);
  EXPECT_NEAR(camera::read_camera_file(camera_file()).calibration.focal_px, 578.4, 1.8);
}

TEST_F(CalibrateCommand, RefusesTwoPictures) {
  write("a.png", simulated_stills()[0]);
  write("b.png", simulated_stills()[2]);
  const auto result = calibrate("1.5");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.errors, AllOf(HasSubstr("three pictures"), HasSubstr("has 2")));
  EXPECT_FALSE(std::filesystem::exists(camera_file()));
}

TEST_F(CalibrateCommand, RefusesPicturesOfDifferentSize) {
  write_stills();
  cv::Mat smaller;
  cv::resize(simulated_stills()[2], smaller, {1280, 720}, 0, 0, cv::INTER_AREA);
  write("b.png", smaller);
  const auto result = calibrate("1.5");
  expect_refused(result);
  EXPECT_THAT(result.errors, AllOf(HasSubstr("b.png"), HasSubstr("1280 x 720"), HasSubstr("1920 x 1080")));
}

// Texture, and a regular pattern of dots, are no checkerboard.
TEST_F(CalibrateCommand, RefusesWhatIsNoCheckerboard) {
  write_stills();
  cv::Mat texture(540, 960, CV_8UC3);
  cv::RNG(5).fill(texture, cv::RNG::UNIFORM, 40, 200);
  cv::GaussianBlur(texture, texture, {}, 3);
  cv::resize(texture, texture, {1920, 1080});
  write("b.png", texture);
  auto result = calibrate("1.5");
  expect_refused(result);
  EXPECT_THAT(result.errors, AllOf(HasSubstr("b.png"), HasSubstr("no checkerboard")));

  cv::Mat dots(1080, 1920, CV_8UC3, cv::Scalar::all(190));
  for (int y = 60; y < 1080; y += 60)
    for (int x = 60; x < 1920; x += 60)
      cv::circle(dots, {x, y}, 18, cv::Scalar::all(30), cv::FILLED, cv::LINE_AA);
  write("b.png", dots);
  result = calibrate("1.5");
  expect_refused(result);
  EXPECT_THAT(result.errors, HasSubstr("b.png"));
}

TEST_F(CalibrateCommand, RefusesSixteenBitsAndFilesThatAreNoPictures) {
  write_stills();
  cv::Mat deep;
  simulated_stills()[2].convertTo(deep, CV_16UC3, 257);
  write("b.png", deep);
  auto result = calibrate("1.5");
  expect_refused(result);
  EXPECT_THAT(result.errors, AllOf(HasSubstr("b.png"), HasSubstr("16 bits")));

  test::write_file(folder_ / "b.png", "no picture");
  result = calibrate("1.5");
  expect_refused(result);
  EXPECT_THAT(result.errors, HasSubstr("b.png"));
}

// Written, since a bench may want it, but said to be unreliable: boards that all face the lens.
TEST_F(CalibrateCommand, DoubtsBoardsThatFaceTheLens) {
  write_drawn("a.png", {board_pose(18, 1, 30, 5), 0}, 1);
  write_drawn("b.png", {board_pose(20, 2, 120, 33), 60}, 2);
  write_drawn("c.png", {board_pose(22, 1, 250, 71), -70}, 3);
  const auto result = calibrate("3");
  expect_doubted(result);
  EXPECT_THAT(result.errors, HasSubstr("face the lens"));
}

TEST_F(CalibrateCommand, DoubtsALensThatWasNotTurned) {
  write_drawn("a.png", {board_pose(18, 20, 30, 5), 3}, 1);
  write_drawn("b.png", {board_pose(20, 26, 120, 33), 3}, 2);
  write_drawn("c.png", {board_pose(22, 34, 250, 71), 3}, 3);
  const auto result = calibrate("3");
  expect_doubted(result);
  EXPECT_THAT(result.errors, AllOf(HasSubstr("was turned by"), Not(HasSubstr("face the lens"))));
}

// Squares twice, half or 25.4 times their size put the boards where no arthroscope works; the distance that
// was measured by hand tells half as much again, too.
TEST_F(CalibrateCommand, DoubtsAWrongSquareSize) {
  write_stills();
  for (const char* square_mm : {"3", "38.1", "0.6"}) {
    const auto result = calibrate(square_mm);
    expect_doubted(result);
    EXPECT_THAT(result.errors, HasSubstr("side of a square")) << square_mm;
  }
  const auto told = calibrate("2.25", {"--distance-mm", "22"});
  expect_doubted(told);
  EXPECT_THAT(told.errors, AllOf(HasSubstr("22 mm"), HasSubstr("side of a square")));
  EXPECT_EQ(calibrate("1.5", {"--distance-mm", "22"}).exit_code, 0);
}

}  // namespace
}  // namespace arthronaut
