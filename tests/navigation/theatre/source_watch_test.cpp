#include "navigation/theatre/source_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <vector>

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

// That the pictures come in another size is a state, whatever words it is told in, and over with the silence.
TEST_F(SourceWatchTest, PicturesOfAnotherSizeAreAStateOfTheSilence) {
  pictures(well_, 1000);
  const Eigen::Vector2i now_px(1280, 720);
  (void)watch_.silence("tower: anything", now_ns_, now_px);
  EXPECT_EQ(watch_.trouble(), SourceTrouble::NoPicture);
  EXPECT_EQ(watch_.changed_to_px(), now_px);
  silence(100, "tower: broke off");
  EXPECT_FALSE(watch_.changed_to_px()) << "of another silence nobody says so";
  (void)watch_.silence("tower: anything", now_ns_, now_px);
  (void)watch_.picture(well_, 5, now_ns_);
  EXPECT_FALSE(watch_.changed_to_px());
}

// What the record is told of a silence goes with its reason, and not with every attempt to connect again.
TEST_F(SourceWatchTest, AReasonOfASilenceThatChangesIsNews) {
  pictures(well_, 1000);
  std::vector<std::string> news;
  const auto silent = [&](int ms, const auto& why) {
    for (const std::int64_t end = now_ns_ + ms * kMs; now_ns_ < end; now_ns_ += 100 * kMs)
      if (watch_.silence(why(), now_ns_)) news.push_back(watch_.words());
  };
  silent(1500, [] { return ""; });
  silent(1500, [] { return "the scope's cable is out"; });
  const std::vector<std::string> expected{"No picture comes", "No picture comes: the scope's cable is out"};
  EXPECT_EQ(news, expected);
  news.clear();
  int attempts = 0;
  silent(10'000, [&] { return "attempt " + std::to_string(++attempts); });
  EXPECT_LE(news.size(), 10U);
  ASSERT_FALSE(news.empty());
  silent(1100, [] { return "another camera is there"; });
  EXPECT_EQ(news.back(), "No picture comes: another camera is there");
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

// A source and a screen on a seeded clock: pictures come at a rate, some ms early or late, are known 20 ms
// after they were captured, and the screen shows the newest one every 17 ms.
class ShownPictures {
 public:
  explicit ShownPictures(SourceWatch& watch, unsigned seed) : watch_(watch), random_(seed) {}
  void run(double rate, double seconds, double uneven_ms = 3) {
    std::uniform_real_distribution<double> early_or_late(-uneven_ms, uneven_ms);
    const double end_ms = now_ms_ + 1000 * seconds;
    for (; now_ms_ < end_ms; now_ms_ += 1) {
      if (now_ms_ >= next_ms_) {
        come_.push_back(next_ms_);
        next_ms_ += 1000 / rate + early_or_late(random_);
      }
      if (!come_.empty() && now_ms_ >= come_.front() + kWork_ms) {
        if (watch_.picture({}, kWork_ms, ns(now_ms_))) said.push_back({now_ms_, watch_.trouble()});
        known_ms_ = come_.front();
        come_.erase(come_.begin());
      }
      if (now_ms_ < drawn_ms_ + 17) continue;
      if (known_ms_ != shown_ms_ && shown_ms_ > 0) watch_.shown_until(drawn_ms_ - shown_ms_, ns(now_ms_));
      drawn_ms_ = now_ms_;
      shown_ms_ = known_ms_;
    }
  }
  void pause(double seconds) {
    now_ms_ += 1000 * seconds;
    next_ms_ = now_ms_;
  }
  [[nodiscard]] double now_ms() const { return now_ms_; }
  struct Said {
    double at_ms;
    SourceTrouble trouble;
  };
  std::vector<Said> said;

 private:
  static constexpr double kWork_ms = 20;
  static std::int64_t ns(double ms) { return static_cast<std::int64_t>(ms * 1e6); }
  SourceWatch& watch_;
  std::mt19937 random_;
  std::vector<double> come_;
  double now_ms_ = 5000, next_ms_ = 5000, drawn_ms_ = 0, known_ms_ = 0, shown_ms_ = 0;
};

// Below some twelve pictures a second each is too old to guide by before the next one is shown. That is told
// once, within half a second of pictures, and stays told.
TEST_F(SourceWatchTest, Hazard3ASlowSourceIsToldOnceAndSteadily) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    for (const double rate : {5.0, 8.0, 10.0}) {
      SourceWatch watch;
      ShownPictures pictures(watch, seed);
      const double begin_ms = pictures.now_ms();
      pictures.run(rate, 20);
      ASSERT_EQ(pictures.said.size(), 1U) << rate << " a second, seed " << seed;
      EXPECT_EQ(pictures.said[0].trouble, SourceTrouble::Slow);
      EXPECT_LT(pictures.said[0].at_ms - begin_ms, 100 + 5 * 1000 / rate);
      EXPECT_THAT(watch.words(), HasSubstr("are too few"));
      if (rate == 10) {
        EXPECT_THAT(watch.words(), testing::AnyOf(testing::StartsWith("10 "), testing::StartsWith("9 "),
                                                  testing::StartsWith("11 ")));
      }
      EXPECT_FALSE(watch.silence("", static_cast<std::int64_t>((pictures.now_ms() + 1000 / rate) * 1e6)))
          << "its own pace is no silence";
      pictures.run(30, 5);
      ASSERT_EQ(pictures.said.size(), 2U);
      EXPECT_EQ(pictures.said[1].trouble, SourceTrouble::None) << "it is quick enough again";
    }
    for (const double rate : {20.0, 30.0, 60.0}) {
      SourceWatch watch;
      ShownPictures pictures(watch, seed);
      pictures.run(rate, 20);
      EXPECT_TRUE(pictures.said.empty()) << rate << " a second, seed " << seed;
    }
  }
}

