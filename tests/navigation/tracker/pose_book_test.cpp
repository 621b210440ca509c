#include "navigation/tracker/pose_book.h"

#include <gtest/gtest.h>

#include <cmath>

namespace arthronaut::tracker {
namespace {

constexpr double kEpoch_s = 1.8e9, kStep_s = 1.0 / 60;
constexpr int kFemur = 0, kProbe = 2, kGuide = 3;

geometry::RigidTransform pose_at(double seed, double time_s) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1, seed, -0.5).normalized();
  return {Eigen::Quaterniond(Eigen::AngleAxisd(0.3 + 0.1 * seed + 0.01 * time_s, axis)),
          {10 * seed + time_s, -20, 35 + seed}};
}

// As the tracker has them, and all in one: the tools are where the truth is.
struct Truth {
  double time_s = 0;
  [[nodiscard]] geometry::RigidTransform tracker_from_world() const { return pose_at(7, time_s); }
  [[nodiscard]] geometry::RigidTransform world_from(int id) const { return pose_at(id, 2 * time_s); }
  [[nodiscard]] geometry::RigidTransform tracker_from(int id) const {
    return tracker_from_world() * world_from(id);
  }
};

class PoseBookTest : public ::testing::Test {
 protected:
  PoseBookTest() {
    bodies_.tools = tools::standard_tools();
    bodies_.tools.tracker = tools::OutsideTracker{"", 0.2, 0.1};
    bodies_.probe_name = "probe";
    bodies_.guide_name = "femoral guide";
  }
  static std::int64_t ns(double s) { return 1'000'000'000'000 + static_cast<std::int64_t>(s * 1e9); }
  void tell(PoseBook& book, const std::string& device, const geometry::RigidTransform& pose,
            double taken_s) const {
    EXPECT_TRUE(book.take({device, pose, has_stamps_ ? kEpoch_s + taken_s : 0, ns(taken_s + 0.001)}));
  }
  // World, probe and guide, 60 times a second.
  void run(PoseBook& book, double from_s, double to_s) {
    for (double t = from_s; t < to_s; t += kStep_s) {
      tell(book, "WorldFemur", Truth{t}.tracker_from_world(), t);
      tell(book, "Probe", Truth{t}.tracker_from(kProbe), t);
      tell(book, "Guide", Truth{t}.tracker_from(kGuide), t);
      newest_s_ = t;
    }
  }
  [[nodiscard]] geometry::RigidTransform tip_in_world(double taken_s) const {
    const geometry::RigidTransform probe = Truth{taken_s}.world_from(kProbe);
    return {probe.rotation, probe * *bodies_.tools.find_tool("probe")->tip_mm};
  }
  // As this program's own server gives them out.
  void tell_in_world(PoseBook& book, double taken_s) {
    tell(book, "ProbeTip_World", tip_in_world(taken_s), taken_s);
    tell(book, "Guide_World", Truth{taken_s}.world_from(kGuide), taken_s);
    newest_s_ = taken_s;
  }
  [[nodiscard]] static TrackerPoses at(const PoseBook& book, double s) {
    TrackerPoses poses;
    book.poses_at(ns(s), poses);
    return poses;
  }
  static geometry::RigidTransform world_from(const TrackerPoses& poses, int id,
                                             const tools::OutsideTracker& tracker) {
    const auto pose = geometry::compose(geometry::inverse(pose_of(poses, kFemur, 5, tracker)),
                                        pose_of(poses, id, 5, tracker));
    EXPECT_TRUE(pose.is_valid);
    return pose.target_from_source;
  }
  static void expect_same(const geometry::RigidTransform& a, const geometry::RigidTransform& b) {
    EXPECT_LT((a.translation_mm - b.translation_mm).norm(), 1e-9);
    EXPECT_LT(a.rotation.angularDistance(b.rotation), 1e-9);
  }

  TrackedBodies bodies_;
  bool has_stamps_ = true;
  double newest_s_ = 0;
};

