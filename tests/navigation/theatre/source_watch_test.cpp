#include "navigation/theatre/source_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace arthronaut::theatre {
namespace {

using testing::HasSubstr;

constexpr std::int64_t kMs = 1'000'000, kStart_ns = 5'000 * kMs;

class SourceWatchTest : public ::testing::Test {
 protected:
  // 60 a second for so long.
  void pictures(const pipeline::PictureObservation& view, int ms, double guidance_ms = 5) {
    for (const std::int64_t end = now_ns_ + ms * kMs; now_ns_ < end; now_ns_ += 16 * kMs)
      (void)watch_.picture(view, guidance_ms, now_ns_);
  }
  // Asked ten times a second.
  void silence(int ms, const std::string& why = "") {
    for (const std::int64_t end = now_ns_ + ms * kMs; now_ns_ < end; now_ns_ += 100 * kMs)
      (void)watch_.silence(why, now_ns_);
  }
  SourceWatch watch_;
  std::int64_t now_ns_ = kStart_ns;
  pipeline::PictureObservation well_;
};

TEST_F(SourceWatchTest, SilenceIsToldWithinHalfASecond) {
  pictures(well_, 1000);
  EXPECT_EQ(watch_.trouble(), SourceTrouble::None);
  silence(200);
  EXPECT_EQ(watch_.trouble(), SourceTrouble::None) << "a hiccup is no trouble";
  silence(300);
  EXPECT_EQ(watch_.trouble(), SourceTrouble::NoPicture);
  silence(100, "tower: broke off");
  EXPECT_THAT(watch_.words(), HasSubstr("tower: broke off"));
  EXPECT_TRUE(watch_.picture(well_, 5, now_ns_)) << "it is over with the first picture";
  EXPECT_EQ(watch_.words(), "");
}

// Pictures come, and others were lost: that is no silence, whatever the rate.
TEST_F(SourceWatchTest, LostPicturesAreToldWhileOthersCome) {
  const std::string lost = "camera 0: 31 of the last 120 pictures were lost";
  EXPECT_TRUE(watch_.picture(well_, 5, now_ns_ += 100 * kMs, lost));
  EXPECT_EQ(watch_.trouble(), SourceTrouble::Lost);
  EXPECT_EQ(watch_.words(), lost);
  silence(200);
  EXPECT_FALSE(watch_.picture(well_, 5, now_ns_, "camera 0: 32 of the last 120 pictures were lost"))
      << "its count is no news";
  EXPECT_TRUE(watch_.picture(well_, 5, now_ns_ += 100 * kMs));
  EXPECT_EQ(watch_.trouble(), SourceTrouble::None);
}

// A source that knows why is believed at once.
TEST_F(SourceWatchTest, AReasonIsNotWaitedFor) {
  pictures(well_, 100);
  silence(100, "gives pictures of 640 x 480 now");
  EXPECT_EQ(watch_.trouble(), SourceTrouble::NoPicture);
}

TEST_F(SourceWatchTest, WhatIsWrongWithThePictureIsSaid) {
  for (const auto& [wrong, trouble] :
       {std::pair{&pipeline::PictureObservation::is_blank, SourceTrouble::Plain},
        std::pair{&pipeline::PictureObservation::is_frozen, SourceTrouble::Frozen},
        std::pair{&pipeline::PictureObservation::is_torn, SourceTrouble::Torn}}) {
    pipeline::PictureObservation view;
    view.*wrong = true;
    EXPECT_TRUE(watch_.picture(view, 5, now_ns_ += 16 * kMs));
    EXPECT_EQ(watch_.trouble(), trouble);
    EXPECT_FALSE(watch_.words().empty());
    pictures(well_, 2100);
    EXPECT_EQ(watch_.trouble(), SourceTrouble::None);
  }
}

// One torn picture is over in 16 ms and can be read for two seconds.
TEST_F(SourceWatchTest, WhatIsOverAtOnceCanBeRead) {
  pipeline::PictureObservation torn;
  torn.is_torn = true;
  (void)watch_.picture(torn, 5, now_ns_);
  pictures(well_, 1500);
  EXPECT_EQ(watch_.trouble(), SourceTrouble::Torn);
  pictures(well_, 1000);
  EXPECT_EQ(watch_.trouble(), SourceTrouble::None);
}

// The limit of a live picture's age, to guidance.
TEST_F(SourceWatchTest, LatePicturesAreAnAlarm) {
  pictures(well_, 500, 99);
  EXPECT_EQ(watch_.trouble(), SourceTrouble::None);
  EXPECT_TRUE(watch_.picture(well_, 132, now_ns_));
  EXPECT_EQ(watch_.trouble(), SourceTrouble::Late);
  EXPECT_THAT(watch_.words(), HasSubstr("132 ms"));
  pictures(well_, 2100, 20);
  EXPECT_EQ(watch_.trouble(), SourceTrouble::None);
}

// By how much is said in words that stand for long enough to be read.
TEST_F(SourceWatchTest, HowLateIsSaidOnceASecond) {
  std::string before;
  int said = 0;
  for (int i = 0; i < 120; ++i) {
    pictures(well_, 17, 120 + i);
    if (watch_.words() != before) ++said;
    before = watch_.words();
  }
  EXPECT_GE(said, 2);
  EXPECT_LE(said, 4);
}

// 30 pictures a second sent as 60 are no trouble; 15 sent as 60 are.
TEST_F(SourceWatchTest, RepeatsAreSaidWhenTheyAreMost) {
  pipeline::PictureObservation view;
  view.repeat_share = 0.5;
  pictures(view, 500);
  EXPECT_EQ(watch_.trouble(), SourceTrouble::None);
  view.repeat_share = 0.75;
  pictures(view, 500);
  EXPECT_EQ(watch_.trouble(), SourceTrouble::Repeated);
  EXPECT_THAT(watch_.words(), HasSubstr("75"));
}

}  // namespace
}  // namespace arthronaut::theatre
