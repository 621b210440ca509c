// landmarks: proposed, set and confirmed; and what plan makes of proposed ones.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/app/command_line/plan_command.h"
#include "tests/resources/described.h"

namespace arthronaut {
namespace {

using test::run_program;
using ::testing::HasSubstr;
using ::testing::Not;

// The window and the report propose what a case lacks, and the command left the grid's checks unmade.
TEST_F(PlanCommand, ShowsThePlanOnProposedLandmarksAndKeepsNoneOfThem) {
  knee_.landmarks.clear();
  save(knee_);
  const auto result = run({"plan", "--bone", "femur"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.output,
              HasSubstr("Grid: landmarks proposed from the bone's shape, confirmed by nobody"));
  EXPECT_THAT(result.output, HasSubstr("Deep to shallow: "));
  EXPECT_THAT(result.output, Not(HasSubstr("not checked")));
  EXPECT_THAT(run({"plan", "--bone", "femur", "--json"}).output, HasSubstr("\"landmarks\": \"proposed\""));
  EXPECT_TRUE(cases::load_case(folder_ / "knee.arthro").landmarks.empty());
}

// A knee without landmarks: they are proposed, and that is a reason to look before relying on it. They stay
// in the case, as proposed, so that its grid is there for the checks and for whoever reads it; what a person
// had placed stays as it was.
TEST_F(PlanCommand, ADefaultOnProposedLandmarksIsNotReliableAndKeepsThem) {
  knee_.landmarks.clear();
  const Eigen::Vector3d placed = made_.femur_landmarks.at("notch_apex") + Eigen::Vector3d(0.5, 0, 0);
  knee_.landmarks[bones::BoneKind::Femur]["notch_apex"] = placed;
  save(knee_);
  const auto result = run({"plan", "--bone", "femur", "--default"});
  EXPECT_EQ(result.exit_code, 4) << result.output << result.errors;
  EXPECT_THAT(result.output + result.errors, HasSubstr("blumensaat_anterior"));
  EXPECT_THAT(result.output, Not(HasSubstr("not checked"))) << "the tibia's are proposed, too";
  const cases::Case kept = cases::load_case(folder_ / "knee.arthro");
  const auto& states = kept.landmark_states.at(bones::BoneKind::Femur);
  EXPECT_TRUE(kept.landmarks.at(bones::BoneKind::Femur).contains("blumensaat_anterior"));
  EXPECT_EQ(landmarks::state_of(states, "blumensaat_anterior"), landmarks::LandmarkState::Proposed);
  EXPECT_EQ(kept.landmarks.at(bones::BoneKind::Femur).at("notch_apex"), placed);
  EXPECT_EQ(landmarks::state_of(states, "notch_apex"), landmarks::LandmarkState::Confirmed);
  EXPECT_FALSE(kept.landmarks.contains(bones::BoneKind::Tibia));
}

TEST_F(PlanCommand, LandmarksAreProposedSetAndKept) {
  knee_.landmarks.clear();
  save(knee_);
  const auto proposed = run({"landmarks", "--propose", "--json"});
  EXPECT_EQ(proposed.exit_code, 0) << proposed.output << proposed.errors;
  ASSERT_TRUE(nlohmann::json::accept(proposed.output)) << proposed.output;
  EXPECT_EQ(test::undescribed(nlohmann::json::parse(proposed.output), "landmarks"), "");
  EXPECT_EQ(run({"landmarks", "--set", "femur.notch_apex=1,2,3"}).exit_code, 0);
  const cases::Case saved = cases::load_case(folder_ / "knee.arthro");
  EXPECT_EQ(saved.landmarks.at(bones::BoneKind::Femur).at("notch_apex"), Eigen::Vector3d(1, 2, 3));
  EXPECT_GT(saved.landmarks.at(bones::BoneKind::Femur).size(), 5U);
  // The case may follow what is set and confirmed.
  EXPECT_EQ(run_program({"landmarks", "--set", "femur.notch_apex=1,2,4", "--confirm", "femur",
                         folder_ / "knee.arthro", "--json"})
                .exit_code,
            0);
  EXPECT_EQ(run({"landmarks", "--propose"}).exit_code, 0);
  const auto proposed_count = [&] {
    std::size_t count = 0;
    const cases::Case now = cases::load_case(folder_ / "knee.arthro");
    for (const auto& [bone, states] : now.landmark_states)
      for (const auto& [name, state] : states) count += state == landmarks::LandmarkState::Proposed ? 1 : 0;
    return count;
  };
  const std::size_t before = proposed_count();
  ASSERT_GT(before, 2U) << "the tibia's";
  EXPECT_EQ(run_program({"landmarks", "--confirm", "tibia.plateau_medial,tibia.plateau_lateral",
                         folder_ / "knee.arthro"})
                .exit_code,
            0);
  EXPECT_EQ(proposed_count(), before - 2);
  EXPECT_EQ(run({"landmarks", "--confirm", "all"}).exit_code, 0);
  EXPECT_EQ(proposed_count(), 0U);
  EXPECT_THAT(run({"landmarks", "--confirm", "femur,no_such_bone"}).errors, HasSubstr("no_such_bone"));
  const auto unknown = run({"landmarks", "--set", "femur.no_such_point=1,2,3"});
  EXPECT_NE(unknown.exit_code, 0);
  EXPECT_THAT(unknown.errors, HasSubstr("no_such_point"));
}

}  // namespace
}  // namespace arthronaut
