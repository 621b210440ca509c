#include "app/navigate/camera_choice.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "app/navigate/known_streams.h"
#include "planning/files/private_folder.h"
#include "planning/geometry/error.h"
#include "tests/temporary_folder.h"

namespace arthronaut::navigate {
namespace {

TEST(CameraChoice, OffersCamerasThenStreamsThenTheField) {
  CameraChoice choice;
  EXPECT_FALSE(choice.chosen());
  choice.open({{2, "Capture card"}}, {"rtsp://nurse:secret@tower/scope"});
  ASSERT_TRUE(choice.chosen());
  EXPECT_EQ(choice.chosen()->name, "Capture card");
  EXPECT_EQ(choice.chosen()->device, 2);
  choice.choose_next();
  ASSERT_TRUE(choice.chosen());
  EXPECT_EQ(choice.chosen()->device, std::nullopt);
  EXPECT_EQ(choice.chosen()->address, "rtsp://nurse:secret@tower/scope");
  EXPECT_EQ(choice.chosen()->name, "rtsp://tower/scope") << "no password on the screen";
  EXPECT_FALSE(choice.wants_text());
  choice.choose_next();
  EXPECT_FALSE(choice.chosen()) << "the field";
  EXPECT_TRUE(choice.wants_text());
  choice.choose_next();
  EXPECT_EQ(choice.chosen()->name, "Capture card");
  choice.close();
  EXPECT_FALSE(choice.is_open() || choice.chosen() || choice.wants_text());
}

// What was used before is what is opened again.
TEST(CameraChoice, WhatWasUsedBeforeIsChosen) {
  const LivePictures stream{"udp://@:5000", std::nullopt, "udp://@:5000"};
  CameraChoice choice;
  choice.open({{0, "Webcam"}}, {"rtsp://tower/scope", "udp://@:5000"}, stream);
  EXPECT_EQ(choice.chosen(), stream);
  choice.open({{0, "Webcam"}}, {"rtsp://tower/scope"}, LivePictures{"Scope", 3, ""});
  EXPECT_EQ(choice.chosen()->name, "Webcam") << "it is gone";
}

// Gives a picture every few milliseconds.
class Gives final : public sources::FrameSource {
 public:
  [[nodiscard]] const sources::SourceInfo& info() const override { return info_; }
  [[nodiscard]] camera::FramePtr next() override {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return std::make_shared<camera::Frame>();
  }

