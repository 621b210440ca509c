#include "navigation/sources/capture_time.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace arthronaut::sources {
namespace {

using camera::CaptureClock;

// Two days after the machine was started.
constexpr std::int64_t kNow_ns = 172'800'000'000'000 + 123'456'789;

// A stamp of the driver is the capture time, to a microsecond, in which V4L2 counts. However old: a queue
// that holds pictures for seconds gives out none of now.
TEST(LatePicture, Hazard3IsAsOldAsTheDriversStampSays) {
  for (const double age_ms : {0.0, 16.7, 350.0, 1999.0, 2001.0, 3000.0, 3'600'000.0}) {
    const CaptureTime captured = capture_time(static_cast<double>(kNow_ns) * 1e-6 - age_ms, kNow_ns);
    EXPECT_EQ(captured.clock, CaptureClock::Driver) << age_ms;
    EXPECT_NEAR(static_cast<double>(kNow_ns - captured.ns), age_ms * 1e6, 1000) << age_ms;
  }
}

// No stamp, one of the future or of the wall clock: then only the moment of handing over is known, and it is
// said that it is that.
TEST(LatePicture, TakesTheHandingOverWhereTheStampCannotBeTrue) {
  const double now_ms = static_cast<double>(kNow_ns) * 1e-6;
  for (const double driver_ms : {0.0, -1.0, now_ms + 5, 1.79e12, std::numeric_limits<double>::quiet_NaN()}) {
    const CaptureTime captured = capture_time(driver_ms, kNow_ns);
    EXPECT_EQ(captured.clock, CaptureClock::HandedOver) << driver_ms;
    EXPECT_EQ(captured.ns, kNow_ns) << driver_ms;
  }
}

// A sender at 30 pictures a second whose clock says other things than ours, over a network that takes 2 to 30
// ms: times are even again, and late by what the quickest one took. A picture that waited 200 ms is seen to
// be old.
TEST(StreamClock, TakesTheNetworksUnevennessOut) {
  constexpr std::int64_t kMs = 1'000'000, kInterval = 33'333'333, kSender = 5'000'000'000'000,
                         kOurs = 77'000'000'000;
  StreamClock clock;
  std::uint32_t draws = 1;
  for (int i = 0; i < 3000; ++i) {
    draws = draws * 1664525U + 1013904223U;
    const std::int64_t sent = kOurs + i * kInterval, on_its_way = (2 + draws % 29) * kMs;
    clock.arrived(kSender + i * kInterval, sent + on_its_way);
    if (i < 100) continue;  // until a quick one has come
    // Quickest 2 ms; in the second or so until the next such one the estimate gives way by 0.2 ms a second.
    EXPECT_NEAR(static_cast<double>(clock.captured_ns(kSender + i * kInterval) - sent), 2.5 * kMs, 1.5 * kMs);
  }
  const std::int64_t late = 3000;
  clock.arrived(kSender + late * kInterval, kOurs + late * kInterval + 200 * kMs);
  EXPECT_NEAR(static_cast<double>(clock.captured_ns(kSender + late * kInterval) - (kOurs + late * kInterval)),
              2.5 * kMs, 1.5 * kMs);
}

// A sender whose clock runs slow by 100 millionths is followed for an hour; one that was started again begins
// anew.
TEST(StreamClock, FollowsASlowClockAndANewOne) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  StreamClock clock;
  for (std::int64_t s = 0; s < 3600; ++s) clock.arrived(s * kSecond - s * 100'000, s * kSecond);
  EXPECT_NEAR(static_cast<double>(clock.captured_ns(3599 * kSecond - 3599 * 100'000)), 3599e9, 1e6);
  // The same in packets half a millisecond apart.
  constexpr std::int64_t kPacket = 500'000;
  StreamClock packets;
  for (std::int64_t i = 0; i < 240'000; ++i) packets.arrived(i * kPacket - i * kPacket / 10'000, i * kPacket);
  const std::int64_t last = 239'999 * kPacket;
  EXPECT_NEAR(static_cast<double>(packets.captured_ns(last - last / 10'000) - last), 0, 1e6);
  clock.arrived(0, 4000 * kSecond);
  EXPECT_EQ(clock.captured_ns(0), 4000 * kSecond);
}

// A sender whose count goes back by less than half a second: its pictures look so much older until the count
// is where it was, and then are as old as they are, also on a machine that is behind by then.
TEST(StreamClock, IsRightAgainAfterACountThatWentBack) {
  constexpr std::int64_t kMs = 1'000'000, kInterval = 33'333'333;
  for (const std::int64_t behind : {0, 150}) {
    for (const std::int64_t back : {40, 120, 300, 480}) {
      StreamClock clock;
      for (std::int64_t i = 0; i < 300; ++i) {
        const std::int64_t captured = i * kInterval, jitter = i * 7 % 5 * kMs;
        const std::int64_t stamp = captured - (i < 100 ? 0 : back * kMs);
        clock.arrived(stamp, captured + jitter + (i < 60 ? 0 : behind * kMs));
        const double off_ms = 1e-6 * static_cast<double>(clock.captured_ns(stamp) - captured);
        EXPECT_LE(off_ms, 6) << "younger than it is: " << back << " ms back, " << behind << " behind, " << i;
        const bool is_known = i < 100 || i > 100 + back * kMs / kInterval + 1;
        EXPECT_GE(off_ms, is_known ? -6 : -6 - back) << back << " ms back, " << behind << " behind, " << i;
      }
    }
  }
}

// Pictures that come in another order than they are shown in are no such count, on a machine that falls
// behind and while some are lost either.
TEST(StreamClock, Hazard3PicturesThatArePutInOrderStayAsOldAsTheyAre) {
  constexpr std::int64_t kInterval = 33'333'333;
  // As they come: I P B B B, with B pictures that others rest on, and one between two.
  const std::vector<std::vector<std::int64_t>> orders{{4, 1, 2, 3}, {4, 2, 1, 3}, {2, 1}};
  for (const auto& order : orders) {
    StreamClock clock;
    std::uint32_t draws = 1;
    std::int64_t number = 0;
    clock.arrived(0, 0);
    for (std::int64_t group = 0; group < 300; ++group) {
      for (const std::int64_t at : order) {
        ++number;
        draws = draws * 1664525U + 1013904223U;
        if (draws % 10 < 2) continue;
        const std::int64_t stamp = (group * static_cast<std::int64_t>(order.size()) + at) * kInterval;
        // What is shown last of a group comes first, once it was captured; then the others, and ever later.
        const std::int64_t captured = stamp, arrived = (number + 4) * kInterval + number * kInterval / 10;
        clock.arrived(stamp, arrived);
        EXPECT_LE(1e-6 * static_cast<double>(clock.captured_ns(stamp) - captured), 5 * 33.4) << number;
      }
    }
    // At 30 seconds behind nothing is called new.
    EXPECT_LE(1e-6 * static_cast<double>(clock.captured_ns(number * kInterval) - number * kInterval),
              5 * 33.4);
  }
}

// A machine that is too busy falls behind its stream, however far: what is old is never called new.
TEST(StreamClock, Hazard3WhatFallsBehindStaysOld) {
  constexpr std::int64_t kInterval = 16'666'667;
  StreamClock clock;
  for (std::int64_t i = 0; i < 600; ++i) {
    const std::int64_t captured = i * kInterval, arrived = captured + i * kInterval / 2;  // two for three
    clock.arrived(captured, arrived);
    EXPECT_NEAR(static_cast<double>(clock.captured_ns(captured) - captured), 0, 3e6) << i;
  }
  // Four seconds without any, and then what had waited meanwhile.
  StreamClock stalled;
  stalled.arrived(0, 0);
  stalled.arrived(kInterval, 4'000'000'000);
  EXPECT_NEAR(static_cast<double>(stalled.captured_ns(kInterval)), static_cast<double>(kInterval), 1e6);
}

}  // namespace
}  // namespace arthronaut::sources
