#include "navigation/simulator/staging.h"

#include <gtest/gtest.h>

#include "planning/geometry/error.h"
#include "tests/navigation/simulator/phantom_options.h"

namespace arthronaut::simulator {
namespace {

double arc_mm(const std::vector<ProbePose>& stroke) {
  double length = 0;
  for (std::size_t i = 1; i < stroke.size(); ++i) length += (stroke[i].tip_mm - stroke[i - 1].tip_mm).norm();
  return length;
}

// Every knee, of either side, and either bone has a stage: long strokes on the bone, a wide pivot on the
// femur, the world marker just above the bone.
TEST(Staging, FindsAPlaceInEveryKnee) {
  for (const auto side : {bones::Side::Right, bones::Side::Left}) {
    for (const std::uint64_t seed : {1u, 2u}) {
      for (const auto bone_kind : {bones::BoneKind::Femur, bones::BoneKind::Tibia}) {
        SCOPED_TRACE(std::to_string(seed) + " " + std::string(bones::to_text(bone_kind)));
        const SimulationOptions options = phantom_options(seed, side, bone_kind);
        const geometry::Surface bone(bone_kind == bones::BoneKind::Femur ? options.knee.femur.mesh
                                                                         : options.knee.tibia.mesh);
        const Staging staging = stage_operation(options, bone);
        const Eigen::Vector3d tip_in_probe = *probe_of(options.tools).tip_mm;
        double length = 0;
        for (const auto& stroke : staging.strokes) {
          length += arc_mm(stroke);
          for (const ProbePose& pose : stroke) {
            EXPECT_LT(std::abs(bone.signed_distance_mm(pose.tip_mm)), 1e-3);
            EXPECT_LT((pose.bone_from_marker * tip_in_probe - pose.tip_mm).norm(), 1e-9);
          }
        }
        EXPECT_GE(length, 175);  // strokes of at least 200 steps of 0.5 mm at most
        if (bone_kind == bones::BoneKind::Femur)
          EXPECT_GE(staging.pivot_cone_deg, 25);
        else
          EXPECT_TRUE(staging.pivot.empty());
        const double height = bone.signed_distance_mm(staging.bone_from_world_marker.translation_mm);
        EXPECT_GT(height, 0.5);
        EXPECT_LT(height, 5);
      }
    }
  }
}

// The probe's swing has no place above the plateau, and is not played there.
TEST(Staging, ThePivotIsOfTheFemurAlone) {
  const SimulationOptions options = phantom_options(1, bones::Side::Right, bones::BoneKind::Tibia);
  EXPECT_THROW(SimulatedOperation(options, Phase::Pivot), InvalidInput);
}

// The same options give the same stage.
TEST(Staging, IsDeterministic) {
  const SimulationOptions options = phantom_options();
  const geometry::Surface bone(options.knee.femur.mesh);
  const Staging first = stage_operation(options, bone), again = stage_operation(options, bone);
  EXPECT_EQ(first.bone_from_world_marker.translation_mm, again.bone_from_world_marker.translation_mm);
  EXPECT_EQ(first.bone_from_camera_drill.translation_mm, again.bone_from_camera_drill.translation_mm);
  ASSERT_EQ(first.strokes.size(), again.strokes.size());
}

// Tools that lack what a phase needs are told by name.
TEST(Staging, NamesTheToolThatIsMissing) {
  SimulationOptions options = phantom_options();
  const geometry::Surface bone(options.knee.femur.mesh);
  options.tools.tools.clear();
  EXPECT_THROW((void)stage_operation(options, bone), InvalidInput);
  options.tools = tools::standard_tools();
  options.tools.world_markers.clear();
  EXPECT_THROW((void)stage_operation(options, bone), InvalidInput);
}

}  // namespace
}  // namespace arthronaut::simulator