 private:
  sources::SourceInfo info_;
};

// A sender that is off now gives its place to one that is on, until a hand has chosen.
TEST(CameraChoice, WhatAnswersIsChosenInPlaceOfWhatDoesNot) {
  const LivePictures silent{"udp://@:5000", std::nullopt, "udp://@:5000"};
  CameraChoice choice;
  choice.open({}, {"udp://@:5000", "udp://@:5001"}, silent,
              [&](const LivePictures& one) -> std::unique_ptr<sources::FrameSource> {
                if (one == silent) throw DeviceError("nobody there");
                return std::make_unique<Gives>();
              });
  EXPECT_EQ(choice.chosen(), silent);
  for (int i = 0; i < 2000 && choice.chosen() == silent; ++i) {
    choice.prefer_what_answers();
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_EQ(choice.chosen()->address, "udp://@:5001");
  EXPECT_FALSE(choice.chosen_does_not_answer());
  choice.choose_next_offered();
  choice.prefer_what_answers();
  EXPECT_EQ(choice.chosen(), silent) << "a hand wants it all the same";
  EXPECT_TRUE(choice.chosen_does_not_answer());
}

// What is navigated by is not opened a second time, and answers all the same.
TEST(CameraChoice, WhatIsNavigatedByStaysChosen) {
  const LivePictures open{"udp://@:5000", std::nullopt, "udp://@:5000"};
  CameraChoice choice;
  std::atomic<bool> other_is_read = false;
  choice.open({}, {"udp://@:5000", "udp://@:5001"}, open,
              [&](const LivePictures& one) -> std::unique_ptr<sources::FrameSource> {
                if (one == open) return nullptr;
                other_is_read = true;
                return std::make_unique<Gives>();
              });
  for (int i = 0; i < 2000 && !other_is_read; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  std::this_thread::sleep_for(std::chrono::milliseconds(200));  // the other one gives pictures by now
  choice.prefer_what_answers();
  EXPECT_EQ(choice.chosen(), open);
  EXPECT_FALSE(choice.chosen_does_not_answer());
}

// A stream whose sender was not on yet is kept nowhere. The foot that asks again gets it, and no webcam.
TEST(CameraChoice, AStreamThatGaveNoPictureIsAskedAgainByAFoot) {
  const LivePictures stream{"udp://@:5000", std::nullopt, "udp://@:5000"};
  CameraChoice choice;
  choice.open({{0, "Webcam"}}, {}, stream);
  EXPECT_EQ(choice.chosen(), stream);
  choice.open({}, {}, stream);
  EXPECT_EQ(choice.chosen(), stream);
  EXPECT_FALSE(choice.wants_text()) << "a press of the pedal opens it";
  const LivePictures secret{"rtsp://tower/scope", std::nullopt, "rtsp://nurse:secret@tower/scope"};
  choice.open({}, {}, secret);
  EXPECT_EQ(choice.chosen(), secret);
}

// An address that was mistyped is put right, not typed anew; a password does not come up again.
TEST(CameraChoice, WhatDidNotOpenStandsInTheField) {
  CameraChoice choice;
  choice.open({}, {}, LivePictures{"rtsp://towr/scope", std::nullopt, "rtsp://towr/scope"});
  EXPECT_EQ(choice.typed(), "rtsp://towr/scope");
  choice.open({}, {}, LivePictures{"rtsp://tower/scop", std::nullopt, "rtsp://nurse:secret@tower/scop"});
  EXPECT_EQ(choice.typed(), "");
}

// Where nothing is connected and nothing known, an address is all there is to say.
TEST(CameraChoice, WithoutAnyTheFieldWaits) {
  CameraChoice choice;
  choice.open({}, {});
  EXPECT_TRUE(choice.is_open());
  EXPECT_FALSE(choice.chosen());
  EXPECT_TRUE(choice.wants_text());
}

// A foot goes round among what is offered, and is never caught in the field.
TEST(CameraChoice, AFootGoesPastTheField) {
  CameraChoice choice;
  choice.open({{2, "Capture card"}}, {"rtsp://tower/scope"});
  for (const char* name : {"rtsp://tower/scope", "Capture card", "rtsp://tower/scope"}) {
    choice.choose_next_offered();
    ASSERT_TRUE(choice.chosen());
    EXPECT_EQ(choice.chosen()->name, name);
    EXPECT_FALSE(choice.wants_text());
  }
  choice.choose_field();
  choice.choose_next_offered();
  EXPECT_EQ(choice.chosen()->name, "Capture card");
  choice.open({}, {});
  choice.choose_next_offered();
  EXPECT_TRUE(choice.wants_text()) << "nothing is offered: the field waits";
}

// In the field K writes a k, and Space a space.
TEST(CameraChoice, SaysWhatTheKeysDoNow) {
  CameraChoice choice;
  choice.open({{0, "Webcam"}}, {});
  EXPECT_NE(choice.keys().find("K or V: the next one"), std::string_view::npos);
  choice.choose_field();
  EXPECT_EQ(choice.keys().find("K or"), std::string_view::npos);
  EXPECT_EQ(choice.keys().find("Space"), std::string_view::npos);
  EXPECT_NE(choice.keys().find("Enter"), std::string_view::npos);
}

TEST(CameraChoice, TakesTheAddressOfAStreamAndNothingElse) {
  CameraChoice choice;
  choice.open({}, {});
  for (const char* typed : {"rtsp://tower/scope", "  udp://@:5000\t", "gst:videotestsrc ! appsink"}) {
    const auto taken = choice.take_address(typed);
    ASSERT_TRUE(taken) << typed;
    EXPECT_FALSE(taken->device);
  }
  EXPECT_EQ(choice.take_address(" udp://@:5000 ")->address, "udp://@:5000");
  EXPECT_EQ(choice.take_address("RTSP://Tower/Scope")->address, "rtsp://Tower/Scope")
      << "the same stream as in small letters";
  for (const char* typed : {"", "  ", "tower", "/dev/video", "/dev/video0?size=big", "clip.mkv", "://"})
    EXPECT_FALSE(choice.take_address(typed)) << typed;
}

// A slip of the finger ends nothing that runs: it is answered where it was typed.
TEST(CameraChoice, RefusesAKindOfAddressThatNobodyKnowsBeforeAnythingIsOpened) {
  CameraChoice choice;
  choice.open({}, {});
  EXPECT_FALSE(choice.take_address("rstp://nurse:secret@tower/scope"));
  EXPECT_NE(choice.trouble().find("rstp://tower/scope: no address of a kind that can be opened"),
            std::string::npos)
      << choice.trouble();
  EXPECT_TRUE(choice.is_open());
}

// A tracker's address opens no pictures: it is kept for those that are chosen next, until another is typed or
// none, and one that is wrong takes nothing away.
TEST(CameraChoice, KeepsTheAddressOfAnOutsideTracker) {
  CameraChoice choice;
  choice.open({{0, "Webcam"}}, {});
  choice.choose_field();
  EXPECT_TRUE(choice.wants_text());
  EXPECT_FALSE(choice.take_address(" igtl://tower:18944 "));
  EXPECT_EQ(choice.tracker(), "igtl://tower:18944");
  EXPECT_EQ(choice.trouble(), "");
  EXPECT_FALSE(choice.take_address("Igtl://tower:18944"));
  EXPECT_EQ(choice.tracker(), "igtl://tower:18944");
  EXPECT_EQ(choice.trouble(), "");
  for (const char* wrong : {"igtl://tower:port", "igtl://:18944", "igtl://tower:99999"}) {
    EXPECT_FALSE(choice.take_address(wrong)) << wrong;
    EXPECT_NE(choice.trouble(), "") << wrong;
    EXPECT_EQ(choice.tracker(), "igtl://tower:18944") << wrong;
  }
  choice.close();
  choice.open({{0, "Webcam"}}, {});
  EXPECT_EQ(choice.tracker(), "igtl://tower:18944");
  EXPECT_TRUE(choice.take_address("udp://@:5000"));
  EXPECT_FALSE(choice.take_address("igtl://"));
  EXPECT_EQ(choice.tracker(), "");
}

TEST(KnownStreams, AreKeptTheNewestFirstAndForTheirUserAlone) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder / "data/streams.json";
  EXPECT_TRUE(load_known_streams(file).empty());
  for (const char* address : {"udp://@:1", "udp://@:2", "udp://@:1"}) note_stream(file, address);
  EXPECT_EQ(load_known_streams(file), (std::vector<std::string>{"udp://@:1", "udp://@:2"}));
  EXPECT_TRUE(files::is_private(file.parent_path()));
  for (int port = 10; port < 20; ++port) note_stream(file, "udp://@:" + std::to_string(port));
  EXPECT_EQ(load_known_streams(file).size(), 5U);
  EXPECT_EQ(load_known_streams(file).front(), "udp://@:19");
}

TEST(KnownStreams, AFileThatCannotBeReadIsNoneAtAll) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder / "streams.json";
  std::ofstream(file) << "{\"format\": \"something else\"";
  EXPECT_TRUE(load_known_streams(file).empty());
  note_stream(file, "udp://@:1");
  EXPECT_EQ(load_known_streams(file).size(), 1U);
  note_stream(folder / "streams.json/of/a/file", "udp://@:1");  // told to nobody: nothing depends on it
}

}  // namespace
}  // namespace arthronaut::navigate
