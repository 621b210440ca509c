#include "navigation/theatre/live_operation.h"

#include <gtest/gtest.h>

#include "navigation/recording/session.h"
#include "tests/navigation/theatre/theatre_sources.h"
#include "tests/temporary_folder.h"

namespace arthronaut::theatre {
namespace {

using Phase = LiveState::Phase;
using sources::SourceKind;

class LiveOperationTest : public ::testing::Test {
 protected:
  static LiveOptions options() {
    LiveOptions options;
    options.operation = test::phantom_setup();
    options.bone = [] { return registration::phantom_bone().prepared; };
    return options;
  }
  template <typename Condition>
  static bool waits_for(const Condition& condition) {
    for (int i = 0; i < 2000 && !condition(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return condition();
  }
  LiveOperation live_{options(), [] {}};
};

// A live source that fails stays the live source that failed: no simulation, no recording takes its place,
// whatever is pressed after it.
TEST_F(LiveOperationTest, SourceFailureNeverChangesTheKind) {
  live_.start(test::plain_source(4, true, SourceKind::Live));
  ASSERT_TRUE(waits_for([&] { return live_.latest()->phase == Phase::Failed; }));
  EXPECT_NE(live_.latest()->message.find("unplugged"), std::string::npos) << live_.latest()->message;
  live_.apply(operation::Draw{true});
  live_.apply(operation::TakeTouch{});
  live_.apply(operation::SkipVerification{});
  live_.finish();
  const auto latest = live_.latest();
  EXPECT_EQ(latest->phase, Phase::Failed);
  EXPECT_FALSE(latest->operation->has_source);
  EXPECT_FALSE(latest->operation->draws);
  ASSERT_NE(latest->operation->source, nullptr);
  EXPECT_EQ(latest->operation->source->kind, SourceKind::Live);
  EXPECT_EQ(live_.failure(), "");
}

TEST_F(LiveOperationTest, ASourceThatCannotBeOpenedIsAStateOfTheScreen) {
  TheatreSource broken = test::plain_source(4, false, SourceKind::Live);
  broken.open = []() -> std::unique_ptr<sources::FrameSource> { throw DeviceError("no such device"); };
  live_.start(broken);
  ASSERT_TRUE(waits_for([&] { return live_.latest()->phase == Phase::Failed; }));
  EXPECT_FALSE(live_.latest()->operation->has_source);
  live_.start(test::plain_source(4));
  EXPECT_TRUE(waits_for([&] { return live_.latest()->phase == Phase::Ended; }));
  EXPECT_EQ(live_.latest()->operation->frame_count, 4);
}

// A picture of another size than the camera's ends the source; the message says both sizes.
TEST_F(LiveOperationTest, AnotherPictureSizeIsTold) {
  TheatreSource source = test::plain_source(4);
  source.setup.pipeline.calibration.image_size_px = {320, 240};
  live_.start(source);
  ASSERT_TRUE(waits_for([&] { return live_.latest()->phase == Phase::Failed; }));
  live_.finish();
  EXPECT_EQ(live_.latest()->phase, Phase::Failed) << "and nothing of it goes on";
  EXPECT_NE(live_.latest()->message.find("160 x 120"), std::string::npos) << live_.latest()->message;
  EXPECT_NE(live_.latest()->message.find("320 x 240"), std::string::npos) << live_.latest()->message;
}

// Pictures that are no plain ones.
class SlowSource : public test::PlainSource {
 public:
  using PlainSource::PlainSource;
  [[nodiscard]] camera::FramePtr next() override {
    const std::int64_t index = PlainSource::next()->index;
    return std::make_shared<const camera::Frame>(
        test::round_frame(index, static_cast<std::uint8_t>(100 + index % 100)));
  }
};

// The screen tells when it drew which picture: eight a second are told to be too few, and so is a touch that
// was not taken.
TEST_F(LiveOperationTest, Hazard3ASlowSourceAndARefusedTouchArePublished) {
  TheatreSource source = test::plain_source(0, false, SourceKind::Live);
  source.open = [] { return std::make_unique<SlowSource>(1000, false, 8); };
  live_.start(source);
  ASSERT_TRUE(waits_for([&] {
    const LiveStatePtr now = live_.latest();
    if (now->picture != nullptr) live_.shown(*now, LiveOperation::now_s());
    return now->trouble == SourceTrouble::Slow;
  }));
  EXPECT_EQ(live_.latest()->refusal.count, 0);
  live_.apply(operation::ConfirmTimeOut{});  // a live source takes no touch before
  live_.apply(operation::TakeTouch{});
  ASSERT_TRUE(waits_for([&] { return live_.latest()->refusal.count == 1; }));
  EXPECT_EQ(live_.latest()->operation->touch_refusal, operation::TouchRefusal::TipUnknown);
  EXPECT_NEAR(live_.latest()->refused_s, LiveOperation::now_s(), 5);
  live_.end_source();
}

// What a picture shows that repeats the one before is as old as that one: a source that hangs guides no
// longer than one that is silent.
TEST_F(LiveOperationTest, Hazard3ARepeatedPictureIsAsOldAsTheOneThatItRepeats) {
  static constexpr int kRate = 30;
  class EachTwice : public test::PlainSource {
   public:
    EachTwice() : PlainSource(1000, false, kRate) {}
    [[nodiscard]] camera::FramePtr next() override {
      const std::int64_t index = PlainSource::next()->index;
      auto frame = std::make_shared<camera::Frame>(
          test::round_frame(index, static_cast<std::uint8_t>(100 + 7 * (index / 2 % 15))));
      frame->timestamp_ns = index * 1'000'000'000 / kRate;
      return frame;
    }
  };
  TheatreSource source = test::plain_source(0, false, SourceKind::Live);
  source.open = [] { return std::make_unique<EachTwice>(); };
  live_.start(source);
  // On a busy machine the picture that another one repeats may not have been looked at: that one is new then.
  LiveStatePtr seen;
  ASSERT_TRUE(waits_for([&] {
    seen = live_.latest();
    return seen->picture != nullptr && seen->picture->index > 4 && seen->shown_for_s > 0;
  }));
  EXPECT_EQ(seen->picture->index % 2, 1);
  EXPECT_NEAR(seen->shown_for_s, 1.0 / kRate, 1e-6);
  EXPECT_NEAR(seen->age_s(seen->captured_s + 0.01), 0.01 + 1.0 / kRate, 1e-6);
  live_.end_source();
}

// A gap in a recording's time stamps freezes nobody's screen: it is passed over, and what is pressed
// meanwhile is taken at once.
TEST_F(LiveOperationTest, AGapInARecordingIsNotWaitedFor) {
  class GappedSource : public test::PlainSource {
   public:
    GappedSource() : PlainSource(3, false) {}
    [[nodiscard]] camera::FramePtr next() override {
      const camera::FramePtr plain = PlainSource::next();
      if (plain == nullptr) return nullptr;
      const auto frame = std::make_shared<camera::Frame>(*plain);
      if (frame->index > 0) frame->timestamp_ns += 3'600'000'000'000;
      return frame;
    }
  };
  TheatreSource source = test::plain_source(0);
  source.open = [] { return std::make_unique<GappedSource>(); };
  const double begun_s = LiveOperation::now_s();
  live_.start(source);
  ASSERT_TRUE(waits_for([&] { return live_.latest()->phase == Phase::Ended; }));
  EXPECT_LT(LiveOperation::now_s() - begun_s, 10);
  EXPECT_EQ(live_.latest()->operation->frame_count, 3);
}

// A record that cannot be begun is said on the screen and ends nothing.
TEST(LiveOperationRecord, TroubleIsPublished) {
  LiveOptions options;
  options.operation = test::phantom_setup();
  options.bone = [] { return registration::phantom_bone().prepared; };
  options.make_session_folder = []() -> std::filesystem::path { throw IoError("sessions", "disk full"); };
  LiveOperation live(options, [] {});
  live.start(test::plain_source(4));
  for (int i = 0; i < 2000 && live.latest()->phase != Phase::Ended; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_EQ(live.latest()->phase, Phase::Ended);
  EXPECT_NE(live.latest()->record_trouble.find("disk full"), std::string::npos);
  EXPECT_EQ(live.latest()->operation->frame_count, 4);
}

// What is said in the moment in which the case is closed is in its record.
TEST(LiveOperationRecord, HoldsWhatWasSaidAsItWasClosed) {
  const test::TemporaryFolder folder;
  constexpr long kSaid = 50;
  {
    LiveOptions options;
    options.operation = test::phantom_setup();
    options.bone = [] { return registration::phantom_bone().prepared; };
    options.make_session_folder = [&] { return folder.path(); };
    LiveOperation live(options, [] {});
    TheatreSource source = test::plain_source(0, false, SourceKind::Live);
    source.open = [] { return std::make_unique<SlowSource>(1000, false, 8); };
    live.start(source);
    for (int i = 0; i < 2000 && live.latest()->picture == nullptr; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    ASSERT_NE(live.latest()->picture, nullptr);
    for (long i = 0; i < kSaid; ++i) live.apply(operation::ReadDepthStop{20});
    live.request_stop();
  }
  const recording::RecordedSession session(folder.path());
  EXPECT_EQ(std::count_if(
                session.events().begin(), session.events().end(),
                [](const recording::SessionEvent& event) { return event.kind == recording::kCommandEvent; }),
            kSaid);
}

}  // namespace
}  // namespace arthronaut::theatre
