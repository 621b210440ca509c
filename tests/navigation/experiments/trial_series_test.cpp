#include "navigation/experiments/trial_series.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "planning/bones/mesh_file.h"
#include "planning/files/json_document.h"
#include "planning/geometry/error.h"
#include "planning/phantom/phantom_knee.h"
#include "tests/planning/geometry/shapes.h"
#include "tests/temporary_folder.h"

namespace arthronaut::experiments {

// What is written is all that another program needs: the truth takes the curves back onto the bone that lies
// beside them. Dry tips are off by 0.1 mm white and 0.1 mm slow noise in each coordinate, 0.25 mm in all.
TEST(TrialSeries, WritesTrialsThatOtherProgramsCanRun) {
  const auto knee = phantom::make_phantom_knee();
  TrialSeriesOptions options;
  options.area_center_mm = knee.femoral_tunnel.entry_mm;
  const TrialSeries series(knee.femur.mesh, options);
  const test::TemporaryFolder folder;
  write_trials(folder.path(), series, 2);
  const geometry::Surface surface(bones::read_mesh(folder / "bone.ply"));
  for (const std::string name : {"trial_0", "trial_1"}) {
    const auto curves = strokes::read_curves_file(folder / (name + ".csv"));
    const auto truth = files::read_json(folder / (name + ".json"), "arthronaut.trial", 1);
    const auto bone_from_marker = truth.rigid_transform("marker_from_bone").inverse();
    EXPECT_LT((truth.vector3("target_mm") - series.target_mm()).norm(), 1e-6);
    ASSERT_GT(curves.size(), 1000u);
    for (const strokes::CurvePoint& point : curves) {
      ASSERT_LT(std::abs(surface.signed_distance_mm(bone_from_marker * point.position_mm)), 1.0);
    }
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "trial_2.json"));
}

// The same number gives the same trial, another number another one.
TEST(TrialSeries, IsDeterministic) {
  const auto knee = phantom::make_phantom_knee();
  TrialSeriesOptions options;
  options.area_center_mm = knee.femoral_tunnel.entry_mm;
  const TrialSeries series(knee.femur.mesh, options);
  EXPECT_EQ(series.make(3).curves.back().position_mm, series.make(3).curves.back().position_mm);
  EXPECT_NE(series.make(3).curves.back().position_mm, series.make(4).curves.back().position_mm);
}

// A ball has no notch to digitise.
TEST(TrialSeries, RefusesABoneWithoutNotch) {
  EXPECT_THROW(TrialSeries(test::octahedron(30), {}), InvalidInput);
}

}  // namespace arthronaut::experiments