// The tool in the bone's world, whatever frame the tracker keeps both in; with the error that was said.
TEST_F(PoseBookTest, ToolsAreWhereTheyAreInTheBonesWorld) {
  PoseBook book(bodies_);
  book.begin(0.001);
  run(book, 0, 1);
  const TrackerPoses poses = at(book, newest_s_ + 0.002);
  for (const int id : {kProbe, kGuide})
    expect_same(world_from(poses, id, *bodies_.tools.tracker), Truth{newest_s_}.world_from(id));
  EXPECT_NEAR(poses.oldest_age_s(), 0.002, 1e-5);
  const auto pose = pose_of(poses, kProbe, 5, *bodies_.tools.tracker);
  EXPECT_NEAR(pose.covariance(0, 0), 0.04, 1e-12);
  EXPECT_NEAR(pose.covariance(5, 5), std::pow(geometry::rad_from_deg(0.1), 2), 1e-15);
  EXPECT_EQ(state_of(poses, 1), BodyState::NeverCame) << "nobody sent the tibia";
}

// Between the message of the bone and those of the tools nothing is lost, and nothing mixed.
TEST_F(PoseBookTest, ABonesPoseThatIsNewerThanTheToolsWaitsForThem) {
  PoseBook book(bodies_);
  book.begin(0);
  run(book, 0, 1);
  const double next_s = newest_s_ + kStep_s;
  tell(book, "WorldFemur", Truth{next_s}.tracker_from_world(), next_s);
  expect_same(world_from(at(book, next_s + 0.002), kProbe, *bodies_.tools.tracker),
              Truth{newest_s_}.world_from(kProbe));
}

TEST_F(PoseBookTest, PosesOfDifferentMomentsAreNotPutTogether) {
  PoseBook book(bodies_);
  book.begin(0);
  for (double t = 0; t < 1; t += kStep_s) {
    tell(book, "WorldFemur", Truth{t}.tracker_from_world(), t);
    tell(book, "Probe", Truth{t}.tracker_from(kProbe), t + 0.008);
  }
  EXPECT_EQ(state_of(at(book, 1), kProbe), BodyState::OtherMoment);
}

// Gone in a tenth of a second, each for its own reason.
TEST_F(PoseBookTest, WhatIsNotOfNowIsNotUsedAndSaysWhy) {
  PoseBook book(bodies_);
  EXPECT_EQ(state_of(at(book, 0), kProbe), BodyState::NotConnected);
  book.begin(0);
  EXPECT_EQ(state_of(at(book, 0), kProbe), BodyState::NeverCame);
  run(book, 0, 0.3);
  EXPECT_EQ(state_of(at(book, newest_s_), kProbe), BodyState::ClockUnknown);
  run(book, 0.3, 1);
  EXPECT_EQ(state_of(at(book, newest_s_ + 0.09), kProbe), BodyState::Tracked);
  EXPECT_EQ(state_of(at(book, newest_s_ + 0.102), kProbe), BodyState::Stale);
  // Later than they are taken by more than that.
  const double t = newest_s_ + kStep_s;
  EXPECT_TRUE(book.take({"Probe", Truth{t}.tracker_from(kProbe), kEpoch_s + t, ns(t + 0.15)}));
  EXPECT_EQ(state_of(at(book, t + 0.16), kProbe), BodyState::Late);
  EXPECT_TRUE(book.take({"Guide", std::nullopt, kEpoch_s + t, ns(t)}));
  EXPECT_EQ(state_of(at(book, t), kGuide), BodyState::NoRotation);
  book.take_lost("WorldFemur");
  EXPECT_EQ(state_of(at(book, t), kFemur), BodyState::ToldLost);
  book.end();
  EXPECT_EQ(state_of(at(book, t), kFemur), BodyState::NotConnected);
}

