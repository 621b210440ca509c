// A tracker on loopback that is late, wrong, killed and started again.
#include "navigation/openigtlink/igtl_tracker.h"

#include <gtest/gtest.h>

#include <thread>

#include "navigation/sources/capture_time.h"
#include "planning/geometry/error.h"
#include "tests/navigation/openigtlink/tracker_peer.h"

namespace arthronaut::openigtlink {
namespace {

using test::TrackerPeer;
using tracker::BodyState;
using Milliseconds = std::chrono::milliseconds;

constexpr int kProbe = 2;

class IgtlTrackerTest : public ::testing::Test {
 protected:
  IgtlTrackerTest() {
    bodies_.tools = tools::standard_tools();
    bodies_.tools.tracker = tools::OutsideTracker{"", 0.2, 0.1};
    bodies_.probe_name = "probe";
    bodies_.guide_name = "femoral guide";
  }
  [[nodiscard]] static geometry::RigidTransform pose(double seed, long i) {
    const double s = seed + 1e-3 * static_cast<double>(i % 100);
    return {Eigen::Quaterniond(Eigen::AngleAxisd(s, Eigen::Vector3d::UnitX())), {10 * s, -20, 35}};
  }
  // The bone's and the probe's pose, of one moment.
  void send() {
    const double stamp_s = stamps_ ? test::utc_s() + ahead_s_ : 0;
    ++count_;
    (void)(peer_.send(test::transform_message("WorldFemur", pose(0.1, count_), stamp_s)) &&
           peer_.send(test::transform_message("Probe", pose(0.5, count_), stamp_s)));
  }
  [[nodiscard]] static BodyState state(IgtlTracker& tracker) {
    tracker::TrackerPoses poses;
    tracker.poses_at(sources::steady_now_ns(), poses);
    return tracker::state_of(poses, kProbe);
  }
  // Sends 100 times a second until it is so; false: not within 20 s.
  template <typename Condition>
  bool until(const Condition& condition, bool sends = true) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (std::chrono::steady_clock::now() < end) {
      if (sends) send();
      if (condition()) return true;
      std::this_thread::sleep_for(Milliseconds(10));
    }
    return false;
  }

