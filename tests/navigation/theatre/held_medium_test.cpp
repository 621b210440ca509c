// Guidance waits until the pictures have confirmed the medium.
#include <gtest/gtest.h>

#include <map>

#include "navigation/simulator/simulated_operation.h"
#include "tests/navigation/simulator/phantom_options.h"
#include "tests/navigation/theatre/theatre_sources.h"

namespace arthronaut::theatre {
namespace {

using guidance::GuidanceState;

// What a drilling operation guides by, with a registration that is of whatever medium is stated.
std::map<GuidanceState, int> states_in(double stated_index) {
  const operation::OperationSetup setup = test::phantom_setup();
  simulator::SimulationOptions options = simulator::phantom_options();
  options.frame_count = 40;
  TheatreSource source;
  source.setup.kind = sources::SourceKind::Recording;
  source.setup.pipeline.calibration = options.camera;
  source.setup.pipeline.tools = options.tools;
  source.setup.pipeline.refractive_index = stated_index;
  source.open = [=] {
    return std::make_unique<simulator::SimulatedOperation>(options, simulator::Phase::Drill);
  };
  OperationRun run(setup, test::at_once(setup), {});
  run.start(source);
  operation::GiveRegistration known =
      test::true_registration(registration::phantom_bone().trial(experiments::TrialNoise::Dry, 1),
                              operation::provenance_of(setup, source.setup));
  known.registration.marker_from_bone =
      simulator::SimulatedOperation(options, simulator::Phase::Drill).marker_from_bone();
  run.apply(known);
  std::map<GuidanceState, int> states;
  for (OperationRun::Step step = run.step(); !step.has_ended; step = run.step())
    if (step.picture != nullptr) ++states[run.state_of_frame()->frame.guidance.state];
  run.end_source();
  for (const auto& [state, count] : states)
    std::printf("%.4f: %s in %d\n", stated_index, std::string(guidance::to_text(state)).c_str(), count);
  return states;
}

TEST(HeldMedium, Hazard27GuidesInNoPictureOfTheWrongOneAndInEveryOneOfTheRightOne) {
  const double right = simulator::phantom_options().refractive_index;
  auto of_right = states_in(right), of_wrong = states_in(right > 1.1 ? 1.0 : 1.3345);
  EXPECT_GT(of_right[GuidanceState::Valid], 20);
  EXPECT_EQ(of_right[GuidanceState::MediumUnsure] + of_right[GuidanceState::WrongMedium], 0);
  EXPECT_EQ(of_wrong[GuidanceState::Valid], 0);
  EXPECT_GT(of_wrong[GuidanceState::MediumUnsure], 0);
}

}  // namespace
}  // namespace arthronaut::theatre
