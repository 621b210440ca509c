#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "navigation/registration/registration_file.h"
#include "navigation/strokes/stroke_tangents.h"
#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"
#include "planning/geometry/quantile.h"
#include "tests/navigation/registration/phantom_bone.h"
#include "tests/temporary_folder.h"

namespace arthronaut::registration {

namespace {

using experiments::TrialNoise;
using geometry::median;
using testing::Contains;
using testing::HasSubstr;

double target_error_mm(const RegistrationSummary& found, const experiments::Trial& trial,
                       const Eigen::Vector3d& target) {
  return found.has_pose ? (found.marker_from_bone * target - trial.marker_from_bone * target).norm() : 1e9;
}

}  // namespace

// The paper's dry setting, no initial guess: always found, always sure, and the error is about the one
// predicted.
TEST(RegisterCurves, DryTrialsAreAllFoundAndSure) {
  const PhantomBone& bone = phantom_bone();
  std::vector<double> errors, ratios;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto trial = bone.trial(TrialNoise::Dry, seed);
    const auto found = register_curves(*bone.prepared, trial.curves, {seed, true, bone.target_mm});
    EXPECT_TRUE(found.reliable) << "seed " << seed << ": " << testing::PrintToString(found.reasons);
    errors.push_back(target_error_mm(found, trial, bone.target_mm));
    ratios.push_back(errors.back() / found.predicted_tre_mm);
    EXPECT_LT(errors.back(), 0.4) << "seed " << seed;
  }
  EXPECT_LT(median(errors), 0.12);
  EXPECT_GT(median(ratios), 0.4);
  EXPECT_LT(median(ratios), 1.7);
}

// Lifted samples, soft tissue and slow errors: found, or doubted, never wrong and sure.
TEST(RegisterCurves, ExVivoTrialsAreNeverWrongAndSure) {
  const PhantomBone& bone = phantom_bone();
  std::vector<double> errors;
  int found_count = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto trial = bone.trial(TrialNoise::ExVivo, seed);
    const auto found = register_curves(*bone.prepared, trial.curves, {seed, true, bone.target_mm});
    errors.push_back(target_error_mm(found, trial, bone.target_mm));
    found_count += errors.back() < 2;
    EXPECT_TRUE(errors.back() < 2 || !found.reliable) << "seed " << seed << " off by " << errors.back();
  }
  EXPECT_GE(found_count, 9);
  EXPECT_LT(median(errors), 0.45);
}

// Without the world marker's help the same is found.
TEST(RegisterCurves, WorksWithoutTheMarkerPrior) {
  const PhantomBone& bone = phantom_bone();
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const auto trial = bone.trial(TrialNoise::Dry, seed);
    const auto found = register_curves(*bone.prepared, trial.curves, {seed, false, bone.target_mm});
    EXPECT_TRUE(found.reliable);
    EXPECT_LT(target_error_mm(found, trial, bone.target_mm), 0.4);
  }
}

// The same seed gives the same numbers, to the last bit.
TEST(RegisterCurves, IsDeterministicForASeed) {
  const PhantomBone& bone = phantom_bone();
  const auto trial = bone.trial(TrialNoise::ExVivo, 3);
  const auto first = register_curves(*bone.prepared, trial.curves, {7, true, bone.target_mm});
  const auto second = register_curves(*bone.prepared, trial.curves, {7, true, bone.target_mm});
  EXPECT_EQ(first.marker_from_bone.translation_mm, second.marker_from_bone.translation_mm);
  EXPECT_EQ(first.covariance, second.covariance);
  EXPECT_EQ(first.point_residuals_mm, second.point_residuals_mm);
}

// Clean points lie on the bone to within the rounding of the residual's grid, each with its own residual, in
// order; a point lifted by 3 mm reads 3 mm.
TEST(RegisterCurves, PointResidualsAreSignedDistancesInOrder) {
  const PhantomBone& bone = phantom_bone();
  experiments::TrialSetting clean;
  clean.white_mm = clean.slow_mm = 0;
  auto trial = bone.trial(clean, 2);
  const Eigen::Vector3d on_bone = trial.marker_from_bone.inverse() * trial.curves[100].position_mm;
  trial.curves[100].position_mm =
      trial.marker_from_bone * (on_bone + 3 * bone.surface->closest_point(on_bone).normal);
  const auto found = register_curves(*bone.prepared, trial.curves, {1, true, bone.target_mm});
  ASSERT_EQ(found.point_residuals_mm.size(), trial.curves.size());
  EXPECT_NEAR(found.point_residuals_mm[100], 3.0, 0.3);
  EXPECT_LT(std::abs(found.point_residuals_mm[99]), 0.1);
  EXPECT_LT(target_error_mm(found, trial, bone.target_mm), 0.02);
}

