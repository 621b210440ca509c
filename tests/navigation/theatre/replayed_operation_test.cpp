// A recorded operation, run again, comes to the same state in every frame.
#include <gtest/gtest.h>

#include <map>
#include <random>

#include "navigation/recording/replay.h"
#include "tests/navigation/simulator/phantom_options.h"
#include "tests/navigation/theatre/theatre_sources.h"
#include "tests/temporary_folder.h"

namespace arthronaut::theatre {
namespace {

using operation::Command;

class ReplayedOperation : public ::testing::Test {
 protected:
  OperationRun::MakeSessionFolder folders() {
    return [this] {
      const auto folder = folder_ / ("session" + std::to_string(++count_));
      std::filesystem::create_directory(folder);
      return folder;
    };
  }
  void expect_replays(const std::string& session, long frames) const {
    recording::ReplayOptions options;
    options.bone = registration::phantom_bone().prepared;
    options.surface = std::make_shared<geometry::Surface>(registration::phantom_bone().mesh);
    const auto summary = recording::replay_session(recording::RecordedSession(folder_ / session), options);
    EXPECT_TRUE(summary.is_same_build);
    EXPECT_EQ(summary.states_compared, frames) << session;
    EXPECT_EQ(summary.states_equal, frames) << session;
    for (const auto& difference : summary.differences)
      ADD_FAILURE() << session << " " << difference.frame << " " << difference.what << " "
                    << difference.detail;
  }
  // Every command there is, each once or more.
  [[nodiscard]] std::vector<Command> commands(const operation::SourceSetup& source) const {
    operation::PlannedTunnel edited = test::phantom_plan();
    edited.length_mm += 1;
    const auto of = operation::provenance_of(setup_, source);
    operation::GiveRegistration resumed = test::true_registration(trial_, of);
    resumed.is_resumed = true;
    return {operation::Draw{true},
            test::true_registration(trial_, of),
            operation::TakeTouch{},
            operation::TouchControlPoint{},
            operation::SkipVerification{},
            operation::OfferPlan{edited},
            operation::TakePlanOver{},
            operation::Draw{true},
            operation::ExcludeStroke{0, true},
            operation::RegisterStrokes{},
            operation::TakeBackStroke{},
            resumed,
            operation::ChooseRegistration{0},
            operation::ReadDepthStop{21.5},
            operation::TunnelDrilled{},
            operation::ForgetTouches{},
            operation::ClearStrokes{},
            operation::MarkerPlacedAnew{},
            test::true_registration(trial_, of)};
  }

  const test::TemporaryFolder folder_;
  int count_ = 0;
  operation::OperationSetup setup_ = test::phantom_setup();
  experiments::Trial trial_ = registration::phantom_bone().trial(experiments::TrialNoise::Dry, 1);
};

// Commands at seeded frames over two sources of one operation, some of them between the sources; the second
// session goes on with what the first made.
TEST_F(ReplayedOperation, EveryCommandOverTwoSourcesGivesTheSameStates) {
  std::mt19937 random(3);
  {
    OperationRun run(setup_, test::at_once(setup_), folders());
    for (const int frames : {60, 50}) {
      const TheatreSource source = test::plain_source(frames);
      run.start(source);
      std::multimap<int, Command> script;
      for (const Command& command : commands(source.setup))
        script.emplace(std::uniform_int_distribution(0, frames - 1)(random), command);
      for (int i = 0; i < frames; ++i) {
        ASSERT_TRUE(run.step().picture);
        const auto [first, end] = script.equal_range(i);
        for (auto it = first; it != end; ++it) run.apply(it->second);
      }
      run.end_source();
      run.apply(operation::SkipVerification{});
      run.apply(operation::OfferPlan{test::phantom_plan()});
    }
  }
  EXPECT_EQ(recording::RecordedSession(folder_ / "session2").header().continues, "session1");
  expect_replays("session1", 60);
  expect_replays("session2", 50);
}

// What was given before any source ran is a part of the operation, too: a registration that stands from the
// first frame keeps the probe from drawing.
TEST_F(ReplayedOperation, WhatWasGivenBeforeTheFirstSourceIsReplayed) {
  {
    OperationRun run(setup_, test::at_once(setup_), folders());
    const TheatreSource source = test::plain_source(20);
    operation::PlannedTunnel edited = test::phantom_plan();
    edited.tunnel.entry_mm.x() += 1;
    run.apply(operation::OfferPlan{edited});
    run.apply(test::true_registration(trial_, operation::provenance_of(setup_, source.setup)));
    (void)run.follow_registration();
    run.start(source);
    EXPECT_FALSE(run.state()->draws);
    for (int i = 0; i < 20; ++i) ASSERT_TRUE(run.step().picture);
    run.end_source();
  }
  expect_replays("session1", 20);
}

// The simulator's pictures, kept by the record and tracked again: poses, strokes and decisions are the same
// to the last bit.
TEST_F(ReplayedOperation, TheSimulatorsPicturesGiveTheSameStates) {
  constexpr int kFrames = 24;
  simulator::SimulationOptions options = simulator::phantom_options();
  options.frame_count = kFrames;
  TheatreSource source;
  source.setup.kind = sources::SourceKind::Simulation;
  source.setup.pipeline.calibration = options.camera;
  source.setup.pipeline.tools = options.tools;
  source.setup.pipeline.refractive_index = options.refractive_index;
  source.open = [=] {
    return std::make_unique<simulator::SimulatedOperation>(options, simulator::Phase::Scratch);
  };
  long with_tip = 0;
  {
    OperationRun run(setup_, test::at_once(setup_), folders());
    run.start(source);
    run.keep_video(true);
    const std::vector<Command> script = commands(source.setup);
    for (std::size_t i = 0; i < kFrames; ++i) {
      ASSERT_TRUE(run.step().picture);
      with_tip += run.state()->frame.tip_is_valid ? 1 : 0;
      if (i >= 4 && i - 4 < script.size()) run.apply(script[i - 4]);
    }
    run.end_source();
    EXPECT_EQ(run.record_trouble(), "");
  }
  EXPECT_GT(with_tip, 5) << "the test must see something";
  expect_replays("session1", kFrames);
}

}  // namespace
}  // namespace arthronaut::theatre