// Hazard: a lost tool whose last pose is passed on as if it were seen. A tracker measures, and no two
// measurements are alike to the last bit.
TEST_F(PoseBookTest, APoseThatRepeatsItselfIsNoPose) {
  for (const bool may_repeat : {false, true}) {
    bodies_.tools.tracker->may_repeat = may_repeat;
    PoseBook book(bodies_);
    book.begin(0);
    run(book, 0, 1);
    for (double t = 1; t < 2.2; t += kStep_s) {
      tell(book, "WorldFemur", Truth{t}.tracker_from_world(), t);
      tell(book, "Probe", Truth{1}.tracker_from(kProbe), t);
      if (std::abs(t - 1 - PoseBook::kMaxAge_s) < 0.01) continue;  // whichever way it is rounded
      EXPECT_EQ(state_of(at(book, t + 0.002), kProbe),
                !may_repeat && t > 1 + PoseBook::kMaxAge_s ? BodyState::Repeats : BodyState::Tracked)
          << t;
    }
  }
}

TEST_F(PoseBookTest, AnErrorThatNobodySaidGuidesNothing) {
  bodies_.tools.tracker->sigma_deg.reset();
  PoseBook book(bodies_);
  book.begin(0);
  run(book, 0, 1);
  const TrackerPoses poses = at(book, newest_s_);
  EXPECT_EQ(state_of(poses, kProbe), BodyState::ErrorUnknown);
  EXPECT_FALSE(pose_of(poses, kProbe, 5, *bodies_.tools.tracker).is_valid);
}

// Without stamps the time of arrival serves, and that is said.
TEST_F(PoseBookTest, WithoutStampsArrivalCountsAndIsSaid) {
  has_stamps_ = false;
  PoseBook book(bodies_);
  book.begin(0);
  run(book, 0, 0.1);
  const TrackerPoses poses = at(book, newest_s_ + 0.011);
  EXPECT_TRUE(poses.times_are_arrivals);
  EXPECT_EQ(state_of(poses, kProbe), BodyState::Tracked);
  EXPECT_NEAR(poses.oldest_age_s(), 0.01, 1e-6);
}

// In the world of the one bone there is, the probe by its tip.
TEST_F(PoseBookTest, PosesInTheWorldOfTheOneBoneNeedNoneOfIt) {
  bodies_.tools.world_markers.resize(1);
  PoseBook book(bodies_);
  book.begin(0);
  for (double t = 0; t < 1; t += kStep_s) tell_in_world(book, t);
  const TrackerPoses poses = at(book, newest_s_ + 0.002);
  for (const int id : {kProbe, kGuide})
    expect_same(world_from(poses, id, *bodies_.tools.tracker), Truth{newest_s_}.world_from(id));
  // A tool in the tracker's own frame has nothing in common with them.
  book.begin(0);
  for (double t = 1; t < 2; t += kStep_s) {
    tell(book, "ProbeTip_World", tip_in_world(t), t);
    tell(book, "Guide", Truth{t}.tracker_from(kGuide), t);
    newest_s_ = t;
  }
  EXPECT_EQ(state_of(at(book, newest_s_ + 0.002), kGuide), BodyState::OtherFrame);
}

// Of two bones nobody says whose world it is.
TEST_F(PoseBookTest, Hazard43AWorldThatMayBeAnotherBonesGuidesNothing) {
  PoseBook book(bodies_);
  book.begin(0);
  for (double t = 0; t < 1; t += kStep_s) tell_in_world(book, t);
  for (const int id : {kFemur, kProbe, kGuide})
    EXPECT_EQ(state_of(at(book, newest_s_ + 0.002), id), BodyState::OtherWorld) << id;
  // With the bone's own poses it is told.
  for (double t = 1; t < 2; t += kStep_s) {
    tell(book, "WorldFemur", Truth{t}.tracker_from_world(), t);
    tell_in_world(book, t);
  }
  expect_same(world_from(at(book, newest_s_ + 0.002), kProbe, *bodies_.tools.tracker),
              Truth{newest_s_}.world_from(kProbe));
}

// Hazard: a server that is started anew and sees the bone's body no more goes on with a world of its own.
TEST_F(PoseBookTest, Hazard43AWorldThatTheBoneToldIsUnknownWithoutIt) {
  bodies_.tools.world_markers.resize(1);
  for (const bool was_lost : {false, true}) {
    PoseBook book(bodies_);
    book.begin(0);
    for (double t = 0; t < 1; t += kStep_s) {
      if (!was_lost) tell(book, "WorldFemur", Truth{t}.tracker_from_world(), t);
      tell_in_world(book, t);
    }
    if (was_lost) book.take_lost("WorldFemur");
    book.end();
    book.begin(0);
    for (double t = 2; t < 3; t += kStep_s) tell_in_world(book, t);
    for (const int id : {kFemur, kProbe, kGuide})
      EXPECT_EQ(state_of(at(book, newest_s_ + 0.002), id), BodyState::OtherWorld) << id << was_lost;
  }
}