// What can't hold the bone is refused, each with its own reason.
TEST(RegisterCurves, RefusesCurvesThatHoldNothing) {
  const PhantomBone& bone = phantom_bone();
  const auto trial = bone.trial(TrialNoise::Dry, 1);
  const auto reasons_of = [&](const strokes::Curves& curves) {
    const auto found = register_curves(*bone.prepared, curves);
    EXPECT_FALSE(found.reliable);
    EXPECT_FALSE(found.reasons.empty());
    return found.reasons;
  };
  strokes::Curves line;
  for (int i = 0; i < 200; ++i)
    line.push_back({0, i / 60.0, Eigen::Vector3d(10 + 0.1 * i, 5 + 0.02 * i, -7)});
  EXPECT_THAT(reasons_of(line), Contains(HasSubstr("straight line")));

  experiments::TrialSetting small;
  small.area_radius_mm = 3;
  EXPECT_THAT(reasons_of(bone.trial(small, 4).curves), Contains(HasSubstr("patch")));

  EXPECT_THAT(reasons_of({trial.curves.begin(), trial.curves.begin() + 10}),
              Contains(HasSubstr("only 10 points")));
  EXPECT_THAT(reasons_of({}), Contains(HasSubstr("only 0 points")));

  strokes::Curves metres = trial.curves, equal = trial.curves, huge = trial.curves, broken = trial.curves;
  for (auto& point : metres) point.position_mm *= 1e-3;
  for (auto& point : equal) point.position_mm = {3, 4, 5};
  for (auto& point : huge) point.position_mm *= 1e3;
  broken[5].position_mm.x() = std::nan("");
  EXPECT_THAT(reasons_of(metres), Contains(HasSubstr("metres")));
  EXPECT_THAT(reasons_of(equal), Contains(HasSubstr("the same")));
  EXPECT_THAT(reasons_of(huge), Contains(HasSubstr("mm?")));
  EXPECT_THAT(reasons_of(broken), Contains(HasSubstr("not finite")));
}

// Strokes drawn on a ball or a plane as large as the notch fit a bone in many ways.
TEST(RegisterCurves, RefusesSurfacesThatSlide) {
  const PhantomBone& bone = phantom_bone();
  const auto trial = bone.trial(TrialNoise::Dry, 1);
  const auto normal = trial.marker_from_bone.rotate(bone.surface->closest_point(bone.target_mm).normal);
  const Eigen::Vector3d middle = trial.marker_from_bone * bone.target_mm;
  strokes::Curves flat = trial.curves, ball = trial.curves;
  const Eigen::Vector3d center = middle - 15 * normal;
  for (auto& point : flat) point.position_mm -= normal * normal.dot(point.position_mm - middle);
  for (auto& point : ball) point.position_mm = center + 15 * (point.position_mm - center).normalized();
  EXPECT_FALSE(register_curves(*bone.prepared, flat).reliable);
  EXPECT_FALSE(register_curves(*bone.prepared, ball).reliable);
}

// Strokes on a right knee, and a mesh of the left one.
TEST(RegisterCurves, RefusesTheOtherSidesBone) {
  const PhantomBone& bone = phantom_bone();
  geometry::TriangleMesh image = bone.mesh;
  for (Eigen::Vector3d& vertex : image.vertices_mm) vertex.x() = -vertex.x();
  for (auto& triangle : image.triangles) std::swap(triangle[1], triangle[2]);
  const SurfaceIndex mirrored(image);
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const auto found =
        register_curves(mirrored, bone.trial(TrialNoise::Dry, seed).curves, {seed, true, std::nullopt});
    EXPECT_FALSE(found.reliable);
    EXPECT_THAT(found.reasons, Contains(HasSubstr("other side")));
  }
}