  TrackerPeer peer_;
  tracker::TrackedBodies bodies_;
  double ahead_s_ = 0;
  bool stamps_ = true;
  long count_ = 0;
};

TEST_F(IgtlTrackerTest, GivesPosesWhateverTheClocksDiffer) {
  for (const double ahead_s : {0.0, 3600.0, -3600.0}) {
    ahead_s_ = ahead_s;
    peer_.drop();
    IgtlTracker tracker(peer_.address(), bodies_);
    EXPECT_TRUE(until([&] { return state(tracker) == BodyState::Tracked; })) << tracker.trouble();
    EXPECT_EQ(tracker.trouble(), "");
  }
}

// Stalled: gone within the limit whatever the thread does, told, and there again when the tracker goes on.
TEST_F(IgtlTrackerTest, AStallIsSeenAndTold) {
  IgtlTracker tracker(peer_.address(), bodies_);
  ASSERT_TRUE(until([&] { return state(tracker) == BodyState::Tracked; })) << tracker.trouble();
  const auto stalled = std::chrono::steady_clock::now();
  EXPECT_TRUE(until([&] { return state(tracker) == BodyState::Stale; }, false));
  EXPECT_GE(std::chrono::steady_clock::now() - stalled, Milliseconds(80)) << "not before its time";
  EXPECT_TRUE(until([&] { return tracker.trouble().find("no pose comes") != std::string::npos; }, false))
      << tracker.trouble();
  EXPECT_TRUE(until([&] { return state(tracker) == BodyState::Tracked; })) << tracker.trouble();
  EXPECT_EQ(tracker.trouble(), "");
}

TEST_F(IgtlTrackerTest, OneThatIsKilledIsTakenUpAgainByItself) {
  IgtlTracker tracker(peer_.address(), bodies_);
  ASSERT_TRUE(until([&] { return state(tracker) == BodyState::Tracked; })) << tracker.trouble();
  peer_.stop();
  EXPECT_TRUE(until([&] { return state(tracker) == BodyState::NotConnected; }, false));
  EXPECT_TRUE(until([&] { return tracker.trouble().find("refused") != std::string::npos; }, false))
      << tracker.trouble();
  peer_.start();
  EXPECT_TRUE(until([&] { return state(tracker) == BodyState::Tracked; })) << tracker.trouble();
}

TEST_F(IgtlTrackerTest, WaitsForOneThatIsNotThereYet) {
  peer_.stop();
  IgtlTracker tracker(peer_.address(), bodies_);
  EXPECT_TRUE(until([&] { return tracker.trouble().find("connecting again") != std::string::npos; }, false));
  peer_.start();
  EXPECT_TRUE(until([&] { return state(tracker) == BodyState::Tracked; })) << tracker.trouble();
}

// What is spoilt on its way does not count, and does not end the connection.
TEST_F(IgtlTrackerTest, WrongChecksumsAreToldAndGuideNothing) {
  IgtlTracker tracker(peer_.address(), bodies_);
  const auto spoilt = [&] {
    test::Bytes message = test::transform_message("Probe", pose(0.5, ++count_), test::utc_s());
    message.back() ^= 1;
    (void)peer_.send(message);
    return tracker.trouble().find("checksum") != std::string::npos;
  };
  EXPECT_TRUE(until(spoilt, false)) << tracker.trouble();
  EXPECT_EQ(state(tracker), BodyState::NeverCame);
  EXPECT_TRUE(until([&] { return state(tracker) == BodyState::Tracked; })) << tracker.trouble();
}

// Something else listens there: told, and tried again.
TEST_F(IgtlTrackerTest, WhatIsNoTrackerIsTold) {
  IgtlTracker tracker(peer_.address(), bodies_);
  const std::string web = "HTTP/1.1 400 Bad Request\r\nContent-Type: text/plain\r\nConnection: close\r\n\r\n";
  const auto answered = [&] {
    (void)peer_.send(test::Bytes(web.begin(), web.end()));
    return tracker.trouble().find("no OpenIGTLink") != std::string::npos;
  };
  EXPECT_TRUE(until(answered, false)) << tracker.trouble();
  peer_.drop();
  EXPECT_TRUE(until([&] { return state(tracker) == BodyState::Tracked; })) << tracker.trouble();
}

TEST_F(IgtlTrackerTest, HalfAMessageEndsTheConnection) {
  IgtlTracker tracker(peer_.address(), bodies_);
  test::Bytes half = test::transform_message("Probe", pose(0.5, 1), test::utc_s());
  half.resize(70);
  ASSERT_TRUE(until([&] { return peer_.send(half); }, false));
  EXPECT_TRUE(until([&] { return tracker.trouble().find("half-way") != std::string::npos; }, false))
      << tracker.trouble();
  peer_.drop();
  EXPECT_TRUE(until([&] { return state(tracker) == BodyState::Tracked; })) << tracker.trouble();
}

// One length in a header is wrong: all that comes after it would be of that message, for hours, while bytes
// come all the time.
TEST_F(IgtlTrackerTest, AMessageThatDoesNotEndEndsTheConnection) {
  IgtlTracker tracker(peer_.address(), bodies_);
  ASSERT_TRUE(until([&] { return state(tracker) == BodyState::Tracked; })) << tracker.trouble();
  test::Bytes spoilt = test::transform_message("Probe", pose(0.5, 1), test::utc_s());
  spoilt[46] = 0x40;  // a gigabyte
  ASSERT_TRUE(until([&] { return peer_.send(spoilt); }, false));
  EXPECT_TRUE(until([&] { return tracker.trouble().find("does not end") != std::string::npos; }))
      << tracker.trouble();
  peer_.drop();
  EXPECT_TRUE(until([&] { return state(tracker) == BodyState::Tracked; })) << tracker.trouble();
}

// The tracker's clock is set back while it runs, by an hour or by as little as makes a pose late: nothing is
// used until a new connection has told how it goes now.
TEST_F(IgtlTrackerTest, AClockThatIsSetAnewIsLearntAnew) {
  for (const double back_s : {3600.0, 0.2}) {
    ahead_s_ = 0;
    peer_.drop();
    IgtlTracker tracker(peer_.address(), bodies_);
    ASSERT_TRUE(until([&] { return state(tracker) == BodyState::Tracked; })) << tracker.trouble();
    ahead_s_ = -back_s;
    EXPECT_TRUE(until([&] { return state(tracker) == BodyState::Late; }));
    EXPECT_TRUE(until([&] { return state(tracker) == BodyState::NotConnected; })) << back_s;
    EXPECT_NE(tracker.trouble().find("late by its clock"), std::string::npos) << tracker.trouble();
    peer_.drop();
    EXPECT_TRUE(until([&] { return state(tracker) == BodyState::Tracked; })) << tracker.trouble();
  }
}

TEST_F(IgtlTrackerTest, NamesThatNobodyHereGoesByAreTold) {
  IgtlTracker tracker(peer_.address(), bodies_);
  const auto sends_others = [&] {
    (void)peer_.send(test::transform_message("StylusToTracker", pose(0.5, ++count_), test::utc_s()));
    return tracker.trouble().find("StylusToTracker") != std::string::npos;
  };
  EXPECT_TRUE(until(sends_others, false)) << tracker.trouble();
}

// Letting it go waits for nothing, whatever the tracker does.
TEST_F(IgtlTrackerTest, EndsAtOnce) {
  auto tracker = std::make_unique<IgtlTracker>("igtl://192.0.2.1:18944", bodies_);  // answers to nobody
  std::this_thread::sleep_for(Milliseconds(100));
  const auto begin = std::chrono::steady_clock::now();
  tracker.reset();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(2)) << "connecting takes longer";
}

TEST(TrackerAddress, IsReadOrRefused) {
  EXPECT_EQ(tracker_address("igtl://tracker:1234").host, "tracker");
  EXPECT_EQ(tracker_address("igtl://tracker:1234").port, 1234);
  EXPECT_EQ(tracker_address("igtl://10.0.0.7").port, 18944);
  EXPECT_EQ(tracker_address("igtl://[::1]:5").host, "::1");
  EXPECT_EQ(tracker_address("igtl://[::1]").port, 18944);
  for (const char* bad :
       {"", "tracker:1234", "igtl://", "igtl://:5", "igtl://a:0", "igtl://a:65536", "igtl://a:x",
        "igtl://a:5x", "igtl://[::1", "igtl://[::1]x:5", "igtl://a/b:5", "http://a:5"})
    EXPECT_THROW((void)tracker_address(bad), InvalidInput) << bad;
}

}  // namespace
}  // namespace arthronaut::openigtlink
