// Whatever is asked for, in whatever order, an operation goes on, and a second run does the same.
#include <gtest/gtest.h>

#include <array>
#include <random>
#include <set>

#include "tests/navigation/operation/phantom_operation.h"

namespace arthronaut::operation {
namespace {

using registration::phantom_bone;
using sources::SourceKind;
using test::PhantomOperation;

// 200 commands of a seed between frames of strokes, rests, losses and sources that come and go; the digests
// of the decisions after each.
std::vector<std::uint64_t> digests_of(std::uint64_t seed) {
  static const experiments::Trial trial = phantom_bone().trial(experiments::TrialNoise::Dry, 1);
  std::mt19937_64 random(seed);
  const auto below = [&](int count) { return static_cast<int>(random() % static_cast<unsigned>(count)); };
  PhantomOperation run;
  std::vector<std::uint64_t> digests;
  std::size_t next_point = 0;
  for (int i = 0; i < 200; ++i) {
    if (i == 0 && below(2) == 0) {
      ResumeOperation resume;
      resume.of = provenance_of(run.operation().setup(), test::scripted_source());
      resume.registration = test::true_registration(trial, resume.of).registration;
      resume.registration_of = resume.of;
      resume.touches_mm = {test::on_bone(trial, 0)};
      resume.control_point_mm = test::on_bone(trial, 2);
      run.apply(resume);
    }
    if (i == 0 || below(40) == 0) {
      SourceSetup source = test::scripted_source(
          std::array{SourceKind::Live, SourceKind::Recording, SourceKind::Simulation}.at(random() % 3));
      if (below(3) == 0) source.pipeline.refractive_index = 1.3345;
      if (below(2) == 0) source.pipeline.tools.tools.back().provenance.origin = provenance::Origin::Nominal;
      run.start(source);
    }
    if (below(60) == 0) run.operation().end_source();
    const bool has_source = run.state()->has_source;
    const int frames = has_source ? below(30) : 0;
    const int scene = below(4);
    for (int n = 0; n < frames; ++n) {
      if (scene == 0) run.show_guide(below(8) - 6.0);
      if (scene == 1) run.show(run.frame());
      if (scene == 2) run.show_tip(test::on_bone(trial, 2.0 * below(2)));
      if (scene == 3) run.show_tip(trial.curves[next_point++ % trial.curves.size()].position_mm);
    }
    if (below(30) == 0) run.wait(40);
    PlannedTunnel plan = test::phantom_plan();
    plan.length_mm += below(2);
    GiveRegistration give = test::true_registration(
        trial, provenance_of(run.operation().setup(), test::scripted_source(), below(2)));
    give.is_resumed = below(2) == 0;
    const std::vector<Command> commands{Draw{below(4) != 0},
                                        TakeTouch{},
                                        TouchControlPoint{},
                                        ForgetTouches{},
                                        TakeBackStroke{},
                                        ExcludeStroke{below(6) - 1, below(2) == 0},
                                        ClearStrokes{},
                                        RegisterStrokes{},
                                        ChooseRegistration{static_cast<std::size_t>(below(5))},
                                        OfferPlan{below(4) == 0 ? std::nullopt : std::optional(plan)},
                                        TakePlanOver{},
                                        SkipVerification{},
                                        MarkerPlacedAnew{},
                                        ReadDepthStop{below(40) * 1.0},
                                        TunnelDrilled{},
                                        TakeBackDrilled{},
                                        ConfirmTimeOut{},
                                        CheckGuide{},
                                        TrustGuide{},
                                        give};
    run.apply(commands[random() % commands.size()]);
    const auto state = run.state();
    digests.push_back(digest_of_decisions(*state));
    // Whatever came before: nothing that does not stand is handed to guidance as reliable.
    const RegistrationInForce& in_force = state->registration->in_force;
    if (in_force.registration != nullptr) {
      EXPECT_EQ(in_force.registration->reliable, in_force.standing == Standing::Stands) << "seed " << seed;
    }
    EXPECT_EQ(in_force.standing == Standing::Void, in_force.mismatch.has_value());
    EXPECT_FALSE(state->frame.guidance.is_valid() && !state->guide_check.may_guide()) << "seed " << seed;
    if (state->drilled.tunnel) {
      EXPECT_GE(state->drilled.tunnel->pose_count, 15);
    }
  }
  return digests;
}

TEST(RandomCommands, NeverThrowAndASecondRunIsTheSame) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    std::vector<std::uint64_t> first;
    ASSERT_NO_THROW(first = digests_of(seed)) << "seed " << seed;
    EXPECT_EQ(digests_of(seed), first) << "seed " << seed;
    EXPECT_GT(std::set<std::uint64_t>(first.begin(), first.end()).size(), 20U) << "something happened";
  }
}

}  // namespace
}  // namespace arthronaut::operation
