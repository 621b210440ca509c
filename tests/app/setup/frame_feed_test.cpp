#include "app/setup/frame_feed.h"

#include <gtest/gtest.h>

#include <fstream>

#include "app/case/case_calibration.h"
#include "app/setup/setup_sources.h"
#include "navigation/camera/camera_file.h"
#include "navigation/simulator/simulated_operation.h"
#include "navigation/sources/recovering_source.h"
#include "planning/geometry/error.h"
#include "tests/temporary_folder.h"

namespace arthronaut::setup {
namespace {

// `count` numbered pictures, then the end, or what a broken file throws.
class Numbers : public sources::FrameSource {
 public:
  Numbers(int count, bool breaks, bool ends = true) : count_(count), breaks_(breaks) { info_.ends = ends; }
  [[nodiscard]] const sources::SourceInfo& info() const override { return info_; }
  [[nodiscard]] camera::FramePtr next() override {
    if (given_ == count_) {
      if (breaks_) throw InvalidInput("clip.mkv: frame 2 is cut off");
      return nullptr;
    }
    auto frame = std::make_shared<camera::Frame>();
    frame->index = given_;
    frame->timestamp_ns = given_++ * 10'000'000;
    return frame;
  }

 private:
  int count_, given_ = 0;
  bool breaks_;
  sources::SourceInfo info_;
};

FeedSource numbers(int count, bool breaks = false) {
  FeedSource source;
  source.open = [=] { return std::make_unique<Numbers>(count, breaks); };
  return source;
}

// The next picture, however long the machine takes.
camera::FramePtr wait_for_picture(FrameFeed& feed) {
  for (int i = 0; i < 400; ++i)
    if (camera::FramePtr frame = feed.next()) return frame;
  return nullptr;
}

// Where every pose counts no picture is left out, however slow the worker is.
TEST(FrameFeed, LeavesNothingOutWhereEveryPictureCounts) {
  FeedSource source = numbers(5);
  source.newest_wins = false;
  FrameFeed feed(source);
  for (int i = 0; i < 5; ++i) {
    const camera::FramePtr frame = wait_for_picture(feed);
    ASSERT_NE(frame, nullptr);
    EXPECT_EQ(frame->index, i);
  }
  for (int i = 0; i < 400 && !feed.has_ended(); ++i) EXPECT_EQ(feed.next(), nullptr);
  EXPECT_TRUE(feed.has_ended());
}

// A still stands, the very same picture again and again, until the next one is asked for; asking twice while
// it is on its way does not skip one.
TEST(FrameFeed, StillsStandUntilTheNextIsAskedFor) {
  FeedSource source = numbers(3);
  source.is_stills = true;
  FrameFeed feed(source);
  const camera::FramePtr first = wait_for_picture(feed);
  ASSERT_NE(first, nullptr);
  EXPECT_EQ(wait_for_picture(feed), first);
  feed.advance();
  feed.advance();
  const camera::FramePtr second = wait_for_picture(feed);
  ASSERT_NE(second, nullptr);
  EXPECT_EQ(second->index, 1);
}

// What the source throws arrives at the worker, after the pictures before it, once; then it has ended.
TEST(FrameFeed, HandsErrorsToTheWorker) {
  FeedSource source = numbers(2, true);
  source.newest_wins = false;
  FrameFeed feed(source);
  EXPECT_NE(wait_for_picture(feed), nullptr);
  EXPECT_NE(wait_for_picture(feed), nullptr);
  EXPECT_THROW((void)wait_for_picture(feed), InvalidInput);
  for (int i = 0; i < 400 && !feed.has_ended(); ++i) (void)feed.next();
  EXPECT_TRUE(feed.has_ended());
}

const sources::DeviceTurns kTurns;

// A camera that is out, which its source waits for: the feed says that the source has ended, then why it does
// not come back, and ends all the same.
TEST(FrameFeed, EndsWhileItsSourceWaitsForACamera) {
  FeedSource source;
  source.is_live = true;
  source.open = [] {
    return sources::recovering([](const sources::Opening& opening) -> std::unique_ptr<sources::FrameSource> {
      if (opening.is_again) throw DeviceError("camera 0: is not connected");
      return std::make_unique<Numbers>(0, false, false);
    });
  };
  FrameFeed feed(source);
  const std::string reason = "camera 0: is not connected";
  for (int i = 0; i < 400 && feed.trouble().find(reason) == std::string::npos; ++i)
    EXPECT_EQ(feed.next(), nullptr);
  EXPECT_NE(feed.trouble().find(reason), std::string::npos) << feed.trouble();
  EXPECT_FALSE(feed.has_ended());
}

class Sources : public ::testing::Test {
 protected:
  Sources() {
    std::filesystem::create_directories(folder_ / "board");
    std::ofstream(folder_ / "board" / "b.PNG") << "x";
    std::ofstream(folder_ / "board" / "a.jpg") << "x";
    std::ofstream(folder_ / "knee.mkv") << "x";
  }
  const test::TemporaryFolder temporary_;
  const std::filesystem::path& folder_ = temporary_.path();
};

// Pictures are offered for the camera alone, videos for everything, the simulated arthroscope first.
TEST_F(Sources, AreFoundInTheCase) {
  const auto for_camera = sources_for(Purpose::Camera, folder_, kTurns);
  ASSERT_GE(for_camera.size(), 3U);
  EXPECT_EQ(for_camera[0].name, camera::kSimulatedScope);
  EXPECT_EQ(for_camera[1].name, "Pictures in board");
  EXPECT_TRUE(for_camera[1].is_stills);
  EXPECT_EQ(for_camera[2].name, "knee.mkv");
  const auto for_tools = sources_for(Purpose::Tools, folder_, kTurns);
  EXPECT_EQ(for_tools[1].name, "knee.mkv");
}

// A stream is a source of every step: named by its address, shown without its password, live.
TEST_F(Sources, AreStreamsToo) {
  for (const Purpose purpose : {Purpose::Camera, Purpose::Tools, Purpose::Fluid}) {
    const std::string address = "rtsp://nurse:secret@tower/scope";
    const auto offered = sources_for(purpose, folder_, kTurns, {address, "udp://@:5000"});
    const auto index = index_of(offered, address);
    ASSERT_TRUE(index);
    EXPECT_EQ(offered[*index].name, "rtsp://tower/scope");
    EXPECT_TRUE(offered[*index].is_live);
    EXPECT_FALSE(offered[*index].is_stills);
    EXPECT_TRUE(index_of(offered, "udp://@:5000"));
  }
}

// So is a camera that was typed with the way in which it is to be opened; what is no address is left out.
TEST_F(Sources, AreCamerasByTheirAddressToo) {
  for (const Purpose purpose : {Purpose::Camera, Purpose::Tools, Purpose::Fluid}) {
    const std::string address = "/dev/video7?size=1920x1080&rate=60";
    const auto offered = sources_for(purpose, folder_, kTurns, {address, "/dev/video7x"});
    const auto index = index_of(offered, address);
    ASSERT_TRUE(index);
    EXPECT_EQ(offered[*index].name, address);
    EXPECT_TRUE(offered[*index].is_live && offered[*index].look);
    EXPECT_FALSE(index_of(offered, "/dev/video7x"));
  }
}

// With a real scope's camera.json no step offers the simulator, but to who asks for it by its word.
TEST_F(Sources, Hazard26ARealCaseNeverOffersTheSimulatorUnasked) {
  camera::CalibrationRecord record;
  record.calibration = simulator::standard_camera();
  record.scope_name = "Scope 30";
  camera::write_camera_file(folder_ / "camera.json", record);
  for (const Purpose purpose : {Purpose::Camera, Purpose::Tools, Purpose::Fluid}) {
    for (const FeedSource& source : sources_for(purpose, folder_, kTurns)) EXPECT_FALSE(source.is_simulated);
    const auto asked = sources_for(purpose, folder_, kTurns, {kSimulatorWord});
    ASSERT_FALSE(asked.empty());
    EXPECT_TRUE(asked.back().is_simulated);
  }
  record.scope_name = camera::kSimulatedScope;
  camera::write_camera_file(folder_ / "camera.json", record);
  EXPECT_TRUE(sources_for(Purpose::Tools, folder_, kTurns).front().is_simulated);
}

// A path that was named is found among what is offered, wherever it stands; for tools a folder of pictures is
// none.
TEST_F(Sources, AreFoundByTheirPath) {
  const std::vector<std::filesystem::path> named{folder_ / "board", folder_ / "knee.mkv",
                                                 folder_ / "nothing"};
  const auto for_tools = sources_for(Purpose::Tools, folder_, kTurns, named);
  EXPECT_FALSE(index_of(for_tools, folder_ / "board").has_value());
  EXPECT_EQ(index_of(for_tools, folder_ / "knee.mkv"), 1U);
  EXPECT_FALSE(index_of(for_tools, folder_ / "nothing").has_value());
  EXPECT_FALSE(index_of(for_tools, {}).has_value());
  EXPECT_EQ(index_of(sources_for(Purpose::Camera, folder_, kTurns, named), folder_ / "knee.mkv"), 2U);
}

// A picture that is none is told by its name, not swallowed.
TEST_F(Sources, NameTheFileThatIsNoPicture) {
  FrameFeed feed(sources_for(Purpose::Camera, folder_, kTurns)[1]);
  try {
    (void)wait_for_picture(feed);
    FAIL() << "no exception";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("a.jpg"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace arthronaut::setup
