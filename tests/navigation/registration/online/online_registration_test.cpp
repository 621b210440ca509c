#include "navigation/registration/online/online_registration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "tests/navigation/registration/phantom_bone.h"

namespace arthronaut::registration {

namespace {

using experiments::TrialNoise;
using geometry::RigidTransform;

OnlineOptions options_for(const PhantomBone& bone) {
  OnlineOptions options;
  options.target_in_bone_mm = bone.target_mm;
  options.direction_in_bone = Eigen::Vector3d(-0.8, 0, 0.6);
  return options;
}

// Point by point, as the frames bring them; returns the states that were passed.
std::vector<OnlineState> draw(OnlineRegistration& online, const strokes::Curves& curves) {
  std::vector<OnlineState> states{online.result().state};
  for (const strokes::CurvePoint& point : curves) {
    online.add_points({&point, 1});
    const OnlineState state = online.update().state;
    if (state != states.back()) states.push_back(state);
  }
  return states;
}

}  // namespace

// From nothing to confirmed while the strokes come in; the coach's bar ends full.
TEST(OnlineRegistration, ConfirmsWhileScratching) {
  const PhantomBone& bone = phantom_bone();
  const auto trial = bone.trial(TrialNoise::Dry, 1);
  OnlineRegistration online(bone.prepared, options_for(bone));
  const auto states = draw(online, trial.curves);
  EXPECT_EQ(states.front(), OnlineState::Collecting);
  EXPECT_EQ(states.back(), OnlineState::Confirmed);
  const OnlineResult& result = online.result();
  EXPECT_DOUBLE_EQ(result.coach.progress, 1);
  EXPECT_EQ(result.coach.message, "") << "what follows is the operation's to say";
  EXPECT_LT((result.registration.marker_from_bone * bone.target_mm - trial.marker_from_bone * bone.target_mm)
                .norm(),
            0.4);
  EXPECT_EQ(result.strokes.size(), 6u);
  EXPECT_GT(result.predicted_angle_deg, 0);
}

// Markers of another size than stated: the strokes bring the bone in doubt, which revokes what a few of them
// confirmed, and what is missing says why.
TEST(OnlineRegistration, DoubtsStrokesOfAnotherSizeThanTheBone) {
  const PhantomBone& bone = phantom_bone();
  auto curves = bone.trial(TrialNoise::Dry, 1).curves;
  for (strokes::CurvePoint& point : curves) point.position_mm *= 1.05;
  OnlineRegistration online(bone.prepared, options_for(bone));
  draw(online, curves);
  EXPECT_TRUE(online.result().bone_is_in_doubt);
  EXPECT_NE(online.result().state, OnlineState::Confirmed);
  EXPECT_THAT(online.result().coach.missing, testing::Contains(testing::HasSubstr("larger than the bone")));
}

// With little drawn it says what is missing, and where to go on: a place on the bone that was not touched
// yet.
TEST(OnlineRegistration, CoachSaysWhatIsMissing) {
  const PhantomBone& bone = phantom_bone();
  auto curves = bone.trial(TrialNoise::Dry, 1).curves;
  curves.resize(130);
  OnlineRegistration online(bone.prepared, options_for(bone));
  draw(online, curves);
  const Coach& coach = online.result().coach;
  EXPECT_LT(coach.progress, 1);
  EXPECT_FALSE(coach.missing.empty());
  if (online.result().registration.has_pose) {
    ASSERT_TRUE(coach.next_patch_in_bone_mm.has_value());
    EXPECT_LT(std::abs(bone.surface->signed_distance_mm(*coach.next_patch_in_bone_mm)), 0.01);
    EXPECT_GT(coach.patches.size(), 20u);
  }
}

// A bad stroke can be taken out, put back, and undone.
TEST(OnlineRegistration, StrokesCanBeExcludedAndUndone) {
  const PhantomBone& bone = phantom_bone();
  auto curves = bone.trial(TrialNoise::Dry, 3).curves;
  OnlineRegistration online(bone.prepared, options_for(bone));
  draw(online, curves);
  EXPECT_TRUE(online.exclude_stroke(2));
  EXPECT_FALSE(online.exclude_stroke(99));
  EXPECT_TRUE(online.update().strokes[2].is_excluded);
  EXPECT_LT(online.curves_in_use().size(), curves.size());
  EXPECT_TRUE(online.exclude_stroke(2, false));
  EXPECT_TRUE(online.undo_stroke());
  EXPECT_EQ(online.update().strokes.size(), 5u);
  EXPECT_TRUE(online.result().registration.has_pose);
  online.clear();
  EXPECT_EQ(online.update().state, OnlineState::Collecting);
  EXPECT_FALSE(online.undo_stroke());
}

// Which side's bone it is was found with the strokes of then: without one of them it is asked again before
// anything is confirmed, though nothing longer was drawn.
TEST(OnlineRegistration, AsksForTheSideAgainWhenAStrokeIsTakenOut) {
  const PhantomBone& bone = phantom_bone();
  const strokes::Curves curves = bone.trial(TrialNoise::Dry, 1).curves;
  OnlineRegistration online(bone.prepared, options_for(bone));
  std::size_t next = 0;
  // Whether it was asked on the way to being confirmed.
  const auto asks_until_confirmed = [&] {
    bool asks = false;
    do {
      online.add_points({&curves[next++], 1});
      asks = online.update().registration.evidence.side_lead.has_value() || asks;
    } while (next < curves.size() && online.result().state != OnlineState::Confirmed);
    return asks;
  };
  EXPECT_TRUE(asks_until_confirmed());
  const double length_mm = online.result().length_mm;
  EXPECT_TRUE(online.exclude_stroke(0));
  EXPECT_NE(online.update().state, OnlineState::Confirmed);
  EXPECT_TRUE(asks_until_confirmed());
  EXPECT_EQ(online.result().state, OnlineState::Confirmed);
  EXPECT_LT(online.result().length_mm, 1.5 * length_mm);
}

// The phantom's notch is much like its own mirror image, and these strokes are doubted for it from the first
// asking on: what took a fifth of a second then is not asked at every step of the stroke.
TEST(OnlineRegistration, AsksForTheSideAgainOnlyWithMoreStroke) {
  const PhantomBone& bone = phantom_bone();
  OnlineRegistration online(bone.prepared, options_for(bone));
  std::optional<double> answer;
  std::vector<double> asked_mm;
  for (const strokes::CurvePoint& point : bone.trial(TrialNoise::ExVivo, 2).curves) {
    online.add_points({&point, 1});
    const OnlineResult& result = online.update();
    const std::optional<double>& side_lead = result.registration.evidence.side_lead;
    EXPECT_NE(result.state, OnlineState::Confirmed);
    if (side_lead && side_lead != answer) {
      answer = side_lead;
      asked_mm.push_back(result.length_mm);
    }
  }
  ASSERT_GT(asked_mm.size(), 1u);
  for (std::size_t i = 1; i < asked_mm.size(); ++i) EXPECT_GT(asked_mm[i], 1.1 * asked_mm[i - 1]);
}

// The wrong side's bone is never confirmed: neither by clean strokes nor by noisy ones, of which the second
// trial fits the phantom's notch, which is much like its own mirror image, a little better the wrong way
// round.
TEST(OnlineRegistration, NeverConfirmsTheMirroredBone) {
  const PhantomBone& bone = phantom_bone();
  for (const auto& [noise, seed] : {std::pair{TrialNoise::Dry, 1}, std::pair{TrialNoise::ExVivo, 2}}) {
    auto curves = bone.trial(noise, static_cast<std::uint64_t>(seed)).curves;
    for (auto& point : curves) point.position_mm.x() = -point.position_mm.x();
    OnlineRegistration online(bone.prepared, options_for(bone));
    for (const OnlineState state : draw(online, curves)) EXPECT_LT(state, OnlineState::Confirmed);
  }
}

// Cartilage of 2 mm that the mesh lacks, and of 2 mm that the probe lacks: confirmed on the way, with the
// thickness in what was assumed.
TEST(OnlineRegistration, SolvesTheThicknessOfCartilageWhileScratching) {
  const PhantomBone& bone = phantom_bone();
  for (const double thickness_mm : {2.0, -2.0}) {
    CartilageTrial laid = cartilage_trial(bone, bone.trial(TrialNoise::Dry, 1), thickness_mm);
    laid.trial.curves.resize(600);
    OnlineOptions options = options_for(bone);
    options.cartilage = laid.region;
    OnlineRegistration online(bone.prepared, options);
    EXPECT_EQ(draw(online, laid.trial.curves).back(), OnlineState::Confirmed);
    const RegistrationSummary& found = online.result().registration;
    ASSERT_EQ(found.assumptions.size(), 1u);
    EXPECT_NEAR(thickness_in(found.assumptions[0]), thickness_mm, 0.3) << found.assumptions[0];
    const RigidTransform& truth = laid.trial.marker_from_bone;
    EXPECT_LT((found.marker_from_bone * bone.target_mm - truth * bone.target_mm).norm(), 0.4);
    for (const StrokeInfo& stroke : online.result().strokes) EXPECT_LT(stroke.median_residual_mm, 0.4);
  }
}

// What was excluded or undone has no say in the thickness: without the strokes on it, the region is as if
// never touched.
TEST(OnlineRegistration, ExcludedStrokesHaveNoSayInTheThickness) {
  constexpr int kOnCartilage = 100;
  const PhantomBone& bone = phantom_bone();
  CartilageTrial laid = cartilage_trial(bone, bone.trial(TrialNoise::Dry, 3), 2);
  strokes::Curves& curves = laid.trial.curves;
  for (std::size_t i = 0; i < curves.size(); ++i)
    curves[i].curve += laid.is_on_cartilage[i] ? kOnCartilage : 0;
  std::stable_sort(curves.begin(), curves.end(),
                   [](const auto& l, const auto& r) { return l.curve < r.curve; });
  const int last = curves.back().curve;
  OnlineOptions options = options_for(bone);
  options.cartilage = laid.region;
  OnlineRegistration online(bone.prepared, options);
  constexpr std::size_t kAtOnce = 100;
  for (std::size_t i = 0; i < curves.size(); i += kAtOnce) {
    online.add_points({curves.data() + i, std::min(kAtOnce, curves.size() - i)});
    online.update();
  }
  const auto assumption = [&online] {
    const auto& assumptions = online.result().registration.assumptions;
    return assumptions.empty() ? std::string() : assumptions.front();
  };
  EXPECT_NEAR(thickness_in(assumption()), 2, 0.3) << assumption();
  EXPECT_TRUE(online.undo_stroke());
  for (int curve = kOnCartilage; curve < last; ++curve) EXPECT_TRUE(online.exclude_stroke(curve));
  online.update();
  EXPECT_THAT(assumption(),
              testing::AnyOf(testing::HasSubstr("no stroke lies on"), testing::HasSubstr("left out")));
  for (int curve = kOnCartilage; curve < last; ++curve) EXPECT_TRUE(online.exclude_stroke(curve, false));
  online.update();
  EXPECT_NEAR(thickness_in(assumption()), 2, 0.3) << assumption();
}

// A region whose thickness is free confirms no bone of the other side.
TEST(OnlineRegistration, NeverConfirmsTheMirroredBoneWithCartilage) {
  const PhantomBone& bone = phantom_bone();
  CartilageTrial laid = cartilage_trial(bone, bone.trial(TrialNoise::Dry, 1), 2);
  laid.trial.curves.resize(500);
  for (auto& point : laid.trial.curves) point.position_mm.x() = -point.position_mm.x();
  OnlineOptions options = options_for(bone);
  options.cartilage = laid.region;
  OnlineRegistration online(bone.prepared, options);
  for (const OnlineState state : draw(online, laid.trial.curves)) EXPECT_LT(state, OnlineState::Confirmed);
}

// What was drawn is judged to its last point when that is asked for, and a solution of hardly more stroke is
// no further witness: two solutions stay two, and don't confirm.
TEST(OnlineRegistration, JudgesAllWhenAsked) {
  const PhantomBone& bone = phantom_bone();
  auto curves = bone.trial(TrialNoise::Dry, 1).curves;
  curves.resize(700);
  OnlineRegistration online(bone.prepared, options_for(bone));
  draw(online, curves);
  const std::uint64_t before = online.result().revision;
  online.judge_all();
  EXPECT_EQ(online.update().revision, before + 1);
  EXPECT_EQ(online.result().state, OnlineState::Confirmed);
  EXPECT_EQ(online.result().registration.point_residuals_mm.size(), curves.size());

  OnlineRegistration at_once(bone.prepared, options_for(bone));
  at_once.add_points(curves);
  for (int i = 0; i < 8; ++i) {
    at_once.judge_all();
    EXPECT_LT(at_once.update().state, OnlineState::Confirmed)
        << "one piece of stroke, asked of again and again";
  }
}

}  // namespace arthronaut::registration
