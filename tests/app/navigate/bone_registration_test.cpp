#include "app/navigate/bone_registration.h"

#include <gtest/gtest.h>

#include "app/navigate/registration_words.h"
#include "app/navigate/touched_picture.h"
#include "tests/navigation/registration/phantom_bone.h"

namespace arthronaut::navigate {
namespace {

using registration::phantom_bone;

std::shared_future<SurfaceIndexPtr> ready_bone() {
  std::promise<SurfaceIndexPtr> promise;
  promise.set_value(phantom_bone().prepared);
  return promise.get_future().share();
}

tunnels::Tunnel plan() {
  tunnels::Tunnel tunnel;
  tunnel.entry_mm = phantom_bone().target_mm;
  tunnel.direction = Eigen::Vector3d(-0.8, 0, 0.6);
  return tunnel;
}

class BoneRegistrationTest : public ::testing::Test {
 protected:
  // As the frames bring the tip: the strokes of a trial, a gap between them.
  void draw_on(BoneRegistration& bone, const strokes::Curves& curves) {
    for (const strokes::CurvePoint& point : curves) {
      time_s_ += last_curve_ == point.curve ? 1.0 / 60 : 1.0;
      last_curve_ = point.curve;
      bone.add_tip(time_s_, point.position_mm);
    }
  }
  void draw(const strokes::Curves& curves) {
    draw_on(bone_, curves);
    bone_.finish();
    (void)bone_.status();  // as every frame does
  }
  [[nodiscard]] Eigen::Vector3d on_bone(double dx_mm) const {
    return trial_.marker_from_bone *
           surface_->closest_point(phantom_bone().target_mm + Eigen::Vector3d(dx_mm, dx_mm, 3)).point_mm;
  }