// Servers send a tool in the tracker's frame and in the bone's world at once. Between the tool's messages of
// one moment and the bone's, nothing may be put together that is of two frames.
TEST_F(PoseBookTest, Hazard43OneBodyUnderTwoNamesIsReadInOneFrame) {
  PoseBook book(bodies_);
  book.begin(0);
  for (double t = 0; t < 1; t += kStep_s) {
    tell(book, "Probe", Truth{t}.tracker_from(kProbe), t);
    tell(book, "Probe_World", Truth{t}.world_from(kProbe), t);
    if (t > 0.5) {
      const TrackerPoses poses = at(book, t + 0.002);
      const double told_s = t - kStep_s;  // the bone's newest
      ASSERT_EQ(state_of(poses, kProbe), BodyState::Tracked);
      expect_same(world_from(poses, kProbe, *bodies_.tools.tracker), Truth{told_s}.world_from(kProbe));
    }
    tell(book, "WorldFemur", Truth{t}.tracker_from_world(), t);
  }
}

TEST_F(PoseBookTest, Hazard43ALostToolRepeatedUnderTwoNamesIsLost) {
  PoseBook book(bodies_);
  book.begin(0);
  for (double t = 0; t < 2; t += kStep_s) {
    tell(book, "WorldFemur", Truth{t}.tracker_from_world(), t);
    tell(book, "Probe", Truth{0}.tracker_from(kProbe), t);
    tell(book, "Probe_World", Truth{0}.world_from(kProbe), t);
    newest_s_ = t;
  }
  EXPECT_EQ(state_of(at(book, newest_s_ + 0.002), kProbe), BodyState::Repeats);
}

TEST_F(PoseBookTest, NamesAreThoseOfTheTools) {
  bodies_.tools.tracker->devices = {{"femur", "ReferenceToTracker"}, {"probe", "StylusToTracker"}};
  PoseBook book(bodies_);
  book.begin(0);
  EXPECT_FALSE(book.take({"WorldFemur", pose_at(1, 0), kEpoch_s, ns(0)})) << "another name was said";
  EXPECT_FALSE(book.take({"Stylus", pose_at(1, 0), kEpoch_s, ns(0)}));
  EXPECT_TRUE(book.take({"ReferenceToTracker", pose_at(1, 0), kEpoch_s, ns(0)}));
  EXPECT_TRUE(book.take({"StylusToTracker", pose_at(1, 0), kEpoch_s, ns(0)}));
}

// A clock that is set back, by an hour or by no more than what makes a pose late: nothing is used, and a new
// connection is asked for. It is not for what comes late once.
TEST_F(PoseBookTest, AClockThatIsSetAnewAsksForAnotherConnection) {
  for (const double back_s : {0.2, 0.9, 3600.0}) {
    PoseBook book(bodies_);
    book.begin(0);
    run(book, 0, 1);
    EXPECT_FALSE(book.is_late());
    for (double t = 1; t < 3; t += kStep_s) {
      EXPECT_TRUE(book.take({"Probe", Truth{t}.tracker_from(kProbe), kEpoch_s + t - back_s, ns(t)}));
      EXPECT_TRUE(book.is_late()) << back_s;
      EXPECT_EQ(state_of(at(book, t + 0.001), kProbe), BodyState::Late) << back_s;
    }
    EXPECT_TRUE(book.take({"Probe", Truth{3}.tracker_from(kProbe), kEpoch_s + 3, ns(3)}));
    EXPECT_FALSE(book.is_late()) << back_s;
    book.begin(0);
    EXPECT_FALSE(book.is_late());
  }
}

}  // namespace
}  // namespace arthronaut::tracker