// Strokes that miss the mirror image by nearly as much as such noise may, and lead there by far over the next
// pose: it shows alone when the other side is asked.
TEST(RegisterCurves, RefusesTheOtherSidesBoneWhereItFitsFairly) {
  const PhantomBone& bone = phantom_bone();
  const auto wall_mm = experiments::find_lateral_notch_wall(bone.mesh, *bone.surface, bones::Side::Right);
  ASSERT_TRUE(wall_mm);
  for (const std::uint64_t seed : {8'000'027, 8'000'033, 8'000'036}) {
    strokes::Curves curves = experiments::make_trial(bone.mesh, *bone.surface, *wall_mm,
                                                     experiments::setting_of(TrialNoise::ExVivo), seed)
                                 .curves;
    for (auto& point : curves) point.position_mm.x() = -point.position_mm.x();
    const auto found = register_curves(*bone.prepared, curves, {seed, true, *wall_mm});
    EXPECT_FALSE(found.reliable) << "seed " << seed;
    EXPECT_THAT(found.reasons, Contains(HasSubstr("mirror image"))) << "seed " << seed;
  }
}

// Many points are no trouble, and weigh no more than the path they lie on.
TEST(RegisterCurves, TakesTwentyThousandPoints) {
  const PhantomBone& bone = phantom_bone();
  auto setting = experiments::setting_of(TrialNoise::Dry);
  setting.step_mm = 0.027;
  const auto trial = bone.trial(setting, 5);
  ASSERT_GE(trial.curves.size(), 19'000u);
  const auto found = register_curves(*bone.prepared, trial.curves, {1, true, bone.target_mm});
  EXPECT_TRUE(found.reliable) << testing::PrintToString(found.reasons);
  EXPECT_LT(target_error_mm(found, trial, bone.target_mm), 0.4);
  EXPECT_EQ(found.point_residuals_mm.size(), trial.curves.size());
}

// The predicted error grows with the distance from what was touched.
TEST(RegisterCurves, PredictedErrorGrowsAwayFromTheTouchedArea) {
  const PhantomBone& bone = phantom_bone();
  const auto found =
      register_curves(*bone.prepared, bone.trial(TrialNoise::Dry, 1).curves, {1, true, bone.target_mm});
  EXPECT_NEAR(predicted_error_mm(found, bone.target_mm), found.predicted_tre_mm, 1e-9);
  EXPECT_GT(predicted_error_mm(found, bone.target_mm + Eigen::Vector3d(0, 0, 60)), found.predicted_tre_mm);
}

// Cartilage of 2 mm that the mesh lacks, and of 2 mm that the probe lacks: told of the region, the
// registration is sure, the thickness comes out within 0.3 mm, the error at the target is that of bare bone
// and about the one predicted. What is left of the residuals is the tip's noise, on the region too.
TEST(RegisterCurves, SolvesTheThicknessOfCartilage) {
  const PhantomBone& bone = phantom_bone();
  std::vector<double> ratios;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    for (const double thickness_mm : {2.0, -2.0}) {
      const CartilageTrial laid = cartilage_trial(bone, bone.trial(TrialNoise::Dry, seed), thickness_mm);
      RegistrationOptions options{seed, true, bone.target_mm};
      options.cartilage = laid.region;
      const auto found = register_curves(*bone.prepared, laid.trial.curves, options);
      EXPECT_TRUE(found.reliable) << "seed " << seed << ": " << testing::PrintToString(found.reasons);
      ASSERT_EQ(found.assumptions.size(), 1u);
      EXPECT_NEAR(thickness_in(found.assumptions[0]), thickness_mm, 0.3) << found.assumptions[0];
      EXPECT_LT(found.misfit_mm, 0.2);
      ratios.push_back(target_error_mm(found, laid.trial, bone.target_mm) / found.predicted_tre_mm);
      EXPECT_LT(ratios.back() * found.predicted_tre_mm, 0.4)
          << "seed " << seed << ", " << thickness_mm << " mm";
      std::vector<double> on_cartilage_mm;
      for (std::size_t i = 0; i < laid.is_on_cartilage.size(); ++i) {
        if (laid.is_on_cartilage[i]) on_cartilage_mm.push_back(found.point_residuals_mm[i]);
      }
      EXPECT_NEAR(median(on_cartilage_mm), 0, 0.3);
    }
  }
  EXPECT_GT(median(ratios), 0.3);
  EXPECT_LT(median(ratios), 1.7);
}

