// Markers that are partly hidden when they are first seen, or that were lost: found by what is left of them,
// and never taken for another one.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <utility>

#include "navigation/markers/marker_tracker.h"
#include "navigation/markers/seen_code.h"
#include "tests/navigation/markers/rendered_marker.h"

namespace arthronaut::markers {
namespace {

using geometry::RigidTransform;

constexpr std::int64_t kFrameNs = 16'666'667;
// A highlight of this strength saturates what is dark within 1.7 sigma.
constexpr double kHighlight = 900;

class MarkerRecovery : public ::testing::Test {
 protected:
  [[nodiscard]] RenderedPicture picture(const RigidTransform& pose) const {
    return {camera_, {{codes_[0], 4, pose}}};
  }
  [[nodiscard]] Eigen::Vector2d seen_at(const RigidTransform& pose, double x_mm, double y_mm) const {
    return *camera_.project(pose * Eigen::Vector3d(x_mm, y_mm, 0));
  }
  // Two thirds of the marker are left: its edges are good to 0.1 px each, as in a picture without a
  // highlight, but the light that falls off beside it moves some. Far below what is called wrong.
  static void expect_near(const MarkerObservation& seen, const RigidTransform& truth) {
    ASSERT_TRUE(seen.is_tracked()) << to_text(seen.state);
    EXPECT_LT(geometry::deg_from_rad(geometry::rotation_angle_rad(
                  seen.camera_from_marker.rotation.conjugate() * truth.rotation)),
              1.5);
    EXPECT_LT((seen.camera_from_marker.translation_mm - truth.translation_mm).norm(), 0.2);
  }
  // From nothing, at pose_, and nothing else. In three frames, since each is searched in another way.
  void expect_found(const RenderedPicture& shown) {
    tracker_->reset();
    for (int frame = 0; frame < 3; ++frame) (void)tracker_->track(shown.view(), camera_, frame * kFrameNs);
    const auto seen = tracker_->track(shown.view(), camera_, 3 * kFrameNs);
    expect_near(seen[0], pose_);
    EXPECT_FALSE(seen[1].is_tracked());
  }
  // beyond: pictures in which the shutter smears a cell over more than one and a quarter. squares: of how
  // far off it is by its covariance, one for each direction.
  struct Followed {
    int tracked = 0, beyond = 0, tracked_beyond = 0;
    double squares = 0;
  };
  struct MostOff {
    double turned_deg, moved_mm;
  };
  // camera_from_marker at(time_s), at 30 pictures a second with the shutter open for this part of each.
  template <class At>
  [[nodiscard]] Followed follow(const At& at, int frames, double open, const MostOff& most) {
    constexpr double kFrame_s = 1.0 / 30;
    const double half_open_s = 0.5 * open * kFrame_s;
    Followed followed;
    for (int frame = 0; frame < frames; ++frame) {
      const double time_s = frame * kFrame_s;
      const RigidTransform truth = at(time_s);
      const geometry::Vector6d first = geometry::log(truth.inverse() * at(time_s - half_open_s)),
                               last = geometry::log(truth.inverse() * at(time_s + half_open_s));
      PictureOptions options;
      options.seed = static_cast<unsigned>(frame + 1);
      const RenderedPicture shown(camera_, {{codes_[0], 4, truth, last - first, 4 * (first + last)}},
                                  options);
      const auto seen =
          tracker_->track(shown.view(), camera_, static_cast<std::int64_t>(std::llround(1e9 * time_s)));
      const bool is_beyond = (last - first).head<3>().norm() * 6 / 4 > 1.25;
      followed.beyond += is_beyond;
      EXPECT_FALSE(seen[1].is_tracked());
      if (!seen[0].is_tracked()) continue;
      ++followed.tracked;
      followed.tracked_beyond += is_beyond;
      const geometry::Vector6d off = geometry::log(seen[0].camera_from_marker.inverse() * truth);
      EXPECT_LT(geometry::deg_from_rad(off.tail<3>().norm()), most.turned_deg) << "frame " << frame;
      EXPECT_LT(off.head<3>().norm(), most.moved_mm) << "frame " << frame;
      followed.squares += off.dot(seen[0].covariance.inverse() * off) / 6;
    }
    return followed;
  }

