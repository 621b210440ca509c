// By how much the tile changed that changed most, picture by picture, as measured of encoded streams.
#include "navigation/pipeline/repeated_pictures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace arthronaut::pipeline {
namespace {

constexpr double kNoise = 2.1;

// A source of so many pictures a second.
class Source {
 public:
  explicit Source(int rate) : rate_(rate) { repeated_.begin(0); }
  bool give(double largest) {
    (void)repeated_.observe(largest, kNoise, ++frame_ * 1'000'000'000LL / rate_);
    return repeated_.is_suspected();
  }
  // Of the 0.4 s before the newest one.
  [[nodiscard]] double share() const {
    return repeated_.share(frame_ * 1'000'000'000LL / rate_ - 400'000'000);
  }
  [[nodiscard]] double shown_for_ms() const { return static_cast<double>(repeated_.shown_for_ns()) * 1e-6; }
  // A live scene in motion.
  void live(int count) {
    std::uniform_real_distribution<double> motion(10.5, 14.5);
    for (int i = 0; i < count; ++i) EXPECT_FALSE(give(motion(random_))) << i;
  }
  // Milliseconds from the first of these until it is suspected, counted to the picture that tells; it stays
  // so to the last. -1: never.
  double suspected_after_ms(const std::vector<double>& steps) {
    double after_ms = -1;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const bool is_suspected = give(steps[i]);
      EXPECT_FALSE(after_ms >= 0 && !is_suspected) << "it hangs still, " << i;
      if (is_suspected && after_ms < 0) after_ms = 1000.0 * static_cast<double>(i + 1) / rate_;
    }
    return after_ms;
  }

 private:
  int rate_;
  long frame_ = 0;
  std::mt19937 random_{7};
  RepeatedPictures repeated_;
};

// What openh264 makes of a picture that hangs: it refines it, and codes it anew every 15 pictures. `until`
// the first key frame.
std::vector<double> hanging_h264(int until) {
  std::vector<double> steps{0.79};
  while (steps.size() < 120) {
    const int after_key = (static_cast<int>(steps.size()) - until + 150) % 15;
    const bool is_first = static_cast<int>(steps.size()) < until + 15;
    const std::vector<double> refined{is_first ? 2.47 : 0.69, 0.62, 0.18, 0.06};
    steps.push_back(static_cast<std::size_t>(after_key) < refined.size()
                        ? refined[static_cast<std::size_t>(after_key)]
                        : 0);
  }
  if (until == 0) steps[0] = 2.47;
  return steps;
}

// Guidance is to be gone a tenth of a second after the source hangs, and to stay away: each key frame of the
// hanging picture changes all of it by as much as noise does.
TEST(RepeatedPictures, OfAnEncoderThatRefinesAPictureThatHangsAreTold) {
  for (int until = 0; until < 15; ++until) {
    Source source(30);
    source.live(60);
    const double after_ms = source.suspected_after_ms(hanging_h264(until));
    EXPECT_GT(after_ms, 0) << until;
    EXPECT_LE(after_ms, 101) << until;
  }
}

// x264 at CRF 28, 60 pictures a second, of a scope whose mask hides how much noise there is.
TEST(RepeatedPictures, OfACoarseEncoderAreToldByTheStop) {
  Source source(60);
  source.live(60);
  EXPECT_LE(source.suspected_after_ms({1.0, 0.89, 0.40, 0.31, 0.31, 0.14, 0.09, 0.06, 0.09, 0.04}), 84);
}

// What a source that hangs goes on showing is as old as its last live picture, from the first one that
// repeats it to the one that is suspected: also where an encoder refines the first ones, and the third is
// suspected.
TEST(RepeatedPictures, AreAsOldAsWhatTheyShow) {
  for (int until = 0; until < 15; ++until) {
    Source source(30);
    source.live(60);
    EXPECT_EQ(source.shown_for_ms(), 0);
    const std::vector<double> steps = hanging_h264(until);
    int repeats = 0;
    while (!source.give(steps[static_cast<std::size_t>(repeats)]))
      EXPECT_NEAR(source.shown_for_ms(), 1000.0 * ++repeats / 30, 0.01) << until;
    EXPECT_GE(repeats, 1) << until;
    EXPECT_LE(repeats, 2) << until;
    EXPECT_EQ(source.shown_for_ms(), 0) << "no pose stands";
  }
}

// One picture that is shown twice is as old as that, and the next one is new. Nothing is suspected.
TEST(RepeatedPictures, OfWhichOneAloneIsRepeatedAreNewAgainWithTheNext) {
  for (const int rate : {25, 30, 60}) {
    Source source(rate);
    for (int i = 0; i < 5; ++i) {
      source.live(20);
      EXPECT_FALSE(source.give(0));
      EXPECT_NEAR(source.shown_for_ms(), 1000.0 / rate, 0.01) << rate;
      EXPECT_FALSE(source.give(12));
      EXPECT_EQ(source.shown_for_ms(), 0) << rate;
    }
  }
}

// A scope that stops from one picture to the next keeps its noise: with the second one of it that is known.
TEST(RepeatedPictures, OfAScopeThatStopsAtOnceAreNewAgainWithTheSecond) {
  Source source(30);
  source.live(60);
  EXPECT_FALSE(source.give(2.2));
  EXPECT_GT(source.shown_for_ms(), 0);
  for (int i = 0; i < 30; ++i) {
    EXPECT_FALSE(source.give(2.1));
    EXPECT_EQ(source.shown_for_ms(), 0) << i;
  }
}

// x264 refines a picture that hangs in small steps: it is suspected 0.2 s later, hung for 0.3 s all the same,
// and too old to be shown meanwhile. One of constant rate (4 Mb/s) goes on to refine it, from one key frame
// to the next, and it stays suspected. As measured at 960 x 540 and 30 pictures a second, `probe_wet`.
TEST(RepeatedPictures, OfAnEncoderThatRefinesInSmallStepsAreToldAndStayTold) {
  const std::vector<double> crf_18{0.84, 0.85, 0.69, 0.69, 0.40, 0.34, 0.28, 0.22, 0.16, 0.12, 0.05, 0.08};
  const std::vector<double> rate_4m{1.16, 0.97, 1.01, 0.91, 0.56, 0.42, 0.30, 0.43, 0.25, 0.29, 1.15, 0.47,
                                    0.57, 0.38, 0.46, 0.51, 0.52, 0.46, 0.18, 0.22, 0.20, 0.20, 0.20, 0.13};
  for (const std::vector<double>& steps : {crf_18, rate_4m}) {
    RepeatedPictures repeated;
    repeated.begin(0);
    std::int64_t time_ns = 0;
    const auto give = [&](double largest) {
      (void)repeated.observe(largest, 2.4, time_ns += 33'333'333);
      return repeated.is_suspected();
    };
    for (int i = 0; i < 30; ++i) EXPECT_FALSE(give(i % 2 == 0 ? 46 : 70));
    for (std::size_t i = 0; i < steps.size(); ++i) {
      EXPECT_EQ(give(steps[i]), i >= 5) << i << ' ' << steps[0];
      EXPECT_TRUE(i >= 5 || repeated.shown_for_ns() > 33'000'000 * static_cast<std::int64_t>(i + 1)) << i;
      EXPECT_EQ(repeated.hanging_share(time_ns - 300'000'000) >= 0.8, i >= 8) << i << ' ' << steps[0];
    }
  }
}

// Before anything is known of the source, and after it hung a moment ago.
TEST(RepeatedPictures, AreToldAtOnceAlsoOfASourceThatIsNotKnown) {
  Source source(30);
  source.live(3);
  EXPECT_LE(source.suspected_after_ms({0, 0, 0, 0, 0}), 67);
  source.live(6);
  EXPECT_LE(source.suspected_after_ms({0, 0, 0, 0, 0}), 101);
}

// A source that hung goes on by a leap, since everything has moved meanwhile; that it moves by less
// afterwards is no stop. When it hangs once more it is told as soon as the first time, and what it shows is
// as old from the first picture on that repeats. As measured of openh264 in a drill that freezes its source
// again and again, 30 pictures a second.
TEST(RepeatedPictures, OfASourceThatHangsOnceMoreAreToldAsSoon) {
  Source source(30);
  source.live(60);
  for (int times = 0; times < 5; ++times) {
    SCOPED_TRACE(times);
    EXPECT_LE(source.suspected_after_ms({0.91, 0, 0, 2.38, 0.57, 0.18, 0, 0, 0, 0, 0, 0, 0, 0, 0}), 67);
    EXPECT_FALSE(source.give(125.5));
    source.live(45);
    EXPECT_FALSE(source.give(0.71));
    EXPECT_NEAR(source.shown_for_ms(), 33.3, 0.1) << "it may hang";
    EXPECT_FALSE(source.give(13));
    source.live(20);
  }
}

// Where sender and network are busy two repeats come less than two intervals after the last live one.
TEST(RepeatedPictures, ThatComeALittleTooSoonAreToldAsSoon) {
  RepeatedPictures repeated;
  repeated.begin(0);
  std::int64_t time_ns = 0;
  const auto give = [&](double largest, std::int64_t after_ns) {
    (void)repeated.observe(largest, kNoise, time_ns += after_ns);
    return repeated.is_suspected();
  };
  for (int i = 0; i < 30; ++i) EXPECT_FALSE(give(12, 33'333'333));
  EXPECT_FALSE(give(0, 28'000'000));
  EXPECT_TRUE(give(0, 31'000'000));
}

// A habit is none once what it shows on is older than may guide.
TEST(RepeatedPictures, ThatAreTooOldAreToldWhateverTheHabit) {
  Source source(30);
  source.live(20);
  for (int i = 0; i < 10; ++i) {
    EXPECT_FALSE(source.give(12));
    for (int repeat = 0; repeat < 4; ++repeat) {
      const bool is_suspected = source.give(0);
      EXPECT_TRUE(repeat < 2 || is_suspected) << repeat;
    }
  }
}

// A scope that comes to rest keeps its noise, also where a codec takes most of it away; a probe's tip that is
// stopped by the bone leaves that of the scope.
TEST(RepeatedPictures, OfAScopeThatComesToRestAreNone) {
  for (const double noise : {0.5, 0.8, 1.2, 2.0, 5.0}) {
    Source source(60);
    source.live(60);
    std::uniform_real_distribution<double> rest(noise, 1.2 * noise);
    std::mt19937 random(3);
    for (int i = 0; i < 90; ++i) EXPECT_FALSE(source.give(rest(random))) << noise << ' ' << i;
  }
}

// 30 pictures a second, each sent twice; 24, two and three times; 15, four times: moving, and at rest.
TEST(RepeatedPictures, OfAConverterAreItsHabit) {
  for (const std::vector<int>& times : {std::vector<int>{2}, std::vector<int>{2, 3}, std::vector<int>{4}}) {
    for (const double largest : {12.0, 2.5}) {
      Source source(60);
      for (int i = 0; i < 240; ++i) {
        EXPECT_FALSE(source.give(largest));
        for (int repeat = 1; repeat < times[static_cast<std::size_t>(i) % times.size()]; ++repeat)
          EXPECT_FALSE(source.give(0.1)) << times[0] << ' ' << largest;
      }
    }
  }
}

// Four pictures in five repeat, and an encoder refines each: more than 0.65 of the last 0.4 s repeat from the
// eleventh picture on, which is what is told, and none once all move again. A picture that moved and the four
// after it, as measured at 960 x 540 of x264 at CRF 18, 23 and 28 and at 4 Mb/s, and of openh264, of which
// the first one may be refined as much as noise changes it.
TEST(RepeatedPictures, Hazard28ThatAnEncoderRefinesBetweenTwoThatMoveAreCounted) {
  for (const std::vector<double>& five :
       {std::vector<double>{98, 1.88, 1.64, 1.14, 0.71}, std::vector<double>{86, 1.90, 1.47, 0.89, 0.98},
        std::vector<double>{100, 0.88, 1.18, 0.80, 0.54}, std::vector<double>{87, 0.53, 0.95, 0.81, 0.59},
        std::vector<double>{49, 0.53, 0, 0, 0}, std::vector<double>{53, 1.65, 0.43, 0.20, 0}}) {
    Source source(30);
    source.live(30);
    for (std::size_t i = 0; i < 60; ++i) {
      (void)source.give(five[i % 5]);
      if (i >= 10) {
        EXPECT_GT(source.share(), 0.65) << i << ' ' << five[1];
      }
    }
    source.live(16);
    EXPECT_EQ(source.share(), 0);
  }
}

// A hand that stops and goes on: it takes longer to do so than from one picture to the next, and then it is
// at rest for longer than it moved, or moves for longer than it rested.
TEST(RepeatedPictures, OfAHandThatStopsAndGoesOnAreNone) {
  for (const double noise : {2.2, 3.0, 5.0}) {
    Source source(30);
    source.live(30);
    for (int i = 0; i < 10; ++i) {
      for (const double largest : {40.0, 55.0, 30.0, 12.0, 4.0, noise, noise, noise, noise, 5.0, 20.0})
        (void)source.give(largest);
      EXPECT_LE(source.share(), 0.4) << noise;
    }
  }
}

// It ends with the first picture in which something moves, and a tenth of a second after it is noisy again.
TEST(RepeatedPictures, EndWhenTheSourceLivesAgain) {
  for (const bool moves : {true, false}) {
    Source source(30);
    source.live(30);
    (void)source.suspected_after_ms({0, 0, 0, 0, 0});
    for (int i = 0; !moves && i < 2; ++i) EXPECT_TRUE(source.give(2.4));
    EXPECT_FALSE(source.give(moves ? 12 : 2.4));
  }
}

}  // namespace
}  // namespace arthronaut::pipeline