  experiments::Trial trial_ = phantom_bone().trial(experiments::TrialNoise::Dry, 1);
  std::shared_ptr<const geometry::Surface> surface_ =
      std::make_shared<geometry::Surface>(phantom_bone().mesh);
  BoneRegistration bone_{ready_bone(), plan(), surface_};
  double time_s_ = 0;
  int last_curve_ = -1;
};

// Nothing guides before it is confirmed; then it takes effect by itself, with the numbers of that moment in
// the history.
TEST_F(BoneRegistrationTest, AConfirmedRegistrationTakesEffectByItself) {
  EXPECT_EQ(bone_.status()->in_force, nullptr);
  draw(trial_.curves);
  const RegistrationStatus status = *bone_.status();
  ASSERT_NE(status.in_force, nullptr);
  EXPECT_TRUE(status.in_force->reliable);
  EXPECT_GT(status.change_count, 0U);
  ASSERT_FALSE(status.history->empty());
  EXPECT_EQ(status.history->back().registration, status.in_force);
  const Eigen::Vector3d target = phantom_bone().target_mm;
  EXPECT_LT((status.in_force->marker_from_bone * target - trial_.marker_from_bone * target).norm(), 0.6);
  EXPECT_EQ(state_of(status).name, "Confirmed");
  EXPECT_EQ(missing_of(status), "");
  EXPECT_EQ(numbers_of(status).size(), 2U);
  EXPECT_GE(stroke_rows(status).size(), 6U);
}

// The first half of the strokes confirms; the rest is of a surface that is not this bone's, wavy by more than
// any tracker's error. Together they fit no longer: what the first half found guides no more, with the
// reason.
TEST_F(BoneRegistrationTest, ADoubtAboutTheBoneTakesGuidanceAway) {
  constexpr double kWave_mm = 1.0, kLength_mm = 9;
  const std::size_t half = trial_.curves.size() / 2;
  draw({trial_.curves.begin(), trial_.curves.begin() + static_cast<std::ptrdiff_t>(half)});
  ASSERT_NE(bone_.status()->in_force, nullptr);
  ASSERT_TRUE(bone_.status()->in_force->reliable);
  strokes::Curves other_bone(trial_.curves.begin() + static_cast<std::ptrdiff_t>(half), trial_.curves.end());
  for (strokes::CurvePoint& point : other_bone) {
    const Eigen::Vector3d phase = 2 * geometry::kPi / kLength_mm * point.position_mm;
    point.position_mm += kWave_mm * Eigen::Vector3d(phase.y(), phase.z(), phase.x()).array().sin().matrix();
  }
  draw(other_bone);
  const auto status = bone_.status();
  EXPECT_TRUE(status->online->bone_is_in_doubt);
  EXPECT_FALSE(status->in_force->reliable);
  EXPECT_FALSE(status->in_force->reasons.empty());
}

// While it collects, the words say what is missing.
TEST_F(BoneRegistrationTest, SaysWhatIsMissingWhileItCollects) {
  strokes::Curves little;
  for (const strokes::CurvePoint& point : trial_.curves)
    if (little.size() < trial_.curves.size() / 20) little.push_back(point);
  draw(little);
  const RegistrationStatus status = *bone_.status();
  EXPECT_EQ(status.in_force, nullptr);
  EXPECT_TRUE(missing_of(status).starts_with("Missing: ")) << missing_of(status);
  EXPECT_LT(progress_of(status), 1);
}

// A bumped marker: what is in force becomes unreliable at once with the reason; touches that were wrong can
// be forgotten; clearing the points after an alarm drops the registration for good.
TEST_F(BoneRegistrationTest, ABumpedMarkerTakesGuidanceAway) {
  draw(trial_.curves);
  const Eigen::Vector3d control = on_bone(0);
  bone_.touch_control_point(control);
  const Eigen::Vector3d bump(0, 0, 2.4);
  bone_.touch_control_point(control + bump);
  EXPECT_TRUE(bone_.status()->in_force->reliable);
  const std::uint64_t before = bone_.status()->change_count;
  bone_.touch_control_point(control + bump);
  RegistrationStatus status = *bone_.status();
  EXPECT_FALSE(status.in_force->reliable);
  EXPECT_EQ(status.in_force->reasons.front(), status.alarm);
  EXPECT_GT(status.change_count, before);
  EXPECT_EQ(state_of(status).severity, widgets::Severity::Bad);
  EXPECT_EQ(progress_of(status), 0);

  bone_.forget_touches();
  bone_.finish();
  EXPECT_TRUE(bone_.status()->in_force->reliable);

  bone_.touch_control_point(control);
  for (int i = 0; i < 2; ++i) bone_.touch_control_point(control + bump);
  EXPECT_FALSE(bone_.status()->in_force->reliable);
  bone_.clear();
  bone_.finish();
  status = *bone_.status();
  EXPECT_EQ(status.in_force, nullptr);
  EXPECT_EQ(status.alarm, "");
  ASSERT_FALSE(status.history->empty()) << "its numbers are kept";
  EXPECT_TRUE(status.history->back().is_void);
  bone_.step_history(-1);
  EXPECT_EQ(bone_.status()->in_force, nullptr) << "it can't be taken again";
}

// Touches on the bone that are not used in the fit verify it; their distance is the one that is shown large.
TEST_F(BoneRegistrationTest, TouchesVerify) {
  draw(trial_.curves);
  for (int i = 0; i < 3; ++i) bone_.add_touch(on_bone(0));
  bone_.finish();
  EXPECT_EQ(state_of(*bone_.status()).name, "Confirmed") << "one place, touched three times";
  EXPECT_FALSE(bone_.status()->touches.last().is_new_place);
  EXPECT_FALSE(is_verified(*bone_.status()));
  for (const double dx_mm : {4.0, -4.0}) bone_.add_touch(on_bone(dx_mm));
  bone_.finish();
  const RegistrationStatus status = *bone_.status();
  EXPECT_EQ(state_of(status).name, "Verified");
  EXPECT_TRUE(is_verified(status));
  const auto touch = touch_of(status);
  ASSERT_TRUE(touch);
  EXPECT_EQ(touch->number.name, "Touch 5");
  EXPECT_EQ(touch->number.severity, widgets::Severity::Good);
}

// Going back to an earlier registration holds against newer ones until the newest is chosen again.
TEST_F(BoneRegistrationTest, AnEarlierRegistrationCanBeChosen) {
  draw(trial_.curves);
  bone_.register_all([] { return true; });
  RegistrationStatus status = *bone_.status();
  ASSERT_GE(status.history->size(), 2U);
  EXPECT_EQ(status.in_force, status.history->back().registration);
  bone_.step_history(-1);
  status = *bone_.status();
  EXPECT_TRUE(status.is_chosen);
  EXPECT_EQ(status.in_force, (*status.history)[status.history->size() - 2].registration);
  EXPECT_EQ(history_rows(status).size(), status.history->size());
  bone_.step_history(1);
  EXPECT_FALSE(bone_.status()->is_chosen);
}

// What was asked for by an operation that has been stopped meanwhile does not take effect.
TEST_F(BoneRegistrationTest, AStoppedRegistrationHasNoEffect) {
  draw(trial_.curves);
  const RegistrationStatus before = *bone_.status();
  bone_.register_all([] { return false; });
  EXPECT_EQ(bone_.status()->in_force, before.in_force);
  EXPECT_EQ(bone_.status()->history->size(), before.history->size());
}

// What was fitted to strokes that are gone when the fit is done must never show: clearing, taking back or
// leaving out while the fit waits for its bone makes it void.
TEST_F(BoneRegistrationTest, ARegistrationOfOldStrokesHasNoEffect) {
  const std::vector<std::function<void(BoneRegistration&)>> changes{
      [](BoneRegistration& bone) { bone.clear(); }, [](BoneRegistration& bone) { bone.take_back_stroke(); },
      [](BoneRegistration& bone) { bone.leave_out(0, true); },
      [](BoneRegistration&) {},  // nothing changes: it takes effect
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    BoneRegistration* during = nullptr;
    // A deferred future runs in the fit's own call, right after the strokes were taken.
    const std::shared_future<SurfaceIndexPtr> bone = std::async(std::launch::deferred, [&]() {
                                                       changes[i](*during);
                                                       return SurfaceIndexPtr(phantom_bone().prepared);
                                                     }).share();
    BoneRegistration tried(bone, plan(), surface_);
    during = &tried;
    draw_on(tried, trial_.curves);
    tried.register_all([] { return true; });
    EXPECT_EQ(tried.status()->history->empty(), i + 1 < changes.size()) << "change " << i;
  }
}

// The same of the registration that runs along: what it found with a stroke does not take effect once the
// stroke is left out, though the worker hears of that later than the screen.
TEST_F(BoneRegistrationTest, AnOldResultThatRanAlongHasNoEffect) {
  draw_on(bone_, trial_.curves);
  bone_.finish();  // confirmed by now, and nobody has asked yet
  bone_.leave_out(0, true);
  const auto status = bone_.status();
  EXPECT_TRUE(status->online == nullptr || status->online->strokes.front().is_excluded);
  EXPECT_TRUE(status->online != nullptr || status->history->empty());
}

// The screen asks in every frame: as long as nothing changes it gets the same object.
TEST_F(BoneRegistrationTest, TheStatusIsMadeAnewOnlyAfterAChange) {
  const auto first = bone_.status();
  EXPECT_EQ(bone_.status(), first);
  bone_.touch_control_point({1, 2, 3});
  const auto touched = bone_.status();
  EXPECT_NE(touched, first);
  bone_.finish();
  EXPECT_TRUE(bone_.status()->touches.has_control_point());
}

// A bone that becomes ready late takes in what was drawn and touched before, with no call but the screen's;
// the control point is the one that was kept then.
TEST_F(BoneRegistrationTest, ABoneThatIsReadyLateTakesInWhatCameBefore) {
  std::promise<SurfaceIndexPtr> promise;
  BoneRegistration late(promise.get_future().share(), plan(), surface_);
  draw_on(late, trial_.curves);
  for (const double dx_mm : {0.0, 0.0, 4.0, -4.0}) late.add_touch(on_bone(dx_mm));
  late.touch_control_point(on_bone(0));
  EXPECT_EQ(late.status()->online, nullptr);
  EXPECT_EQ(state_of(*late.status()).text, "The bone is being made ready; go on drawing.");
  promise.set_value(phantom_bone().prepared);
  (void)late.status();
  late.finish();
  const RegistrationStatus status = *late.status();
  ASSERT_NE(status.online, nullptr);
  EXPECT_TRUE(status.online->registration.has_pose);
  EXPECT_EQ(status.online->touches.size(), 3U) << "one place touched twice counts once";
  for (int i = 0; i < 2; ++i) late.touch_control_point(on_bone(0) + Eigen::Vector3d(0, 0, 2));
  late.finish();
  EXPECT_NE(late.status()->online->alarm, "") << "compared with the one of before";
}

// Strokes that were all drawn before the bone was ready are judged as those drawn live, with all of them and
// one of them left out, and take effect: nobody draws on and nobody presses a key.
TEST_F(BoneRegistrationTest, StrokesThatWereDrawnBeforeTheBoneWasReadyConfirm) {
  for (const bool leaves_out : {false, true}) {
    std::promise<SurfaceIndexPtr> promise;
    BoneRegistration late(promise.get_future().share(), plan(), surface_);
    draw_on(late, trial_.curves);
    const int last = late.status()->drawn->back().curve;
    if (leaves_out) late.leave_out(last, true);
    promise.set_value(phantom_bone().prepared);
    (void)late.status();  // as every frame of the screen does
    late.finish();
    const RegistrationStatus status = *late.status();
    EXPECT_EQ(state_of(status).name, "Confirmed");
    ASSERT_NE(status.in_force, nullptr);
    EXPECT_TRUE(status.in_force->reliable);
    const std::size_t left_out_count = leaves_out
                                           ? static_cast<std::size_t>(std::count_if(
                                                 status.drawn->begin(), status.drawn->end(),
                                                 [last](const auto& point) { return point.curve == last; }))
                                           : 0;
    EXPECT_EQ(status.in_force->point_residuals_mm.size(), status.drawn->size() - left_out_count)
        << "every point has a say, to the last one";
    EXPECT_EQ(status.online->strokes.back().is_excluded, leaves_out);
    const Eigen::Vector3d target = phantom_bone().target_mm;
    EXPECT_LT((status.in_force->marker_from_bone * target - trial_.marker_from_bone * target).norm(), 0.6);
  }
}

// A bone that cannot be made ready says why, once and for all; nothing else fails.
TEST_F(BoneRegistrationTest, ABoneThatFailsSaysWhy) {
  std::promise<SurfaceIndexPtr> promise;
  BoneRegistration broken(promise.get_future().share(), plan(), surface_);
  promise.set_exception(std::make_exception_ptr(std::runtime_error("the mesh is empty")));
  draw_on(broken, trial_.curves);
  broken.add_touch(on_bone(0));
  const RegistrationStatus status = *broken.status();
  EXPECT_EQ(status.bone_trouble, "the mesh is empty");
  EXPECT_EQ(state_of(status).text, "the mesh is empty");
  EXPECT_EQ(state_of(status).severity, widgets::Severity::Bad);
  broken.register_all([] { return true; });
  EXPECT_EQ(broken.status()->in_force->reasons.front(), "the mesh is empty");
}

// After clearing, nothing of the old strokes comes back, and new ones register anew.
TEST_F(BoneRegistrationTest, ClearsAndStartsAgain) {
  draw(trial_.curves);
  bone_.clear();
  RegistrationStatus status = *bone_.status();
  EXPECT_TRUE(status.drawn->empty());
  EXPECT_TRUE(stroke_rows(status).empty());
  EXPECT_NE(status.in_force, nullptr) << "without an alarm the registration stays";
  const std::size_t entries = status.history->size();
  draw(trial_.curves);
  status = *bone_.status();
  EXPECT_GT(status.history->size(), entries);
  EXPECT_EQ(status.in_force, status.history->back().registration);
}

// Strokes on the bone are thin and green, those off it thick and red, and one that is left out is grey.
TEST_F(BoneRegistrationTest, ThePictureShowsHowFarStrokesLieOff) {
  draw(trial_.curves);
  RegistrationStatus status = *bone_.status();
  TouchedPicture picture;
  scene::SceneContent content;
  picture.add_strokes(content, status, *surface_, -1);
  ASSERT_FALSE(content.lines.empty());
  for (const scene::LineItem& line : content.lines) EXPECT_EQ(line.color, scene::kCurveColor);
  auto off = std::make_shared<strokes::Curves>(*status.drawn);
  for (strokes::CurvePoint& point :
       *off)  // lifted off along the line of sight of a probe: far from everything
    point.position_mm +=
        4 * (point.position_mm - trial_.marker_from_bone * Eigen::Vector3d::Zero()).normalized();
  status.drawn = off;
  status.left_out = {0};
  content = {};
  picture.add_strokes(content, status, *surface_, -1);
  long red = 0, grey = 0;
  for (const scene::LineItem& line : content.lines) {
    red += line.color == kOffColor ? 1 : 0;
    grey += line.color == kLeftOutColor ? 1 : 0;
  }
  EXPECT_GT(red, 0);
  EXPECT_GT(grey, 0);
  content = {};
  add_patches(content, status.online->coach);
  EXPECT_EQ(content.rods.size(), status.online->coach.patches.size());
}

// Cartilage of 2 mm on a bone that was segmented bare: what was assumed about it stands on the screen, and
// touches on it lie where they should.
TEST_F(BoneRegistrationTest, SaysWhatWasAssumedAboutCartilage) {
  const auto covered = registration::cartilage_trial(phantom_bone(), trial_, 2);
  BoneRegistration bone(ready_bone(), plan(), surface_, covered.region);
  EXPECT_EQ(assumed_of(*bone.status()), "");
  draw_on(bone, {covered.trial.curves.begin(), covered.trial.curves.begin() + 600});
  bone.finish();
  const std::string assumed = assumed_of(*bone.status()), words = "Assumed: ";
  ASSERT_TRUE(assumed.starts_with(words)) << assumed;
  EXPECT_NEAR(registration::thickness_in(assumed.substr(words.size())), 2, 0.3) << assumed;
  ASSERT_NE(bone.status()->in_force, nullptr);
  for (const double up_mm : {12.0, 16.0}) {
    const geometry::SurfacePoint place =
        surface_->closest_point(phantom_bone().target_mm + Eigen::Vector3d(0, 0, up_mm));
    bone.add_touch(trial_.marker_from_bone * (place.point_mm + 2 * place.normal));
    EXPECT_NEAR(bone.status()->touches.last().distance_mm.value(), 0, 0.4);
  }
  EXPECT_EQ(bone.status()->alarm, "");
  bone.register_all([] { return true; });
  EXPECT_TRUE(bone.status()->in_force->reliable);
  EXPECT_EQ(bone.status()->in_force->assumptions.size(), 1U);
}

}  // namespace
}  // namespace arthronaut::navigate