  camera::CameraModel camera_ = small_scope();
  std::vector<MarkerCode> codes_ = codes_4x4_50();
  std::unique_ptr<MarkerTracker> tracker_ = make_tracker(std::vector<DeclaredMarker>{{0, 4}, {2, 4}});
  RigidTransform pose_ = facing_pose(0.5, 0.3, 15, 20, 12, 25);
};

// From nothing, though a highlight takes a corner with the cells about it.
TEST_F(MarkerRecovery, FindsAMarkerUnderAHighlight) {
  auto shown = picture(pose_);
  const Eigen::Vector2d corner = seen_at(pose_, 1.6, 1.6);
  shown.shine(corner.x(), corner.y(), 8, kHighlight);
  expect_found(shown);
}

// From nothing, though hardly a piece is seen of one side: the ends of those beside it say where it lies.
TEST_F(MarkerRecovery, FindsAMarkerOfWhichAHighlightHidesOneSide) {
  for (const Eigen::Vector2d& side :
       {Eigen::Vector2d(-1, 0), Eigen::Vector2d(0, -1), Eigen::Vector2d(0, 1)}) {
    auto shown = picture(pose_);
    for (const double along_mm : {-1.2, -0.4, 0.4, 1.2}) {
      const Eigen::Vector2d place_mm = 1.9 * side + along_mm * Eigen::Vector2d(side.y(), side.x());
      const Eigen::Vector2d place = seen_at(pose_, place_mm.x(), place_mm.y());
      shown.shine(place.x(), place.y(), 8, kHighlight);
    }
    SCOPED_TRACE(::testing::Message() << "side " << side.transpose());
    expect_found(shown);
  }
}

// From nothing, though highlights leave no more than two sides that meet.
TEST_F(MarkerRecovery, FindsAMarkerOfWhichHighlightsLeaveTwoSides) {
  for (const Eigen::Vector2d& hidden :
       {Eigen::Vector2d(-1, -1), Eigen::Vector2d(1, -1), Eigen::Vector2d(-1, 1), Eigen::Vector2d(1, 1)}) {
    auto shown = picture(pose_);
    for (const double along_mm : {-0.6, 0.4, 1.4}) {
      for (const Eigen::Vector2d& place_mm : {Eigen::Vector2d(1.8 * hidden.x(), along_mm * hidden.y()),
                                              Eigen::Vector2d(along_mm * hidden.x(), 1.8 * hidden.y())}) {
        const Eigen::Vector2d place = seen_at(pose_, place_mm.x(), place_mm.y());
        shown.shine(place.x(), place.y(), 10, kHighlight);
      }
    }
    SCOPED_TRACE(::testing::Message() << "hidden " << hidden.transpose());
    expect_found(shown);
  }
}

// From nothing, though highlights cut its dark in two.
TEST_F(MarkerRecovery, FindsAMarkerThatHighlightsCutInTwo) {
  auto shown = picture(pose_);
  for (const double y_mm : {-1.8, -0.9, 0.0, 0.9, 1.8}) {
    const Eigen::Vector2d place = seen_at(pose_, 0.2, y_mm);
    shown.shine(place.x(), place.y(), 5, kHighlight);
  }
  expect_found(shown);
}

// From nothing, though a highlight on each side cuts its outline into more pieces than two.
TEST_F(MarkerRecovery, FindsAMarkerThatHighlightsCutOnEverySide) {
  auto shown = picture(pose_);
  for (const Eigen::Vector2d& place_mm : {Eigen::Vector2d(-1.67, 0), Eigen::Vector2d(1.67, 0),
                                          Eigen::Vector2d(0, -1.67), Eigen::Vector2d(0, 1.67)}) {
    const Eigen::Vector2d place = seen_at(pose_, place_mm.x(), place_mm.y());
    shown.shine(place.x(), place.y(), 7, kHighlight);
  }
  expect_found(shown);
}

// From nothing, though something as dark as blood, ragged, lies across its margin and joins its square to
// what is dark beside it.
TEST_F(MarkerRecovery, FindsAMarkerWhoseMarginIsStained) {
  auto shown = picture(pose_);
  const Eigen::Vector2d edge = seen_at(pose_, 0.6, -2);
  const int x = static_cast<int>(edge.x()), y = static_cast<int>(edge.y());
  for (const auto& [from, up] : {std::pair(-32, 4), std::pair(-20, 12), std::pair(-8, 16), std::pair(4, 14),
                                 std::pair(16, 22), std::pair(28, 9)})
    shown.veil(x + from, y - up, x + from + 12, y + 40 + up, 0.32, 8);
  expect_found(shown);
}

// From nothing, through smoke that leaves a third of the contrast.
TEST_F(MarkerRecovery, FindsAMarkerBehindAVeil) {
  auto shown = picture(pose_);
  shown.veil(0, 0, 800, 600, 0.3, 130);
  expect_found(shown);
}

// From nothing, though something dark lies over one side and a corner beside it, so that no outline closes
// and what is dark of the marker is a part of it. Nothing else is seen, so that nothing says what moves.
TEST_F(MarkerRecovery, FindsAMarkerOfWhichSomethingDarkLeavesTwoSides) {
  auto shown = picture(pose_);
  const Eigen::Vector2d left = seen_at(pose_, -1.0, 0), low = seen_at(pose_, 0, -1.0);
  shown.cover(0, 0, static_cast<int>(left.x()), 600, 30);
  shown.cover(0, static_cast<int>(low.y()), 800, 600, 30);
  expect_found(shown);
}

// Followed behind something bright that takes two fifths of it and whose light passes for other cells, so
// that they no more say which marker it is: it is where it was, and its edges lie where they are predicted.
TEST_F(MarkerRecovery, FollowsAMarkerWhoseHiddenCellsSayOtherwise) {
  PictureOptions soft;
  soft.blur_px = 1.6;
  auto shown = RenderedPicture(camera_, {{codes_[0], 4, pose_}}, soft);
  for (int frame = 0; frame < 3; ++frame)
    expect_near(tracker_->track(shown.view(), camera_, frame * kFrameNs)[0], pose_);
  const int left = static_cast<int>(seen_at(pose_, -0.3, -0.3).x());
  shown.cover(0, 0, left, 600, 200);
  for (int frame = 3; frame < 6; ++frame)
    expect_near(tracker_->track(shown.view(), camera_, frame * kFrameNs)[0], pose_);
}

// Out of sight for four frames, then half a side away and under a highlight.
TEST_F(MarkerRecovery, FindsALostMarkerWhereItWentUnderAHighlight) {
  for (int frame = 0; frame < 2; ++frame)
    expect_near(tracker_->track(picture(pose_).view(), camera_, frame * kFrameNs)[0], pose_);
  auto hidden = picture(pose_);
  hidden.cover(0, 0, 800, 600, 60);
  for (int frame = 2; frame < 6; ++frame)
    EXPECT_FALSE(tracker_->track(hidden.view(), camera_, frame * kFrameNs)[0].is_tracked());
  const RigidTransform moved = facing_pose(2.4, 0.9, 15, 20, 12, 25);
  auto shown = picture(moved);
  const Eigen::Vector2d place = seen_at(moved, -1.2, 0.8);
  shown.shine(place.x(), place.y(), 8, kHighlight);
  (void)tracker_->track(shown.view(), camera_, 6 * kFrameNs);
  expect_near(tracker_->track(shown.view(), camera_, 7 * kFrameNs)[0], moved);
}

// A third is covered by something dark. The cells that are left say which marker it is, and which way up: no
// other code, and no other turn, is confirmed at the same place.
TEST_F(MarkerRecovery, KnowsACoveredCodeFromEveryOther) {
  auto shown = picture(pose_);
  const Eigen::Vector2d middle = seen_at(pose_, 0, 0);
  shown.cover(0, static_cast<int>(middle.y()) + 16, 800, 600, 35);
  const LinearTable table(1.6);
  const LinearImage image(shown.view(), table);
  const auto standard = std::span(codes_).first(5);
  EXPECT_TRUE(see_code(image, camera_, pose_, 4, {standard}, 0).is_confirmed());
  for (std::size_t other = 1; other < standard.size(); ++other)
    EXPECT_FALSE(see_code(image, camera_, pose_, 4, {standard}, other).is_confirmed()) << "marker " << other;
  const Eigen::Quaterniond quarter(Eigen::AngleAxisd(geometry::kPi / 2, Eigen::Vector3d::UnitZ()));
  const RigidTransform turned{pose_.rotation * quarter, pose_.translation_mm};
  EXPECT_FALSE(see_code(image, camera_, turned, 4, {standard}, 0).is_confirmed());
}

// A highlight takes a quarter of the inside, wherever it lies: the cells that it takes a part of say by what
// is left of them which marker it is, and which way up. No other code or turn is ever confirmed: what glows
// at its rim is not bright. The outline is whole, so that the marker is found in the first picture.
TEST_F(MarkerRecovery, KnowsACodeByThePartsOfCellsThatAHighlightLeaves) {
  const auto without = picture(pose_);
  const LinearTable table(1.6);
  const auto standard = std::span(codes_).first(5);
  for (const auto& [sigma_px, grey] : {std::pair(13, kHighlight), std::pair(16, 600.0)}) {
    for (int at = 0; at < 25; ++at) {
      const double x_mm = 0.6 * (at % 5 - 2), y_mm = 0.6 * (at / 5 - 2);
      SCOPED_TRACE(::testing::Message()
                   << "highlight of " << sigma_px << " px at " << x_mm << ", " << y_mm << " mm");
      auto shown = without;
      const Eigen::Vector2d place = seen_at(pose_, x_mm, y_mm);
      shown.shine(place.x(), place.y(), sigma_px, grey);
      const LinearImage image(shown.view(), table);
      for (int turn = 0; turn < 4; ++turn) {
        const Eigen::Quaterniond turned(
            Eigen::AngleAxisd(turn * geometry::kPi / 2, Eigen::Vector3d::UnitZ()));
        const RigidTransform pose{pose_.rotation * turned, pose_.translation_mm};
        for (std::size_t i = 0; i < standard.size(); ++i)
          EXPECT_EQ(see_code(image, camera_, pose, 4, {standard}, i).is_confirmed(), i == 0 && turn == 0)
              << "marker " << i << " turned by " << turn;
      }
      if (sigma_px > 13) continue;  // little of the edges is left to measure
      tracker_->reset();
      const auto seen = tracker_->track(shown.view(), camera_, 0);
      expect_near(seen[0], pose_);
      EXPECT_FALSE(seen[1].is_tracked());
    }
  }
}

// A highlight over a third of the inside: fewer cells tell the code where the other declared markers are seen
// elsewhere, and still no other turn is confirmed.
TEST_F(MarkerRecovery, KnowsACodeByFewerCellsWhereTheOthersAreElsewhere) {
  const auto without = picture(pose_);
  const LinearTable table(1.6);
  const auto standard = std::span(codes_).first(5);
  const std::array<char, 5> others = {0, 1, 1, 1, 1};
  int among_all = 0, alone = 0;
  for (int at = 0; at < 25; ++at) {
    auto shown = without;
    const Eigen::Vector2d place = seen_at(pose_, 0.6 * (at % 5 - 2), 0.6 * (at / 5 - 2));
    shown.shine(place.x(), place.y(), 20, kHighlight);
    const LinearImage image(shown.view(), table);
    among_all += see_code(image, camera_, pose_, 4, {standard}, 0).is_confirmed();
    alone += see_code(image, camera_, pose_, 4, {standard, {}, others}, 0).is_confirmed();
    for (int turn = 1; turn < 4; ++turn) {
      const Eigen::Quaterniond turned(Eigen::AngleAxisd(turn * geometry::kPi / 2, Eigen::Vector3d::UnitZ()));
      const RigidTransform pose{pose_.rotation * turned, pose_.translation_mm};
      EXPECT_FALSE(see_code(image, camera_, pose, 4, {standard, {}, others}, 0).is_confirmed())
          << "highlight " << at << ", turned by " << turn;
    }
  }
  EXPECT_LE(among_all, 13);
  EXPECT_GE(alone, 19);
}

// A marker that is not declared, under a highlight that hides what tells it from a declared one but for a
// cell: it is not taken for that one.
TEST_F(MarkerRecovery, TakesNoUndeclaredMarkerForADeclaredOne) {
  const LinearTable table(1.6);
  const auto standard = std::span(codes_).first(5), others = std::span(codes_).subspan(5);
  struct Likeness {
    std::size_t shown, declared;
    int turn;
    double x_mm, y_mm;
  };
  for (const Likeness& like : {Likeness{37, 2, 3, -1.2, 0.6}, Likeness{43, 3, 3, 0.6, -1.2}}) {
    RenderedPicture shown(camera_, {{codes_[like.shown], 4, pose_}});
    const Eigen::Vector2d place = seen_at(pose_, like.x_mm, like.y_mm);
    shown.shine(place.x(), place.y(), 12, kHighlight);
    const LinearImage image(shown.view(), table);
    const Eigen::Quaterniond turned(
        Eigen::AngleAxisd(like.turn * geometry::kPi / 2, Eigen::Vector3d::UnitZ()));
    const RigidTransform pose{pose_.rotation * turned, pose_.translation_mm};
    EXPECT_TRUE(see_code(image, camera_, pose, 4, {standard}, like.declared).is_confirmed());
    EXPECT_FALSE(see_code(image, camera_, pose, 4, {standard, others}, like.declared).is_confirmed());
  }
}

// A hand that shakes: while the shutter is open it takes the marker over nearly two cells, and from picture
// to picture two cells and more from where it was going to. Neither edges nor cells can be told there; the
// whole code, smeared as it moves, can. What stands is no farther off than two fifths of what is called
// wrong.
TEST_F(MarkerRecovery, FollowsAMarkerThatShakes) {
  const auto at = [&](double time_s) -> RigidTransform {
    geometry::Vector6d twist;
    twist << 2.6 * std::cos(22 * time_s), 1.1 * std::cos(19 * time_s), 0.3 * std::sin(9 * time_s),
        0.02 * std::sin(7 * time_s), 0.02 * std::sin(8 * time_s), 0.15 * std::cos(21 * time_s);
    return pose_ * geometry::exp(twist);
  };
  const Followed followed = follow(at, 16, 0.6, {.turned_deg = 2, .moved_mm = 0.4});
  EXPECT_GE(followed.beyond, 6);
  EXPECT_GE(followed.tracked_beyond, 0.8 * followed.beyond);
  EXPECT_GE(followed.tracked, 14);
  EXPECT_LT(followed.squares / followed.tracked, 2);
}

// A hand that trembles: the marker turns back every third picture, smeared over up to two cells and a half,
// and the shutter is open for more of the time than is supposed at first. The way from picture to picture
// says nothing of where it goes on to; its smear does. What stands is no farther off than two fifths of what
// is called wrong, and says so.
TEST_F(MarkerRecovery, FollowsAMarkerThatTrembles) {
  const RigidTransform rest = facing_pose(0.5, 0.3, 22, 20, 12, 25);
  const auto at = [&](double time_s) -> RigidTransform {
    geometry::Vector6d twist;
    twist << 2.6 * std::cos(32 * time_s), 1.0 * std::cos(29 * time_s), 0.3 * std::sin(9 * time_s),
        0.02 * std::sin(7 * time_s), 0.02 * std::sin(8 * time_s), 0.15 * std::cos(21 * time_s);
    return rest * geometry::exp(twist);
  };
  const Followed followed = follow(at, 24, 0.75, {.turned_deg = 2.5, .moved_mm = 0.5});
  EXPECT_GE(followed.beyond, 12);
  EXPECT_GE(followed.tracked_beyond, 0.8 * followed.beyond);
  EXPECT_GE(followed.tracked, 20);
  EXPECT_LT(followed.squares / followed.tracked, 2);
}

// Where nothing is but tissue, nothing is read.
TEST_F(MarkerRecovery, ReadsNothingBesideTheMarker) {
  const auto shown = picture(pose_);
  const LinearTable table(1.6);
  const LinearImage image(shown.view(), table);
  EXPECT_FALSE(see_code(image, camera_, facing_pose(-4, -2, 15, 5, 5, 40), 4, {codes_}, 0).is_confirmed());
  EXPECT_FALSE(
      see_code(image, camera_, facing_pose(1.9, 0.3, 15, 20, 12, 25), 4, {codes_}, 0).is_confirmed());
}

}  // namespace
}  // namespace arthronaut::markers