// About the limit, where some pictures are too old and others are not, nothing that is said goes before it
// could be read.
TEST_F(SourceWatchTest, Hazard3AboutTheLimitNothingFlickers) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    for (const double rate : {11.0, 12.0, 13.0, 14.0, 15.0}) {
      SourceWatch watch;
      ShownPictures pictures(watch, seed);
      pictures.run(rate, 30, 15);
      for (std::size_t i = 1; i < pictures.said.size(); ++i)
        EXPECT_TRUE(pictures.said[i].trouble == SourceTrouble::Slow ||
                    pictures.said[i].at_ms - pictures.said[i - 1].at_ms >= 2000)
            << rate << " a second, seed " << seed;
    }
  }
}

// A screen that draws 26 pictures a second, each 60 ms after it was captured, draws none of them too old.
TEST_F(SourceWatchTest, ASlowScreenIsNoSlowSource) {
  for (int i = 0; i < 200; ++i) {
    watch_.shown_until(i % 3 == 0 ? 97 : 60, now_ns_);
    pictures(well_, 38);
    ASSERT_EQ(watch_.trouble(), SourceTrouble::None) << i;
  }
}

// How long a source was away says nothing of its pace.
TEST_F(SourceWatchTest, APauseIsNoPace) {
  ShownPictures pictures(watch_, 1);
  pictures.run(10, 5);
  pictures.pause(4);
  pictures.run(10, 0.5);
  EXPECT_EQ(watch_.trouble(), SourceTrouble::Slow);
  EXPECT_THAT(watch_.words(), testing::AnyOf(testing::StartsWith("10 "), testing::StartsWith("9 "),
                                             testing::StartsWith("11 ")));
}

// Single pictures that are late on the screen hide nothing for longer than they are late.
TEST_F(SourceWatchTest, ALateScreenNowAndThenIsNoSlowSource) {
  for (int i = 0; i < 200; ++i) {
    watch_.shown_until(i % 4 == 0 ? 130 : 60, now_ns_);
    pictures(well_, 33);
    ASSERT_EQ(watch_.trouble(), SourceTrouble::None) << i;
  }
  for (int i = 0; i < 6; ++i) watch_.shown_until(130, now_ns_);
  pictures(well_, 33);
  EXPECT_EQ(watch_.trouble(), SourceTrouble::Slow);
  EXPECT_THAT(watch_.words(), HasSubstr("end other programs")) << "pictures come often enough";
}