// Soft tissue and lifting on top of it: found, or doubted, never wrong and sure.
TEST(RegisterCurves, CartilageInExVivoTrialsIsNeverWrongAndSure) {
  const PhantomBone& bone = phantom_bone();
  int found_count = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const CartilageTrial laid = cartilage_trial(bone, bone.trial(TrialNoise::ExVivo, seed), 2);
    RegistrationOptions options{seed, true, bone.target_mm};
    options.cartilage = laid.region;
    const auto found = register_curves(*bone.prepared, laid.trial.curves, options);
    const double error_mm = target_error_mm(found, laid.trial, bone.target_mm);
    found_count += error_mm < 2;
    EXPECT_TRUE(error_mm < 2 || !found.reliable) << "seed " << seed << " off by " << error_mm;
  }
  EXPECT_GE(found_count, 3);
}

// A declared region, whose thickness is free, lets no bone of the other side pass; neither in the last trial,
// whose strokes fit the wrong way round within their noise once the region is left out.
TEST(RegisterCurves, RefusesTheOtherSidesBoneWithCartilageToo) {
  const PhantomBone& bone = phantom_bone();
  for (const auto& [noise, seed] :
       {std::pair{TrialNoise::Dry, 1u}, std::pair{TrialNoise::Dry, 2u}, std::pair{TrialNoise::ExVivo, 11u}}) {
    CartilageTrial laid = cartilage_trial(bone, bone.trial(noise, seed), 2);
    for (auto& point : laid.trial.curves) point.position_mm.x() = -point.position_mm.x();
    RegistrationOptions options{seed, true, bone.target_mm};
    options.cartilage = laid.region;
    const auto found = register_curves(*bone.prepared, laid.trial.curves, options);
    EXPECT_FALSE(found.reliable);
    EXPECT_THAT(found.reasons, Contains(HasSubstr("other side")));
  }
}

// A corner of the strokes on cartilage: too little to hold its thickness, so it is left out, and harms
// nothing.
TEST(RegisterCurves, LeavesOutCartilageThatWasHardlyTouched) {
  const PhantomBone& bone = phantom_bone();
  const CartilageTrial laid = cartilage_trial(bone, bone.trial(TrialNoise::Dry, 2), -2, 15);
  RegistrationOptions options{1, true, bone.target_mm};
  options.cartilage = laid.region;
  const auto found = register_curves(*bone.prepared, laid.trial.curves, options);
  EXPECT_TRUE(found.reliable) << testing::PrintToString(found.reasons);
  EXPECT_THAT(found.assumptions, Contains(HasSubstr("left out")));
  EXPECT_LT(target_error_mm(found, laid.trial, bone.target_mm), 0.4);
}

// A little over the 100 mm that are needed, of which too little lies on the region to hold its thickness:
// what is left is not enough.
TEST(RegisterCurves, DoesNotCountStrokesThatAreLeftOut) {
  const PhantomBone& bone = phantom_bone();
  experiments::TrialSetting setting = experiments::setting_of(TrialNoise::Dry);
  setting.stroke_count = 2;
  setting.length_of_each_mm = 46;
  for (const std::uint64_t seed : {2u, 8u}) {
    const CartilageTrial laid = cartilage_trial(bone, bone.trial(setting, seed), -2, 14);
    ASSERT_GT(strokes::smoothed_length_mm(laid.trial.curves), 100);
    RegistrationOptions options{1, true, bone.target_mm};
    options.cartilage = laid.region;
    const auto found = register_curves(*bone.prepared, laid.trial.curves, options);
    EXPECT_THAT(found.assumptions, Contains(HasSubstr("left out")));
    EXPECT_THAT(found.reasons, Contains(HasSubstr("too little was touched")));
  }
}

// Where all strokes lie on the cartilage, nothing holds its thickness, and that is said.
TEST(RegisterCurves, DoubtsStrokesOnCartilageAlone) {
  const PhantomBone& bone = phantom_bone();
  RegistrationOptions options{1, true, bone.target_mm};
  options.cartilage.emplace().points_mm = bone.mesh.vertices_mm;
  const auto found = register_curves(*bone.prepared, bone.trial(TrialNoise::Dry, 3).curves, options);
  EXPECT_FALSE(found.reliable);
  EXPECT_THAT(found.reasons, Contains(HasSubstr("cartilage")));
  EXPECT_THAT(found.assumptions, Contains(HasSubstr("taken to lie on the mesh")));
}

