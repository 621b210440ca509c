// A whole source with nobody at the pedal: what is in the record at its end.
#include "navigation/theatre/navigate_source.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "navigation/recording/session.h"
#include "navigation/sources/capture_time.h"
#include "tests/navigation/operation/ball_pictures.h"
#include "tests/navigation/theatre/theatre_sources.h"
#include "tests/temporary_folder.h"

namespace arthronaut::theatre {
namespace {

class LivePictures : public test::PlainSource {
 public:
  LivePictures() : PlainSource(5, true) {
    info_ = PlainSource::info(), info_.kind = sources::SourceKind::Live;
  }
  [[nodiscard]] const sources::SourceInfo& info() const override { return info_; }

 private:
  sources::SourceInfo info_;
};

class NavigateSource : public ::testing::Test {
 protected:
  [[nodiscard]] static NavigateOptions options(sources::SourceKind kind) {
    NavigateOptions options;
    options.operation = test::phantom_setup();
    options.source = test::scripted_source(kind);
    return options;
  }
  [[nodiscard]] RecordOptions record() const {
    RecordOptions record;
    record.folder = folder_.path();
    return record;
  }
  [[nodiscard]] static auto pictures(std::int64_t count, bool fails = false) {
    return std::make_shared<test::PlainSource>(count, fails);
  }
  [[nodiscard]] std::vector<std::string> events(std::string_view kind) const {
    std::vector<std::string> texts;
    const recording::RecordedSession session(folder_.path());
    for (const recording::SessionEvent& event : session.events())
      if (event.kind == kind) texts.push_back(event.text);
    return texts;
  }
  const test::TemporaryFolder folder_;
};

// From the command line nobody can hold a guide against anything: the record says so, once, and says nothing
// where there was nothing to be checked.
TEST_F(NavigateSource, Hazard6TheRecordSaysThatNobodyCheckedANominalGuide) {
  NavigateOptions live = options(sources::SourceKind::Live);
  live.source.pipeline.tools.tools.back().provenance.origin = provenance::Origin::Nominal;
  live.is_confirmed = true;
  const NavigationSummary summary = navigate_source(pictures(5), live, record());
  EXPECT_EQ(summary.statistics.frame_count, 5);
  EXPECT_EQ(events(recording::kGuideCheckedEvent),
            std::vector<std::string>{"nominal, and nobody checked it"});
  EXPECT_EQ(events(recording::kTimeOutConfirmedEvent).size(), 1U);
}

TEST_F(NavigateSource, AMeasuredGuideAndARecordingAskForNothing) {
  NavigateOptions live = options(sources::SourceKind::Live);
  live.is_confirmed = true;
  (void)navigate_source(pictures(5), live, record());
  EXPECT_TRUE(events(recording::kGuideCheckedEvent).empty());
}

// Nobody confirmed a time-out of a recording: its record must not say so.
TEST_F(NavigateSource, OfARecordingNothingIsConfirmed) {
  NavigateOptions video = options(sources::SourceKind::Recording);
  video.source.pipeline.tools.tools.back().provenance.origin = provenance::Origin::Nominal;
  video.is_confirmed = true;
  (void)navigate_source(pictures(5), video, record());
  for (const std::string& command : events(recording::kCommandEvent)) {
    EXPECT_EQ(command.find("confirm"), std::string::npos) << command;
    EXPECT_EQ(command.find("trust"), std::string::npos) << command;
  }
}

// How much of the operation was watched is what `navigate` says at its end.
TEST_F(NavigateSource, CountsPicturesThatShowedTheBoneWhereItLay) {
  constexpr long kPictures = 60;
  NavigateOptions ball;
  ball.operation = test::ball_setup();
  ball.source = test::ball_source();
  ball.registration = test::registered_beforehand();
  long registered = 0, seen = 0;
  NavigationObserver observer;
  observer.on_frame = [&](const camera::FramePtr&, const operation::OperationStatePtr& state) {
    registered += state->registration->in_force.standing == operation::Standing::Stands;
    seen += state->contour.state == contour::ContourState::Holds;
  };
  const auto source = std::make_shared<test::BallSource>(kPictures);
  const NavigationSummary summary = navigate_source(source, ball, {}, observer);
  EXPECT_EQ(summary.frames_registered, kPictures);
  EXPECT_EQ(registered, kPictures);
  EXPECT_EQ(summary.frames_bone_seen, seen);
  EXPECT_TRUE(summary.reasons.empty());
  // Looked at for a second before anything is said, with 15 pictures a second.
  EXPECT_GT(seen, kPictures / 2);
  EXPECT_LT(seen, kPictures - 14);
}

// With a registration and a bone that is in no picture nothing was navigated, and nothing is called a
// success.
TEST_F(NavigateSource, SaysThatTheWorldMarkerWasInNoPicture) {
  NavigateOptions blind = options(sources::SourceKind::Recording);
  const auto trial = registration::phantom_bone().trial(experiments::TrialNoise::Dry, 1);
  blind.registration =
      test::true_registration(trial, operation::provenance_of(blind.operation, blind.source));
  const NavigationSummary summary = navigate_source(pictures(5), blind);
  ASSERT_EQ(summary.standing, operation::Standing::Stands);
  ASSERT_EQ(summary.reasons.size(), 1U);
  EXPECT_NE(summary.reasons.front().find("world marker"), std::string::npos) << summary.reasons.front();
}

// A later frame than was asked for is the end, before it was worked in.
TEST_F(NavigateSource, EndsBeforeTheFirstFrameThatIsLater) {
  NavigateOptions some = options(sources::SourceKind::Recording);
  some.duration_s = 6.5 / 60;
  EXPECT_EQ(navigate_source(pictures(20), some, record()).statistics.frame_count, 7);
  EXPECT_EQ(recording::RecordedSession(folder_.path()).frames().size(), 7U);
}

// A live source that fails has ended, and what was made stays; a recording that fails is an error.
TEST_F(NavigateSource, ALiveSourceThatFailsHasEnded) {
  const NavigationSummary summary =
      navigate_source(std::make_shared<LivePictures>(), options(sources::SourceKind::Live), record());
  EXPECT_EQ(summary.ending, "the camera was unplugged");
  EXPECT_NE(std::find(summary.reasons.begin(), summary.reasons.end(),
                      "the source broke off: the camera was unplugged"),
            summary.reasons.end())
      << "not what it was begun for";
  EXPECT_TRUE(recording::RecordedSession(folder_.path()).was_finished());
  EXPECT_THROW((void)navigate_source(pictures(5, true), options(sources::SourceKind::Recording)),
               DeviceError);
}

// Whoever ends it himself has all that he wanted.
TEST_F(NavigateSource, ALiveSourceThatIsStoppedByHandDidNotBreakOff) {
  NavigationObserver observer;
  observer.on_frame = [](const camera::FramePtr&, const operation::OperationStatePtr&) {
    throw StoppedByHand("stopped by hand");
  };
  const NavigationSummary summary = navigate_source(std::make_shared<LivePictures>(),
                                                    options(sources::SourceKind::Live), record(), observer);
  EXPECT_EQ(summary.ending, "stopped by hand");
  EXPECT_EQ(summary.statistics.frame_count, 1);
  for (const std::string& reason : summary.reasons)
    EXPECT_EQ(reason.find("the source broke off"), std::string::npos) << reason;
}

// Whoever passes poses on is told which pictures are not of now, as the screen would not show them; those of
// a recording are shown as if they were.
TEST_F(NavigateSource, Hazard3ALatePictureIsPassedOnAsLate) {
  class AgedPictures : public test::PlainSource {
   public:
    AgedPictures() : PlainSource(6, false) {}
    [[nodiscard]] camera::FramePtr next() override {
      const camera::FramePtr plain = PlainSource::next();
      if (plain == nullptr) return nullptr;
      const auto frame = std::make_shared<camera::Frame>(*plain);
      // The others are of a minute ahead: no busy machine makes them old.
      const std::int64_t age_ms = frame->index == 3 ? 150 : -60'000;
      frame->captured_ns = sources::steady_now_ns() - age_ms * 1'000'000;
      return frame;
    }
  };
  for (const auto kind : {sources::SourceKind::Live, sources::SourceKind::Recording}) {
    std::vector<std::int64_t> shown, late;
    std::string words;
    NavigationObserver observer;
    observer.on_frame = [&](const camera::FramePtr& picture, const operation::OperationStatePtr&) {
      shown.push_back(picture->index);
    };
    observer.on_late = [&](const camera::FramePtr& picture, const std::string& why,
                           const operation::OperationStatePtr&) {
      late.push_back(picture->index);
      words = why;
    };
    (void)navigate_source(std::make_shared<AgedPictures>(), options(kind), {}, observer);
    const bool is_live = kind == sources::SourceKind::Live;
    EXPECT_EQ(late, is_live ? std::vector<std::int64_t>{3} : std::vector<std::int64_t>{});
    EXPECT_EQ(shown.size(), is_live ? 5U : 6U);
    EXPECT_EQ(words.empty(), !is_live);
  }
}

TEST_F(NavigateSource, ARecordThatCannotBeginIsAnError) {
  RecordOptions nowhere;
  nowhere.folder = folder_ / "absent";
  EXPECT_THROW((void)navigate_source(pictures(5), options(sources::SourceKind::Recording), nowhere), IoError);
}

}  // namespace
}  // namespace arthronaut::theatre