// 19 pictures a second that are 80 ms old when they come: twice as many would be too old just as well.
TEST_F(SourceWatchTest, WhatIsLateByItselfIsNotBlamedOnItsRate) {
  for (int i = 0; i < 60; ++i) {
    watch_.shown_until(135, now_ns_);
    pictures(well_, 53);
  }
  EXPECT_EQ(watch_.trouble(), SourceTrouble::Slow);
  EXPECT_THAT(watch_.words(), HasSubstr("end other programs"));
}

// Of 60 a second, each 225 ms old when the next one is shown, with B-frames 174 are the sender's: no other
// program has to end. Where they come at once and are as late it is the machine.
TEST_F(SourceWatchTest, WhatIsLateWhenItComesIsNotBlamedOnTheMachine) {
  for (const double received_ms : {174.0, 20.0, -1.0}) {
    watch_ = {};
    for (int i = 0; i < 60; ++i) {
      watch_.shown_until(225, now_ns_);
      watch_.received(received_ms);
      pictures(well_, 17);
    }
    EXPECT_EQ(watch_.trouble(), SourceTrouble::Slow);
    EXPECT_THAT(watch_.words(),
                HasSubstr(received_ms > 100 ? "Each is 174 ms old when it comes: see to what sends it"
                                            : "end other programs"));
  }
}

// The sender is gone: that is not the computer's fault, however late it was with the pictures before.
TEST_F(SourceWatchTest, Hazard3ASilentSourceIsNotBlamedOnTheMachine) {
  for (int i = 0; i < 30; ++i) {
    watch_.shown_until(1200, now_ns_);
    pictures(well_, 16);
    now_ns_ += 300 * kMs;
  }
  ASSERT_EQ(watch_.trouble(), SourceTrouble::Slow);
  ASSERT_THAT(watch_.words(), HasSubstr("end other programs"));
  silence(200);
  EXPECT_EQ(watch_.trouble(), SourceTrouble::NoPicture);
}

// A record keeps what is wrong beside the words, so that it is known however they are put.
TEST_F(SourceWatchTest, ItsRecordTellsWhatIsWrong) {
  std::vector<SourceTrouble> told;
  const auto tell = [&] {
    EXPECT_EQ(trouble_in(to_record(watch_.trouble(), watch_.words())), watch_.trouble());
    EXPECT_EQ(trouble_in(to_record(watch_.trouble(), "in other words")), watch_.trouble());
    told.push_back(watch_.trouble());
  };
  pictures(well_, 1000);
  tell();
  silence(600);
  tell();
  silence(1200, "tower: broke off");
  tell();
  const auto show = [&](const auto& change, double guidance_ms = 5) {
    pipeline::PictureObservation view;
    change(view);
    pictures(well_, 5000);
    pictures(view, 200, guidance_ms);
    tell();
  };
  show([](auto& view) { view.is_blank = true; });
  show([](auto& view) { view.is_frozen = true; });
  show([](auto& view) { view.is_torn = true; });
  show([](auto& view) { view.repeat_share = 0.8; });
  show([](auto&) {}, 150);
  for (int i = 0; i < 6; ++i) watch_.shown_until(150, now_ns_);
  pictures(well_, 200);
  tell();
  for (int i = 0; i < 12; ++i)
    watch_.shown_until(150, now_ns_ += 120 * kMs), (void)watch_.picture(well_, 5, now_ns_);
  tell();
  watch_ = {};
  (void)watch_.picture(well_, 5, now_ns_, "udp://tower: 3 pictures were lost");
  tell();
  using enum SourceTrouble;
  EXPECT_EQ(told, (std::vector<SourceTrouble>{None, NoPicture, NoPicture, Plain, Frozen, Torn, Repeated, Late,
                                              Slow, Slow, Lost}));
}

}  // namespace
}  // namespace arthronaut::theatre