// A plan whose entry is where the strokes are helps; one on the far side of the bone does no harm, and is
// said.
TEST(RegisterCurves, LooksNearThePlanFirst) {
  const PhantomBone& bone = phantom_bone();
  const auto trial = bone.trial(TrialNoise::ExVivo, 4);
  RegistrationOptions options{1, false, bone.target_mm};
  const geometry::Bounds bounds = geometry::bounds_of(bone.mesh);
  const Eigen::Vector3d far =
      bone.surface->closest_point({bounds.center_mm().x(), bounds.min_mm.y(), bounds.max_mm.z() - 5})
          .point_mm;
  for (const auto& [entry, words] :
       {std::pair{bone.target_mm, "within reach"}, std::pair{far, "out of reach"}}) {
    options.plan_entry_in_bone_mm = entry;
    const auto found = register_curves(*bone.prepared, trial.curves, options);
    EXPECT_LT(target_error_mm(found, trial, bone.target_mm), 1.0) << words;
    EXPECT_THAT(found.assumptions, Contains(HasSubstr(words)));
  }
}

// An entry that is not on the bone at all, such as another patient's plan, helps nothing, harms nothing, and
// is said.
TEST(RegisterCurves, SaysThatThePlannedEntryIsNotOnTheBone) {
  const PhantomBone& bone = phantom_bone();
  const auto trial = bone.trial(TrialNoise::Dry, 4);
  RegistrationOptions options{1, true, bone.target_mm};
  options.plan_entry_in_bone_mm = bone.target_mm + Eigen::Vector3d(200, 0, 0);
  const auto found = register_curves(*bone.prepared, trial.curves, options);
  EXPECT_TRUE(found.reliable);
  EXPECT_LT(target_error_mm(found, trial, bone.target_mm), 0.4);
  EXPECT_THAT(found.assumptions, Contains(HasSubstr("not on this bone")));
}

// registration.json keeps all that guidance needs.
TEST(RegistrationFile, RoundTrip) {
  const PhantomBone& bone = phantom_bone();
  auto found =
      register_curves(*bone.prepared, bone.trial(TrialNoise::Dry, 1).curves, {1, true, bone.target_mm});
  found.reliable = false;
  found.reasons = {"two poses", "one \"patch\""};
  const test::TemporaryFolder folder;
  const auto file = folder / "registration.json";
  write_registration_file(file, found);
  const auto read = read_registration_file(file);
  EXPECT_TRUE(read.has_pose);
  EXPECT_FALSE(read.reliable);
  EXPECT_EQ(read.reasons, found.reasons);
  EXPECT_EQ(read.point_count, found.point_count);
  EXPECT_LT((read.marker_from_bone.translation_mm - found.marker_from_bone.translation_mm).norm(), 1e-9);
  EXPECT_NEAR(predicted_error_mm(read, bone.target_mm), found.predicted_tre_mm, 1e-6);
}

// That nothing was found survives the file, and the file still has all that the format promises.
TEST(RegistrationFile, SaysThatNoPoseWasFound) {
  const test::TemporaryFolder folder;
  const auto file = folder / "registration.json";
  write_registration_file(file, register_curves(*phantom_bone().prepared, {}));
  const auto read = read_registration_file(file);
  EXPECT_FALSE(read.has_pose);
  EXPECT_FALSE(read.reliable);
  EXPECT_THAT(read.reasons, Contains(HasSubstr("only 0 points")));
  EXPECT_THAT(files::read_text(file), HasSubstr("marker_from_bone"));
}

// A file that claims to be sure of no pose is refused.
TEST(RegistrationFile, RefusesToBeSureOfNoPose) {
  const test::TemporaryFolder folder;
  const auto file = folder / "registration.json";
  std::ofstream(file)
      << R"({"format": "arthronaut.registration", "version": 1, "has_pose": false, "rms_mm": 0,
    "inlier_fraction": 0, "point_count": 5, "reliable": true, "reasons": [], "predicted_tre_mm": 0})";
  EXPECT_THROW((void)read_registration_file(file), InvalidInput);
}

// A covariance of the wrong size is refused with its place.
TEST(RegistrationFile, RefusesABrokenCovariance) {
  const test::TemporaryFolder folder;
  const auto file = folder / "registration.json";
  std::ofstream(file) << R"({"format": "arthronaut.registration", "version": 1,
    "marker_from_bone": {"q_wxyz": [1, 0, 0, 0], "t_mm": [0, 0, 0]}, "rms_mm": 0.1, "inlier_fraction": 1,
    "point_count": 5, "reliable": true, "reasons": [], "predicted_tre_mm": 0.1, "covariance": [1, 2]})";
  EXPECT_THROW((void)read_registration_file(file), InvalidInput);
}

}  // namespace arthronaut::registration
