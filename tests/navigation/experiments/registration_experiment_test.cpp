#include "navigation/experiments/registration_experiment.h"

#include <gtest/gtest.h>

#include "planning/files/csv_table.h"
#include "planning/phantom/phantom_knee.h"
#include "tests/temporary_folder.h"

namespace arthronaut::experiments {

namespace {

class RegistrationExperimentTest : public testing::Test {
 protected:
  RegistrationExperimentTest() {
    options_.trial_count = 2;
    options_.series.area_center_mm = knee_.femoral_tunnel.entry_mm;
  }

  phantom::PhantomKnee knee_ = phantom::make_phantom_knee();
  RegistrationExperimentOptions options_;
};

}  // namespace

// A verdict is what its evidence says: who is relied on has the odds that were needed and no more misfit than
// is borne.
TEST_F(RegistrationExperimentTest, EvidenceBearsTheVerdictOut) {
  const auto result = run_registration_experiment(knee_.femur.mesh, options_);
  EXPECT_EQ(result.reliable_count, 2);
  EXPECT_EQ(result.success_count, 2);
  for (const TrialOutcome& trial : result.trials) {
    EXPECT_GT(trial.evidence.length_in_use_mm, 100);
    EXPECT_GE(trial.evidence.log_odds, trial.evidence.needed_log_odds);
    EXPECT_LE(trial.evidence.excess_misfit_mm, trial.evidence.bearable_excess_mm);
  }
}

// Strokes of one femur on one that is narrower and higher by several millimetres at the condyles: whatever is
// found, nothing of it counts as right, and what was relied on counts as wrong. That none is relied on is
// asked of real femora (tests/real_data): the phantom is too smooth about its notch.
TEST_F(RegistrationExperimentTest, NothingIsRightOnAnotherBone) {
  geometry::TriangleMesh other = knee_.femur.mesh;
  for (Eigen::Vector3d& vertex_mm : other.vertices_mm)
    vertex_mm = vertex_mm.cwiseProduct(Eigen::Vector3d(0.85, 1, 1.15));
  options_.registered_to = &other;
  const auto result = run_registration_experiment(knee_.femur.mesh, options_);
  EXPECT_FALSE(result.is_on_own_bone);
  EXPECT_EQ(result.success_count, 0);
  EXPECT_EQ(result.doubted_though_right_count, 0);
  EXPECT_EQ(result.reliable_but_wrong_count, result.reliable_count);
  const test::TemporaryFolder folder;
  write_verdict_evidence(folder / "evidence.csv", result);
  const auto table = files::CsvTable::read(folder / "evidence.csv",
                                           {"trial", "reliable", "lead", "log_odds", "needed_log_odds"});
  ASSERT_EQ(table.row_count(), 2U);
  EXPECT_EQ(table.integer(1, "reliable") == 1, result.trials[1].reliable);
  EXPECT_NEAR(table.number(1, "lead"), result.trials[1].evidence.lead, 1e-3);
  EXPECT_FALSE(table.optional_number(1, "target_error_mm"));
}

}  // namespace arthronaut::experiments
